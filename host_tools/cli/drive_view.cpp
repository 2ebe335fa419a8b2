#include "drive_view.h"

#include "host_tools/lab/session.h"
#include "host_tools/rover/radar_geometry.h"
#include "sim/plant/layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace traction::cli {

namespace {

constexpr double light_m_s = 299792458;

double value_or(const lab::Parameters &parameters, const std::string &key, double otherwise) {
    const auto it = parameters.find(key);
    return it != parameters.end() && std::isfinite(it->second.value) ? it->second.value : otherwise;
}

} // namespace

report::RoverShape shape_of(const sim::RoverDescription &rover) {
    const radar_geometry_t radar = radar_geometry_of(rover);
    report::RoverShape shape{.name = rover.name,
                             .mass_kg = rover.at("body", "mass_kg"),
                             .length_m = rover.at("body", "length_m"),
                             .width_m = rover.at("body", "width_m"),
                             .height_m = rover.at("body", "height_m"),
                             .wheel = {},
                             .Hz_per_m_s = 2 * radar.carrier_Hz / light_m_s * std::cos(radar.depression_deg * std::numbers::pi / 180)};
    const sim::LayoutParameters layout = rover.layout();
    shape.halves = !layout.rigid && (layout.kind == sim::Layout::four || layout.kind == sim::Layout::six);
    for (const int slot : sim::wheels_of(layout.kind)) {
        const sim::WheelPlace at = sim::wheel_place(layout, rover.at("body", "half_wheelbase_m"), rover.at("body", "half_track_m"), slot);
        const bool caster = sim::is_caster(layout.kind, slot), own = !caster && slot < sim::wheel_count;
        shape.wheel.push_back({.x_m = at.ahead_m,
                               .y_m = at.left_m,
                               .radius_m = caster ? layout.caster_radius_m
                                           : own  ? rover.radius_m(static_cast<std::size_t>(slot))
                                                  : rover.at("wheels", "radius_m"),
                               .width_m = rover.at("wheels", "width_m"),
                               .number = slot});
    }
    return shape;
}

report::RoverShape shape_of(const lab::Model &model) {
    report::RoverShape shape{.name = model.name,
                             .mass_kg = value_or(model.rover, "mass_kg", 1),
                             .length_m = 0,
                             .width_m = 0,
                             .height_m = 0,
                             .halves = model.halves || model.wheel.size() == 4,
                             .wheel = {}};
    double front_m = 0, rear_m = 0, aside_m = 0, inside_m = 0, radius_m = 0;
    for (const lab::WheelSpec &wheel : model.wheel) {
        const double r = value_or(wheel.geometry, "radius_m", 0.05), w = value_or(wheel.geometry, "width_m", 0.5 * r);
        shape.wheel.push_back({.x_m = value_or(wheel.geometry, "x_m", 0),
                               .y_m = value_or(wheel.geometry, "y_m", 0),
                               .radius_m = r,
                               .width_m = w > 0 ? w : 0.5 * r});
        const report::RoverShape::Wheel &at = shape.wheel.back();
        front_m = std::max(front_m, at.x_m), rear_m = std::min(rear_m, at.x_m), radius_m = std::max(radius_m, r);
        aside_m = std::max(aside_m, std::fabs(at.y_m)), inside_m = std::max(inside_m, std::fabs(at.y_m) - 0.6 * at.width_m);
    }
    shape.length_m = front_m - rear_m + 2.2 * radius_m;
    shape.width_m = inside_m > radius_m ? 2 * inside_m : 2 * std::max(aside_m, radius_m);
    shape.height_m = 2.5 * radius_m;
    return shape;
}

nlohmann::json with_replay(nlohmann::json result, const lab::Session &session) {
    if (session.runs.size() != 1 || session.model.wheel.empty()) return result; // several runs have several clocks
    const report::RoverShape shape = shape_of(session.model);
    for (const report::RoverShape::Wheel &wheel : shape.wheel)
        if (!(wheel.radius_m > 0)) return result;
    nlohmann::json replay = report::replay_of(session.runs.front(), nullptr, shape);
    if (!replay.is_null()) result["replay"] = std::move(replay);
    return result;
}

} // namespace traction::cli
