// The samples themselves: rates, gaps, clock, dead and stuck sensors, outliers, resolution.
#include "series.h"

#include "host_tools/log/vocabulary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace traction::check {

namespace {

bool is_sensor(const log::Quantity &entry) { return entry.kind == log::Kind::measured || entry.kind == log::Kind::raw; }
bool one_of(std::string_view quantity, std::initializer_list<std::string_view> list) {
    return std::find(list.begin(), list.end(), quantity) != list.end();
}

class Quality {
  public:
    Quality(const log::Log &log, const std::vector<log::Repair> &repairs, const Grid &grid, Findings &findings, std::vector<Rate> &rates)
        : log_(log), repairs_(repairs), grid_(grid), findings_(findings), rates_(rates) {}
    void run();

  private:
    struct Gap {
        double t0_s, t1_s;
        std::vector<std::string> signals;
    };
    void repairs();
    void rate(const log::Signal &signal);
    void gaps();
    bool frozen_over(const Gap &gap, std::string &evidence) const;
    void dead_or_stuck(const log::Signal &signal, const log::Quantity &entry, bool counted = false);
    log::Signal whole_pose(const log::Signal &camera_x) const;
    void outliers(const log::Signal &signal);
    void jumps(const log::Signal &signal);
    void derived_speeds();
    void coarse(const log::Signal &signal);
    bool active_at(const log::Signal &signal, double t_s) const;
    bool electrics_agree(int wheel, double t0_s, double t1_s, bool &known) const;
    bool constant_by_design(const log::Signal &signal) const { return log_.header.count("constant." + signal.name) != 0; }
    void add(const char *id, Severity severity, const std::string &signal, std::string text, std::string mend, double value,
             double t0_s = not_known, double t1_s = not_known) {
        findings_.push_back({id, severity, signal, std::move(text), std::move(mend), value, t0_s, t1_s});
    }

    const log::Log &log_;
    const std::vector<log::Repair> &repairs_;
    const Grid &grid_;
    Findings &findings_;
    std::vector<Rate> &rates_;
    std::vector<Gap> gaps_;
};

void Quality::repairs() {
    std::map<std::pair<std::string, std::size_t>, std::pair<std::size_t, std::size_t>> told; // cause, count: its finding, further signals
    for (const log::Repair &repair : repairs_) {
        if (repair.id == "not_finite") {
            const log::Signal *signal = log_.find(repair.signal);
            const double share =
                static_cast<double>(repair.count) / static_cast<double>(repair.count + (signal != nullptr ? signal->value.size() : 0));
            add("not_finite", share > 0.2 ? Severity::error : Severity::warning, repair.signal,
                repair.text + say(" (%.1f %% of the column)", 100 * share),
                "find out why the sensor gave no number, and leave such cells empty", share);
        } else if (one_of(repair.id, {"unsorted", "duplicate_time", "time_not_finite", "cut_last_line", "out_of_range"})) {
            if (one_of(repair.id, {"unsorted", "duplicate_time"})) { // one clock has many columns
                const auto [seen, fresh] = told.try_emplace({repair.id, repair.count}, findings_.size(), 0);
                if (!fresh) {
                    ++seen->second.second;
                    continue;
                }
            }
            add(repair.id.c_str(), Severity::warning, repair.signal, repair.text, "mend the recording, so that nothing has to be guessed",
                static_cast<double>(repair.count));
        } else {
            add(repair.id.c_str(), Severity::note, repair.signal, repair.text, "nothing to do if this is what was meant",
                static_cast<double>(repair.count));
        }
    }
    for (const auto &[cause, finding] : told)
        if (finding.second > 0) findings_[finding.first].text += say("; so have %zu other signals", finding.second);
    if (const auto ended = log_.header.find("ended"); ended != log_.header.end() && ended->second == "interrupted")
        add("interrupted", Severity::note, "", say("the run was stopped after %.1f s, before its end", log_.duration_s()),
            "nothing to do if what is there is enough", log_.duration_s());
}

void Quality::rate(const log::Signal &signal) {
    const std::vector<double> &t = signal.t_s;
    std::vector<double> step(t.size() - 1);
    for (std::size_t i = 0; i + 1 < t.size(); ++i) step[i] = t[i + 1] - t[i];
    Rate rate;
    rate.signal = signal.name;
    rate.samples = t.size();
    rate.median_s = quantile(step, 0.5);
    rate.largest_gap_s = *std::max_element(step.begin(), step.end());
    const double big = std::max(10 * rate.median_s, 0.2);
    double expected = 0, regular = 0;
    for (std::size_t i = 0; i < step.size(); ++i) {
        const double multiple = step[i] / rate.median_s;
        regular += std::fabs(multiple - std::round(multiple)) < 0.25 && multiple > 0.5;
        if (step[i] <= big) {
            expected += std::max(1.0, std::round(multiple));
            continue;
        }
        expected += 1;
        auto same = std::find_if(gaps_.begin(), gaps_.end(),
                                 [&](const Gap &gap) { return std::fabs(gap.t0_s - t[i]) < 0.6 && std::fabs(gap.t1_s - t[i + 1]) < 0.6; });
        if (same == gaps_.end()) same = gaps_.insert(gaps_.end(), Gap{t[i], t[i + 1], {}});
        same->t0_s = std::max(same->t0_s, t[i]); // the fastest signal knows best
        same->t1_s = std::min(same->t1_s, t[i + 1]);
        if (same->signals.empty() || same->signals.back() != signal.name) same->signals.push_back(signal.name);
    }
    const bool is_regular = regular > 0.8 * static_cast<double>(step.size());
    rate.missing = is_regular ? 1 - static_cast<double>(step.size()) / expected : 0;
    rate.jitter = (quantile(step, 0.95) - quantile(step, 0.05)) / (2 * rate.median_s);
    const bool said =
        std::any_of(findings_.begin(), findings_.end(), [&](const Finding &f) { return f.id == "not_finite" && f.signal == signal.name; });
    // a radar without a peak and a camera that is blocked give no sample: nothing is wrong with the log
    const bool may_pause = signal.name == "radar.speed_m_s" || signal.name.rfind("camera.", 0) == 0;
    if (rate.missing > 0.03 && !said) {
        add("samples_missing", rate.missing > 0.2 && !may_pause ? Severity::error : Severity::warning, signal.name,
            say("'%s' lacks %.0f %% of its samples (one every %.4g s expected)", signal.name.c_str(), 100 * rate.missing, rate.median_s),
            "look for an overloaded logger or a bad link; record again", rate.missing);
    } else if (rate.jitter > 0.3 && !said) {
        const std::size_t beside = static_cast<std::size_t>(std::count_if(rates_.begin(), rates_.end(), [&](const Rate &other) {
            return other.samples == rate.samples && other.jitter == rate.jitter && other.median_s == rate.median_s;
        }));
        const auto told =
            std::find_if(findings_.begin(), findings_.end(), [&](const Finding &f) { return f.id == "jitter" && f.value == rate.jitter; });
        const bool same_rows = beside > 0 && told != findings_.end(); // one clock, told once
        const std::string first = same_rows ? told->signal : signal.name,
                          others = same_rows ? " and of " + std::to_string(beside) + " others beside it" : "";
        const std::string text = say("the time from sample to sample of '%s'%s varies by +-%.0f %% around %.4g s", first.c_str(),
                                     others.c_str(), 100 * rate.jitter, rate.median_s);
        if (same_rows)
            told->text = text;
        else
            add("jitter", Severity::warning, signal.name, text, "stamp samples where they are measured, not where they are written",
                rate.jitter);
    }
    rates_.push_back(rate);
}

// True when what integrates (angle, position) did not move on over the gap although it was moving: no time passed, the clock jumped.
bool Quality::frozen_over(const Gap &gap, std::string &evidence) const {
    int moving = 0, frozen = 0;
    for (const log::Signal &signal : log_.signals) {
        const log::Quantity *entry = log::find_quantity(signal.name);
        if (entry == nullptr ||
            !(entry->quantity == "angle" || entry->quantity == "encoder" || (entry->object == "camera" && entry->quantity != "yaw")))
            continue;
        const std::vector<double> &t = signal.t_s, &v = signal.value;
        const auto after = std::upper_bound(t.begin(), t.end(), 0.5 * (gap.t0_s + gap.t1_s));
        const std::size_t b = static_cast<std::size_t>(after - t.begin());
        if (b == 0 || b >= t.size()) continue;
        std::size_t start = b - 1;
        while (start > 0 && t[b - 1] - t[start] < 0.5) --start;
        if (b - start < 3) continue;
        const double speed = (v[b - 1] - v[start]) / (t[b - 1] - t[start]),
                     one_step = speed * (t[b - 1] - t[start]) / static_cast<double>(b - 1 - start);
        double noise = 0; // of one step around the mean step
        for (std::size_t i = start + 1; i < b; ++i) noise = std::max(noise, std::fabs(v[i] - v[i - 1] - one_step));
        const double predicted = speed * (t[b] - t[b - 1]), moved = v[b] - v[b - 1];
        if (std::fabs(predicted) < 10 * std::max(noise, std::fabs(one_step))) continue;
        ++moving;
        if (std::fabs(moved) < 0.2 * std::fabs(predicted)) {
            if (frozen++ == 0) evidence = say("'%s' moved by %.3g where %.3g was due", signal.name.c_str(), moved, predicted);
        }
    }
    return moving > 0 && frozen == moving;
}

void Quality::gaps() {
    std::size_t sensors = 0;
    for (const Rate &rate : rates_) sensors += rate.samples >= 20;
    std::map<std::string, std::pair<int, double>> own; // gaps of one signal alone: how many, the largest
    for (const Gap &gap : gaps_) {
        const double size = gap.t1_s - gap.t0_s;
        if (2 * gap.signals.size() < sensors) {
            for (const std::string &signal : gap.signals) {
                ++own[signal].first;
                own[signal].second = std::max(own[signal].second, size);
            }
            continue;
        }
        std::string evidence;
        if (frozen_over(gap, evidence)) {
            add("clock_jump", Severity::error, "", say("the clock jumps by %.3g s at t = %.3f s: ", size, gap.t0_s) + evidence,
                "take the jump out of all later times, or cut the log there", size, gap.t0_s, gap.t1_s);
        } else {
            add("gap", Severity::warning, "",
                say("%zu signals have no sample for %.3g s from t = %.3f s (or the clock jumped while the machine stood)",
                    gap.signals.size(), size, gap.t0_s),
                "cut the log there, or accept that nothing is learnt from that span", size, gap.t0_s, gap.t1_s);
        }
    }
    for (const auto &[signal, gap] : own) {
        add("gap", Severity::warning, signal, say("'%s' has %d gap(s), the longest %.3g s", signal.c_str(), gap.first, gap.second),
            "look for an overloaded logger or a bad link", gap.second);
    }
}

bool Quality::active_at(const log::Signal &signal, double t_s) const {
    const double cell = (t_s - grid_.start_s) / step_s;
    if (!(cell >= 0) || cell >= static_cast<double>(grid_.count)) return false;
    const std::size_t k = static_cast<std::size_t>(cell);
    const int index = log::wheel_of(signal.name);
    if (index < 0) return grid_.active[k] != 0;
    for (const Wheel &wheel : grid_.wheel) {
        if (wheel.index != index) continue;
        if (!wheel.duty.empty()) return std::fabs(wheel.duty[k]) > 0.05;
        if (!wheel.voltage.empty()) return std::fabs(wheel.voltage[k]) > 0.3;
        const bool is_speed = signal.name.find(".speed_") != std::string::npos;
        if (is_speed) {
            const log::Signal *set = log_.find("wheel" + std::to_string(index) + ".set_speed_rad_s");
            if (set == nullptr || set->t_s.empty()) return false;
            const auto next = std::upper_bound(set->t_s.begin(), set->t_s.end(), t_s);
            return next != set->t_s.begin() && std::fabs(set->value[static_cast<std::size_t>(next - set->t_s.begin()) - 1]) > 0.5;
        }
        return !wheel.speed.empty() && std::fabs(wheel.speed[k]) > 0.5;
    }
    return false;
}

constexpr double dead_band = 0.15; // of the largest voltage that the log holds: beyond it none is expected (assumed)

// A wheel that stands although driven is blocked when its motor's voltage is all spent in the winding, or stands because its bridge passes
// nothing on (a dead band, in which a loop's integral may rest): a small voltage, and no current, where one that turned would be braked by
// its friction. Else its encoder is dead.
bool Quality::electrics_agree(int index, double t0_s, double t1_s, bool &known) const {
    known = false;
    for (const Wheel &wheel : grid_.wheel) {
        if (wheel.index != index || wheel.voltage.empty() || wheel.current.empty() || wheel.speed.empty() || wheel.unsigned_current)
            continue;
        std::vector<double> y = wheel.voltage;
        for (std::size_t k = 0; k < y.size(); ++k) {
            if (grid_.time(k) >= t0_s && grid_.time(k) <= t1_s) y[k] = not_known;
        }
        const Fit law = fit(y, wheel.speed, wheel.current);
        if (!law.good) return false;
        double left = 0, size = 0, current = 0, current_squares = 0, full = 0;
        int n = 0;
        for (const double V : wheel.voltage)
            if (std::isfinite(V)) full = std::max(full, std::fabs(V));
        for (std::size_t k = 0; k < y.size(); ++k) {
            if (grid_.time(k) < t0_s || grid_.time(k) > t1_s || !std::isfinite(wheel.voltage[k] + wheel.speed[k] + wheel.current[k]))
                continue;
            left += std::fabs(wheel.voltage[k] - law.a * wheel.speed[k] - law.b * wheel.current[k]);
            size += std::fabs(wheel.voltage[k]);
            current += wheel.current[k], current_squares += wheel.current[k] * wheel.current[k];
            ++n;
        }
        known = n > 10;
        const bool no_current = current * current < 9 * current_squares; // within three standard errors of none
        return known && (left < std::max(0.15 * size, 4 * n * law.rms) || (no_current && size < dead_band * full * n));
    }
    return false;
}

// counted: a rate of counts or angles.
void Quality::dead_or_stuck(const log::Signal &signal, const log::Quantity &entry, bool counted) {
    const std::vector<double> &t = signal.t_s, &v = signal.value;
    struct Run {
        std::size_t first = 0, end = 0;
    } longest;
    std::size_t equal = 0, active = 0;
    for (std::size_t i = 0; i < v.size();) {
        std::size_t end = i + 1;
        while (end < v.size() && v[end] == v[i]) ++end;
        std::size_t driven = 0;
        for (std::size_t k = i; k < end; ++k) driven += active_at(signal, t[k]);
        active += driven;
        if (10 * driven >= 8 * (end - i)) {
            equal += end - i - 1;
            // what integrates stops by standing: a rate of counts may keep one number as long as a loop holds it
            if (end - i > longest.end - longest.first && (!counted || v[i] == 0)) longest = {i, end};
        }
        i = end;
    }
    const std::size_t length = longest.end - longest.first;
    if (length < 20 || active < 40) return;
    const double t0 = t[longest.first], t1 = t[longest.end - 1];
    if (t1 - t0 < 1.5) return;
    const bool whole = length >= active - active / 20;
    const bool lively = static_cast<double>(equal - (length - 1)) < 0.2 * static_cast<double>(active - length + 1);
    bool known = false;
    const bool is_wheel_motion = entry.object == "wheel<i>" && (counted || entry.quantity == "speed");
    const bool agrees = is_wheel_motion && electrics_agree(log::wheel_of(signal.name), t0, t1, known);
    const bool may_stand = v[longest.first] == 0 || !lively; // noise that stops on a number other than 0 needs no second witness
    if ((agrees && may_stand) || (!known && !lively && !whole)) return;
    if (whole) {
        add("dead_sensor", Severity::error, signal.name,
            say("'%s' stands at %.5g through the whole drive", signal.name.c_str(), v[longest.first]),
            "check its wiring; or take the column out of the log", t1 - t0, t0, t1);
    } else {
        add("stuck_sensor", Severity::error, signal.name,
            say("'%s' stands at %.5g for %.3g s from t = %.3f s while the machine is driven", signal.name.c_str(), v[longest.first],
                t1 - t0, t0),
            "check its wiring; cut the span out of the log", t1 - t0, t0, t1);
    }
}

// The camera sees nothing new only when x, y and yaw all stand: one mixed number of the three.
log::Signal Quality::whole_pose(const log::Signal &camera_x) const {
    log::Signal pose = camera_x;
    for (const auto &[name, weight] : {std::pair{"camera.y_m", 1.2345678}, std::pair{"camera.yaw_rad", 0.7654321}}) {
        const log::Signal *part = log_.find(name);
        if (part == nullptr || part->t_s != camera_x.t_s) continue;
        for (std::size_t i = 0; i < pose.value.size(); ++i) pose.value[i] += weight * part->value[i];
    }
    return pose;
}

void Quality::outliers(const log::Signal &signal) {
    const double middle = quantile(signal.value, 0.5), width = quantile(signal.value, 0.99) - quantile(signal.value, 0.01);
    if (!(width > 0)) return;
    std::size_t count = 0, worst = 0;
    for (std::size_t i = 0; i < signal.value.size(); ++i) {
        if (std::fabs(signal.value[i] - middle) < 15 * width) continue;
        if (count++ == 0 || std::fabs(signal.value[i] - middle) > std::fabs(signal.value[worst] - middle)) worst = i;
    }
    if (count == 0 || count > signal.value.size() / 100 + 1) return;
    add("outlier", Severity::warning, signal.name,
        say("%zu sample(s) of '%s' lie far outside the rest, the worst %.5g at t = %.3f s", count, signal.name.c_str(), signal.value[worst],
            signal.t_s[worst]),
        "leave these cells empty", signal.value[worst], signal.t_s[worst], signal.t_s[worst]);
}

// A wheel angle that starts again with every turn; a counter that overflows or is reset.
void Quality::jumps(const log::Signal &signal) {
    if (wraps(signal)) {
        add("wrapped", Severity::error, signal.name, say("'%s' starts again with every turn", signal.name.c_str()),
            "make it continuous (map: unwrap = true)", 0);
        return;
    }
    const std::vector<double> &t = signal.t_s, &v = signal.value;
    std::vector<double> gap, rate;
    for (std::size_t i = 1; i < v.size(); ++i) gap.push_back(t[i] - t[i - 1]);
    const double usual = quantile(gap, 0.5);
    for (std::size_t i = 1; i < v.size(); ++i) rate.push_back(std::fabs(v[i] - v[i - 1]) / std::max(gap[i - 1], usual));
    const auto alone = [&](std::size_t i) { // twenty times its neighbours
        return (i == 0 || rate[i] > 20 * rate[i - 1]) && (i + 1 == rate.size() || rate[i] > 20 * rate[i + 1]);
    };
    double fast = 0; // of all steps that follow from one another
    for (std::size_t i = 0; i < rate.size(); ++i)
        if (!alone(i)) fast = std::max(fast, rate[i]);
    const auto [low, high] = std::minmax_element(v.begin(), v.end());
    // five times as fast as any other step, alone, and no small part of the whole; a wheel that hardly turned says nothing
    const double half_radian = signal.name.find(".angle_rad") != std::string::npos ? 0.5
                               : std::isfinite(grid_.rad_per_count)                ? 0.5 / grid_.rad_per_count
                                                                                   : 200;
    const double large = std::max(0.02 * (*high - *low), half_radian);
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < rate.size(); ++i)
        if (alone(i) && rate[i] > 5 * fast && fast > 0 && std::fabs(v[i + 1] - v[i]) > large && count++ == 0) first = i;
    if (count == 0 || count > rate.size() / 10 + 1) return;
    add("counter_jump", Severity::error, signal.name,
        say("'%s' jumps by %.6g between two samples at t = %.3f s (%zu such jumps): a counter that overflowed or was reset",
            signal.name.c_str(), v[first + 1] - v[first], t[first + 1], count),
        "make it continuous (map: unwrap = true with period = the counter's range), or cut the log there", v[first + 1] - v[first],
        t[first], t[first + 1]);
}

// A wheel whose speed comes from its angle or counts may stand still as well.
void Quality::derived_speeds() {
    static const log::Quantity *speed = log::find_quantity("wheel0.speed_rad_s");
    for (const Wheel &wheel : grid_.wheel) {
        if (speed == nullptr || wheel.speed.empty() || wheel.speed_column.find(".speed_rad_s") != std::string::npos) continue;
        log::Signal rate{wheel.speed_column, {}, {}};
        std::vector<double> size = wheel.speed;
        for (double &v : size) v = std::fabs(v);
        const double creep = 0.02 * quantile(size, 0.98); // a count now and then
        for (std::size_t k = 0; k < grid_.count; ++k)
            if (std::isfinite(wheel.speed[k]))
                rate.t_s.push_back(grid_.time(k)), rate.value.push_back(std::fabs(wheel.speed[k]) < creep ? 0 : wheel.speed[k]);
        if (rate.t_s.size() >= 40) dead_or_stuck(rate, *speed, true);
    }
}

void Quality::coarse(const log::Signal &signal) {
    std::vector<double> sorted = signal.value;
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    if (sorted.size() < 3) return;
    std::vector<double> step(sorted.size() - 1);
    for (std::size_t i = 0; i + 1 < sorted.size(); ++i) step[i] = sorted[i + 1] - sorted[i];
    const double quantum = quantile(step, 0.1), range = quantile(signal.value, 0.99) - quantile(signal.value, 0.01);
    if (!(quantum > 0.05 * range) || sorted.size() > 40) return;
    add("coarse", Severity::note, signal.name,
        say("'%s' comes in steps of %.4g, %.0f %% of its range", signal.name.c_str(), quantum, 100 * quantum / range),
        "where there is a count or a finer sensor, log that as well", quantum);
}

void Quality::run() {
    repairs();
    const bool trials = log_.header.count("rows") != 0 && log_.header.at("rows") == "trials";
    std::size_t known = 0, most = 0;
    double fastest = std::numeric_limits<double>::infinity();
    for (const log::Signal &signal : log_.signals) {
        const log::Quantity *entry = log::find_quantity(signal.name);
        if (entry == nullptr || !is_sensor(*entry) || signal.name.rfind("truth.", 0) == 0) continue;
        if (signal.value.empty()) {
            add("empty", Severity::warning, signal.name, say("'%s' has no sample", signal.name.c_str()),
                "take the column out, or find out why nothing was recorded", 0);
            continue;
        }
        ++known;
        most = std::max(most, signal.value.size());
        if (constant_by_design(signal) || signal.value.size() < 20) continue;
        outliers(signal);
        if (trials) continue;
        rate(signal);
        fastest = std::min(fastest, rates_.back().median_s);
        if (one_of(entry->quantity, {"current", "accel_x", "gyro_z", "adc", "drawbar_pull", "torque"}))
            check_clipping(signal, grid_, findings_);
        const bool is_clipped = !findings_.empty() && findings_.back().id == "clipped" && findings_.back().signal == signal.name;
        if (!is_clipped && entry->kind == log::Kind::measured &&
            (one_of(entry->quantity, {"current", "accel_x", "gyro_z"}) || (entry->quantity == "speed" && entry->object != "carriage"))) {
            dead_or_stuck(signal, *entry);
        }
        if (entry->object == "wheel<i>" && one_of(entry->quantity, {"angle", "encoder"})) jumps(signal);
        if (signal.name == "camera.x_m") dead_or_stuck(whole_pose(signal), *entry);
        if (one_of(entry->quantity, {"current", "speed"}) && entry->kind == log::Kind::measured) coarse(signal);
    }
    if (known == 0) {
        add("nothing_to_use", Severity::error, "", "no column is a measured quantity of the vocabulary",
            "read the file through a map (--map), or name the columns as docs/log_format.md does", 0);
        return;
    }
    const bool endless = !trials && grid_.count == 0 && log_.duration_s() > 50000; // [s] more than half a day, in one drive
    if (!trials && (fastest >= 2 || endless) && std::isfinite(fastest)) {
        // the unit in which a rover's samples are half a second apart at most
        const char *unit = fastest < 500 ? "milliseconds" : fastest < 5e5 ? "microseconds" : "nanoseconds";
        const char *scale = fastest < 500 ? "0.001" : fastest < 5e5 ? "1e-6" : "1e-9";
        add("time_unit", Severity::error, "t_s", say("the fastest signal comes every %.4g s: the times look like %s", fastest, unit),
            say("give the times in seconds (map: time.scale = %s)", scale), fastest);
    } else if (!trials && fastest < 1e-5) { // [s]: no rover's converter is as fast
        add("time_unit", Severity::error, "t_s", say("the fastest signal comes every %.3g s: the times are no seconds", fastest),
            "give the times in seconds (map: time.scale)", fastest);
    } else if (most < (trials ? 4U : 50U) || (!trials && log_.duration_s() < 2.5)) { // the lab's least number of rows, its shortest block
        add("short", Severity::error, "",
            say("the log lasts %.3g s and has %zu sample(s) of its fastest signal: nothing can be learnt from it", log_.duration_s(), most),
            "record at least half a minute with starts, stops and turns", static_cast<double>(most));
    } else if (!trials && log_.duration_s() < 5) {
        add("short", Severity::warning, "", say("the log lasts %.3g s", log_.duration_s()),
            "record at least half a minute with starts, stops and turns", log_.duration_s());
    }
    if (trials) return;
    derived_speeds();
    gaps();
}

} // namespace

void check_quality(const log::Log &log, const std::vector<log::Repair> &repairs, const Grid &grid, Findings &findings,
                   std::vector<Rate> &rates) {
    Quality(log, repairs, grid, findings, rates).run();
}

} // namespace traction::check
