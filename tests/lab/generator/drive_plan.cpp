#include "drive_plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace traction::generator {

namespace {

using K = Segment::Kind;

Segment go(double duration, double speed, double ramp, double yaw = 0) { return {K::drive, duration, speed, ramp, yaw}; }

std::vector<Segment> full_plan() {
    return {
        go(1.5, 0, 1),
        go(6, 0.22, 0.15),
        go(3, 0.5, 3),
        go(1.5, 0, 6),
        go(3, 0.4, 4),
        go(4, -0.35, 5),
        go(3, -0.1, 0.5),
        go(1.5, 0, 2),
        {K::front_sweep, 17, 0.25, 1},
        go(1.2, 0, 3),
        go(9, -0.3, 1),
        go(5, 0.2, 1, 0.6),
        go(5, 0.2, 1, -0.6),
        go(2.5, 0, 1, 0.9),
        go(2.5, 0, 1, -0.9),
        go(1, 0, 3),
        {K::rear_sweep, 13, 0.25, 1},
        go(1, 0, 3),
        {K::drag_one, 2.5, 0.25, 1, 0, 0},
        {K::drag_one, 2.5, 0.25, 1, 0, 1},
        {K::drag_one, 2.5, 0.25, 1, 0, 2},
        {K::drag_one, 2.5, 0.25, 1, 0, 3},
        {K::coast, 1.5},
        go(2.5, 0.55, 8),
        {K::coast, 1.5},
        go(8, -0.45, 2),
        go(3, 0.1, 1),
        go(3, 0.2, 1),
        go(3, 0.35, 1),
        go(3, 0.5, 1),
        go(1.5, 0, 8),
        go(2.5, -0.5, 8),
        go(2.5, 0.45, 8),
        go(2, 0, 1),
    };
}

// One manoeuvre of a kind, or a few that belong together.
void add_mixed(std::vector<Segment> &plan, Random &random) {
    const double way = random.sign(), speed = random.uniform(0.1, 0.5);
    switch (random.below(8)) {
    case 0:
        plan.push_back(go(random.uniform(2, 6), way * speed, random.log_uniform(0.2, 6)));
        break;
    case 1:
        plan.insert(plan.end(), {go(random.uniform(2, 4), way * speed, 3), go(1.2, 0, 6), go(2.5, -way * speed, 6)});
        break;
    case 2:
        plan.push_back({K::front_sweep, random.uniform(10, 18), random.uniform(0.2, 0.3), 1});
        plan.push_back(go(1, 0, 3));
        break;
    case 3:
        plan.push_back({K::rear_sweep, random.uniform(10, 18), random.uniform(0.2, 0.3), 1});
        plan.push_back(go(1, 0, 3));
        break;
    case 4:
        plan.push_back({K::drag_one, random.uniform(2, 4), 0.25, 1, 0, random.below(wheels), random.uniform(0.3, 0.7)});
        break;
    case 5:
        plan.push_back(go(random.uniform(2, 5), speed, 1, random.sign() * random.uniform(0.3, 0.8)));
        break;
    case 6:
        plan.insert(plan.end(), {go(2, way * speed, 8), {K::coast, 1.5}});
        break;
    default:
        plan.push_back(go(random.uniform(1, 2), 0, 2));
    }
}

void add_drawn(const std::string &name, std::vector<Segment> &plan, Random &random) {
    if (name == "mixed" || name == "halt") return add_mixed(plan, random);
    const double speed = random.uniform(0.15, 0.5);
    if (name == "stop_and_go")
        plan.insert(plan.end(), {go(random.uniform(2, 5), random.uniform() < 0.3 ? -speed : speed, random.log_uniform(0.5, 6)),
                                 go(random.uniform(0.8, 3), 0, random.log_uniform(1, 8))});
    else if (name == "slow")
        plan.push_back(go(random.uniform(3, 8), random.uniform(-0.12, 0.15), random.log_uniform(0.1, 1)));
    else if (name == "curves")
        plan.push_back(go(random.uniform(2, 6), speed, 1, random.uniform(-0.8, 0.8)));
    else if (name == "spins")
        plan.push_back(go(random.uniform(2, 6), random.uniform() < 0.3 ? 0.4 * speed : 0, 1, random.sign() * random.uniform(0.2, 0.9)));
    else if (name == "shuttle")
        plan.insert(plan.end(), {go(random.uniform(2, 5), speed, random.log_uniform(0.2, 3)),
                                 go(random.uniform(2, 5), -speed, random.log_uniform(0.2, 3))});
    else // slopes
        plan.insert(plan.end(), {go(random.uniform(4, 9), speed, 2), go(1.5, 0, 3), go(random.uniform(3, 6), -speed, 2), go(1.5, 0, 3),
                                 go(3.5, 0, 1, 0.9)});
}

} // namespace

std::vector<Segment> make_plan(const std::string &name, double duration_s, Random &random, double speed) {
    std::vector<Segment> plan;
    static const char *const drawn[] = {"mixed", "stop_and_go", "slow", "curves", "slopes", "spins", "shuttle", "halt"};
    if (std::find(std::begin(drawn), std::end(drawn), name) != std::end(drawn)) {
        plan.push_back(go(1.5, 0, 1));
        bool halted = name != "halt";
        for (double total = 0; total < duration_s;) {
            const std::size_t before = plan.size();
            if (!halted && total > 0.4 * duration_s) plan.push_back(go(0.25 * duration_s, 0, 2)), halted = true;
            add_drawn(name, plan, random);
            for (std::size_t i = before; i < plan.size(); ++i) total += plan[i].duration_s, plan[i].speed_m_s *= speed;
        }
        return plan;
    }
    if (name == "full")
        plan = full_plan();
    else if (name == "cruise")
        plan = {go(2, 0, 1), go(10, 0.25, 0.3)};
    else if (name == "stairs")
        plan = {go(2, 0, 1), go(8, 0.1, 0.2), go(8, 0.2, 0.2), go(8, 0.3, 0.2), go(8, 0.15, 0.2)};
    else if (name == "sweep")
        plan = {go(2, 0, 1), {K::front_sweep, 20, 0.3, 1}, go(2, 0, 2), {K::rear_sweep, 20, 0.3, 1}, go(2, 0, 2)};
    else
        throw std::invalid_argument(
            "unknown drive \"" + name +
            "\"; use full, cruise, stairs, sweep, mixed, stop_and_go, slow, curves, slopes, spins, shuttle or halt");
    double total = 0;
    for (Segment &segment : plan) { // nobody drives the same plan twice
        segment.duration_s *= random.uniform(0.9, 1.1);
        segment.speed_m_s *= speed * random.uniform(0.88, 1.12);
        segment.yaw_rate_rad_s *= random.uniform(0.85, 1.15);
        total += segment.duration_s;
    }
    if (name == "full") // the plan fills the time; others end with their last manoeuvre held
        for (Segment &segment : plan) segment.duration_s *= duration_s / total;
    return plan;
}

Driver::Driver(std::vector<Segment> plan, double radius_m, double half_track_m, LoopTune tune, double tick_s)
    : plan_(std::move(plan)), radius_(radius_m), half_track_(half_track_m), tune_(tune), tick_(tick_s) {}

PerWheel Driver::command(double t_s, const PerWheel &w, double estimate, double battery_V) {
    while (index_ + 1 < plan_.size() && t_s >= segment_start_ + plan_[index_].duration_s) segment_start_ += plan_[index_++].duration_s;
    const Segment &now = plan_[index_];
    const double since = t_s - segment_start_;
    speed_ += std::clamp(now.speed_m_s - speed_, -now.ramp_m_s2 * tick_, now.ramp_m_s2 * tick_);
    const double hold = (speed_ + 0.8 * (speed_ - estimate)) / radius_;           // (22) with Kv R = 0.8
    const double rising = 1.5 * now.speed_m_s / radius_ * since / now.duration_s; // (15): slip zero at two thirds
    PerWheel duty{};
    for (std::size_t i = 0; i < wheels; ++i) {
        const double left = (i % 2 == 0) ? 1 : -1;
        switch (now.kind) {
        case K::drive:
            set_[i] = (speed_ - left * half_track_ * now.yaw_rate_rad_s) / radius_;
            break;
        case K::front_sweep:
            set_[i] = i >= 2 ? rising : hold;
            break;
        case K::rear_sweep:
            set_[i] = i < 2 ? rising : hold;
            break;
        case K::drag_one:
            set_[i] = hold * (static_cast<int>(i) == now.wheel ? now.drag_share : 1);
            break;
        case K::coast:
            set_[i] = 0;
            break;
        }
        if (now.kind == K::coast) {
            integral_[i] = 0;
            speed_ = estimate;
            continue; // bridge at zero: the winding is shorted
        }
        const double error = set_[i] - w[i];
        const double raw = tune_.back_emf_Vs_rad / std::max(battery_V, 4.0) * set_[i] + tune_.duty_per_rad_s * error + integral_[i];
        duty[i] = std::clamp(raw, -1.0, 1.0);
        if (raw == duty[i]) integral_[i] += tune_.duty_per_rad * error * tick_; // no wind-up
        duty[i] = std::round(duty[i] * 2000) / 2000;                            // 0.05 % PWM steps
    }
    return duty;
}

} // namespace traction::generator
