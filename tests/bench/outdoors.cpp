#include "tests/bench/outdoors.h"
#include "tests/bench/scatterers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace outdoors {

Echo::Echo(std::uint64_t seed, double depression_deg) {
    Random random{seed * 0x9e3779b1u + 3};
    const double rad = pi / 180, height = 0.3, near = 0.1, far = 2.0, side = 1.2, k2 = 4 * pi * 9.9e9 / 299792458.0;
    const double c = std::cos(depression_deg * rad), s = std::sin(depression_deg * rad);
    const auto cells = static_cast<std::size_t>(track_m / grid_m) + 4;
    for (int b = 0; b < bands; ++b) {
        band_[b].assign(cells, 0);
        sine_[b] = std::sin((b + 0.5) * 60 / bands * rad);
    }
    const int count = static_cast<int>(160 * (track_m + far) * 2 * side);
    double power = 0;
    for (int i = 0; i < count; ++i) {
        const double px = (track_m + far) * random.uniform(), py = side * (2 * random.uniform() - 1), phase = 2 * pi * random.uniform();
        const auto first = static_cast<std::size_t>(std::max(0.0, (px - far) / grid_m));
        const auto last = std::min(cells, static_cast<std::size_t>(std::max(0.0, (px - near) / grid_m)));
        for (std::size_t k = first; k < last; ++k) {
            const double x = px - static_cast<double>(k) * grid_m, r = std::sqrt(x * x + py * py + height * height);
            const double along = (x * c + height * s) / r, up = (x * s - height * c) / r;
            const double el = std::asin(up) / rad / 36, az = std::atan2(py / r, along) / rad / 72, fall = el * el + az * az;
            if (fall > 1.5) {
                continue;
            }
            const double amplitude = std::exp(-4 * std::log(2.0) * fall) * std::sqrt(height / r) / (r * r), angle = k2 * r + phase;
            const int b = std::min(bands - 1, static_cast<int>(std::asin(height / r) / rad / 60 * bands));
            band_[b][k] += std::complex<double>(amplitude * std::cos(angle), amplitude * std::sin(angle));
        }
    }
    for (std::size_t k = 0; k < cells; ++k) {
        double sum = 0;
        for (const auto &band : band_) {
            sum += band[k].real();
        }
        power += sum * sum / static_cast<double>(cells);
    }
    for (auto &band : band_) {
        for (auto &value : band) {
            value /= std::sqrt(power);
        }
    }
}

double Echo::at(double x_m, double z_m) const {
    const double last = track_m - 4 * grid_m, there = std::fmod(std::fabs(x_m), 2 * last),
                 x = (there < last ? there : 2 * last - there) / grid_m + 1;
    const auto i = static_cast<std::size_t>(x);
    const double u = x - static_cast<double>(i), k2 = 4 * pi * 9.9e9 / 299792458.0;
    double sum = 0;
    for (int b = 0; b < bands; ++b) {
        const std::complex<double> *e = &band_[b][i];
        const std::complex<double> value =
            e[0] + 0.5 * u * (e[1] - e[-1] + u * (2.0 * e[-1] - 5.0 * e[0] + 4.0 * e[1] - e[2] + u * (3.0 * (e[0] - e[1]) + e[2] - e[-1])));
        const double turn = k2 * z_m * sine_[b];
        sum += z_m == 0 ? value.real() : value.real() * std::cos(turn) - value.imag() * std::sin(turn);
    }
    return sum;
}

namespace {

struct Rover { // four like wheels on soil, one body
    double speed = 0, wheel_rad_s = 0, current = 0;
    void step(const Case &now, double duty, double slope, double dt) {
        const double KG = 0.265, Ra = 3.24, J = 5e-3, mass = 2.88, volt = 7.2;
        const double rim = radius_m * wheel_rad_s, largest = std::max({std::fabs(rim), std::fabs(speed), 0.01});
        const double slip = (rim - speed) / largest, load = mass * gravity * std::cos(slope) / 4;
        const double traction = now.soil_max_share * load * (slip >= 0 ? 1 : -1) * (1 - std::exp(-std::fabs(slip) / now.soil_slip));
        current = now.coasts ? 0 : (duty * volt - KG * wheel_rad_s) / Ra;
        const double dry = 0.03 * std::tanh(wheel_rad_s / 0.2), rolling = now.rolling_N / 4 * std::tanh(speed / 0.02);
        wheel_rad_s += dt * (KG * current - 1.6e-3 * wheel_rad_s - dry - radius_m * traction) / J;
        accel = (4 * (traction - rolling) - mass * gravity * std::sin(slope)) / mass;
        speed += dt * accel;
    }
    double accel = 0;
};

} // namespace

Run drive(const Case &now, std::uint64_t seed, const control_config_t &config) {
    const Echo *const echo = now.scatterers ? nullptr : &echo_of(seed, now.depression_deg);
    Scatterers *const ground = now.scatterers ? &scatterers_of(seed, now.depression_deg) : nullptr;
    FrontEnd front(now.echo_count, now.snr_dB, seed);
    Rattle rattle(seed);
    Random noise{seed * 77 + 5}, accel_noise{seed * 131 + 9}, luck{seed * 991 + 1};
    clutter::Biquad high = clutter::butterworth(3, radar_Hz, true), low = clutter::butterworth(80, radar_Hz, false);
    const double white = now.echo_count * std::pow(10, -now.snr_dB / 20);
    control_state_t state;
    control_reset(&config, &state);
    Rover rover;
    Run run;
    Random gyro_noise{seed * 313 + 7};
    const double gyro_offset[] = {0.02 * gyro_noise.normal(), 0.02 * gyro_noise.normal(), 0.02 * gyro_noise.normal()}; // 1 deg/s, assumed
    const auto slope_at = [&now](double at_s) { // the body's: the mean over the time in which its wheels come onto it
        if (!now.gyros) return now.slope(at_s);
        double sum = 0;
        for (int j = 0; j < 10; ++j) sum += 0.1 * now.slope(at_s - 0.01 * j);
        return sum;
    };
    double path = 0.4 * static_cast<double>(seed), angle = 0, duty = 0, t = 0, last_speed = now.closed ? 0 : now.speed(0);
    std::uint32_t sequence = 0;
    const double rate_Hz = now.scatterers ? radar_Hz * 1.0003 : radar_Hz;
    std::vector<std::uint16_t> waiting;
    std::vector<std::uint32_t> number;
    std::uint32_t tick = 0;
    int since = 0, samples = 0;
    const int substeps = 50;
    double heave_accel = 0, yaw_rim_m = 0;
    for (int k = 0; k < static_cast<int>(now.duration_s / tick_s); ++k, ++tick) {
        const double before = now.closed ? rover.speed : last_speed, shakes = t < now.still_s ? 0 : 1;
        double speed = before, wheel = 0;
        rattle.waver();
        for (int j = 0; j < substeps; ++j) {
            const double dt = tick_s / substeps;
            t += dt;
            if (now.closed) {
                rover.step(now, duty, slope_at(t), dt);
                speed = rover.speed, wheel = radius_m * rover.wheel_rad_s;
            } else {
                speed = now.speed(t), wheel = now.wheel ? now.wheel(t) : 1.1 * speed;
            }
            path += speed * dt, angle += wheel / radius_m * dt;
            if (now.scatterers) rattle.turn(wheel / radius_m, dt, !now.closed);
            if (t * rate_Hz >= samples + 1) {
                ++samples;
                const double z = shakes * now.heave_m * std::sin(2 * pi * now.heave_Hz * t) + (now.lift_m ? now.lift_m(t) : 0),
                             pitch = shakes * now.pitch_rad * std::sin(2 * pi * 5 * t);
                const double way = path + 0.3 * pitch + (now.waves_m ? now.waves_m(t) : 0);
                const bool dead = now.radar_dead && now.radar_dead(t);
                const double share = now.echo_share ? now.echo_share(t) : 1;
                const bool walks = now.walker_m && now.walker_m(t) != 0;
                const double walker_m = walks ? 3 + now.walker_m(t) : 0;
                const auto both = [&](auto &of) { return share * of(way, z) + (walks ? of(walker_m, 0) : 0); };
                const auto near = [echo](double x, double up) { return echo->at(x, up); };
                const auto scattered = [ground](double x, double up) { return ground->echo(x, up); };
                const double heard = now.scatterers ? front.filtered(both(scattered)) : low.step(high.step(now.echo_count * both(near)));
                const double own = dead ? 0.3 : now.scatterers ? 0 : white; // noise of the converter
                const double count = 512 + now.offset_count + own * noise.normal() +
                                     (dead ? 0 : heard + (t < now.tone_from_s ? 0 : now.tone_count * std::sin(2 * pi * now.tone_Hz * t)));
                ++sequence;
                const bool lost = luck.uniform() < now.lost_share;
                if (!lost && !(now.radar_silent && now.radar_silent(t))) {
                    waiting.push_back(static_cast<std::uint16_t>(now.scatterers ? front.convert(count)
                                                                                : std::clamp(std::floor(count + 0.5), 0.0, 1023.0)));
                    number.push_back(sequence);
                }
            }
        }
        yaw_rim_m += now.turn ? tick_s * now.turn(t) : 0;
        heave_accel = -now.heave_m * std::pow(2 * pi * now.heave_Hz, 2) * std::sin(2 * pi * now.heave_Hz * t);
        const double felt = now.accel_more ? now.accel_more(t) : 0; // beside what the body does
        const double moves = (speed - before) / tick_s + gravity * std::sin(slope_at(t)) + felt;
        const double accel = (now.scatterers ? rattle.accel(moves, now.accel_bias, now.accel_noise, wheel / radius_m / (2 * pi))
                                             : moves + now.accel_bias + now.accel_noise * accel_noise.normal()) +
                             shakes * 0.3 * now.pitch_rad * std::pow(2 * pi * 5, 2) * -std::sin(2 * pi * 5 * t) -
                             (now.gyros ? shakes * gravity * now.pitch_rad * std::sin(2 * pi * 5 * t) : 0);
        last_speed = speed;
        ++since;
        if ((now.missed_share > 0 && luck.uniform() < now.missed_share) || (now.stalled && now.stalled(t))) {
            continue; // the next tick finds what has come meanwhile
        }
        const bool radar_lost = luck.uniform() < now.lost_ticks_share;
        sensor_frame_t frame = {};
        frame.tick = tick;
        frame.present = FRAME_ALL & ~static_cast<std::uint32_t>(FRAME_ACCEL_YZ | FRAME_GYRO_XY);
        if (waiting.empty()) {
            frame.present &= ~static_cast<std::uint32_t>(FRAME_RADAR);
        }
        frame.elapsed_ticks = static_cast<std::uint32_t>(since);
        frame.time_us = 1000000u + tick * 10000u;
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            const double turned = (now.scatterers ? rattle.angle(i) : angle) + (i % 2 == 0 ? -yaw_rim_m : yaw_rim_m) / radius_m;
            frame.encoder_count[i] = static_cast<std::int32_t>(std::floor(turned * 6000 / (2 * pi)));
            const double current = now.closed ? rover.current : 0.3;
            frame.current_count[i] = static_cast<std::uint16_t>(std::clamp(2048 + current / 0.002 + 5 * accel_noise.normal(), 1.0, 4094.0));
        }
        frame.battery_count = 1800;
        frame.accel_x_count = static_cast<std::int16_t>(std::floor(std::clamp(accel, -now.accel_rail, now.accel_rail) / 0.004 + 0.5));
        (void)heave_accel;
        if (now.gyros) {
            frame.present |= FRAME_GYRO_XY | FRAME_ACCEL_YZ;
            frame.accel_z_count = static_cast<std::int16_t>(std::lround(gravity * std::cos(slope_at(t)) / 0.004));
            const auto more = [t](const std::function<double(double)> &of) { return of ? of(t) : 0.0; };
            const double sways = shakes * now.pitch_rad * 2 * pi * 5 * std::cos(2 * pi * 5 * t); // nose down, as the radar goes ahead
            const double rate[] = {more(now.gyro_x_more), more(now.gyro_y_more) + sways - (slope_at(t) - slope_at(t - tick_s)) / tick_s, 0};
            std::int16_t *const count[] = {&frame.gyro_x_count, &frame.gyro_y_count, &frame.gyro_z_count};
            for (std::size_t i = 0; i < 3; ++i) // 0.2 deg/s of noise, assumed
                *count[i] = static_cast<std::int16_t>(std::lround((rate[i] + gyro_offset[i] + 0.0035 * gyro_noise.normal()) / 0.0005));
        }
        if (radar_lost) {
            waiting.clear(), number.clear();
        }
        std::size_t hole = 0; // a frame's samples are consecutive: what lies before a hole inside it is lost, too
        for (std::size_t i = 1; now.sequence && i < number.size(); ++i) {
            hole = number[i] != number[i - 1] + 1 ? i : hole;
        }
        waiting.erase(waiting.begin(), waiting.begin() + static_cast<long>(hole)),
            number.erase(number.begin(), number.begin() + static_cast<long>(hole));
        const std::size_t most = sizeof frame.radar_count / sizeof frame.radar_count[0];
        if (waiting.size() > most) {
            waiting.erase(waiting.begin(), waiting.end() - static_cast<long>(most));
            number.erase(number.begin(), number.end() - static_cast<long>(most));
        }
        frame.radar_sequence = now.sequence && !number.empty() ? number[0] : 0;
        std::copy(waiting.begin(), waiting.end(), frame.radar_count);
        frame.radar_samples = static_cast<std::uint8_t>(waiting.size());
        waiting.clear(), number.clear();
        since = 0;
        command_t command = {};
        command.mode = now.coasts ? MODE_STOP : now.closed ? MODE_PLATFORM_SPEED : MODE_OPEN_LOOP;
        command.platform_speed_m_s = static_cast<float>(now.command_m_s);
        for (float &value : command.duty) {
            value = static_cast<float>((3.24 * 0.3 + 0.265 * wheel / radius_m) / 7.2);
        }
        const trace_t trace = control_step(&config, &state, &command, &frame);
        duty = static_cast<double>(trace.wheel[0].duty);
        char note[256] = "";
        if (std::getenv("OUTDOORS_TRACE") != nullptr) {
            const ground_speed_state_t &g = state.ground_speed;
            std::snprintf(
                note, sizeof note,
                " lean %.3f b %.2f+-%.2f z %.3f%s refused %d misfit %.2f other %d %.2f odds %.1f quiet %d agile %.2f %.2f L %.1f tone %d "
                "%.2f Hz %.0f",
                static_cast<double>(state.sense.lean.lean_q8) * static_cast<double>(config.sense.level_m_s2_per_q8),
                static_cast<double>(g.bias_m_s2), std::sqrt(static_cast<double>(g.p_bb)), static_cast<double>(trace.radar_speed_m_s),
                trace.radar_fresh ? "!" : "", g.refused, static_cast<double>(g.misfit), g.other_alive,
                static_cast<double>(g.other.at.speed_m_s), static_cast<double>(g.odds), g.quiet, static_cast<double>(g.agile.at.speed_m_s),
                static_cast<double>(g.agile.at.bias_m_s2), static_cast<double>(g.agile_sum), state.doppler.tone.found,
                static_cast<double>(state.doppler.tone.turn) / 4294967296.0 * radar_Hz,
                std::hypot(state.doppler.tone.a_re, state.doppler.tone.a_im) / 32);
        }
        run.steps.push_back({t, speed, static_cast<double>(trace.speed_m_s), static_cast<double>(trace.speed_std_m_s), wheel, trace.faults,
                             state.ground_speed.gyro_q8 * 0.0005 / 256, note});
    }
    return run;
}

Score score(const Case &now, const Run &run) {
    Score out;
    int spell = 0; // ticks
    int ok = 0;
    for (const Step &step : run.steps) {
        const double error = step.estimate - step.speed;
        ok = std::fabs(error) <= 0.1 * std::fabs(step.speed) ? ok + 1 : 0;
        if (ok >= 10 && out.first_fix_s < 0) {
            out.first_fix_s = step.t - 0.09;
        }
        if (step.faults != 0 && out.first_fault_s < 0) {
            out.first_fault_s = step.t;
        }
        out.faults |= step.faults;
        const bool wrong = step.estimate * step.speed < 0 && std::fabs(step.speed) > 0.05 && std::fabs(step.estimate) > 0.05;
        spell = wrong ? spell + 1 : 0;
        out.wrong_sign_s = std::max(out.wrong_sign_s, spell / 100.0);
        out.last_true = step.speed;
        if (step.t > now.settle_s) {
            out.square += error * error;
            out.nees_sum += error * error / std::max(1e-12, step.std * step.std);
            out.worst = std::max(out.worst, std::fabs(error));
            out.relative.push_back(std::fabs(error) / std::max(std::fabs(step.speed), 0.05));
            ++out.n;
        }
    }
    out.rmse = std::sqrt(out.square / out.n), out.nees = out.nees_sum / out.n;
    return out;
}

} // namespace outdoors
