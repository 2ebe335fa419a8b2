#include "tests/bench/outdoors_ground.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace outdoors {

namespace {

using Rows = std::vector<Row>;

constexpr double deg = pi / 180;

void add(Rows &all, const std::string &name, double value, Case now) {
    char number[16];
    std::snprintf(number, sizeof number, " %g", value);
    now.name = name + number;
    all.push_back({"ground", std::move(now), -1, 0});
}

void add_echoes(Rows &all) {
    for (const double more : {-5.0, -2.0, 2.0, 5.0}) { // a bracket that is bent; calibrating takes it out, which nobody has done yet
        Case now;
        now.depression_deg = 20 + more;
        add(all, "radar mounted off by degrees", more, now);
    }
    for (const double v : {0.2, 0.5, 1.0}) {
        Case now;
        now.speed = [v](double) { return v; };
        now.echo_share = [](double t) { return std::fmod(t, 6) < 3 ? 1 : 0.316; }; // 10 dB: gravel, concrete
        add(all, "echo changes by 10 dB", v, now);
        now.echo_share = [](double t) { return t > 8 && t < 9 ? 0.03 : 1; }; // 30 dB: smooth water throws it away
        add(all, "a puddle of 1 s", v, now);
        now.speed = [v](double t) { return t < 8.5 ? ramp(t, 8, 8.5, v, 0.5 * v) : ramp(t, 8.5, 9, 0.5 * v, v); };
        add(all, "the same, slowing down in it", v, now);
    }
}

void add_kerbs(Rows &all) {
    for (const double v : {0.3, 0.6}) { // up by 2 cm over 8 cm of way, twice as the axles follow; a blow of 2.5 m/s^2 for 30 ms each
        Case now;
        now.speed = [v](double) { return v; };
        const double rise_s = 0.08 / v, between_s = 0.2 / v;
        now.lift_m = [=](double t) { return 0.01 * (ramp(t, 8, 8 + rise_s, 0, 1) + ramp(t, 8 + between_s, 8 + between_s + rise_s, 0, 1)); };
        now.slope = [=](double t) {
            return 6 * deg * (ramp(t, 8, 8 + rise_s, 0, 1) - ramp(t, 8 + between_s, 8 + between_s + rise_s, 0, 1));
        };
        now.accel_more = [=](double t) {
            const double since = t < 8 + between_s ? t - 8 : t - 8 - between_s;
            return since > 0 && since < 0.03 ? -2.5 : since >= 0.03 && since < 0.06 ? 2.5 : 0;
        };
        add(all, "up a kerb of 2 cm", v, now);
    }
}

void add_starts(Rows &all) {
    for (const double slope : {0.0, 5.0, 10.0}) { // all wheels spin before the body moves
        Case now;
        now.slope = [slope](double) { return slope * deg; };
        now.speed = [](double t) { return ramp(t, 2.5, 4, 0, 0.3); };
        now.wheel = [](double t) { return t < 1 ? 0 : t < 2.5 ? ramp(t, 1, 1.3, 0, 0.4) : ramp(t, 2.5, 4, 0.4, 0.33); };
        now.settle_s = 2, now.duration_s = 14;
        add(all, "all wheels spin at the start, deg", slope, now);
        now.speed = [](double t) { return t < 2.5 ? ramp(t, 1, 1.5, 0, -0.1) : ramp(t, 2.5, 4, -0.1, 0.3); };
        add(all, "the same, sliding back a little, deg", slope, now);
    }
    for (const double v : {0.4, 0.9}) {
        Case now;
        now.speed = [v](double t) {
            const double p = std::fmod(t, 5.0);
            return p < 2.5 ? ramp(p, 1, 1 + v / 2, 0, v) : ramp(p, 3, 3 + v / 2, v, 0);
        };
        now.wheel = nullptr;
        add(all, "starts and stops at 2 m/s2, to", v, now);
        now.speed = [v](double t) { // to and fro as a person with a stick drives
            const double p = std::fmod(t, 6.0);
            return p < 3 ? ramp(p, 1, 1 + v, -v, v) : ramp(p, 4, 4 + v, v, -v);
        };
        add(all, "turns round at 2 m/s2", v, now);
    }
}

void add_turns(Rows &all) {
    for (const double rim : {0.1, 0.3}) {
        Case now;
        now.speed = [](double t) {
            return t < 5 ? 0.3 * ramp(t, 1, 1.5, 0, 1) * ramp(t, 4, 4.5, 1, 0) : t < 10 ? 0 : ramp(t, 10, 10.5, 0, 0.3);
        };
        now.turn = [rim](double t) { return ramp(t, 5, 5.2, 0, rim) * ramp(t, 9, 9.2, 1, 0); };
        add(all, "turns on the spot", rim, now);
        now.slope = [](double t) { return t < 5 ? -5 * deg : t > 9.2 ? 5 * deg : 5 * deg * -std::cos((t - 5) * pi / 4.2); };
        add(all, "the same on 5 deg, facing about", rim, now);
        now.speed = [](double t) {
            const double before = 0.3 * ramp(t, 1, 1.5, 0, 1) * ramp(t, 4, 4.5, 1, 0);
            return t < 6 ? before : t < 9.5 ? -0.3 * ramp(t, 6, 6.6, 0, 1) * ramp(t, 8.5, 9.1, 1, 0) : ramp(t, 10, 10.5, 0, 0.3);
        };
        add(all, "the same, and slides down meanwhile", rim, now);
    }
}

void add_ends_of_the_band(Rows &all) {
    for (const double v : {0.03, 0.05, 0.08}) {
        Case now;
        now.duration_s = 60;
        now.speed = [v](double t) { return v * ramp(t, 2, 2.5, 0, 1); };
        add(all, "creeps for a minute", v, now);
        now.speed = [v](double t) { return v * ramp(t, 2, 2.5, 0, 1) + ramp(t, 30, 30.5, 0, 0.3) - ramp(t, 40, 40.5, 0, 0.3); };
        add(all, "the same, in between faster", v, now);
        now.speed = [v](double t) { return -v * ramp(t, 2, 2.5, 0, 1); };
        now.slope = [](double t) { return t < 15 ? 0 : 5 * deg; };
        add(all, "creeps back as a slope begins", v, now);
    }
    for (const double v : {0.9, 1.1, 1.2}) {
        Case now;
        now.speed = [v](double t) { return v * ramp(t, 1, 3, 0, 1); };
        add(all, "near the band's edge", v, now);
        now.snr_dB = 10;
        add(all, "the same, SNR 10 dB", v, now);
    }
}

void add_warmth(Rows &all) {
    for (const double per_min : {0.1, 0.5}) {
        Case now;
        now.duration_s = 120;
        now.speed = [](double t) { return ramp(t, 2, 2.5, 0, 0.3) + (t > 10 ? 0.1 * std::sin(0.5 * t) : 0); };
        now.accel_more = [per_min](double t) { return per_min / 60 * t; };
        add(all, "accelerometer warms up, by m/s2 a minute", per_min, now);
    }
}

void add_first_hour(Rows &all) {
    for (const double gust :
         {0.05, 0.15, 0.3}) { // grass below the radar goes to and fro by itself, up to that speed; the rover stands, and goes
        Case now;
        now.duration_s = 40, now.settle_s = 2;
        now.waves_m = [gust](double t) { return gust / (2 * pi * 0.6) * std::sin(2 * pi * 0.6 * t) * (t > 5 && t < 30 ? 1 : 0); };
        now.speed = [](double t) { return ramp(t, 30, 30.5, 0, 0.3); };
        add(all, "stands on grass in the wind, by m/s", gust, now);
    }
    for (const double v : {0.3, 0.6}) {
        Case now; // 40 m/s^2 for 20 ms and back in 80, of which an accelerometer of 2 g loses half a metre a second
        now.speed = [v](double) { return v; };
        now.accel_rail = 19.6;
        now.accel_more = [](double t) { return t > 8 && t < 8.02 ? -40 : t >= 8.02 && t < 8.1 ? 10 : 0; };
        add(all, "a blow beyond the accelerometer's rail", v, now);
        now = {};
        now.speed = [v](double t) { return ramp(t, 2, 2 + v / 0.5, 0, v) - ramp(t, 12, 12 + v / 0.5, 0, v); };
        now.echo_share = [speed = now.speed](double t) { return 1 / (1 + 10 * speed(t)); };
        add(all, "the echo falls with speed, to", v, now);
        now = {};
        now.speed = [v](double t) { return v + 0.1 * std::sin(t); };
        now.echo_count = 7.5, now.snr_dB = 5;
        add(all, "wet ground, an echo 20 dB less", v, now);
        now = {};
        now.speed = [v](double t) { return v + 0.1 * std::sin(t); };
        now.stalled = [](double t) { return std::fmod(t, 5) > 4.965; };
        add(all, "three ticks missed in a row, every 5 s", v, now);
    }
    for (const double up_m : {0.2, 0.5}) { // carried: up within a second, askew, and down; then it drives off
        Case now;
        now.duration_s = 24, now.settle_s = 2;
        now.lift_m = [up_m](double t) { return ramp(t, 6, 7, 0, up_m) - ramp(t, 11, 12, 0, up_m); };
        now.slope = [](double t) { return 12 * deg * (ramp(t, 6, 7, 0, 1) - ramp(t, 10, 12, 0, 1.5) + ramp(t, 12, 12.2, 0, 0.5)); };
        now.echo_share = [up_m](double t) { return 1 - (ramp(t, 6, 7, 0, 1) - ramp(t, 11, 12, 0, 1)) * (1 - 0.1 / (0.1 + up_m)); };
        now.speed = [](double t) { return ramp(t, 15, 15.5, 0, 0.3); };
        add(all, "is lifted, and set down, by m", up_m, now);
    }
    Case now; // by hand, motors off: no slip, and as jerkily as a hand does
    now.wheel = now.speed = [](double t) { return t < 5 ? 0 : 0.4 * std::sin(1.3 * (t - 5)) * std::fabs(std::cos(0.7 * (t - 5))); };
    add(all, "is pushed by hand, to", 0.4, now);
}

// What a third generator, which is not kept here, has shown first.
void add_found(Rows &all) {
    for (const double slope : {-10.0, 10.0}) { // the radar reads 6 cm/s too much just as a slope has begun
        for (const double at : {0.1, 0.2, 0.3}) {
            Case now;
            now.closed = true, now.duration_s = 14, now.settle_s = 1.5;
            now.slope = [slope](double t) { return slope * deg * ramp(t, 5, 5.1, 0, 1); };
            now.waves_m = [at](double t) { return 0.08 * (ramp(t, 5 + at, 5.4 + at, 0, 0.4)); };
            add(all, "step, a value off " + std::to_string(at).substr(0, 3) + " s later, deg", slope, now);
        }
    }
    for (const double snr : {20.0, 10.0}) { // it stops, its wheels are held and creep, and the ground tilts: a ferry, a raft of planks
        Case now;
        now.snr_dB = snr;
        now.speed = [](double t) { return ramp(t, 5, 5.3, 0.4, 0) + ramp(t, 16, 16.5, 0, 0.3) + (t > 5.3 && t < 16 ? 0.004 : 0); };
        now.wheel = now.speed;
        now.slope = [](double t) { return 8 * deg * std::sin(2 * pi * t / 4); };
        add(all, "stops where the ground tilts, SNR", snr, now);
    }
    for (const double v : {0.0, 0.3}) {
        Case now;
        now.speed = [v](double t) { return v * ramp(t, 2, 2.5, 0, 1); };
        now.walker_m = [](double t) { return t < 6 ? 0 : 1.9 * (std::fmin(t, 9) - 6); }; // legs swing twice as fast as one walks
        add(all, "someone runs through the beam", v, now);
    }
}

} // namespace

std::vector<Row> ground_rows() {
    Rows all;
    add_echoes(all);
    add_kerbs(all);
    add_starts(all);
    add_turns(all);
    add_ends_of_the_band(all);
    add_warmth(all);
    add_first_hour(all);
    add_found(all);
    return all;
}

} // namespace outdoors
