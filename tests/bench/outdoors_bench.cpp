// outdoors_bench - the whole control_step on echoes and frames of outdoors.h: one row per thing that the first hour outdoors brings.
//
// usage: outdoors_bench [--gyros] [--stood S] [--seeds N] [--first N] [--only WORD]
// [--echo scatterers]. --gyros: the frames have all three; --stood: every row
// begins after S seconds of standing, so that the gyros' offsets are known, and half a second of setting off. Exit 1 when a row misses its
// goal: error <= 4 cm/s, or NEES <= 2, or a fault within 0.5 s; never a wrong sign for more than 0.5 s; closed loops within 0.1 m/s of
// their command from 1.5 s on, without a fault.
#include "tests/bench/outdoors_ground.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>

namespace {

using outdoors::Case;

using outdoors::ramp;
using outdoors::Row;

std::vector<Case> calm() {
    std::vector<Case> all;
    const auto add = [&all](const char *name, std::function<double(double)> speed) {
        Case now;
        now.name = name, now.speed = std::move(speed);
        all.push_back(now);
    };
    add("constant 0.1", [](double) { return 0.1; });
    add("constant 0.2", [](double) { return 0.2; });
    add("constant 0.5", [](double) { return 0.5; });
    add("constant 1.0", [](double) { return 1.0; });
    add("ramps 0.2 m/s2", [](double t) { return t < 10 ? ramp(t, 2, 6, 0.1, 0.9) : ramp(t, 12, 16, 0.9, 0.1); });
    add("ramps 1 m/s2", [](double t) {
        const double p = std::fmod(t, 5.0);
        return p < 2.5 ? ramp(p, 0.5, 1.2, 0.15, 0.85) : ramp(p, 3, 3.7, 0.85, 0.15);
    });
    add("stop and go", [](double t) {
        const double p = std::fmod(t, 6.0);
        return p < 3 ? ramp(p, 1, 1.8, 0, 0.4) : ramp(p, 4, 4.8, 0.4, 0);
    });
    add("slip events", [](double t) {
        const double p = std::fmod(t, 4.0);
        return p < 2 ? ramp(p, 1, 1.3, 0.5, 0.25) : ramp(p, 2.5, 2.8, 0.25, 0.5);
    });
    add("sine", [](double t) { return 0.4 + 0.25 * std::sin(2 * outdoors::pi * t / 5); });
    return all;
}

std::vector<Row> rows() {
    std::vector<Row> all;
    const auto add = [&all](const char *group, const std::string &name, Case now, double fault_by_s = -1, std::uint32_t right = 0) {
        now.name = name;
        all.push_back({group, std::move(now), fault_by_s, right});
    };
    const double deg = outdoors::pi / 180;
    const std::uint32_t slides = FAULT_SPEED_DISAGREE | FAULT_ENCODER_CIRCUIT; // these wheels contradict their motors' currents, too
    const auto constant = [](double v) { return [v](double) { return v; }; };
    for (const Case &now : calm()) {
        add("calm", now.name, now);
    }
    for (const double v : {0.2, 0.3}) {
        for (const double step : {-10.0, -5.0, -3.0, -2.0, -1.0, 2.0, 3.0, 5.0, 10.0}) {
            Case now;
            now.speed = constant(v), now.slope = [step, deg](double t) { return t < 6 ? 0 : step * deg; };
            char name[64];
            std::snprintf(name, sizeof name, "step of %+.0f deg at %.1f m/s", step, v);
            add("slope", name, now);
        }
        Case now;
        now.speed = constant(v), now.settle_s = 2, now.slope = [deg](double) { return 10 * deg; };
        add("slope", "10 deg from the start at " + std::to_string(v).substr(0, 3), now);
        now.slope = [deg](double) { return -10 * deg; };
        add("slope", "-10 deg from the start at " + std::to_string(v).substr(0, 3), now);
    }
    for (const double slope : {-10.0, -8.0, 8.0, 10.0}) {
        Case now;
        now.closed = now.coasts = true, now.duration_s = 4, now.settle_s = 1;
        now.slope = [slope, deg](double) { return slope * deg; };
        char name[64];
        std::snprintf(name, sizeof name, "coasts off on %+.0f deg", slope);
        add("restart", name, now);
    }
    for (const double a : {-0.5, -1.0}) {
        Case now;
        now.speed = [a](double t) { return std::fmax(0.3, 1.0 + a * t); }, now.settle_s = 1;
        add("restart", "decelerating at " + std::to_string(a).substr(0, 4), now);
        now.wheel = [](double) { return 0.0; }, now.speed = [a](double t) { return std::fmax(0.3, 1.0 + a * t); };
        now.duration_s = 4;
        add("restart", "the same, wheels blocked", now, -1, slides);
    }
    {
        Case now;
        now.speed = [](double t) { return t < 5 ? 0.3 : ramp(t, 5, 6, 0.3, -0.4); }, now.wheel = constant(0.33);
        add("backwards", "slides back, wheels forward", now, -1, slides);
        now.speed = [](double t) { return 0.3 * std::cos(2 * outdoors::pi * t / 8); };
        add("backwards", "to and fro, wheels forward", now, -1, slides);
        now.speed = [](double t) { return t < 5 ? 0.3 : ramp(t, 5, 5.7, 0.3, -0.4); },
        now.slope = [deg](double t) { return t < 5 ? 0 : 6 * deg; };
        add("backwards", "slope of 6 deg, slides back", now, -1, slides);
        for (const double grip : {0.05, 0.1, 0.2}) { // kinetic friction pushes forwards all the while, the slope is what the motion needs
            Case real;
            const auto decel = [](double t) { return t > 5 && t < 5.7 ? -1.0 : 0.0; };
            real.speed = [](double t) { return t < 5 ? 0.3 : ramp(t, 5, 5.7, 0.3, -0.4); }, real.wheel = constant(0.33);
            real.slope = [grip, decel](double t) { return t < 5 ? 0 : std::asin(grip - decel(t) / outdoors::gravity); };
            add("backwards", "slides back where soil grips " + std::to_string(grip).substr(0, 4), real, -1, slides);
        }
        Case reverse;
        reverse.speed = [](double t) { return -0.3 + 0.1 * std::sin(t); };
        add("backwards", "reverse drive", reverse);
        reverse.speed = [](double t) { return 0.35 * std::sin(2 * outdoors::pi * t / 6); };
        add("backwards", "forward and reverse", reverse);
    }
    for (const double offset : {15.0, -15.0, 40.0}) {
        Case now;
        now.offset_count = offset, now.echo_count = 10;
        add("converter", "offset " + std::to_string(static_cast<int>(offset)) + ", echo 10 counts", now);
    }
    {
        Case now;
        now.echo_count = 600;
        add("converter", "echo beyond the rails", now);
    }
    for (const double v : {1.5, 2.0, 3.0}) {
        Case now;
        now.speed = constant(v), now.duration_s = 10;
        add("band", "speed " + std::to_string(v).substr(0, 3), now, 0.75);
        now.speed = [v](double t) { return ramp(t, 2, 4, 0.5, v); }, now.settle_s = 1;
        add("band", "from 0.5 to " + std::to_string(v).substr(0, 3), now, 3.7);
    }
    for (const double snr : {10.0, 5.0, 0.0}) {
        for (const double v : {0.2, 0.5, 1.0}) {
            Case now;
            now.snr_dB = snr, now.speed = constant(v);
            add("noise", "SNR " + std::to_string(static_cast<int>(snr)) + " dB at " + std::to_string(v).substr(0, 3), now);
        }
    }
    for (const double v : {0.2, 0.3, 0.5, 0.6}) {
        for (const double tone : {50.0, 33.3}) {
            Case now;
            now.tone_Hz = tone, now.tone_count = now.echo_count * 1.41, now.speed = constant(v);
            add("noise", std::to_string(static_cast<int>(tone)) + " Hz as large as the echo at " + std::to_string(v).substr(0, 3), now);
            now.tone_count *= 0.3;
            add("noise", "the same, a tenth of its power", now);
        }
    }
    for (const double share : {1.41, 0.42}) { // it begins under way, at the echo's edge
        for (const double v : {0.45, 0.55, 0.6, 0.65, 0.7, 0.75}) {
            Case now;
            now.tone_Hz = 50.02, now.tone_count = now.echo_count * share, now.tone_from_s = 6, now.speed = constant(v);
            char name[64];
            std::snprintf(name, sizeof name, "50 Hz of %.2f begins at %.2f", share, v);
            add("noise", name, now);
        }
        Case now;
        now.tone_Hz = 37, now.tone_count = now.echo_count * share, now.tone_from_s = 6, now.speed = constant(0.5);
        add("noise", "37 Hz of " + std::to_string(share).substr(0, 4) + " begins at 0.5", now);
    }
    for (const double tone : {50.1, 60.2, 83.4, 100.0, 119.9, 150.0}) { // a rover that stands beside a lamp, and sets off
        for (const double share : {1.41, 0.1}) {
            Case now;
            now.tone_Hz = tone, now.tone_count = now.echo_count * share, now.settle_s = 10;
            now.speed = [](double t) { return ramp(t, 8, 8.5, 0, 0.3); };
            char name[64];
            std::snprintf(name, sizeof name, "stands beside %.1f Hz, %.2f of the echo", tone, share);
            add("lamp", name, now);
        }
    }
    for (const double a : {0.5, 1.0, 2.0}) {
        for (const Case &calm_case : calm()) {
            if (calm_case.name == "constant 0.5" || calm_case.name == "sine" || calm_case.name == "stop and go") {
                Case now = calm_case;
                now.accel_noise = a;
                add("vibration", "accelerometer " + std::to_string(a).substr(0, 3) + ", " + calm_case.name, now);
            }
        }
    }
    for (const double v : {0.2, 0.3, 0.5, 0.6}) {
        Case now;
        now.speed = constant(v), now.heave_m = 0.005;
        add("vibration", "heave 5 mm at 8 Hz, " + std::to_string(v).substr(0, 3), now);
        now.heave_m = 0, now.pitch_rad = 0.01;
        add("vibration", "pitch 0.01 rad at 5 Hz, " + std::to_string(v).substr(0, 3), now);
    }
    for (const bool sequence : {true, false}) {
        for (const double lost : {0.01, 0.05, 0.1}) {
            Case now;
            now.lost_share = lost, now.sequence = sequence, now.speed = constant(0.5);
            add("lost", std::to_string(lost).substr(0, 4) + " of the samples" + (sequence ? "" : ", unnumbered"), now);
        }
        Case now;
        now.lost_ticks_share = 0.1, now.sequence = sequence, now.speed = constant(0.5);
        add("lost", std::string("a radar tick in ten") + (sequence ? "" : ", unnumbered"), now);
    }
    {
        Case now;
        now.radar_silent = [](double t) { return t > 5 && t < 9; }, now.speed = constant(0.3);
        add("lost", "no radar for 4 s", now, 5.5);
        now.speed = [](double t) { return 0.4 + 0.2 * std::sin(t); };
        add("lost", "no radar for 4 s, sine", now, 5.5);
        Case dead;
        dead.radar_dead = [](double t) { return t > 5; };
        add("lost", "front end dead from 5 s", dead, 5.5);
        dead.radar_dead = [](double) { return true; }, dead.speed = [](double t) { return ramp(t, 1, 1.5, 0, 0.3); }, dead.settle_s = 1;
        add("lost", "front end dead, start", dead, 2);
        for (const double v : {0.1, 0.3, 0.8}) { // a lens cap, mud, water: the front end's noise is all that is left
            Case covered;
            covered.duration_s = 30, covered.speed = constant(v), covered.echo_share = [](double t) { return t < 5 ? 1.0 : 0.0; };
            add("lost", "radar covered from 5 s at " + std::to_string(v).substr(0, 3), covered);
            Case closed;
            closed.closed = true, closed.duration_s = 30, closed.command_m_s = v, closed.echo_share = covered.echo_share;
            add("lost", "the same, closed loop", closed);
            covered.echo_share = closed.echo_share = [](double t) { return t < 5 || t > 12 ? 1.0 : 0.0; };
            add("lost", "radar covered for 7 s at " + std::to_string(v).substr(0, 3), covered);
            add("lost", "covered for 7 s, closed loop", closed);
        }
        for (const double decel : {0.7, 1.5, 3.4})
            for (const double slope : {0.0, 5.0, -5.0}) { // it bogs down, and its wheels turn on
                Case bogged;
                bogged.speed = [decel](double t) { return t < 8 ? 0.3 : std::max(0.0, 0.3 - decel * (t - 8)); };
                bogged.wheel = [](double) { return 0.32; };
                bogged.slope = [slope, deg](double) { return slope * deg; };
                char name[64];
                std::snprintf(name, sizeof name, "bogs down at %.1f m/s2, %+.0f deg", decel, slope);
                add("lost", name, bogged);
            }
        Case missed;
        missed.missed_share = 0.02;
        add("lost", "2 % of the ticks missed", missed, 20);
    }
    for (const double deg_s : {0.3, 1.0, -3.0, 10.0}) { // a gyro that lies once it is trusted: it has stood, and its offset was learned
        Case now;
        now.gyros = true, now.duration_s = 40;
        now.speed = [](double t) { return ramp(t, 3, 3.5, 0, 0.3); };
        char name[64];
        const double w = deg_s * deg;
        now.gyro_y_more = [w](double t) { return t < 8 ? 0 : w; };
        std::snprintf(name, sizeof name, "offset %+.1f deg/s from 8 s on", deg_s);
        add("gyro", name, now);
        now.gyro_y_more = [w](double t) { return t < 8 ? 0 : w * (t - 8) / 32; };
        std::snprintf(name, sizeof name, "drifts to %+.1f deg/s in 32 s", deg_s);
        add("gyro", name, now);
        now.speed = [](double t) { return ramp(t, 3, 3.5, 0, 0.3) + (t > 6 ? 0.15 * std::sin(t) : 0); };
        std::snprintf(name, sizeof name, "drifts to %+.1f deg/s, sine", deg_s);
        add("gyro", name, now);
        Case closed;
        closed.gyros = closed.closed = true, closed.duration_s = 30, closed.settle_s = 8;
        closed.gyro_y_more = [w](double t) { return t < 8 ? 0 : w; };
        std::snprintf(name, sizeof name, "offset %+.1f deg/s, closed loop", deg_s);
        add("gyro", name, closed);
    }
    {
        Case now;
        now.gyros = true, now.duration_s = 600;
        now.speed = [](double t) { return ramp(t, 3, 3.5, 0, 0.3); };
        now.gyro_y_more = [deg](double t) { return deg * t / 600; };
        add("gyro", "warms up: 1 deg/s in 10 min without a stop", now);
        now.duration_s = 120, now.gyro_y_more = [deg](double t) { return deg * t / 120; };
        now.snr_dB = 5;
        add("gyro", "1 deg/s in 2 min, SNR 5 dB", now);
        now.snr_dB = 25, now.accel_noise = 1;
        add("gyro", "1 deg/s in 2 min, accelerometer 1.0", now);
        now.accel_noise = 0.2, now.pitch_rad = 0.01;
        add("gyro", "1 deg/s in 2 min, pitch 0.01 rad at 5 Hz", now);
        now.pitch_rad = 0;
        now.gyro_y_more = nullptr, now.duration_s = 40;
        now.gyro_y_more = [](double t) { return t < 8 ? 0 : 0.3 * (std::fmod(std::floor(100 * t) * 0.754877666, 1.0) - 0.5) * 3.46; };
        add("gyro", "noise of 0.3 rad/s", now);
    }
    const struct {
        const char *name;
        double most, slip;
    } soils[] = {{"concrete", 0.8, 0.05}, {"gravel", 0.95, 0.087}, {"sand", 0.72, 0.26}};
    for (const auto &soil : soils) {
        for (const double slope : {-10.0, -5.0, 5.0, 10.0}) {
            Case now;
            now.closed = true, now.duration_s = 12, now.settle_s = 1.5, now.soil_max_share = soil.most, now.soil_slip = soil.slip;
            now.slope = [slope, deg](double) { return slope * deg; };
            char name[64];
            std::snprintf(name, sizeof name, "%s, %+.0f deg from the start", soil.name, slope);
            add("closed", name, now);
            now.slope = [slope, deg](double t) { return t < 5 ? 0 : slope * deg; };
            std::snprintf(name, sizeof name, "%s, %+.0f deg as a step", soil.name, slope);
            add("closed", name, now);
        }
    }
    for (Row &row : outdoors::ground_rows()) {
        all.push_back(std::move(row));
    }
    return all;
}

// The same drive, begun `stood` + `off` later.
void stand_first(Row &row, double stood) {
    const double off = 0.5, late = stood + off;
    Case &now = row.what;
    const auto later = [late](auto &of) {
        if (of) of = [late, inner = of](double t) { return inner(t > late ? t - late : 0.0); };
    };
    now.duration_s += late, now.settle_s += late, now.still_s = stood;
    row.fault_by_s += row.fault_by_s >= 0 ? late : 0;
    later(now.slope), later(now.radar_dead), later(now.radar_silent);
    later(now.echo_share), later(now.lift_m), later(now.accel_more), later(now.turn), later(now.waves_m), later(now.walker_m);
    for (auto *of : {&now.speed, &now.wheel}) {
        if (*of) *of = [=, inner = *of](double t) { return t > late ? inner(t - late) : ramp(t, stood, late, 0, inner(0)); };
    }
}

std::string names_of(std::uint32_t faults) {
    if (faults == 0) return {};
    char text[32];
    std::snprintf(text, sizeof text, "0x%x", faults);
    return text;
}

} // namespace

int main(int argc, char **argv) {
    int seeds = 4, first = 1;
    std::string only;
    bool gyros = false, scatterers = false;
    double stood = 0;
    for (int i = 1; i < argc; ++i) {
        gyros = gyros || std::strcmp(argv[i], "--gyros") == 0;
    }
    for (int i = 1; i + 1 < argc; ++i) {
        if (std::strcmp(argv[i], "--stood") == 0) stood = std::atof(argv[i + 1]);
        if (std::strcmp(argv[i], "--seeds") == 0) seeds = std::atoi(argv[i + 1]);
        if (std::strcmp(argv[i], "--first") == 0) first = std::atoi(argv[i + 1]);
        if (std::strcmp(argv[i], "--echo") == 0) scatterers = std::strcmp(argv[i + 1], "scatterers") == 0;
        if (std::strcmp(argv[i], "--only") == 0) only = argv[i + 1];
    }
    const control_config_t config = rover_config_default();
    std::printf("%-10s %-38s | %6s %7s %6s %6s %6s | %s\n", "group", "row", "RMSE", "NEES", "sign s", "worst", "p95 %", "faults, first at");
    bool all_met = true;
    double calm_square = 0, nees_sum = 0;
    int calm_rows = 0, nees_rows = 0;
    std::vector<Row> every = rows();
    for (Row &row : every) {
        row.what.scatterers = scatterers;
        row.what.gyros = gyros || row.group == "gyro";
        if (stood > 0 && row.group != "gyro" && row.group != "closed") stand_first(row, stood);
        if (!only.empty() && row.group.find(only) == std::string::npos && row.what.name.find(only) == std::string::npos) {
            continue;
        }
        outdoors::Score sum;
        bool faulted = true, off = false;
        std::vector<double> relative, fix;
        double off_worst = 0;
        for (int seed = first; seed < first + seeds; ++seed) {
            const outdoors::Run run = outdoors::drive(row.what, static_cast<std::uint64_t>(seed), config);
            const outdoors::Score one = outdoors::score(row.what, run);
            if (std::getenv("OUTDOORS_TRACE") != nullptr) { // every tick, for the eye
                for (const outdoors::Step &step : run.steps) {
                    std::printf("%.2f true %.3f estimate %.3f std %.3f wheel %.3f faults %x%s\n", step.t, step.speed, step.estimate,
                                step.std, step.wheel, step.faults, step.note.c_str());
                }
            }
            sum.square += one.square, sum.nees_sum += one.nees_sum, sum.n += one.n, sum.faults |= one.faults;
            sum.wrong_sign_s = std::max(sum.wrong_sign_s, one.wrong_sign_s), sum.worst = std::max(sum.worst, one.worst);
            sum.first_fault_s = std::max(sum.first_fault_s, one.first_fault_s);
            faulted = faulted && one.first_fault_s >= 0 && one.first_fault_s <= row.fault_by_s;
            relative.insert(relative.end(), one.relative.begin(), one.relative.end());
            fix.push_back(one.first_fix_s < 0 ? 99 : one.first_fix_s);
            for (const outdoors::Step &step : run.steps) {
                const double past = row.what.name.find("step") != std::string::npos ? (step.t >= 5 ? step.t - 5 : step.t) : step.t;
                if (row.what.closed && !row.what.coasts && past > 1.5) {
                    off_worst = std::max(off_worst, std::fabs(step.speed - row.what.command_m_s));
                    off = off || std::fabs(step.speed - row.what.command_m_s) > 0.1;
                }
            }
        }
        std::sort(relative.begin(), relative.end()), std::sort(fix.begin(), fix.end());
        const double rmse = 100 * std::sqrt(sum.square / sum.n), nees = sum.nees_sum / sum.n;
        bool met =
            (rmse <= 4 || nees <= 2 || (row.fault_by_s > 0 && faulted)) && (sum.wrong_sign_s <= 0.5 || (row.fault_by_s > 0 && faulted));
        if (row.what.closed && !row.what.coasts) {
            met = !off && sum.faults == 0;
        }
        if (row.fault_by_s < 0 && (sum.faults & ~row.right) != 0) {
            met = false;
        }
        if (row.group == "calm") {
            calm_square += rmse * rmse, ++calm_rows;
        }
        if (sum.faults == 0) {
            nees_sum += nees, ++nees_rows;
        }
        std::printf("%-10s %-38s | %6.2f %7.2f %6.2f %6.2f %6.1f | %s %.2f fix %.2f %s", row.group.c_str(), row.what.name.c_str(), rmse,
                    nees, sum.wrong_sign_s, sum.worst, 100 * relative[relative.size() * 95 / 100], names_of(sum.faults).c_str(),
                    sum.first_fault_s, fix[fix.size() * 9 / 10 < fix.size() ? fix.size() * 9 / 10 : 0], met ? "" : "MISSED");
        if (row.what.closed) {
            std::printf(" off %.3f", off_worst);
        }
        std::printf("\n");
        std::fflush(stdout);
        all_met = all_met && met;
    }
    if (calm_rows > 0) {
        std::printf("calm: RMSE %.2f cm/s; ", std::sqrt(calm_square / calm_rows));
    }
    std::printf("NEES over %d rows without a fault %.2f; goals %s\n", nees_rows, nees_sum / std::max(1, nees_rows),
                all_met ? "met" : "missed");
    return all_met ? 0 : 1;
}
