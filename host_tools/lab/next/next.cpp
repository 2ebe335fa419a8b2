#include "next.h"

#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "information.h"
#include "manoeuvre.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

namespace traction::lab {

namespace {

constexpr double answered_at = 2; // d' from which 85 to 93 % are named right (docs/evidence.md section 5)
constexpr double sizes_of_interest = 3;
constexpr double noticed_at = 4.588; // 2/sqrt(1 - 0.9^2): at this size |cos| = 0.9, the lab's limit of a class, means d' = 2
constexpr int most_manoeuvres = 3;

struct Asked {
    std::vector<int> members;                               // of the plan's candidates
    double known = std::numeric_limits<double>::infinity(); // d' that the diagnosis of the log found for it
};

// What is asked, of which model, on top of which log.
struct Plan {
    Model base; // without the members in question
    std::vector<SizedCandidate> candidates;
    std::vector<Asked> asked;
    const Dataset *data = nullptr;
    std::map<std::string, double> scale; // of the present log's rows
    bool sizes_free = false;             // no log has told the sizes: at least large enough to be noticed
    bool undecided = false;              // the log was judged and did not decide, whatever d' it should have had
};

SizedCandidate of_interest(const Candidate &c) {
    SizedCandidate s{c, {}};
    for (std::size_t j = 0; j < c.strengths.size(); ++j)
        s.size.push_back(sizes_of_interest * (j < c.of_interest.size() ? c.of_interest[j] : c.step[j]));
    return s;
}

// The fitted size where it is one to speak of and has the sign physics allows, else three sizes of interest.
SizedCandidate as_found(const CandidateResult &r) {
    SizedCandidate s = of_interest(r.candidate);
    for (std::size_t j = 0; j < r.value.size() && j < s.size.size(); ++j) {
        const double least = s.size[j] / sizes_of_interest, sign = r.candidate.minimum[j] >= 0 ? 1.0 : (r.value[j] < 0 ? -1.0 : 1.0);
        if (std::fabs(r.value[j]) > least && r.value[j] * sign > 0)
            s.size[j] = std::clamp(r.value[j], r.candidate.minimum[j], r.candidate.maximum[j]);
        else
            s.size[j] *= sign;
    }
    return s;
}

// How far a variant's shape is from the catalogue's typical one.
double unusual(const Candidate &c) {
    double distance = 0;
    const sim::Effect *effect = sim::find_effect(c.effect);
    for (const auto &[key, value] : c.variant)
        for (const sim::EffectParameter &p : effect->parameters)
            if (p.name == key) distance += std::fabs(value - p.typical) / std::max(1e-9, std::fabs(p.maximum - p.minimum));
    return distance;
}

std::optional<Candidate> catalogue_candidate(const std::string &effect, int wheel, const Model &base) {
    Motion motion; // patches are cut along a path: one of half a metre, half a metre on
    for (int k = 0; k <= 200; ++k) motion.path_m.push_back(0.01 * k);
    std::optional<Candidate> best;
    for (Candidate &c : catalogue_candidates(base, Dataset{}, motion))
        if (c.effect == effect && c.wheel == wheel && (!best || unusual(c) < unusual(*best))) best = std::move(c);
    return best;
}

int place_of(Plan &plan, SizedCandidate sized) {
    for (std::size_t i = 0; i < plan.candidates.size(); ++i)
        if (plan.candidates[i].candidate.label() == sized.candidate.label()) return static_cast<int>(i);
    plan.candidates.push_back(std::move(sized));
    return static_cast<int>(plan.candidates.size()) - 1;
}

const CandidateResult *find_result(const Diagnosis &d, const std::string &label) {
    for (const auto *list : {&d.accepted, &d.ranking})
        for (const CandidateResult &r : *list)
            if (r.candidate.label() == label) return &r;
    return nullptr;
}

// d' of three sizes of interest by the diagnosis's own standard error.
double found_of(const Diagnosis &d, const Candidate &c) {
    const CandidateResult *r = find_result(d, c.label());
    double most = 0;
    for (std::size_t j = 0; r != nullptr && j < r->value.size() && j < c.of_interest.size(); ++j) {
        const double error = (r->high[j] - r->low[j]) / (2 * 1.96);
        if (error > 0 && std::isfinite(error)) most = std::max(most, sizes_of_interest * c.of_interest[j] / error);
    }
    return r != nullptr ? most : std::numeric_limits<double>::infinity();
}

// d' of one role, less where the forward model's own error on these drives looks like the effect: it must not be taken for it.
double discounted(const Plan &plan, const Eigen::MatrixXd &gram, const Eigen::VectorXd &precision, int truth, int rival) {
    return detectability(gram, precision, plan.candidates, truth, rival) /
           std::max(1.0, score_statistic(gram, precision, plan.candidates, truth, rival));
}

// The least of "A is true, B is its proxy" and the other way round; whether A shows at all when it is alone.
double distance(const Plan &plan, const Eigen::MatrixXd &gram, const Eigen::VectorXd &precision, const Asked &asked) {
    if (asked.members.size() == 1) return discounted(plan, gram, precision, asked.members[0], -1);
    return std::min(discounted(plan, gram, precision, asked.members[0], asked.members[1]),
                    discounted(plan, gram, precision, asked.members[1], asked.members[0]));
}

bool answers(const Plan &plan, double before, double after) {
    if (before < answered_at) return after >= answered_at;
    return plan.undecided && after * after - before * before >= answered_at * answered_at;
}

// A drive that is planned is a run like the first: no other begins in it.
Model in_one_run(Model model) {
    double first = std::numeric_limits<double>::infinity();
    for (const RunSpec &run : model.runs) first = std::min(first, std::isnan(run.start_s) ? first : run.start_s);
    for (RunSpec &run : model.runs)
        if (run.start_s > first) run.start_s = std::numeric_limits<double>::infinity();
    return model;
}

// The plant that was lent refuses this machine.
struct CannotDrive : std::runtime_error {
    using std::runtime_error::runtime_error;
};

log::Log driven(const std::string &scenario, const DriveScenario &drive) {
    try {
        return drive(scenario);
    } catch (const std::runtime_error &error) { // its own limits: what was found does not depend on them
        throw CannotDrive(error.what());
    }
}

// Fisher information of a drive of this scenario.
Eigen::MatrixXd information_of(const Plan &plan, const std::string &scenario, const DriveScenario &drive) {
    const Model base = in_one_run(plan.base);
    Dataset trial = make_dataset(base, driven(scenario, drive));
    if (plan.data != nullptr) { // sensors that this rover's log lacks will be lacking again, and be as noisy
        std::erase_if(trial.balance, [&](const Balance &b) {
            return std::none_of(plan.data->balance.begin(), plan.data->balance.end(), [&](const Balance &a) { return a.name == b.name; });
        });
        for (Balance &b : trial.balance)
            for (const Balance &a : plan.data->balance)
                if (a.name == b.name) b.noise = std::max(a.noise, 1e-12);
    }
    const Physics physics = make_physics(base);
    Problem problem(trial, physics, free_parameters(base, physics));
    problem.linearise();
    std::map<std::string, double> scale = scale_over_noise(problem);
    for (auto &[name, value] : scale)
        if (const auto found = plan.scale.find(name); found != plan.scale.end()) value = std::max(value, found->second);
    return fisher_information(problem, scale, plan.candidates);
}

struct Choice {
    std::vector<std::size_t> manoeuvres;
    int answered = 0;
    double least = 0, rate = 0; // least d' over answerable questions, and its square per second
};

void name_kinds(const Plan &plan, NextExperiment &next) {
    for (const Manoeuvre &m : manoeuvres_of(plan.base)) {
        const bool fits = std::any_of(plan.candidates.begin(), plan.candidates.end(), [&](const SizedCandidate &s) {
            return std::find(m.good_for.begin(), m.good_for.end(), s.candidate.effect) != m.good_for.end();
        });
        if (fits) next.tried.push_back({m.title, 0, 0, 0});
    }
    for (Question &q : next.questions) q.status = "later";
}

// Fills base, its fit to the log and the rows' scales from the model that explains the log best.
void condition_on_log(Plan &plan, const Model &best, Eigen::MatrixXd &gram, Eigen::VectorXd &precision) {
    const auto count = [&] {
        Eigen::Index n = 0;
        for (const SizedCandidate &s : plan.candidates) n += static_cast<Eigen::Index>(s.size.size());
        return n;
    }();
    if (plan.data == nullptr || plan.data->balance.empty() || plan.data->count < 3) {
        const Physics physics = make_physics(plan.base);
        const std::vector<FreeParameter> parameters = free_parameters(plan.base, physics);
        const auto n = static_cast<Eigen::Index>(parameters.size());
        precision = Eigen::VectorXd::Zero(n);
        for (Eigen::Index i = 0; i < n; ++i)
            if (const double prior = parameters[static_cast<std::size_t>(i)].prior; prior > 0) precision[i] = 1 / (prior * prior);
        gram = Eigen::MatrixXd::Zero(n + count + 1, n + count + 1);
        plan.data = nullptr;
        return;
    }
    const auto fit = [&](Model &model) { // its values alone: no errors, no blocks left out
        const Problem fitted = fitted_problem(model, *plan.data);
        for (std::size_t i = 0; i < fitted.parameters.size(); ++i)
            store(model, fitted.parameters[i], fitted.theta[static_cast<Eigen::Index>(i)], 0);
    };
    Model explained = best;
    fit(explained);
    Problem last(*plan.data, make_physics(explained), free_parameters(explained, make_physics(explained)));
    last.linearise();
    plan.scale = scale_over_noise(last);
    fit(plan.base);
    Problem problem(*plan.data, make_physics(plan.base), free_parameters(plan.base, make_physics(plan.base)));
    problem.linearise();
    gram = fisher_information(problem, plan.scale, plan.candidates);
    gram.rightCols(1).setZero(); // its residual holds what is hidden
    gram.bottomRows(1).setZero();
    precision = problem.prior_precision();
}

// The distances of one plan: of its questions, with the Gram matrices of the log and of every manoeuvre.
struct Table {
    const Plan &plan;
    Eigen::VectorXd precision;
    Eigen::MatrixXd log;
    std::vector<Eigen::MatrixXd> grams; // per manoeuvre
    std::vector<double> before;
    std::vector<bool> answerable; // by all manoeuvres together

    std::vector<double> by_log = {}; // of each question, by the log's information alone

    double distance_at(const Eigen::MatrixXd &gram, std::size_t q) const { return distance(plan, gram, precision, plan.asked[q]); }
    // Where the diagnosis found less in the log than its information promises, a drive adds to what was found.
    double at(const Eigen::MatrixXd &gram, std::size_t q) const {
        const double d = distance_at(gram, q), known = plan.asked[q].known;
        if (!(known < by_log[q])) return d;
        return std::sqrt(known * known + std::max(0.0, d * d - by_log[q] * by_log[q]));
    }
};

// Effects that the model's own parameters would hide at three sizes of interest are asked for at the size that stands out.
void enlarge(Plan &plan, const Eigen::MatrixXd &everything, const Eigen::VectorXd &precision) {
    for (std::size_t i = 0; i < plan.candidates.size(); ++i) {
        SizedCandidate &s = plan.candidates[i];
        const double alone = detectability(everything, precision, plan.candidates, static_cast<int>(i), -1);
        if (!(alone > 0)) continue;
        for (std::size_t j = 0; j < s.size.size(); ++j)
            s.size[j] = std::max(s.size[j], std::min(s.candidate.maximum[j], s.size[j] * noticed_at / alone));
    }
}

void judge_alone(Table &table, const Eigen::MatrixXd &everything, NextExperiment &next) {
    const std::vector<Manoeuvre> &list = manoeuvres_of(table.plan.base);
    for (std::size_t q = 0; q < next.questions.size(); ++q) {
        Question &one = next.questions[q];
        table.by_log.push_back(table.distance_at(table.log, q));
        table.before.push_back(one.before = table.at(table.log, q));
        for (const Eigen::MatrixXd &gram : table.grams) one.best = std::max(one.best, table.at(table.log + gram, q));
        table.answerable.push_back(answers(table.plan, one.before, std::max(one.best, table.at(everything, q))));
        one.status = one.before >= answered_at && !table.plan.undecided ? "told" : table.answerable.back() ? "later" : "never";
    }
    for (std::size_t m = 0; m < list.size(); ++m) {
        Tried t{list[m].title, list[m].duration_s, 1e300, 0};
        for (std::size_t q = 0; q < table.before.size(); ++q) {
            if (!table.answerable[q]) continue;
            const double after = table.at(table.log + table.grams[m], q);
            t.least = std::min(t.least, after);
            t.answered += answers(table.plan, table.before[q], after);
        }
        if (t.least < 1e300) next.tried.push_back(t);
    }
}

void conclude(const Table &table, const Eigen::MatrixXd &after, NextExperiment &next) {
    for (std::size_t q = 0; q < next.questions.size(); ++q) {
        Question &one = next.questions[q];
        one.after = table.at(after, q);
        if (answers(table.plan, one.before, one.after)) one.status = "answered";
        if (one.status != "never") continue;
        for (const int m : table.plan.asked[q].members) {
            const std::string words = measure_instead(table.plan.candidates[static_cast<std::size_t>(m)].candidate.effect);
            if (one.measure.find(words) == std::string::npos) one.measure += (one.measure.empty() ? "" : "; ") + words;
        }
    }
}

// Best set of up to three manoeuvres: most answers, then the largest square of the least d' per second: d'^2 adds up over time, d' does
// not.
Choice choose(const Table &table) {
    const std::size_t n = table.grams.size();
    Choice best;
    const auto consider = [&](const std::vector<std::size_t> &set) {
        Eigen::MatrixXd gram = table.log;
        double seconds = 0;
        for (const std::size_t m : set) gram += table.grams[m], seconds += manoeuvres_of(table.plan.base)[m].duration_s;
        Choice c{set, 0, 1e300, 0};
        for (std::size_t q = 0; q < table.before.size(); ++q) {
            if (!table.answerable[q]) continue;
            const double after = table.at(gram, q);
            c.answered += answers(table.plan, table.before[q], after);
            c.least = std::min(c.least, after);
        }
        c.rate = c.least * c.least / seconds; // squares add up over time
        if (c.answered > best.answered || (c.answered == best.answered && c.answered > 0 && c.rate > best.rate)) best = c;
    };
    const int all = static_cast<int>(std::count(table.answerable.begin(), table.answerable.end(), true));
    for (int size = 1; size <= most_manoeuvres && best.answered < all; ++size) // a longer drive only where a shorter one leaves something
        for (std::size_t i = 0; i < n; ++i) {
            if (size == 1) consider({i});
            for (std::size_t j = i + 1; size > 1 && j < n; ++j) {
                if (size == 2) consider({i, j});
                for (std::size_t k = j + 1; size > 2 && k < n; ++k) consider({i, j, k});
            }
        }
    return best;
}

NextExperiment questions_of(const Plan &plan) {
    NextExperiment next;
    for (const Asked &a : plan.asked) {
        Question q;
        for (const int m : a.members) q.members.push_back(plan.candidates[static_cast<std::size_t>(m)].candidate.label());
        next.questions.push_back(q);
    }
    return next;
}

NextExperiment kinds_alone(const Plan &plan, const std::string &why_not) {
    NextExperiment next = questions_of(plan);
    next.why_not = why_not;
    name_kinds(plan, next);
    return next;
}

NextExperiment with_numbers(Plan plan, const Model &best, const DriveScenario &drive) {
    NextExperiment next = questions_of(plan);
    next.predicted = true;
    Table table{plan, {}, {}, {}, {}, {}};
    condition_on_log(plan, best, table.log, table.precision);
    for (const Manoeuvre &m : manoeuvres_of(plan.base)) {
        next.notes.clear(); // the same for each
        table.grams.push_back(information_of(plan, scenario_of(plan.base, {&m}, next.notes), drive));
    }
    Eigen::MatrixXd everything = table.log;
    for (const Eigen::MatrixXd &gram : table.grams) everything += gram;
    if (plan.sizes_free) enlarge(plan, everything, table.precision);
    judge_alone(table, everything, next);
    const Choice choice = choose(table);
    Eigen::MatrixXd after = table.log;
    if (!choice.manoeuvres.empty()) {
        std::vector<const Manoeuvre *> list;
        for (const std::size_t m : choice.manoeuvres) list.push_back(&manoeuvres_of(plan.base)[m]);
        next.notes.clear();
        next.scenario_toml = scenario_of(plan.base, list, next.notes);
        for (const Manoeuvre *m : list) next.title += (next.title.empty() ? "" : ", then ") + m->title, next.duration_s += m->duration_s;
        after += list.size() > 1 ? information_of(plan, next.scenario_toml, drive)
                                 : table.grams[choice.manoeuvres[0]]; // in one go, as it will be driven
    }
    conclude(table, after, next);
    return next;
}

NextExperiment solve(const Plan &plan, const Model &best, const DriveScenario &drive) {
    if (plan.asked.empty()) return {};
    if (const std::string why = cannot_drive(plan.base); !why.empty()) return kinds_alone(plan, why);
    try {
        return with_numbers(plan, best, drive);
    } catch (const CannotDrive &refused) {
        return kinds_alone(plan, refused.what());
    }
}

} // namespace

NextExperiment next_experiment(const Diagnosis &d, const Model &model, const Dataset &data, bool all, const DriveScenario &drive) {
    Plan plan;
    plan.data = &data;
    plan.base = model;
    std::set<std::string> in_class;
    for (const ConfoundedClass &c : d.classes) in_class.insert(c.members.begin(), c.members.end());
    for (const CandidateResult &a : d.accepted) // what was named for sure belongs to the machine
        if (in_class.count(a.candidate.label()) == 0) plan.base.effects.push_back(effect_of(a.candidate, a.value));
    plan.undecided = true; // whatever is asked here, the diagnosis has looked at this log and could not say
    for (const ConfoundedClass &c : d.classes) {
        std::vector<int> places;
        for (const std::string &label : c.members)
            if (const CandidateResult *r = find_result(d, label)) places.push_back(place_of(plan, as_found(*r)));
        for (std::size_t i = 0; i < places.size(); ++i)
            for (std::size_t j = i + 1; j < places.size(); ++j) plan.asked.push_back({{places[i], places[j]}});
    }
    if (plan.asked.empty() || all)
        for (const auto &[effect, why] : d.not_excited)
            if (const auto c = catalogue_candidate(effect, -1, plan.base))
                plan.asked.push_back({{place_of(plan, of_interest(*c))}, found_of(d, *c)});
    return solve(plan, d.model, drive);
}

NextExperiment next_experiment(const std::vector<std::string> &effects, const Model &model, const Dataset *data,
                               const DriveScenario &drive) {
    Plan plan;
    plan.data = data;
    plan.base = model;
    std::vector<int> places;
    for (const std::string &text : effects) {
        const std::size_t colon = text.find(':');
        const std::string name = text.substr(0, colon);
        int wheel = -1;
        if (colon != std::string::npos)
            wheel = text.size() == colon + 2 && text[colon + 1] >= '0' && text[colon + 1] <= '9' ? text[colon + 1] - '0' : 1000;
        if (sim::find_effect(name) == nullptr)
            throw ModelError("--effects", 0, text, "is no effect of the catalogue", "`traction effects` lists them; NAME, or NAME:WHEEL");
        const auto c = catalogue_candidate(name, wheel, model);
        if (!c)
            throw ModelError("--effects", 0, text,
                             model.find_effect(name, -1) != nullptr ? "is in the model already" : "cannot be had on that wheel",
                             "name another effect, or NAME alone for all wheels");
        places.push_back(place_of(plan, of_interest(*c)));
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = i + 1; j < places.size(); ++j) plan.asked.push_back({{places[i], places[j]}});
    plan.sizes_free = places.size() > 1;
    if (places.size() == 1) plan.asked.push_back({{places[0]}});
    return solve(plan, model, drive);
}

} // namespace traction::lab
