// speed_bench - ground speed by the paper's method and by ours, on the tests' own radar clutter: table by profile.
//
// usage: speed_bench [seeds] [variant]; variants: base, mount3 (3 deg mounting error), n0, n2 (ground exponent), snr10, accel2
// (accelerometer noise x 2). Scored from 4 s on, when the slowest method has its first fix.
#include "firmware/core/rover_config.h"
#include "tests/unit/clutter.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

namespace {

struct Profile {
    const char *name;
    std::function<double(double)> speed;
};

double ramp(double t, double t0, double t1, double v0, double v1) { return t <= t0 ? v0 : t >= t1 ? v1 : v0 + (v1 - v0) * (t - t0) / (t1 - t0); }

std::vector<Profile> profiles()
{
    const double none = 0;
    (void)none;
    return {
        {"constant 0.1", [](double) { return 0.1; }},
        {"constant 0.2", [](double) { return 0.2; }},
        {"constant 0.5", [](double) { return 0.5; }},
        {"constant 1.0", [](double) { return 1.0; }},
        {"ramps 0.2 m/s2", [](double t) { return t < 10 ? ramp(t, 2, 6, 0.1, 0.9) : ramp(t, 12, 16, 0.9, 0.1); }},
        {"ramps 1 m/s2", [](double t) { const double p = std::fmod(t, 5.0); return p < 2.5 ? ramp(p, 0.5, 1.2, 0.15, 0.85) : ramp(p, 3, 3.7, 0.85, 0.15); }},
        {"stop and go", [](double t) { const double p = std::fmod(t, 6.0); return p < 3 ? ramp(p, 1, 1.8, 0, 0.4) : ramp(p, 4, 4.8, 0.4, 0); }},
        {"slip events", [](double t) { const double p = std::fmod(t, 4.0); return p < 2 ? ramp(p, 1, 1.3, 0.5, 0.25) : ramp(p, 2.5, 2.8, 0.25, 0.5); }},
        {"sine", [](double t) { return 0.4 + 0.25 * std::sin(2 * clutter::pi * t / 5); }},
    };
}

struct Score {
    double square = 0, lag_num = 0, lag_den = 0, first_fix = 0;
    int n = 0, runs = 0;
    std::vector<double> relative;
};

struct Variant {
    double mounting = 20, exponent = 1, snr = 20, accel_noise = 0.2;
};

void run(const Profile &profile, const std::vector<double> &echo, int seed, const Variant &variant, const control_config_t &config, Score &score)
{
    const double duration = 20;
    std::vector<double> path{0};
    for (int i = 0; i < 20 * 512 + 8; ++i) {
        path.push_back(path.back() + profile.speed((i + 0.5) / 512.0) / 512.0);
    }
    const double track = (static_cast<double>(echo.size()) - 8) * clutter::grid_m;
    const auto position = [&](double t) { // there and back, so that a long drive fits the track; the radar only sees |v|
        const double x = std::fmod(path[static_cast<std::size_t>(t * 512 + 0.5)], 2 * track);
        return x < track ? x : 2 * track - x;
    };
    clutter::Adc adc;
    adc.snr_dB = variant.snr;
    adc.seed = static_cast<std::uint64_t>(seed);
    const std::vector<std::uint16_t> samples = clutter::drive(echo, duration, position, adc);
    clutter::Random random{static_cast<std::uint64_t>(seed) * 31 + 7};
    doppler_state_t doppler = {};
    ground_speed_state_t filter;
    ground_speed_reset(&config.ground_speed, &filter);
    std::size_t used = 0;
    double fix = duration;
    bool fixed = false;
    int ok_run = 0;
    for (int k = 0; k < 2000; ++k) {
        const double t = 0.01 * (k + 1);
        const auto until = std::min(samples.size(), static_cast<std::size_t>(t * 512));
        const doppler_output_t d = doppler_step(&config.doppler, &doppler, &samples[used], static_cast<int32_t>(until - used));
        used = until;
        const double v = profile.speed(t), a = (profile.speed(t) - profile.speed(t - 0.01)) / 0.01;
        const ground_speed_input_t input = {
            .accel_x_m_s2 = static_cast<float>(a + 0.05 + variant.accel_noise * random.normal()),
            .doppler_m_s = d.speed_m_s,
            .doppler_late_s = static_cast<float>(d.late_samples) / 512.0f,
            .wheel_m_s = static_cast<float>(v * 1.1),
            .accel_valid = true,
            .doppler_fresh = d.fresh,
            .doppler_quiet = d.quiet,
        };
        const double estimate = static_cast<double>(ground_speed_step(&config.ground_speed, &filter, &input).speed_m_s);
        const double error = estimate - v;
        ok_run = std::fabs(error) <= 0.1 * std::fabs(v) ? ok_run + 1 : 0;
        if (!fixed && ok_run >= 10) {
            fixed = true, fix = t - 0.09;
        }
        if (t > 4) {
            score.square += error * error;
            score.n++;
            score.lag_num -= error * a;
            score.lag_den += a * a;
            score.relative.push_back(std::fabs(error) / std::max(v, 0.05));
        }
    }
    score.first_fix += fix;
    score.runs++;
}

} // namespace

int main(int argc, char **argv)
{
    const int seeds = argc > 1 ? std::atoi(argv[1]) : 12;
    const std::string name = argc > 2 ? argv[2] : "base";
    Variant variant;
    variant.mounting = name == "mount3" ? 23 : name == "mount-3" ? 17 : 20;
    variant.exponent = name == "n0" ? 0 : name == "n2" ? 2 : 1;
    variant.snr = name == "snr10" ? 10 : 20;
    variant.accel_noise = name == "accel2" ? 0.4 : 0.2;
    std::map<std::string, std::vector<Score>> table;
    const std::vector<Profile> all = profiles();
    const control_config_t configs[] = {rover_config_paper(), rover_config_default()};
    table["paper"].resize(all.size());
    table["ours"].resize(all.size());
    for (int seed = 1; seed <= seeds; ++seed) {
        clutter::Ground ground;
        ground.seed = static_cast<std::uint64_t>(seed);
        ground.mounting_deg = variant.mounting;
        ground.exponent = variant.exponent;
        const std::vector<double> echo = clutter::echo_along_track(ground);
        for (std::size_t p = 0; p < all.size(); ++p) {
            run(all[p], echo, seed, variant, configs[0], table["paper"][p]);
            run(all[p], echo, seed, variant, configs[1], table["ours"][p]);
        }
    }
    std::printf("%d seeds, %s\n%-16s | paper RMSE cm/s  p95 %%  lag s  fix s | ours RMSE cm/s  p95 %%  lag s  fix s\n", seeds, name.c_str(), "profile");
    double total[2] = {0, 0};
    for (std::size_t p = 0; p < all.size(); ++p) {
        std::printf("%-16s |", all[p].name);
        int column = 0;
        for (const char *method : {"paper", "ours"}) {
            Score &score = table[method][p];
            std::sort(score.relative.begin(), score.relative.end());
            total[column++] += score.square / score.n / static_cast<double>(all.size());
            std::printf("%15.2f %7.1f %6.3f %6.2f %s", 100 * std::sqrt(score.square / score.n),
                        100 * score.relative[score.relative.size() * 95 / 100], score.lag_den > 0 ? score.lag_num / score.lag_den : 0.0,
                        score.first_fix / score.runs, column == 1 ? "|" : "\n");
        }
    }
    std::printf("%-16s |%15.2f                       |%15.2f\n", "all", 100 * std::sqrt(total[0]), 100 * std::sqrt(total[1]));
    return 0;
}
