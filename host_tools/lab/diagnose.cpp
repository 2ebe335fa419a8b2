#include "diagnose.h"

#include "screen.h"
#include "session.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace traction::lab {

namespace {

constexpr double classes_tried = 20; // catalogue effects that are not near copies of one another: about half of the catalogue

std::string one_decimal(double value) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.1f", value);
    return buffer;
}

// Structured columns of all candidates at a baseline: a wheel's column is computed once, "all wheels" is the sum.
class Columns {
  public:
    using Cache = std::map<std::string, Eigen::VectorXd>; // unscaled: good for later rounds too, whose refits are exact anyway
    Columns(Problem &problem, Cache &cache) : problem_(problem), physics_(problem.physics()), cache_(cache) {}

    Eigen::MatrixXd of(const Candidate &c) {
        Eigen::MatrixXd out(problem_.row_scale.size(), static_cast<Eigen::Index>(c.strengths.size()));
        for (std::size_t j = 0; j < c.strengths.size(); ++j) out.col(static_cast<Eigen::Index>(j)) = column(c, j).cwiseProduct(problem_.row_scale);
        return out;
    }

  private:
    Eigen::VectorXd column(const Candidate &c, std::size_t j) {
        const FreeParameter &p = c.strengths[j];
        if (c.free_shape || p.slots.size() < 2) return single(c, j, p);
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(problem_.row_scale.size());
        for (const Slot &slot : p.slots) {
            FreeParameter one = p;
            one.slots = {slot};
            one.wheel = slot.wheel;
            sum += single(c, j, one);
        }
        return sum;
    }

    const Eigen::VectorXd &single(const Candidate &c, std::size_t j, const FreeParameter &p) {
        std::string key = c.effect + "/" + p.key + "/" + std::to_string(p.slots.size() == 1 ? p.slots[0].wheel : -1);
        for (const auto &[name, value] : c.variant) key += "/" + name + std::to_string(value);
        const auto found = cache_.find(key);
        if (found != cache_.end()) return found->second;
        if (c.effect == "soil_patch") return cache_[key] = patch(c, p);
        Physics at = physics_;
        Candidate one = c;
        one.wheel = p.slots.size() == 1 && p.slots[0].in_wheel != nullptr ? p.slots[0].wheel : c.wheel;
        one.prepare(at);
        return cache_[key] = problem_.column(at, p, c.step[j]).cwiseQuotient(problem_.row_scale);
    }

    // A patch is the sum of the cells of the path that it covers.
    Eigen::VectorXd patch(const Candidate &c, const FreeParameter &p) {
        const std::vector<double> &path = problem_.forward().motion().path_m;
        if (cells_.empty()) {
            const auto [low, high] = std::minmax_element(path.begin(), path.end());
            cell_start_ = *low;
            cell_length_ = std::max(0.125, (*high - *low) / 32);
            cells_.resize(static_cast<std::size_t>((*high - *low) / cell_length_) + 1);
        }
        double start = 0, length = 0;
        for (const auto &[key, value] : c.variant) (key == "start_m" ? start : length) = value;
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(problem_.row_scale.size());
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            const double begin = cell_start_ + static_cast<double>(i) * cell_length_;
            const double overlap = std::min(begin + cell_length_, start + length) - std::max(begin, start);
            if (overlap <= 0) continue;
            if (cells_[i].size() == 0) {
                Physics at = physics_;
                at.body.patch_start = begin;
                at.body.patch_length = cell_length_;
                cells_[i] = problem_.column(at, p, c.step[0]).cwiseQuotient(problem_.row_scale);
            }
            sum += overlap / cell_length_ * cells_[i];
        }
        return sum;
    }

    Problem &problem_;
    Physics physics_;
    Cache &cache_;
    std::vector<Eigen::VectorXd> cells_;
    double cell_start_ = 0, cell_length_ = 1;
};

struct Scored {
    Candidate candidate;
    Assessment assessment;
    double gain = 0;      // squares
    double gain_error = 0;
    double p_value = 1;   // corrected
    Eigen::VectorXd block_gain;
    std::vector<double> value, error;
    std::string verdict;
    bool refitted = false;
    double best_balance_gain = 0; // largest relative fall in one balance
    double cosine_with_winner = 0;
    double difference = 0, difference_error = 0; // to the winner
};

bool large_enough(const Candidate &c, const std::vector<double> &value) {
    double size = 0, least = 0;
    for (std::size_t j = 0; j < value.size(); ++j) size += value[j] * value[j], least = std::max(least, j < c.of_interest.size() ? c.of_interest[j] : 0.0);
    return std::sqrt(size) >= least;
}

bool plausible_sign(const Candidate &c, const std::vector<double> &value) {
    for (std::size_t j = 0; j < value.size(); ++j)
        if (j < c.minimum.size() && c.minimum[j] >= 0 && value[j] < 0) return false;
    return true;
}

Scored score(const Candidate &c, const Screen &screen, Columns &columns, bool full) {
    Scored s;
    s.candidate = c;
    const Eigen::MatrixXd C = columns.of(c);
    s.assessment = screen.assess(C, Eigen::VectorXd::Zero(C.cols()), full);
    s.gain = s.assessment.gain;
    s.gain_error = s.assessment.gain_error;
    s.block_gain = s.assessment.block_gain;
    s.p_value = std::min(1.0, s.assessment.p_value * c.variants * classes_tried);
    for (Eigen::Index j = 0; j < C.cols(); ++j) {
        s.value.push_back(s.assessment.strength[j]);
        s.error.push_back(s.assessment.standard_error[j]);
    }
    return s;
}

bool nonlinear(const std::string &effect) { return effect == "backlash" || effect == "relaxation_length"; }

// A law whose slope at zero says little of its size: the best of a few sizes starts the fit.
double best_start(Problem &problem, const Candidate &candidate, Eigen::Index place, double linear) {
    double best = linear, least = 1e300;
    const double largest = candidate.maximum[0];
    for (const double size : {0.0, linear, candidate.of_interest[0], 0.1 * largest, 0.25 * largest, 0.5 * largest, 0.8 * largest}) {
        problem.theta[place] = size;
        const double cost = problem.cost();
        if (cost < least) least = cost, best = size;
    }
    return best;
}

// Fits baseline plus candidate in full, from the linear estimate.
void refit(Scored &s, const Problem &base, const Screen &base_screen, const Model &model, const Dataset &data) {
    Physics physics = make_physics(model);
    s.candidate.prepare(physics);
    std::vector<FreeParameter> parameters = base.parameters;
    const auto n = static_cast<Eigen::Index>(parameters.size()), k = static_cast<Eigen::Index>(s.candidate.strengths.size());
    for (const FreeParameter &p : s.candidate.strengths) parameters.push_back(p);
    Problem problem(data, physics, parameters);
    problem.keep_scales(base);
    problem.theta.head(n) = base.theta;
    for (Eigen::Index j = 0; j < k; ++j) {
        const FreeParameter &p = parameters[static_cast<std::size_t>(n + j)];
        const double span = p.maximum - p.minimum;
        const bool limited = !s.candidate.maximum.empty();
        double start = s.value[static_cast<std::size_t>(j)];
        if (limited) start = std::clamp(start, std::max(p.minimum, s.candidate.minimum[static_cast<std::size_t>(j)]), s.candidate.maximum[static_cast<std::size_t>(j)]);
        if (limited && std::fabs(start) < 1e-3 * span) start = s.candidate.of_interest[static_cast<std::size_t>(j)];
        problem.theta[n + j] = start;
    }
    if (nonlinear(s.candidate.effect)) {
        problem.theta[n] = best_start(problem, s.candidate, n, problem.theta[n]);
        if (problem.theta[n] < 0.5 * s.candidate.of_interest[0]) return; // no size of it beats its absence
    }
    problem.quick_fit(base, nonlinear(s.candidate.effect) ? 8 : 4);
    if ((s.candidate.touched & stage_motion) != 0) problem.jacobian.resize(0, 0), problem.polish(2); // the soil's curve is strongly nonlinear: fresh sensitivities
    const Screen screen(problem, n);
    const Eigen::VectorXd present = problem.theta.tail(k);
    s.assessment = screen.assess(problem.jacobian.rightCols(k), present, true);
    s.refitted = true;
    s.value.clear(), s.error.clear();
    for (Eigen::Index j = 0; j < k; ++j) {
        s.value.push_back(problem.theta[n + j]);
        s.error.push_back(s.assessment.standard_error[j]);
    }
    s.p_value = std::min(1.0, s.assessment.p_value * s.candidate.variants * classes_tried);
    s.gain = base_screen.heldout_error() - (screen.heldout_error() - s.assessment.gain);
    s.assessment.relief += base_screen.penalty() - screen.penalty();
    s.block_gain = base_screen.block_error() - (screen.block_error() - s.assessment.block_gain);
    const double blocks = static_cast<double>(s.block_gain.size()), mean = s.block_gain.mean();
    s.gain_error = std::sqrt((s.block_gain.array() - mean).square().sum() * blocks / std::max(1.0, blocks - 1));
    const Screen with(problem);
    const std::vector<double> before = base_screen.heldout_by_balance(), after = with.heldout_by_balance();
    for (std::size_t b = 0; b < before.size(); ++b)
        if (before[b] > 0) s.best_balance_gain = std::max(s.best_balance_gain, 1 - after[b] / before[b]);
}

void judge(Scored &s, double base_error, const DiagnoseOptions &options) {
    const double relative = base_error > 0 ? s.gain / base_error : 0;
    const bool gains = s.gain > 0 && (relative > options.least_gain || s.best_balance_gain > options.least_gain_one || s.assessment.relief > options.least_relief);
    if (!(s.p_value < options.p_limit) || !gains) s.verdict = "not_significant";
    else if (!plausible_sign(s.candidate, s.value)) s.verdict = "wrong_sign";
    else if (!large_enough(s.candidate, s.value)) s.verdict = "too_small";
    else s.verdict = "passes";
}

std::string sentence(const Scored &s) {
    const sim::Effect *effect = sim::find_effect(s.candidate.effect);
    return effect == nullptr ? std::string() : std::string(effect->signature);
}

CandidateResult result_of(const Scored &s, double base_error, const Screen &screen) {
    CandidateResult r;
    r.candidate = s.candidate;
    r.value = s.value;
    for (std::size_t j = 0; j < s.value.size(); ++j) {
        r.low.push_back(s.value[j] - 1.96 * s.error[j]);
        r.high.push_back(s.value[j] + 1.96 * s.error[j]);
    }
    const double unit = base_error > 0 ? 1 / base_error : 0;
    r.gain_squares = s.gain;
    r.heldout_gain = s.gain * unit;
    r.gain_low = (s.gain - 1.96 * s.gain_error) * unit;
    r.gain_high = (s.gain + 1.96 * s.gain_error) * unit;
    r.p_value = s.p_value;
    double d = 0;
    for (std::size_t j = 0; j < s.value.size(); ++j)
        if (s.error[j] > 0 && std::isfinite(s.error[j])) d = std::max(d, std::fabs(s.value[j]) / s.error[j]);
    r.detectability = d;
    r.verdict = s.verdict;
    r.explains = sentence(s);
    double positive = 0;
    for (Eigen::Index b = 0; b < s.block_gain.size(); ++b) positive += std::max(0.0, s.block_gain[b]);
    std::vector<std::pair<double, std::size_t>> order;
    for (Eigen::Index b = 0; b < s.block_gain.size(); ++b) order.emplace_back(s.block_gain[b], static_cast<std::size_t>(b));
    std::stable_sort(order.begin(), order.end(), [](const auto &a, const auto &b) { return a.first > b.first; });
    for (std::size_t i = 0; i < std::min<std::size_t>(3, order.size()) && positive > 0; ++i)
        if (order[i].first > 0) r.evidence.push_back({screen.blocks()[order[i].second], order[i].first / positive});
    return r;
}

struct Round {
    std::vector<Scored> scored; // best variant of each effect and wheel, sorted by gain
    double base_error = 0;
};

Round run_round(Problem &problem, const Screen &screen, const Model &model, const Dataset &data, const DiagnoseOptions &options,
                Columns::Cache &cache, const std::function<void()> &tick) {
    Round round;
    round.base_error = screen.heldout_error();
    Columns columns(problem, cache);
    std::map<std::string, Scored> best;
    std::vector<std::string> order;
    for (const Candidate &c : catalogue_candidates(model, data, problem.forward().motion())) {
        Scored s = score(c, screen, columns, true);
        const std::string key = c.label();
        const auto found = best.find(key);
        if (found == best.end()) {
            order.push_back(key);
            best.emplace(key, std::move(s));
        } else if (s.gain > found->second.gain) {
            found->second = std::move(s);
        }
        tick();
    }
    for (const std::string &key : order) round.scored.push_back(std::move(best.at(key)));
    std::stable_sort(round.scored.begin(), round.scored.end(), [](const Scored &a, const Scored &b) { return a.gain > b.gain; });
    // full refits: the best distinct effects that stand a chance, and the strongly nonlinear ones
    int done = 0, specials = 0;
    double best_gain = 0; // of what was refitted: what explains less than half of it can be neither the winner nor of its class
    for (Scored &s : round.scored) {
        judge(s, round.base_error, options);
        const bool anyway = nonlinear(s.candidate.effect) && s.candidate.wheel < 0;
        const bool worth = anyway || s.gain > 0.002 * round.base_error || s.assessment.relief > 0.5 * options.least_relief;
        const bool special = nonlinear(s.candidate.effect);
        if (!worth || !(anyway || special ? anyway || specials < 2 : done < options.refits && s.p_value < 0.2 && s.gain > 0.5 * best_gain)) continue;
        refit(s, problem, screen, model, data);
        judge(s, round.base_error, options);
        ++(special ? specials : done);
        if (s.verdict == "passes") best_gain = std::max(best_gain, s.gain);
        tick();
    }
    for (Scored &s : round.scored)
        if (!s.refitted && s.verdict == "passes") s.verdict = "not_significant"; // behind five that explain more
    std::stable_sort(round.scored.begin(), round.scored.end(), [](const Scored &a, const Scored &b) {
        if (a.refitted != b.refitted) return a.refitted;
        return a.gain > b.gain;
    });
    return round;
}

// The whole model with the candidate, fitted anew with scales of its own: must not be worse where it was not fitted, and the
// candidate must keep its size.
bool holds_up(const Scored &s, const Model &model, const Dataset &data, const Problem &before) {
    Model with = model;
    with.effects.push_back(effect_of(s.candidate, s.value));
    const Physics physics = make_physics(with);
    Problem problem(data, physics, free_parameters(with, physics));
    problem.theta.head(before.theta.size()) = before.theta;
    problem.fit({});
    std::vector<double> value;
    for (Eigen::Index i = problem.theta.size() - static_cast<Eigen::Index>(s.value.size()); i < problem.theta.size(); ++i)
        value.push_back(problem.parameters[static_cast<std::size_t>(i)].base + problem.theta[i]);
    return large_enough(s.candidate, value) && overall_heldout(problem) < 1.01 * overall_heldout(before);
}

// Which passers the data cannot tell from the winner.
std::vector<std::size_t> confounded_with(Round &round, std::size_t winner, const DiagnoseOptions &options) {
    std::vector<std::size_t> members;
    Scored &w = round.scored[winner];
    for (std::size_t i = 0; i < round.scored.size(); ++i) {
        Scored &s = round.scored[i];
        if (i == winner || s.verdict != "passes" || s.candidate.effect == w.candidate.effect) continue;
        const Eigen::VectorXd difference = w.block_gain - s.block_gain;
        const double n = static_cast<double>(difference.size()), mean = difference.mean();
        s.difference = w.gain - s.gain;
        s.difference_error = std::sqrt((difference.array() - mean).square().sum() * n / std::max(1.0, n - 1));
        const double norm = w.assessment.projected.norm() * s.assessment.projected.norm();
        s.cosine_with_winner = norm > 0 ? w.assessment.projected.dot(s.assessment.projected) / norm : 0;
        const bool close = s.difference < 2 * s.difference_error && s.difference < 0.1 * w.gain;
        if (close || (std::fabs(s.cosine_with_winner) > options.same_cosine && s.difference < 0.1 * w.gain)) members.push_back(i);
    }
    return members;
}

} // namespace

double overall_error(const Problem &problem) {
    double sum = 0;
    const std::size_t n = problem.data().balance.size();
    for (std::size_t b = 0; b < n; ++b) sum += std::pow(problem.balance_rms(b, true), 2);
    return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : 0;
}

double overall_heldout(const Problem &problem) {
    const Screen screen(problem);
    const std::vector<double> squares = screen.heldout_by_balance(true);
    double sum = 0;
    const std::size_t n = problem.data().balance.size();
    for (std::size_t b = 0; b < n; ++b) sum += squares[b] / static_cast<double>(problem.data().balance[b].measured.size());
    return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : 0;
}

Rung fit_model(Model &model, const Dataset &data, const std::string &label) {
    const Physics physics = make_physics(model);
    Problem problem(data, physics, free_parameters(model, physics));
    problem.fit({.iterations = 10, .thorough = true});
    Rung rung{label, overall_error(problem), overall_heldout(problem), 1};
    const Screen screen(problem);
    const Eigen::VectorXd errors = screen.parameter_errors();
    for (std::size_t i = 0; i < problem.parameters.size(); ++i)
        store(model, problem.parameters[i], problem.theta[static_cast<Eigen::Index>(i)], errors[static_cast<Eigen::Index>(i)]);
    return rung;
}

// In diagnose_shapes.cpp: what no effect of the catalogue explains.
std::optional<UnknownShape> find_unknown(Problem &first, Problem &last, std::size_t named_count, const DiagnoseOptions &options);

Diagnosis diagnose(const Model &original, const Dataset &data, const DiagnoseOptions &options) {
    Diagnosis d;
    d.model = original;
    d.messages = data.messages;
    if (data.balance.empty() || data.count < 3) {
        d.kind = "nothing";
        d.text = "The log has nothing that this model predicts: nothing can be said.";
        return d;
    }
    int done = 0;
    const auto tick = [&] {
        ++done;
        if (options.progress) options.progress(done, 400);
    };
    Eigen::VectorXd warm;
    Columns::Cache cache;
    std::optional<Problem> first, last;
    for (int round_index = 0; round_index <= options.most_effects; ++round_index) {
        const Physics physics = make_physics(d.model);
        Problem problem(data, physics, free_parameters(d.model, physics));
        for (Eigen::Index i = 0; i < std::min(warm.size(), problem.theta.size()); ++i) problem.theta[i] = warm[i];
        problem.fit({});
        warm = problem.theta;
        const std::string label = d.accepted.empty() ? "baseline" : "+ " + d.accepted.back().candidate.label();
        d.ladder.push_back({label, overall_error(problem), overall_heldout(problem), 1});
        const Screen screen(problem);
        // values of what was accepted, refreshed by the joint fit
        const Eigen::VectorXd errors = screen.parameter_errors();
        for (CandidateResult &a : d.accepted)
            for (std::size_t i = 0; i < problem.parameters.size(); ++i)
                for (std::size_t j = 0; j < a.candidate.strengths.size(); ++j)
                    if (problem.parameters[i].owner == a.candidate.effect && problem.parameters[i].wheel == a.candidate.wheel && problem.parameters[i].key == a.candidate.strengths[j].key) {
                        const auto row = static_cast<Eigen::Index>(i);
                        a.value[j] = problem.parameters[i].base + problem.theta[row];
                        a.low[j] = a.value[j] - 1.96 * errors[row];
                        a.high[j] = a.value[j] + 1.96 * errors[row];
                    }
        if (round_index == 0) first = problem;
        last = problem;
        if (round_index == options.most_effects) break;
        Round round = run_round(problem, screen, d.model, data, options, cache, tick);
        std::size_t winner = round.scored.size();
        for (std::size_t i = 0; i < round.scored.size() && winner == round.scored.size(); ++i) {
            if (round.scored[i].verdict != "passes") continue;
            if (holds_up(round.scored[i], d.model, data, problem)) winner = i;
            else round.scored[i].verdict = "not_significant";
        }
        std::vector<std::size_t> members;
        if (winner < round.scored.size()) members = confounded_with(round, winner, options);
        if (round_index == 0)
            for (const Scored &s : round.scored) {
                if (s.candidate.wheel >= 0) continue;
                // three sizes of interest: do they show at all, and do they show beside what the model may adjust?
                bool alone = false, beside = false;
                for (std::size_t j = 0; j < s.error.size(); ++j) {
                    const double size = 3 * s.candidate.of_interest[j];
                    alone = alone || size * s.assessment.column_norm > 2;
                    beside = beside || size > 2 * s.error[j];
                }
                if (!alone) d.not_excited.emplace_back(s.candidate.effect, "a size three times that of interest changes the log by " + one_decimal(s.candidate.of_interest.empty() ? 0.0 : 3 * s.candidate.of_interest[0] * s.assessment.column_norm) + " standard deviations");
                else if (!beside && s.p_value > 0.05) d.not_excited.emplace_back(s.candidate.effect, "it would hide behind the model's own uncertain parameters: a size three times that of interest is " + one_decimal(3 * s.candidate.of_interest[0] / s.error[0]) + " standard errors");
            }
        for (std::size_t i = 0; i < round.scored.size(); ++i) {
            CandidateResult r = result_of(round.scored[i], round.base_error, screen);
            const bool member = std::find(members.begin(), members.end(), i) != members.end();
            if (i == winner) r.verdict = members.empty() ? "named" : "class";
            else if (member) r.verdict = "class";
            else if (r.verdict == "passes") r.verdict = "not_significant";
            if ((i == winner || member) && !members.empty()) r.class_index = static_cast<int>(d.classes.size());
            for (const auto &[effect, why] : d.not_excited)
                if (effect == r.candidate.effect && r.verdict == "not_significant" && r.candidate.wheel < 0) r.verdict = "not_excited";
            if (round_index == 0) d.ranking.push_back(r);
            if (i == winner) d.accepted.push_back(r);
        }
        if (winner == round.scored.size()) break;
        const Scored &w = round.scored[winner];
        if (!members.empty()) {
            ConfoundedClass c;
            c.members.push_back(w.candidate.label());
            for (const std::size_t i : members) c.members.push_back(round.scored[i].candidate.label());
            if (const sim::Effect *effect = sim::find_effect(w.candidate.effect)) c.separate_by = effect->reveals;
            d.classes.push_back(std::move(c));
        }
        d.model.effects.push_back(effect_of(w.candidate, w.value));
    }
    // backward: drop what no longer matters beside the others
    for (std::size_t i = d.accepted.size(); i-- > 0;) {
        const CandidateResult &one = d.accepted[i];
        bool solid = large_enough(one.candidate, one.value), sure = false;
        for (std::size_t j = 0; j < one.value.size(); ++j) sure = sure || one.low[j] * one.high[j] > 0;
        solid = solid && sure; // larger than its own uncertainty
        if (d.accepted.size() == 1 && solid) break;
        Model without = d.model;
        const Candidate &c = d.accepted[i].candidate;
        std::erase_if(without.effects, [&](const EffectUse &use) { return use.name == c.effect && use.wheel == c.wheel; });
        const Physics physics = make_physics(without);
        Problem problem(data, physics, free_parameters(without, physics));
        for (Eigen::Index j = 0; j < std::min(warm.size(), problem.theta.size()); ++j)
            if (problem.parameters[static_cast<std::size_t>(j)].prior > 0) problem.theta[j] = warm[j];
        problem.fit({});
        const Screen screen(problem);
        Scored s;
        s.candidate = c;
        s.value = d.accepted[i].value;
        refit(s, problem, screen, without, data);
        judge(s, screen.heldout_error(), options);
        if (s.verdict == "passes" && solid) continue;
        d.messages.push_back(c.label() + " was found first, and is not needed beside the others: dropped");
        std::erase_if(d.ladder, [&](const Rung &r) { return r.label == "+ " + c.label(); });
        if (d.ladder.size() > 1) d.ladder.back().train = overall_error(problem), d.ladder.back().heldout = overall_heldout(problem);
        d.model = without;
        last = problem;
        d.accepted.erase(d.accepted.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (options.shapes) d.unknown = find_unknown(*first, *last, d.accepted.size(), options);
    for (const CandidateResult &a : d.accepted) d.effects.push_back(a.candidate.label());
    const bool any_class = !d.classes.empty();
    if (d.accepted.empty()) d.kind = d.unknown ? "unknown" : "nothing";
    else d.kind = d.unknown ? "partial" : any_class ? "class" : "named";
    d.text = verdict_text(d);
    return d;
}

} // namespace traction::lab
