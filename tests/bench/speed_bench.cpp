// speed_bench - ground speed by the paper's method and by ours, on two radars that share no code: the tests' clutter (clutter.h)
// and the simulator's radar (sim/sensors/radar.h). Tables by profile, then what a misfit of radar or ground does.
//
// usage: speed_bench [--seeds N] [--json FILE] [--brief]; brief: the first table alone. `traction bench speed` runs it.
// Scored from 4 s on, when the slowest method has its first fix. Exit 1 when a goal of ours is missed on either radar.
#include "firmware/core/rover_config.h"
#include "host_tools/log/write_file.h"
#include "sim/sensors/radar.h"
#include "tests/unit/clutter.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

namespace {

struct Profile {
    const char *name;
    std::function<double(double)> speed;
};

double ramp(double t, double t0, double t1, double v0, double v1) {
    return t <= t0 ? v0 : t >= t1 ? v1 : v0 + (v1 - v0) * (t - t0) / (t1 - t0);
}

std::vector<Profile> profiles() {
    return {
        {"constant 0.1", [](double) { return 0.1; }},
        {"constant 0.2", [](double) { return 0.2; }},
        {"constant 0.5", [](double) { return 0.5; }},
        {"constant 1.0", [](double) { return 1.0; }},
        {"ramps 0.2 m/s2", [](double t) { return t < 10 ? ramp(t, 2, 6, 0.1, 0.9) : ramp(t, 12, 16, 0.9, 0.1); }},
        {"ramps 1 m/s2",
         [](double t) {
             const double p = std::fmod(t, 5.0);
             return p < 2.5 ? ramp(p, 0.5, 1.2, 0.15, 0.85) : ramp(p, 3, 3.7, 0.85, 0.15);
         }},
        {"stop and go",
         [](double t) {
             const double p = std::fmod(t, 6.0);
             return p < 3 ? ramp(p, 1, 1.8, 0, 0.4) : ramp(p, 4, 4.8, 0.4, 0);
         }},
        {"slip events",
         [](double t) {
             const double p = std::fmod(t, 4.0);
             return p < 2 ? ramp(p, 1, 1.3, 0.5, 0.25) : ramp(p, 2.5, 2.8, 0.25, 0.5);
         }},
        {"sine", [](double t) { return 0.4 + 0.25 * std::sin(2 * clutter::pi * t / 5); }},
    };
}

struct Score {
    double square = 0, lag_num = 0, lag_den = 0, first_fix = 0;
    int n = 0, runs = 0;
    std::vector<double> relative;
};

struct Variant {
    std::string name;
    double mounting_error_deg = 0, exponent = 1, snr_dB = 20, accel_noise = 0.2;
    bool noise_stated = false; // the firmware's configuration knows accel_noise
};

// What a run reads from the radar, at 512 Hz.
using Samples = std::vector<std::uint16_t>;

constexpr double duration_s = 20;

std::vector<double> path_of(const Profile &profile) {
    std::vector<double> path{0};
    for (int i = 0; i < duration_s * 512 + 8; ++i) {
        path.push_back(path.back() + profile.speed((i + 0.5) / 512.0) / 512.0);
    }
    return path;
}

// The tests' own clutter; there and back, so that a long drive fits the track: the radar only sees |v|.
Samples listen_clutter(const std::vector<double> &echo, const std::vector<double> &path, int seed, const Variant &variant) {
    const double track = (static_cast<double>(echo.size()) - 8) * clutter::grid_m;
    const auto position = [&](double t) {
        const double x = std::fmod(path[static_cast<std::size_t>(t * 512 + 0.5)], 2 * track);
        return x < track ? x : 2 * track - x;
    };
    clutter::Adc adc;
    adc.snr_dB = variant.snr_dB;
    adc.seed = static_cast<std::uint64_t>(seed);
    return clutter::drive(echo, duration_s, position, adc);
}

Samples listen_simulator(const std::vector<double> &path, int seed, const Variant &variant) {
    traction::sim::RadarConfig config;
    config.mounting_error_deg = variant.mounting_error_deg;
    config.ground_exponent = variant.exponent;
    config.noise_count = config.echo_count * std::pow(10, -variant.snr_dB / 20);
    traction::sim::Radar radar(config, static_cast<std::uint64_t>(seed));
    Samples samples;
    for (int n = 0; n < duration_s * 512; ++n) {
        samples.push_back(radar.sample(path[static_cast<std::size_t>(n)]));
    }
    return samples;
}

void run(const Profile &profile, const Samples &samples, int seed, const Variant &variant, const control_config_t &config, Score &score) {
    clutter::Random random{static_cast<std::uint64_t>(seed) * 31 + 7};
    doppler_state_t doppler = {};
    ground_speed_state_t filter;
    ground_speed_reset(&config.ground_speed, &filter);
    std::size_t used = 0;
    double fix = duration_s;
    bool fixed = false;
    int ok_run = 0;
    for (int k = 0; k < 2000; ++k) {
        const double t = 0.01 * (k + 1);
        const auto until = std::min(samples.size(), static_cast<std::size_t>(t * 512));
        const doppler_output_t d = doppler_step(&config.doppler, &doppler, &samples[used], static_cast<int32_t>(until - used));
        used = until;
        const double v = profile.speed(t), a = (profile.speed(t) - profile.speed(t - 0.01)) / 0.01;
        const ground_speed_input_t input = {.accel_x_m_s2 = static_cast<float>(a + 0.05 + variant.accel_noise * random.normal()),
                                            .doppler_m_s = d.speed_m_s,
                                            .doppler_late_s = static_cast<float>(d.late_samples) / 512.0f,
                                            .wheel_m_s = static_cast<float>(v * 1.1),
                                            .slowest_m_s = 0.0f,
                                            .wheels_part = false,
                                            .accel_valid = true,
                                            .doppler_fresh = d.fresh,
                                            .doppler_quiet = d.quiet,
                                            .doppler_dead = false,
                                            .busy = false,
                                            .doppler_trust = 1,
                                            .doppler_misfit = 0,
                                            .doppler_relieved = false,
                                            .elapsed_ticks = 1,
                                            .lean_q8 = 0};
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

struct Row {
    std::string profile;
    double rmse_cm_s, p95_percent, lag_s, first_fix_s;
};

struct Table {
    std::vector<Row> rows;
    double rmse_cm_s = 0; // over all profiles alike
};

Table table_of(std::vector<Score> scores) {
    Table table;
    const std::vector<Profile> all = profiles();
    double square = 0;
    for (std::size_t p = 0; p < all.size(); ++p) {
        Score &score = scores[p];
        std::sort(score.relative.begin(), score.relative.end());
        square += score.square / score.n / static_cast<double>(all.size());
        table.rows.push_back({all[p].name, 100 * std::sqrt(score.square / score.n), 100 * score.relative[score.relative.size() * 95 / 100],
                              score.lag_den > 0 ? score.lag_num / score.lag_den : 0.0, score.first_fix / score.runs});
    }
    table.rmse_cm_s = 100 * std::sqrt(square);
    return table;
}

struct Both {
    Table paper, ours;
};

// One radar, one variant: both methods on the same samples.
Both measure(bool simulator, const Variant &variant, int seeds) {
    const std::vector<Profile> all = profiles();
    const control_config_t paper = rover_config_paper();
    control_config_t ours = rover_config_default();
    if (variant.noise_stated) {
        ours.ground_speed.speed_noise_m2_s2 = static_cast<float>(std::pow(variant.accel_noise * 0.01, 2));
    }
    std::vector<Score> paper_scores(all.size()), our_scores(all.size());
    for (int seed = 1; seed <= seeds; ++seed) {
        std::vector<double> echo;
        if (!simulator) {
            clutter::Ground ground;
            ground.seed = static_cast<std::uint64_t>(seed);
            ground.mounting_deg += variant.mounting_error_deg;
            ground.exponent = variant.exponent;
            echo = clutter::echo_along_track(ground);
        }
        for (std::size_t p = 0; p < all.size(); ++p) {
            const std::vector<double> path = path_of(all[p]);
            const Samples samples = simulator ? listen_simulator(path, seed, variant) : listen_clutter(echo, path, seed, variant);
            run(all[p], samples, seed, variant, paper, paper_scores[p]);
            run(all[p], samples, seed, variant, ours, our_scores[p]);
        }
    }
    return {table_of(std::move(paper_scores)), table_of(std::move(our_scores))};
}

void print(const char *radar, int seeds, const Both &both) {
    std::printf("%s, %d seeds\n%-16s | paper RMSE cm/s  p95 %%  lag s  fix s | ours RMSE cm/s  p95 %%  lag s  fix s\n", radar, seeds,
                "profile");
    for (std::size_t p = 0; p < both.ours.rows.size(); ++p) {
        const Row &a = both.paper.rows[p], &b = both.ours.rows[p];
        std::printf("%-16s |%15.2f %7.1f %6.3f %6.2f |%14.2f %7.1f %6.3f %6.2f\n", a.profile.c_str(), a.rmse_cm_s, a.p95_percent, a.lag_s,
                    a.first_fix_s, b.rmse_cm_s, b.p95_percent, b.lag_s, b.first_fix_s);
    }
    std::printf("%-16s |%15.2f                       |%14.2f\n", "all", both.paper.rmse_cm_s, both.ours.rmse_cm_s);
}

nlohmann::json json_of(const Table &table) {
    nlohmann::json rows = nlohmann::json::array();
    for (const Row &row : table.rows) {
        rows.push_back({{"profile", row.profile},
                        {"rmse_cm_s", row.rmse_cm_s},
                        {"p95_percent", row.p95_percent},
                        {"lag_s", row.lag_s},
                        {"first_fix_s", row.first_fix_s}});
    }
    return {{"rows", rows}, {"rmse_cm_s", table.rmse_cm_s}};
}

// Goals of docs/evidence.md section 3; rows 1 and 3 are the constant speeds 0.2 and 1.0 m/s.
bool goals_met(const Table &ours) {
    bool met = ours.rmse_cm_s <= 1.8 && ours.rows[1].p95_percent <= 15 && ours.rows[3].p95_percent <= 4 &&
               ours.rows[1].first_fix_s <= 0.5 && ours.rows[2].first_fix_s <= 0.5 && ours.rows[3].first_fix_s <= 0.5;
    for (const Row &row : ours.rows) {
        met = met && std::fabs(row.lag_s) <= 0.03;
    }
    return met;
}

bool say_goals(const Table &ours) {
    const bool met = goals_met(ours);
    std::printf("goals of docs/evidence.md section 3 (RMSE 1.8 cm/s, p95 15 %% at 0.2 and 4 %% at 1.0 m/s, |lag| 0.03 s, first fix 0.5 s "
                "from 0.2 m/s on): %s\n",
                met ? "met" : "missed");
    return met;
}

} // namespace

int main(int argc, char **argv) {
    int seeds = 12;
    bool brief = false;
    std::string json_file;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--brief") {
            brief = true;
        } else if (word == "--seeds" && i + 1 < argc) {
            seeds = std::max(1, std::atoi(argv[++i]));
        } else if (word == "--json" && i + 1 < argc) {
            json_file = argv[++i];
        } else {
            std::fprintf(stderr, "speed_bench: %s is not known; usage: speed_bench [--seeds N] [--json FILE] [--brief]\n", argv[i]);
            return 2;
        }
    }
    nlohmann::json json = {{"schema", "traction.bench_speed/1"}, {"seeds", seeds}};
    const Both base = measure(false, {.name = "base"}, seeds);
    print("the tests' clutter", seeds, base);
    json["clutter"] = {{"paper", json_of(base.paper)}, {"ours", json_of(base.ours)}};
    bool met = say_goals(base.ours);
    if (!brief) {
        const Both simulated = measure(true, {.name = "base"}, seeds);
        print("\nthe simulator's radar", seeds, simulated);
        met = say_goals(simulated.ours) && met;
        json["simulator"] = {{"paper", json_of(simulated.paper)}, {"ours", json_of(simulated.ours)}};
        const Variant variants[] = {{.name = "mounting +3 deg", .mounting_error_deg = 3},
                                    {.name = "mounting -3 deg", .mounting_error_deg = -3},
                                    {.name = "ground exponent 0", .exponent = 0},
                                    {.name = "ground exponent 2", .exponent = 2},
                                    {.name = "SNR 10 dB", .snr_dB = 10},
                                    {.name = "accelerometer noise x 2", .accel_noise = 0.4},
                                    {.name = "the same, noise stated", .accel_noise = 0.4, .noise_stated = true}};
        const int few = (seeds + 2) / 3;
        std::printf("\n%-24s | RMSE cm/s, %d seeds: clutter paper, ours | simulator paper, ours\n", "misfit", few);
        for (const Variant &variant : variants) {
            const Both a = measure(false, variant, few), b = measure(true, variant, few);
            std::printf("%-24s | %28.2f %7.2f   | %12.2f %7.2f\n", variant.name.c_str(), a.paper.rmse_cm_s, a.ours.rmse_cm_s,
                        b.paper.rmse_cm_s, b.ours.rmse_cm_s);
            json["misfit"].push_back({{"name", variant.name},
                                      {"clutter", {{"paper_cm_s", a.paper.rmse_cm_s}, {"ours_cm_s", a.ours.rmse_cm_s}}},
                                      {"simulator", {{"paper_cm_s", b.paper.rmse_cm_s}, {"ours_cm_s", b.ours.rmse_cm_s}}}});
        }
    }
    json["goals_met"] = met;
    if (!json_file.empty()) {
        traction::log::write_file(json.dump(1) + "\n", json_file);
    }
    return met ? 0 : 1;
}
