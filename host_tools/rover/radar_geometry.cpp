#include "radar_geometry.h"

#include "sim/scenario/scenario_error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace traction {

namespace {

struct Field {
    const char *name;
    double radar_geometry_t::*value;
};
constexpr Field fields[] = {
    {"carrier_Hz", &radar_geometry_t::carrier_Hz},
    {"vertical_deg", &radar_geometry_t::vertical_deg},
    {"horizontal_deg", &radar_geometry_t::horizontal_deg},
    {"depression_deg", &radar_geometry_t::depression_deg},
    {"rate_Hz", &radar_geometry_t::rate_Hz},
    {"band_low_Hz", &radar_geometry_t::band_low_Hz},
    {"band_high_Hz", &radar_geometry_t::band_high_Hz},
    {"speed_high_m_s", &radar_geometry_t::speed_high_m_s},
    {"ground_exponent", &radar_geometry_t::ground_exponent},
};

bool equal(const radar_geometry_t &a, const radar_geometry_t &b) {
    return a.target == b.target &&
           std::all_of(std::begin(fields), std::end(fields), [&](const Field &f) { return a.*f.value == b.*f.value; });
}

std::string text_of(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

struct Made {
    std::mutex mutex;
    std::deque<std::pair<radar_geometry_t, doppler_template_t>> all; // a deque: its elements stay where they are
};

Made &made() {
    static Made here;
    return here;
}

} // namespace

bool needs_own_template(const sim::RoverDescription &rover) {
    const double depression = rover.at("radar", "depression_deg");
    const bool other_band = rover.value("radar", "band_low_Hz").given || rover.value("radar", "band_high_Hz").given ||
                            rover.value("radar", "speed_high_m_s").given;
    return rover.radar == "own" || rover.at("radar", "rate_Hz") != 512 || depression < 15 || depression > 25 || other_band;
}

radar_geometry_t radar_geometry_of(const sim::RoverDescription &rover) {
    const auto models = sim::radar_models();
    const auto model = std::find_if(models.begin(), models.end(), [&](const sim::RadarModel &m) { return m.name == rover.radar; });
    const double rate_Hz = rover.at("radar", "rate_Hz");
    radar_geometry_t out = model != models.end()
                               ? radar_geometry_like_reference(model->frequency_Hz, model->vertical_deg, model->horizontal_deg, rate_Hz)
                               : radar_geometry_like_reference(rover.at("radar", "carrier_Hz"), rover.at("radar", "vertical_deg"),
                                                               rover.at("radar", "horizontal_deg"), rate_Hz);
    out.depression_deg = rover.at("radar", "depression_deg");
    for (const auto &[name, into] : {std::pair{"band_low_Hz", &out.band_low_Hz}, std::pair{"band_high_Hz", &out.band_high_Hz},
                                     std::pair{"speed_high_m_s", &out.speed_high_m_s}})
        if (rover.value("radar", name).given) *into = rover.at("radar", name);
    const radar_geometry_refusal_t refusal = radar_geometry_check(&out);
    if (refusal.field != nullptr) {
        const sim::RoverValue &value = rover.value("radar", refusal.field);
        char range[96];
        std::snprintf(range, sizeof range, "must be %g to %g for a template", refusal.low, refusal.high);
        throw sim::ScenarioError(rover.file, value.line, std::string("radar.") + refusal.field, text_of(refusal.value).substr(0, 12), range,
                                 refusal.mend);
    }
    return out;
}

const doppler_template_t *template_of(const radar_geometry_t &geometry) {
    Made &here = made();
    const std::lock_guard<std::mutex> lock(here.mutex); // radar_template_make is not reentrant either
    for (const auto &[known, beam] : here.all)
        if (equal(known, geometry)) return &beam;
    auto &fresh = here.all.emplace_back();
    fresh.first = geometry;
    radar_template_make(&geometry, &fresh.second);
    return &fresh.second;
}

std::map<std::string, std::string> geometry_lines(const doppler_template_t *beam, const std::string &prefix) {
    Made &here = made();
    const std::lock_guard<std::mutex> lock(here.mutex);
    std::map<std::string, std::string> lines;
    for (const auto &[known, its_beam] : here.all)
        if (&its_beam == beam) {
            for (const Field &field : fields) lines[prefix + field.name] = text_of(known.*field.value);
            lines[prefix + "target"] = known.target == RADAR_TARGET_POINT ? "point" : "ground";
        }
    return lines;
}

radar_geometry_t geometry_of_lines(const std::map<std::string, std::string> &lines, const std::string &prefix) {
    radar_geometry_t out = radar_geometry_reference();
    for (const Field &field : fields) {
        const auto line = lines.find(prefix + field.name);
        char *end = nullptr;
        if (line == lines.end()) throw std::invalid_argument(prefix + field.name + ": missing beside the other numbers of this radar");
        out.*field.value = std::strtod(line->second.c_str(), &end);
        if (end == line->second.c_str() || *end != '\0') throw std::invalid_argument(line->first + ": " + line->second + ": not a number");
    }
    const auto target = lines.find(prefix + "target");
    if (target != lines.end() && target->second == "point") out.target = RADAR_TARGET_POINT;
    const radar_geometry_refusal_t refusal = radar_geometry_check(&out);
    if (refusal.field != nullptr) throw std::invalid_argument(prefix + refusal.field + ": " + text_of(refusal.value) + ": " + refusal.mend);
    return out;
}

} // namespace traction
