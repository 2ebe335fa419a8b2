#include "patch_edges.h"

#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/fit/profile.h"
#include "host_tools/lab/fit/screen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace traction::lab {

namespace {

constexpr double risen = 3.84; // (2) of profile.h
constexpr double two_sided = 1.96;
constexpr int most_searches = 6; // each followed by a fit
constexpr double least_step_m = 0.01;

// The patch of a problem at edges of choice.
class Patch {
  public:
    Patch(Problem &problem, const std::string &effect, double step_m)
        : problem_(problem), screen_(problem), at_(problem.physics()), step_(step_m), phi_(dispersion(effect)) {
        const bool grip = effect == "soil_patch";
        start_ = grip ? &at_.body.patch_start_m : &at_.body.heavy_start_m;
        length_ = grip ? &at_.body.patch_length_m : &at_.body.heavy_length_m;
        edges = {*start_, *start_ + *length_};
        const std::vector<double> path = problem.forward().motion().path_m;
        if (path.empty()) return;
        const auto [low, high] = std::minmax_element(path.begin(), path.end());
        low_ = *low - 2 * step_, high_ = *high + 2 * step_; // a patch may be the whole way's first part, or its last
    }

    using Edges = std::array<double, 2>;
    Edges edges;

    // Of the edges moved by so many steps; infinite where no patch is left, or none that is driven over.
    double error(int first, int last) {
        const Edges e = moved(first, last);
        if (e[1] - e[0] < step_ || e[0] < low_ - least_step_m || e[1] > high_ + least_step_m)
            return std::numeric_limits<double>::infinity();
        *start_ = e[0], *length_ = e[1] - e[0];
        Eigen::VectorXd change;
        return screen_.profiled_error(problem_.scaled_residual(at_, stage_motion), change);
    }

    void descend() {
        for (double best = error(0, 0);;) {
            int first = 0, last = 0;
            for (int size = 32; size >= 1; size /= 2)
                for (const int by : {-size, size})
                    for (const auto &[a, b] : {std::array{by, 0}, std::array{0, by}, std::array{by, by}})
                        if (const double e = error(a, b); e < best) best = e, first = a, last = b;
            if (first == 0 && last == 0) return;
            edges = moved(first, last);
        }
    }

    // How far an edge goes, in metres, until the error has risen, by the farther of both sides.
    double half_width(bool of_start) {
        const double least = error(0, 0), most = least + risen * phi_;
        double far = 0;
        for (const int side : {-1, 1}) {
            int inside = 0;
            for (int by = 1; by <= 64; by = by < 8 ? by + 1 : by + by / 4) {
                if (error(of_start ? side * by : 0, of_start ? 0 : side * by) > most) break;
                inside = by;
            }
            far = std::max(far, (inside + 2) * step_);
        }
        return far;
    }

  private:
    Edges moved(int first, int last) const { return {edges[0] + first * step_, edges[1] + last * step_}; }

    double dispersion(const std::string &effect) const {
        const Eigen::VectorXd white = white_variances(problem_);
        const std::vector<ParameterError> errors = screen_.parameter_errors();
        for (std::size_t i = 0; i < errors.size(); ++i)
            if (problem_.parameters[i].owner == effect)
                return std::max(1.0, std::pow(errors[i].standard, 2) / white[static_cast<Eigen::Index>(i)]);
        return 1;
    }

    Problem &problem_;
    Screen screen_;
    Physics at_;
    double *start_, *length_;
    double step_, phi_, low_ = -std::numeric_limits<double>::infinity(), high_ = std::numeric_limits<double>::infinity();
};

// Way gone by the log less the way gone by the model, at the end of each row of what measures it: by a camera, else by a radar, whose
// readings, which know no direction, stand for the time since the one before.
std::vector<std::pair<double, double>> strayed(const Problem &problem, const Motion &motion) {
    const Dataset &data = problem.data();
    const auto backwards = [&](double t) {
        const double k = std::clamp((t - data.start_s) / data.step_s, 0.0, static_cast<double>(motion.v_m_s.size()) - 1);
        return motion.v_m_s[static_cast<std::size_t>(k)] < 0;
    };
    for (const BalanceKind kind : {BalanceKind::camera_x, BalanceKind::radar}) {
        std::vector<std::pair<double, double>> list;
        double sum = 0;
        Eigen::Index row = 0;
        for (const Balance &b : data.balance) {
            for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
                if (b.kind != kind) continue;
                const double since = b.t1_s[r] - (r > 0 ? std::max(b.t0_s[r], b.t1_s[r - 1]) : b.t0_s[r]), off = problem.residual[row];
                sum += kind == BalanceKind::camera_x ? off : backwards(0.5 * (b.t0_s[r] + b.t1_s[r])) ? -off * since : off * since;
                list.emplace_back(b.t1_s[r], sum);
            }
        }
        if (!list.empty()) return list;
    }
    return {};
}

constexpr double unmeasured = 0.02; // of the way gone, by what it may stray where neither measures it: assumed

// How far the model's way has strayed where it passes this place, by its mean square over the passes [m].
double strayed_at(const Problem &problem, const Motion &motion, double place_m) {
    const std::vector<std::pair<double, double>> by_time = strayed(problem, motion);
    double squares = 0, passes = 0, way = 0;
    for (std::size_t k = 1; k < motion.path_m.size(); ++k) {
        way += std::fabs(motion.path_m[k] - motion.path_m[k - 1]);
        if ((motion.path_m[k] < place_m) == (motion.path_m[k - 1] < place_m)) continue;
        const double t = problem.data().time(k);
        const auto after = std::find_if(by_time.begin(), by_time.end(), [&](const auto &one) { return one.first > t; });
        const double off = by_time.empty() ? unmeasured * way : after == by_time.begin() ? 0 : std::prev(after)->second;
        squares += off * off, ++passes;
    }
    return passes > 0 ? std::sqrt(squares / passes) : 0;
}

EffectUse *find_use(Model &model, const std::string &effect) {
    const auto found = std::find_if(model.effects.begin(), model.effects.end(), [&](const EffectUse &use) { return use.name == effect; });
    return found == model.effects.end() ? nullptr : &*found;
}

void hold(Parameter &p, double value) {
    p.value = value, p.fixed = true;
    p.minimum = -std::numeric_limits<double>::infinity(), p.maximum = -p.minimum; // a place has no range of the catalogue's
}

// A model with its patch elsewhere and the fit of it, which begins where that of the patch as it was ended.
struct Placed {
    Model model;
    Problem fit;
};

Placed placed(const Model &model, const Dataset &data, const std::string &effect, const Problem &warm, const PatchEdges &edges) {
    Model moved = model;
    EffectUse &use = *find_use(moved, effect);
    hold(use.parameters.at("start_m"), edges.start_m), hold(use.parameters.at("length_m"), edges.length_m);
    const Physics physics = make_physics(moved);
    Problem fit(data, physics, free_parameters(moved, physics));
    fit.start_near(warm);
    fit.theta = warm.theta;
    fit.within_bounds();
    fit.fit({});
    return {std::move(moved), std::move(fit)};
}

// While the patch lies a little off, the ground's numbers keep the way such that its edges look right there: it is tried at another scale
// of the way, each with a fit.
bool scale_way(Model &model, const Dataset &data, const std::string &effect, Problem &problem) {
    bool moved = false;
    const EffectUse &use = *find_use(model, effect);
    const PatchEdges from{use.parameters.at("start_m").value, use.parameters.at("length_m").value};
    for (const double by : {0.96, 0.98, 0.99, 1.01, 1.02, 1.04}) {
        Placed other = placed(model, data, effect, problem, {from.start_m * by, from.length_m * by});
        if (!(overall_error(other.fit) < overall_error(problem))) continue;
        model = std::move(other.model), problem = std::move(other.fit), moved = true;
    }
    return moved;
}

} // namespace

PatchEdges search_edges(const Problem &fit, const std::string &effect, double step_m) {
    Problem moving = fit;
    Patch patch(moving, effect, step_m);
    patch.descend();
    return {patch.edges[0], patch.edges[1] - patch.edges[0]};
}

EdgeErrors edge_errors(const Problem &fit, const std::string &effect, double step_m) {
    Problem moving = fit;
    Patch patch(moving, effect, step_m);
    const Motion motion = moving.forward().motion();
    double half[2];
    for (const std::size_t edge : {0U, 1U})
        half[edge] = std::hypot(patch.half_width(edge == 0), two_sided * strayed_at(fit, motion, patch.edges[edge]));
    return {half[0], std::hypot(half[0], half[1])};
}

bool place_patch(Model &model, const Dataset &data, const std::string &effect, Problem &problem) {
    if (find_use(model, effect) == nullptr) return false;
    const double step = std::max(least_step_m, half_row_m(model, data));
    bool moved = false;
    for (int i = 0; i < most_searches; ++i) {
        Placed other = placed(model, data, effect, problem, search_edges(problem, effect, step));
        if (overall_error(other.fit) < overall_error(problem))
            model = std::move(other.model), problem = std::move(other.fit);
        else if (!scale_way(model, data, effect, problem))
            break;
        moved = true;
    }
    const EdgeErrors errors = edge_errors(problem, effect, step);
    EffectUse &use = *find_use(model, effect);
    for (const auto &[key, half] : {std::pair{"start_m", errors.start_half_m}, std::pair{"length_m", errors.length_half_m}}) {
        Parameter &p = use.parameters.at(key);
        p.low = p.value - half, p.high = p.value + half;
    }
    return moved;
}

double half_row_m(const Model &model, const Dataset &data) {
    double sum = 0, n = 0;
    for (std::size_t i = 0; i < data.wheel.size(); ++i)
        for (const double speed : data.wheel[i].speed_rad_s)
            if (std::fabs(speed) > data.standstill_rad_s) sum += std::fabs(speed) * model.wheel[i].geometry.at("radius_m").value, ++n;
    return n > 0 ? 0.5 * sum / n * 0.05 : 0;
}

} // namespace traction::lab
