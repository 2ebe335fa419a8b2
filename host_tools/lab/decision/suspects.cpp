#include "suspects.h"

#include "host_tools/lab/inputs/smooth.h"
#include "host_tools/lab/inputs/stretch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <span>
#include <string_view>
#include <utility>

namespace traction::lab {

namespace {

constexpr double several_names = 1.1; // one wrong number is simpler than two effects
constexpr double one_name = 0.9;      // it must explain more than one effect, or than a shape does
constexpr double much_better = 0.5;   // of the error as stated
constexpr double better = 0.75;       // the same, where an effect was named
constexpr double as_much = 1.02;      // of the error that what was named leaves
constexpr double ruler = 0.1;         // how far a track may be off
constexpr double nearly_all = 0.9;    // of the squares that several names of scales explain
constexpr double sure = 2;            // standard errors of the blocks' differences
constexpr double suspicious = 0.15;   // (1) of doubt.h, before effects
constexpr double all_of_it = 0.9;     // the same with all that was accepted: of the signal itself
constexpr double never_ground = 25;   // times noise: what neither effect nor shape explains there is no ground
constexpr double quarter_less = 1.3;  // of an error, that two effects and more take a quarter off
constexpr double looked_at_s = 20;    // what is grossly wrong shows wherever the model fails: there each datum is tried first

constexpr Datum data_of_a_model[] = {
    {"rover", "mass_kg", "the mass", 1.3}, // on stiff ground a log was seen to tell it no better than 1.2
    {"wheel", "radius_m", "the wheels' radius", 1.25},
    {"rover", "track_scale", "the track (the wheels' y_m, all times)", 1.03}, // a ruler's mistake; no effect of the catalogue is it
    {"motor", "torque_constant_Nm_A", "the torque constant (of the wheel's side of the gear)"},
    {"motor", "back_emf_Vs_rad", "the back-EMF (of the wheel's side of the gear)"},
    {"motor", "resistance_ohm", "the motors' resistance", 1.4, true},
    {"motor", "inertia_kg_m2", "the inertia at the wheel"},
    {"motor", "coulomb_Nm", "the dry friction of the drives", 1.4, true},
    {"motor", "viscous_Nms", "the viscous friction of the drives", 1.4, true},
    {"soil", "mu", "the ground's grip"},
    {"soil", "rolling_coefficient", "the rolling resistance", 1.4, true, 0.02}, // a slope of one degree does as much
    {"soil", "shear_slip", "the soil law's stiffness"},
};

} // namespace

std::vector<const Datum *> all_data() {
    std::vector<const Datum *> list;
    for (const Datum &datum : data_of_a_model)
        if (&datum != &track()) list.push_back(&datum);
    return list;
}

const Datum &track() {
    return *std::find_if(std::begin(data_of_a_model), std::end(data_of_a_model),
                         [](const Datum &datum) { return std::string_view(datum.key) == "track_scale"; });
}

std::vector<Parameter *> values_of(Model &model, const Datum &datum) {
    std::vector<Parameter *> out;
    const std::string table = datum.table;
    const auto take = [&](Parameters &from) {
        if (const auto found = from.find(datum.key); found != from.end()) out.push_back(&found->second);
    };
    if (table == "rover") take(model.rover);
    for (WheelSpec &wheel : model.wheel)
        if (table != "rover") take(table == "wheel" ? wheel.geometry : table == "motor" ? wheel.motor : wheel.soil);
    return out;
}

bool set_free(Model &model, const Datum &datum, double start) {
    bool any = false;
    for (Parameter *p : values_of(model, datum)) {
        if (!(p->value > 0)) continue;
        p->value *= start;
        p->prior = &datum == &track() ? ruler * p->value : p->value;
        p->fixed = false;
        p->minimum = 0.01 * p->value, p->maximum = 6 * p->value;
        any = true;
    }
    return any;
}

std::optional<double> from_the_edge(double start, double ratio) {
    if (ratio > 0.03 && ratio < 5.5) return std::nullopt;
    return start * (ratio < 1 ? 0.05 : 5);
}

bool is_suspicious(double worst, std::size_t accepted, double before, double after) {
    return !(worst < suspicious) || (accepted >= 2 && before > quarter_less * after);
}

bool is_no_ground(double error) { return error > never_ground; }

bool describes_nothing(double worst) { return !(worst < all_of_it); }

bool is_gross(const Suspect &s) { return s.fitted < s.stated / s.gross || (!s.more_is_an_effect && s.fitted > s.stated * s.gross); }

Dataset worst_stretch(const Problem &first) {
    const Dataset &data = first.data();
    const double end = data.time(data.count - 1), step = 0.25 * looked_at_s;
    if (data.independent_rows || end - data.start_s < 2 * looked_at_s) return data;
    const Eigen::VectorXd squares = first.residual.cwiseQuotient(first.noise_rows()).cwiseAbs2();
    std::vector<double> left(static_cast<std::size_t>((end - data.start_s) / step) + 1, 0); // of each quarter of a stretch
    Eigen::Index row = 0;
    for (const Balance &b : data.balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        const double mean = squares.segment(row, n).mean();
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
            const double place =
                std::clamp((0.5 * (b.t0_s[r] + b.t1_s[r]) - data.start_s) / step, 0.0, static_cast<double>(left.size() - 1));
            left[static_cast<std::size_t>(place)] += std::min(4 * mean, squares[row]) / static_cast<double>(n);
        }
    }
    std::size_t best = 0;
    double most = 0;
    for (std::size_t i = 0; i + 4 <= left.size(); ++i)
        if (const double sum = left[i] + left[i + 1] + left[i + 2] + left[i + 3]; sum > most) most = sum, best = i;
    const double from = std::min(data.start_s + static_cast<double>(best) * step, end - looked_at_s);
    return stretch(data, from, from + looked_at_s);
}

double error_within(const Problem &fitted, const Dataset &part) {
    const Eigen::VectorXd squares = fitted.residual.cwiseQuotient(fitted.noise_rows()).cwiseAbs2();
    const double from = part.start_s, to = part.time(part.count - 1);
    double sum = 0, balances = 0;
    Eigen::Index row = 0;
    for (const Balance &b : fitted.data().balance) {
        double own = 0, n = 0;
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row)
            if (b.t0_s[r] >= from && b.t1_s[r] <= to) own += squares[row], ++n;
        if (n > 0) sum += own / n, ++balances;
    }
    return balances > 0 ? std::sqrt(sum / balances) : 0;
}

double fit_scatter(const Problem &fitted) {
    const Eigen::VectorXd e = fitted.residual.cwiseQuotient(fitted.noise_rows());
    double sum = 0;
    Eigen::Index row = 0;
    for (const Balance &b : fitted.data().balance) {
        std::vector<double> bend; // second differences: of white noise, sqrt(6) times it
        for (std::size_t r = 2; r < b.measured.size(); ++r)
            bend.push_back(std::fabs(e[row + static_cast<Eigen::Index>(r)] - 2 * e[row + static_cast<Eigen::Index>(r) - 1] +
                                     e[row + static_cast<Eigen::Index>(r) - 2]));
        sum += bend.empty() ? 0 : std::pow(1.4826 * median(bend), 2) / 6;
        row += static_cast<Eigen::Index>(b.measured.size());
    }
    return fitted.data().balance.empty() ? 0 : std::sqrt(sum / static_cast<double>(fitted.data().balance.size()));
}

double error_less(const Problem &fitted, const Eigen::VectorXd &squares) {
    const Eigen::VectorXd left = (fitted.residual.cwiseAbs2() - squares).cwiseQuotient(fitted.noise_rows().cwiseAbs2());
    double sum = 0;
    Eigen::Index row = 0;
    for (const Balance &b : fitted.data().balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        if (n > 0) sum += left.segment(row, n).mean();
        row += n;
    }
    return fitted.data().balance.empty() ? 0 : std::sqrt(std::max(0.0, sum / static_cast<double>(fitted.data().balance.size())));
}

bool strained(const Problem &problem) {
    for (std::size_t i = 0; i < problem.parameters.size(); ++i)
        for (const Datum &datum : data_of_a_model)
            if (problem.parameters[i].owner == datum.table && problem.parameters[i].key == datum.key && problem.at_bound(i)) return true;
    return false;
}

namespace {

using Law = const char *[2]; // effect, datum
constexpr Law numbers[] = {{"torque_constant", "torque_constant_Nm_A"}, {"wheel_radius", "radius_m"}, {"shear_stiffness", "shear_slip"}};
constexpr Law likenesses[] = {
    {"current_gain", "torque_constant_Nm_A"}, {"voltage_gain", "back_emf_Vs_rad"}, {"voltage_gain", "torque_constant_Nm_A"}};

bool has_law(const Problem &last, const Datum &datum, std::span<const Law> laws) {
    return std::any_of(last.parameters.begin(), last.parameters.end(), [&](const FreeParameter &p) {
        return std::any_of(laws.begin(), laws.end(),
                           [&](const Law &law) { return p.owner == law[0] && std::string_view(law[1]) == datum.key; });
    });
}

} // namespace

const Datum *number_of(std::string_view effect) {
    for (const Law &law : numbers)
        for (const Datum &datum : data_of_a_model)
            if (effect == law[0] && std::string_view(law[1]) == datum.key) return &datum;
    return nullptr;
}

Kin kin_of(const Problem &last, const Datum &datum) {
    return has_law(last, datum, numbers) ? Kin::its_number : has_law(last, datum, likenesses) ? Kin::acts_alike : Kin::none;
}

bool names_several_scales(const Problem &last) {
    std::set<std::string_view> names;
    for (const FreeParameter &p : last.parameters)
        for (const std::string_view one : {"camera_scale", "radar_scale", "wheel_radius", "encoder_missed", "gyro_scale"})
            if (p.owner == one && p.wheel < 0) names.insert(one == "encoder_missed" ? "wheel_radius" : one);
    return names.size() > 1;
}

bool does_as_much(const Suspect &s, double before, double left) {
    return is_gross(s) && before * before - s.error * s.error > nearly_all * (before * before - left * left);
}

double largest_share(std::size_t accepted, double before, double left) {
    return accepted == 0   ? std::min(much_better, one_name * left / before)
           : accepted == 1 ? std::min(notable, as_much * left / before)
                           : std::min(better, several_names * left / before);
}

bool is_suspect(const Suspect &s, std::size_t accepted, double before, double left, const std::function<bool()> &relieves,
                const std::function<double()> &lead, const std::function<Kin()> &kin) {
    // more of it is an effect, unless it alone does what took two names: then one of them is none
    if (accepted >= 2 && s.more_is_an_effect && s.fitted > s.stated * s.gross && s.error < better * before &&
        s.error < several_names * left && lead() > 0)
        return true;
    if (!is_gross(s)) return false;
    const bool helps = s.error < (accepted > 0 ? better : much_better) * before;
    const bool alone = s.error < (accepted >= 2 ? several_names : one_name) * left; // one number against all that was named
    // what was named has the datum's own number free already: that is no simpler, nor less contradicted, only better or not
    if (helps && alone) return accepted < 2 || kin() != Kin::its_number || lead() > sure;
    // one number against one effect: what is named leaves the sheet contradicted and the datum does not, or it predicts at least as
    // well
    if (!(accepted == 1 && s.error < as_much * left && s.error < notable * before)) return false;
    return (kin() != Kin::its_number && relieves()) || lead() > (kin() == Kin::none ? 0 : sure);
}

std::vector<Suspect> told_once(std::vector<Suspect> suspects) {
    std::stable_sort(suspects.begin(), suspects.end(), [](const Suspect &x, const Suspect &y) { return x.error < y.error; });
    std::vector<Suspect> once;
    for (Suspect &suspect : suspects)
        if (std::none_of(once.begin(), once.end(), [&](const Suspect &seen) { return seen.quantity == suspect.quantity; }))
            once.push_back(std::move(suspect));
    return once;
}

std::string what_to_look_at(const std::vector<Suspect> &suspects, double worst) {
    char buffer[300];
    if (suspects.empty()) {
        std::snprintf(buffer, sizeof buffer,
                      "as fitted it leaves %.0f %% of a measured signal (but for noise). Look at the wheels' order and signs, radius, "
                      "mass, units and gear, and "
                      "the ground's law",
                      100 * worst);
        return buffer;
    }
    std::string text;
    for (std::size_t i = 0; i < suspects.size() && i < 3; ++i) {
        const Suspect &s = suspects[i];
        std::snprintf(buffer, sizeof buffer, "%s%s: %.4g %s would describe it (error %.3g x noise), the model has %.4g",
                      i == 0 ? "Look first at " : "; or ", s.quantity.c_str(), s.fitted, s.unit == "1" ? "" : s.unit.c_str(), s.error,
                      s.stated);
        text += buffer;
    }
    return text + "; then at units, gear, the wheels' order, and the ground's law";
}

} // namespace traction::lab
