#include "speed.h"

#include "firmware/core/rover_config.h"
#include "host_tools/rover/radar_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace traction::speed {

namespace {

constexpr double tick_s = 0.01;
constexpr int trend_ticks = 30; // without an accelerometer a change of speed is told by values; no longer than this is it believed without
constexpr double unused = 1e6;  // of a limit that nothing reaches

std::string short_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

const doppler_template_t *beam_of(radar_geometry_t radar, double rate_Hz, const std::string &source) {
    radar.rate_Hz = rate_Hz;
    radar.band_high_Hz = std::min(radar.band_high_Hz, 0.46875 * rate_Hz);
    const radar_geometry_refusal_t refusal = radar_geometry_check(&radar);
    if (refusal.field != nullptr)
        throw log::LogError(source, 0, 0,
                            std::string("radar.") + refusal.field + " = " + short_text(refusal.value) + ": give " +
                                short_text(refusal.low) + " to " + short_text(refusal.high),
                            refusal.mend);
    return template_of(radar);
}

control_config_t config_of(const doppler_template_t *beam, const Settings &settings, bool accel, bool wheels) {
    rover_parameters_t parameters;
    control_config_t config;
    rover_parameters_reference(&parameters);
    parameters.radar = ROVER_RADAR_OWN;
    parameters.beam = beam;
    parameters.value[ROVER_radar_offset_count] = static_cast<float>(settings.offset_count);
    parameters.value[ROVER_radar_max_count] = static_cast<float>(settings.max_count);
    parameters.value[ROVER_radar_quiet_count2] = static_cast<float>(settings.quiet_count2);
    parameters.value[ROVER_doppler_scale] = static_cast<float>(settings.scale);
    parameters.value[ROVER_wheel_radius_m] = static_cast<float>(settings.wheel_radius_m);
    control_config_build(&parameters, &config);
    if (settings.paper) control_config_make_paper(&config);
    ground_speed_config_t &filter = config.ground_speed;
    if (!accel) {
        const double agility = settings.agility_m_s2 > 0 ? settings.agility_m_s2 : beam->line ? 3 : 0.5; // assumed: a car's braking
        filter.bias_start_m_s2 = static_cast<float>(agility);
        filter.bias_noise_m2_s4 = static_cast<float>(agility * agility * tick_s); // (1)
        filter.bias_max_m_s2 = static_cast<float>(std::fmax(3, 4 * agility));
    }
    if (!wheels) {
        filter.still_m_s = 0;                     // no wheel is at rest, and none creeps
        filter.felt_share = 0;                    // nor tells what of the acceleration is noise
        filter.wheel_odds = 2 * filter.sign_sure; // begins forward; from then on the accelerometer carries the sign through zero
        if (!accel) filter.sign_sure = static_cast<float>(unused), filter.wheel_odds = static_cast<float>(10 * unused); // forward
        filter.wheel_noise_m_s = static_cast<float>(unused / 1000);
        filter.apart_share = filter.force_most = filter.force_pull = 0;
        filter.roll_told_m_s = static_cast<float>(unused);
        filter.apart_least_m_s = filter.apart_told_m_s = static_cast<float>(unused);
    }
    return config;
}

// Mean of a signal's samples in (from, to]; the last one before where there is none, no older than 50 ms.
class Ticked {
  public:
    explicit Ticked(const log::Signal &signal) : signal_(signal) {}
    bool at(double to_s, double &value) {
        double sum = 0;
        int n = 0;
        while (next_ < signal_.t_s.size() && signal_.t_s[next_] <= to_s) {
            if (signal_.t_s[next_] > to_s - tick_s) sum += signal_.value[next_], n++;
            next_++;
        }
        if (n > 0) value = sum / n;
        if (n == 0 && next_ > 0) value = signal_.value[next_ - 1];
        return n > 0 || (next_ > 0 && signal_.t_s[next_ - 1] > to_s - 0.05);
    }

  private:
    const log::Signal &signal_;
    std::size_t next_ = 0;
};

// One tick's samples, which may have gaps in them, through the Doppler stage.
class Listener {
  public:
    Listener(const Counts &counts, const doppler_config_t &config) : counts_(counts), config_(config) {}
    doppler_output_t tick(double to_s) {
        doppler_output_t heard{};
        std::uint32_t elapsed = 1;
        do {
            std::size_t run = 0; // samples without a gap
            while (run < DOPPLER_SAMPLES_MAX && next_ + run < counts_.number.size() && time(next_ + run) <= to_s &&
                   (run == 0 || counts_.number[next_ + run] == counts_.number[next_ + run - 1] + 1))
                run++;
            const auto first = run > 0 ? static_cast<std::uint32_t>(counts_.number[next_] + 1) : 0; // from 1: 0 means not numbered
            const doppler_arrival_t arrival = {first, elapsed, static_cast<std::int32_t>(run)};
            const std::uint16_t *sample = counts_.count.data() + (run > 0 ? next_ : 0);
            const std::int32_t missing = doppler_missing(&config_, &state_, &arrival);
            doppler_gap(&config_, &state_, missing, *sample);
            const doppler_output_t out = doppler_step(&config_, &state_, sample, static_cast<std::int32_t>(run));
            if (heard.fresh)
                heard.late_samples += missing + static_cast<std::int32_t>(run), heard.busy = heard.busy || out.busy, heard.dead = out.dead;
            else
                heard = out;
            next_ += run;
            elapsed = 0;
        } while (next_ < counts_.number.size() && time(next_) <= to_s);
        return heard;
    }
    std::int32_t taken_since(std::size_t before) const { return static_cast<std::int32_t>(next_ - before); }
    std::size_t next() const { return next_; }
    bool done() const { return next_ >= counts_.number.size(); }

  private:
    double time(std::size_t i) const { return static_cast<double>(counts_.number[i]) / counts_.rate_Hz; }
    const Counts &counts_;
    const doppler_config_t &config_;
    doppler_state_t state_{};
    std::size_t next_ = 0;
};

void keep(const doppler_output_t &heard, bool used, double t_s, Result &out) {
    if (!heard.fresh) return;
    out.values++;
    out.quiet += heard.quiet ? 1 : 0;
    out.spoilt += heard.spoilt ? 1 : 0;
    out.beyond += heard.beyond ? 1 : 0;
    if (!used) return;
    out.doppler.t_s.push_back(t_s);
    out.doppler.value.push_back(static_cast<double>(heard.speed_m_s));
}

} // namespace

Helpers helpers_of(const log::Log &log, const std::string &accel, bool wheels, double wheel_radius_m) {
    Helpers out;
    if (accel != "none") {
        const log::Signal *signal = log.find(accel.empty() ? "imu.accel_x_m_s2" : accel);
        if (signal == nullptr && !accel.empty())
            throw log::LogError(log.source, 0, 0, "there is no column " + accel,
                                "name the column of the forward acceleration in m/s^2, or --accel none");
        if (signal != nullptr) out.accel_m_s2 = *signal;
    }
    const log::Signal *first = wheels ? log.find("wheel0.speed_rad_s") : nullptr;
    if (first == nullptr) return out;
    out.rim_m_s = {.name = "rim", .t_s = first->t_s, .value = std::vector<double>(first->t_s.size(), 0.0)};
    int n = 0;
    for (; log.find("wheel" + std::to_string(n) + ".speed_rad_s") != nullptr; n++) {
        Ticked wheel(*log.find("wheel" + std::to_string(n) + ".speed_rad_s"));
        for (std::size_t i = 0; i < first->t_s.size(); i++) {
            double value = 0;
            wheel.at(first->t_s[i], value);
            out.rim_m_s.value[i] += value * wheel_radius_m;
        }
    }
    for (double &v : out.rim_m_s.value) v /= n;
    return out;
}

Result measure(const Counts &counts, const Helpers &helpers, const Settings &settings, const std::string &source) {
    const doppler_template_t *beam = beam_of(settings.radar, counts.rate_Hz, source);
    Result out;
    out.used_accel = !helpers.accel_m_s2.t_s.empty();
    out.used_wheels = !helpers.rim_m_s.t_s.empty();
    out.rate_Hz = counts.rate_Hz;
    out.lowest_m_s = static_cast<double>(beam->speed_m_s[0]);
    out.highest_m_s = static_cast<double>(beam->speed_m_s[beam->speeds - 1]);
    out.doppler.name = "radar.speed_m_s";
    const control_config_t config = config_of(beam, settings, out.used_accel, out.used_wheels);
    Listener listener(counts, config.doppler);
    Ticked accel(helpers.accel_m_s2), rim(helpers.rim_m_s);
    ground_speed_state_t state;
    ground_speed_reset(&config.ground_speed, &state);
    doppler_output_t before{};
    int silent_ticks = 0;
    const double span_s = static_cast<double>(counts.number.back()) / counts.rate_Hz;
    for (int k = 1; k * tick_s <= span_s + 1e-9; k++) {
        const double at_s = k * tick_s, t_s = counts.start_s + at_s;
        double accel_m_s2 = 0, rim_m_s = 0;
        const bool accel_known = accel.at(t_s, accel_m_s2);
        if (!rim.at(t_s, rim_m_s))
            rim_m_s = out.used_wheels || (out.used_accel && state.accepted) ? 0 : 1e-3; // forward, where nobody knows
        const std::size_t taken = listener.next();
        const doppler_output_t now = listener.tick(at_s);
        doppler_output_t heard = before; // one tick later, as on the rover: no tick pays for a search and a correction
        heard.late_samples += listener.taken_since(taken);
        const bool used = heard.fresh && !heard.beyond && !heard.spoilt;
        silent_ticks = used ? 0 : silent_ticks + 1;
        ground_speed_input_t input{};
        input.accel_x_m_s2 = static_cast<float>(accel_m_s2);
        input.doppler_m_s = heard.speed_m_s;
        input.doppler_late_s = heard.fresh ? static_cast<float>(heard.late_samples) * config.doppler.per_sample_s : 0.0F;
        input.wheel_m_s = static_cast<float>(rim_m_s);
        input.accel_valid = out.used_accel ? accel_known : silent_ticks < trend_ticks;
        input.doppler_fresh = used;
        input.doppler_quiet = heard.quiet;
        input.doppler_dead = heard.dead;
        input.busy = now.busy || now.fresh;
        input.doppler_trust = heard.trust;
        input.doppler_misfit = heard.misfit;
        input.doppler_relieved = heard.relieved;
        input.elapsed_ticks = 1;
        const ground_speed_output_t speed = ground_speed_step(&config.ground_speed, &state, &input);
        keep(heard, used && !heard.quiet, t_s, out);
        if (used && !heard.quiet && std::isnan(out.first_s)) out.first_s = at_s;
        out.t_s.push_back(t_s);
        out.speed_m_s.push_back(static_cast<double>(speed.speed_m_s));
        out.std_m_s.push_back(static_cast<double>(speed.std_m_s));
        before = now;
    }
    std::size_t n = 0;
    for (std::size_t i = 0; i < out.t_s.size(); i++) {
        if (!(out.t_s[i] - counts.start_s >= out.first_s)) continue;
        out.mean_m_s += out.speed_m_s[i];
        out.mean_std_m_s += out.std_m_s[i];
        n++;
    }
    if (n > 0) out.mean_m_s /= static_cast<double>(n), out.mean_std_m_s /= static_cast<double>(n);
    return out;
}

Judgement judge(const Result &result, const log::Signal &reference, const std::string &source) {
    constexpr double gap_s = 0.25;
    Judgement out{.reference = reference.name};
    std::size_t next = 0;
    for (std::size_t i = 0; i < result.t_s.size(); i++) {
        const double t = result.t_s[i];
        if (!(t - result.t_s.front() + tick_s >= result.first_s)) continue;
        while (next < reference.t_s.size() && reference.t_s[next] < t) next++;
        if (next == 0 || next >= reference.t_s.size() || reference.t_s[next] - reference.t_s[next - 1] > 2 * gap_s) continue;
        const double u = (t - reference.t_s[next - 1]) / (reference.t_s[next] - reference.t_s[next - 1]);
        const double truth = reference.value[next - 1] + u * (reference.value[next] - reference.value[next - 1]);
        const double e = result.used_wheels ? result.speed_m_s[i] - truth : std::fabs(result.speed_m_s[i]) - std::fabs(truth);
        const double z = result.std_m_s[i] > 0 ? std::fabs(e) / result.std_m_s[i] : 0;
        out.ticks++;
        out.rmse_m_s += e * e;
        out.bias_m_s += e;
        out.nees += z * z;
        out.within_1 += z < 1 ? 1 : 0;
        out.within_2 += z < 2 ? 1 : 0;
        out.worst_m_s = std::max(out.worst_m_s, std::fabs(e));
    }
    if (out.ticks == 0)
        throw log::LogError(source, 0, 0, "the reference " + reference.name + " never meets a speed that the radar heard",
                            "give one of the same time span, sampled every half second or faster");
    const auto n = static_cast<double>(out.ticks);
    out.rmse_m_s = std::sqrt(out.rmse_m_s / n);
    for (double *sum : {&out.bias_m_s, &out.nees, &out.within_1, &out.within_2}) *sum /= n;
    return out;
}

log::Log to_log(const Result &result, const Settings &settings, const std::string &source) {
    log::Log out;
    out.source = source;
    out.header["title"] = "traction speed of " + source;
    out.header["radar.carrier_Hz"] = short_text(settings.radar.carrier_Hz);
    out.header["radar.depression_deg"] = short_text(settings.radar.depression_deg);
    out.header["radar.sample_rate_Hz"] = short_text(result.rate_Hz);
    out.header["estimator"] = settings.paper ? "paper" : "default";
    if (!result.used_wheels) out.header["unsigned.estimate.speed_m_s"] = "1";
    out.signals.push_back({.name = "estimate.speed_m_s", .t_s = result.t_s, .value = result.speed_m_s});
    out.signals.push_back({.name = "estimate.speed_std_m_s", .t_s = result.t_s, .value = result.std_m_s});
    if (!result.doppler.t_s.empty()) out.signals.push_back(result.doppler);
    for (log::Signal &signal : out.signals) // six decimals, as every log here
        for (double &v : signal.value) v = std::round(v * 1e6) / 1e6;
    return out;
}

} // namespace traction::speed
