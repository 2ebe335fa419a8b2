#include "next.h"

#include "result.h"
#include "screen.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>

namespace traction::lab {

namespace {

// Manoeuvres and the effects they tell apart (LAB.md section 3; the catalogue's `reveals` says the same in words).
struct Manoeuvre {
    const char *title;
    std::vector<std::string> effects;
    const char *segments;
};

const std::vector<Manoeuvre> &manoeuvres() {
    static const std::vector<Manoeuvre> list = {
        {"there and back over the same ground",
         {"grade", "multi_pass", "mass_offset_x", "soil_patch", "soil_gradient", "tether_drag", "accel_bias", "rolling_resistance", "body_drag"},
         "[[drive]]\nfor_s = 2.0\nmode = \"stop\"\n\n[[drive]]\nfor_s = 14.0\nmode = \"platform_speed\"\nspeed_m_s = 0.3\n\n[[drive]]\nfor_s = 2.0\nmode = \"platform_speed\"\nspeed_m_s = 0.0\n\n"
         "[[drive]]\nfor_s = 14.0\nmode = \"platform_speed\"\nspeed_m_s = -0.3\n\n[[drive]]\nfor_s = 2.0\nmode = \"platform_speed\"\nspeed_m_s = 0.0\n\n"},
        {"three wheels push, one drags",
         {"mesh_loss", "slip_sinkage", "torque_constant", "current_gain", "wheel_radius", "encoder_missed", "sliding_speed_loss", "shear_stiffness", "mass_offset_y"},
         "[[drive]]\nfor_s = 6.0\nmode = \"wheel_speed\"\nwheel_speed_rad_s = [6.0, 6.0, 6.0, 1.0]\n\n[[drive]]\nfor_s = 6.0\nmode = \"wheel_speed\"\nwheel_speed_rad_s = [1.0, 6.0, 6.0, 6.0]\n\n"
         "[[drive]]\nfor_s = 6.0\nmode = \"wheel_speed\"\nwheel_speed_rad_s = [6.0, 1.0, 6.0, 6.0]\n\n[[drive]]\nfor_s = 6.0\nmode = \"wheel_speed\"\nwheel_speed_rad_s = [6.0, 6.0, 1.0, 6.0]\n\n"},
        {"slip sweep of the front wheels",
         {"slip_sinkage", "shear_stiffness", "sliding_speed_loss", "relaxation_length", "mesh_loss", "speed_resistance"},
         "[[drive]]\nfor_s = 20.0\nmode = \"soil_sweep\"\nspeed_m_s = 0.3\n\n[[drive]]\nfor_s = 20.0\nmode = \"soil_sweep\"\nspeed_m_s = 0.15\n\n"},
        {"hard starts and stops",
         {"load_transfer", "accel_scale", "accel_tilt", "radar_pitch", "camera_delay", "actuation_delay", "relaxation_length", "backlash", "radar_scale", "camera_scale"},
         "[[drive]]\nfor_s = 4.0\nmode = \"platform_speed\"\nspeed_m_s = 0.8\n\n[[drive]]\nfor_s = 3.0\nmode = \"platform_speed\"\nspeed_m_s = -0.8\n\n[[drive]]\nfor_s = 3.0\nmode = \"platform_speed\"\nspeed_m_s = 0.8\n\n"
         "[[drive]]\nfor_s = 3.0\nmode = \"platform_speed\"\nspeed_m_s = 0.0\n\n[[drive]]\nfor_s = 8.0\nmode = \"open_loop\"\nduty = { amplitude = 0.9, period_s = 1.5 }\n\n"},
        {"stairs of speed, both ways",
         {"viscous_friction", "coulomb_friction", "stribeck_friction", "torque_ripple", "speed_resistance", "bridge_dead_time", "voltage_gain", "wiring_resistance", "current_offset", "accel_drift", "winding_heating"},
         "[[drive]]\nfor_s = 6.0\nmode = \"platform_speed\"\nspeed_m_s = 0.05\n\n[[drive]]\nfor_s = 6.0\nmode = \"platform_speed\"\nspeed_m_s = 0.2\n\n[[drive]]\nfor_s = 6.0\nmode = \"platform_speed\"\nspeed_m_s = 0.6\n\n"
         "[[drive]]\nfor_s = 6.0\nmode = \"platform_speed\"\nspeed_m_s = -0.1\n\n[[drive]]\nfor_s = 6.0\nmode = \"platform_speed\"\nspeed_m_s = -0.5\n\n"},
        {"turns on the spot and on the move",
         {"lateral_scrub", "wheel_radius", "mass_offset_y"},
         "[[drive]]\nfor_s = 6.0\nmode = \"platform_speed\"\nspeed_m_s = 0.2\nyaw_rate_rad_s = 0.8\n\n[[drive]]\nfor_s = 6.0\nmode = \"platform_speed\"\nspeed_m_s = 0.2\nyaw_rate_rad_s = -0.8\n\n"
         "[[drive]]\nfor_s = 6.0\nmode = \"platform_speed\"\nspeed_m_s = 0.0\nyaw_rate_rad_s = 0.9\n\n"},
    };
    return list;
}

std::string plain(const std::string &label) { return label.substr(0, label.find(" on wheel")); }

// The effects in question: every class's members, else what was not excited.
std::vector<std::string> open_questions(const Diagnosis &d) {
    std::vector<std::string> list;
    for (const ConfoundedClass &c : d.classes)
        for (const std::string &m : c.members) list.push_back(plain(m));
    if (list.empty())
        for (const auto &[effect, why] : d.not_excited) list.push_back(effect);
    return list;
}

} // namespace

std::string next_scenario(const std::vector<std::string> &effects, const Model &model, std::string &title) {
    const std::set<std::string> wanted(effects.begin(), effects.end());
    const auto hits = [&](const Manoeuvre &m) { return std::count_if(m.effects.begin(), m.effects.end(), [&](const std::string &e) { return wanted.count(e) != 0; }); };
    std::vector<const Manoeuvre *> order;
    for (const Manoeuvre &m : manoeuvres())
        if (hits(m) > 0) order.push_back(&m);
    std::stable_sort(order.begin(), order.end(), [&](const Manoeuvre *a, const Manoeuvre *b) { return hits(*a) > hits(*b); });
    if (order.empty()) order.push_back(&manoeuvres().front());
    if (order.size() > 3) order.resize(3);
    std::string soil = "sand", drives;
    if (model.soil_law == SoilLaw::burckhardt) soil = "concrete";
    else if (!model.wheel.empty() && model.wheel[0].soil.at("shear_slip").value < 0.15) soil = "gravel";
    double duration_s = 4;
    title.clear();
    for (const Manoeuvre *m : order) {
        title += (title.empty() ? "" : ", then ") + std::string(m->title);
        drives += m->segments;
        for (std::size_t at = drives.size() - std::string(m->segments).size(); (at = drives.find("for_s = ", at)) != std::string::npos; ++at) duration_s += std::atof(drives.c_str() + at + 8);
    }
    std::ostringstream out;
    out << "title = \"Next: " << title << "\"\nduration_s = " << duration_s << "\nseed = 1\n\n[ground]\nsoil = \"" << soil << "\"\n\n[[drive]]\nfor_s = 2.0\nmode = \"stop\"\n\n"
        << drives << "[[drive]]\nfor_s = 2.0\nmode = \"stop\"\n";
    return out.str();
}

nlohmann::json next_json(const Diagnosis &d, const Model &model) {
    const std::vector<std::string> effects = open_questions(d);
    if (effects.empty()) return nullptr;
    std::string title;
    const std::string scenario = next_scenario(effects, model, title);
    return {{"title", title}, {"scenario_toml", scenario}, {"separates", effects}};
}

void append_lineage(Model &model, const Dataset &data, const std::vector<Rung> &ladder, const Rung &final_rung) {
    for (std::size_t i = 0; i < ladder.size(); ++i) {
        if (i == 0 && !model.lineage.empty()) continue; // the baseline is the last entry already
        const bool last = i + 1 == ladder.size();
        const Rung &r = last && std::isfinite(final_rung.train) ? final_rung : ladder[i];
        model.lineage.push_back({ladder[i].label, data.log_file, data.date, r.train, r.heldout, ladder[i].floor});
    }
}

Added add_effect(const Model &model, const Dataset &data, const std::string &effect, int wheel, const std::string &file) {
    Added added;
    added.model = model;
    if (wheel < -1 || wheel >= static_cast<int>(model.wheel.size()))
        throw ModelError(model.file, 0, "--wheel", "is " + std::to_string(wheel), "wheels are 0 to " + std::to_string(model.wheel.size() - 1));
    if (model.find_effect(effect, wheel) != nullptr) throw ModelError(model.file, 0, effect, "is in the model already", "use `traction fit` to fit it, `traction drop` to take it out");
    if (!file.empty()) {
        std::ifstream stream(file, std::ios::binary);
        if (!stream.is_open()) throw std::ios_base::failure("cannot open " + file, std::make_error_code(std::errc::no_such_file_or_directory));
        std::ostringstream text;
        text << stream.rdbuf();
        Model bare = model;
        bare.effects.clear();
        bare.lineage.clear();
        const Model with = parse_model(model_text(bare) + "\n" + text.str(), file);
        const auto found = std::find_if(with.effects.begin(), with.effects.end(), [&](const EffectUse &use) { return use.name == effect; });
        if (found == with.effects.end()) throw ModelError(file, 0, "effect.name", "there is no effect \"" + effect + "\" in it", "give the name of one of its [[effect]] tables");
        added.model.effects.push_back(*found);
        added.model.effects.back().wheel = wheel >= 0 ? wheel : found->wheel;
    } else {
        const sim::Effect *known = sim::find_effect(effect);
        if (known == nullptr) throw ModelError(model.file, 0, effect, "is no effect of the catalogue", "`traction effects` lists them; for your own use --effect-file");
        if (wheel >= 0 && !known->per_wheel) throw ModelError(model.file, 0, effect, "cannot be confined to a wheel", "leave --wheel out");
        Problem problem(data, make_physics(model), free_parameters(model, make_physics(model)));
        problem.fit({.iterations = 6, .reweight = true});
        const Screen screen(problem);
        double best = -1e300;
        EffectUse use;
        for (const Candidate &c : catalogue_candidates(model, data, problem.forward().motion())) {
            if (c.effect != effect || c.wheel != wheel) continue;
            Physics at = problem.physics();
            c.prepare(at);
            Eigen::MatrixXd columns(problem.row_scale.size(), static_cast<Eigen::Index>(c.strengths.size()));
            for (std::size_t j = 0; j < c.strengths.size(); ++j) columns.col(static_cast<Eigen::Index>(j)) = problem.column(at, c.strengths[j], c.step[j]);
            const Assessment a = screen.assess(columns, Eigen::VectorXd::Zero(columns.cols()), false);
            if (a.gain <= best) continue;
            best = a.gain;
            std::vector<double> start;
            for (std::size_t j = 0; j < c.strengths.size(); ++j) {
                double v = std::clamp(a.strength[static_cast<Eigen::Index>(j)], c.minimum[j], c.maximum[j]);
                if (std::fabs(v) < 1e-3 * (c.maximum[j] - c.minimum[j])) v = c.of_interest[j];
                start.push_back(v);
            }
            use = effect_of(c, start);
        }
        if (use.name.empty()) throw ModelError(model.file, 0, effect, "has no variant that this log can carry", "drive further, or give its parameters in the model file");
        added.model.effects.push_back(use);
    }
    Model baseline = model;
    added.ladder.push_back(fit_model(baseline, data, "baseline"));
    const std::string label = "+ " + effect + (wheel >= 0 ? " on wheel " + std::to_string(wheel) : "");
    added.ladder.push_back(fit_model(added.model, data, label));
    added.helps = added.ladder[1].heldout < added.ladder[0].heldout;
    char buffer[200];
    std::snprintf(buffer, sizeof buffer, "held-out error %.3f -> %.3f x noise: %s", added.ladder[0].heldout, added.ladder[1].heldout, added.helps ? "it helps" : "it does not help");
    added.text = buffer;
    append_lineage(added.model, data, added.ladder, {label, std::nan(""), std::nan(""), 1});
    added.model.name = model.name;
    return added;
}

std::string added_text(const Added &added) {
    std::string text;
    const EffectUse &use = added.model.effects.back();
    for (const auto &[key, p] : use.parameters) {
        char buffer[200];
        std::snprintf(buffer, sizeof buffer, "%s.%s = %.5g [%.5g, %.5g] %s%s\n", use.name.c_str(), key.c_str(), p.value, p.low, p.high, p.unit.c_str(), p.fixed ? " (shape)" : "");
        text += buffer;
    }
    return text + ladder_text(added.ladder) + added.text + "\n";
}

} // namespace traction::lab
