// Encoders, camera, radar, carriage, gyro and accelerometer against each other: they see one motion.
#include "series.h"

#include <algorithm>
#include <cmath>

namespace traction::check {

namespace {

constexpr double pi = 3.141592653589793;
constexpr double least_turn = 0.1; // of the speed, by which the sides' speeds differ in a turn

std::vector<double> without_sign(std::vector<double> values) {
    for (double &v : values) v = std::fabs(v);
    return values;
}

class Motion {
  public:
    Motion(const Grid &grid, const Machine &machine, Findings &findings) : grid_(grid), machine_(machine), findings_(findings) {}
    void run() {
        encoders();
        heading();
        radar_beside_camera();
        ground();
        yaw();
        accel();
    }

  private:
    void encoders();
    bool stands(const std::vector<double> &rate, const std::vector<double> &speed, const std::string &column);
    void radar_beside_camera();
    void heading();
    void ground();
    void yaw();
    void gyro_turns_as_far();
    void accel();
    bool straight(std::size_t k) const; // the wheels agree, so the body moves along its heading
    double radius_from(const std::vector<double> &speed, double &alike, double &middle) const;
    bool blamed(const std::string &start) const {
        return std::any_of(findings_.begin(), findings_.end(),
                           [&](const Finding &f) { return f.severity == Severity::error && f.signal.rfind(start, 0) == 0; });
    }
    bool wheels_blamed() const {
        return std::any_of(findings_.begin(), findings_.end(), [](const Finding &f) {
            const bool motion = f.signal.find(".speed_rad_s") != std::string::npos || f.signal.find(".angle_rad") != std::string::npos ||
                                f.signal.find(".encoder_count") != std::string::npos;
            return f.severity == Severity::error && motion && f.signal.rfind("wheel", 0) == 0;
        });
    }
    void add(const char *id, Severity severity, const std::string &signal, std::string text, std::string mend, double value) {
        findings_.push_back({id, severity, signal, std::move(text), std::move(mend), value});
    }

    const Grid &grid_;
    const Machine &machine_;
    Findings &findings_;
    bool heading_fits_ = false;
};

bool Motion::straight(std::size_t k) const {
    double size = 0, n = 0;
    for (const Wheel &wheel : grid_.wheel) {
        if (!wheel.speed.empty()) size += std::fabs(wheel.speed[k]), n += 1;
    }
    if (!(size / n > 0.5) || std::fabs(grid_.mean_speed[k]) < 0.8 * size / n) return false;
    return grid_.gyro.empty() || !(std::fabs(grid_.gyro[k]) > 0.3) || blamed("imu.gyro");
}

// A count that stands for 1.5 s while its wheel turns.
bool Motion::stands(const std::vector<double> &rate, const std::vector<double> &speed, const std::string &column) {
    std::size_t run = 0, longest = 0, turning = 0, end = 0;
    for (std::size_t k = 0; k < grid_.count; ++k) {
        const bool turns = std::fabs(speed[k]) > 0.5;
        turning += turns;
        run = turns && rate[k] == 0 ? run + 1 : 0;
        if (run > longest) longest = run, end = k;
    }
    const double lasts = static_cast<double>(longest) * step_s;
    if (lasts < 1.5) return false;
    const bool whole = longest > turning / 2;
    add(whole ? "dead_sensor" : "stuck_sensor", Severity::error, column,
        say("'%s' stands for %.3g s until t = %.3f s while its wheel turns", column.c_str(), lasts, grid_.time(end)),
        "check its wiring; or take the column out of the log", lasts);
    return true;
}

// Both see the ground, so slip does not come in.
void Motion::radar_beside_camera() {
    if (grid_.radar.empty() || grid_.camera_speed.empty()) return;
    const double fast = 0.5 * quantile(grid_.camera_speed, 0.95);
    std::vector<double> ratio;
    for (std::size_t k = 0; k < grid_.count; ++k) {
        if (grid_.camera_speed[k] > fast && grid_.camera_speed[k] > 0) ratio.push_back(std::fabs(grid_.radar[k]) / grid_.camera_speed[k]);
    }
    const double middle = quantile(ratio, 0.5);
    if (ratio.size() < 40 || (middle > 0.5 && middle < 2)) return;
    const UnitSlip *radar = unit_slip('v', middle), *camera = unit_slip('v', 1 / middle);
    if (radar != nullptr && radar->factor > 1) {
        add("unit", Severity::error, "radar.speed_m_s",
            say("the radar reads %.4g times the camera's speed: it looks like %s", middle, radar->written),
            say("multiply it by %.6g", 1 / radar->factor), middle);
    } else if (camera != nullptr && camera->factor > 1) {
        add("unit", Severity::error, "camera.x_m",
            say("the camera's speed is %.4g times the radar's: its positions look like %s", 1 / middle, camera->written),
            say("multiply x and y by %.6g", 1 / camera->factor), 1 / middle);
    } else {
        add("scale", Severity::error, "radar.speed_m_s", say("the radar reads %.3g times the camera's speed", middle), // effects reach 1.3
            "check the units (miles an hour are 2.24, feet 3.28), the radar's mounting angle, and the camera's scale", middle);
    }
}

void Motion::encoders() {
    std::vector<double> per_rad;
    std::vector<const Wheel *> wheels;
    for (const Wheel &wheel : grid_.wheel) {
        const std::string name = "wheel" + std::to_string(wheel.index);
        if (wheel.speed.empty() || blamed(wheel.speed_column)) continue;
        const std::vector<double> speed = smooth(wheel.speed, 2);
        for (const bool count : {false, true}) {
            const std::vector<double> &rate = count ? wheel.count_rate : wheel.angle_rate;
            const std::string column = name + (count ? ".encoder_count" : ".angle_rad");
            if (!rate.empty() && stands(rate, speed, column)) continue;
            const Fit line = rate.empty() ? Fit{} : fit(rate, speed);
            if (!line.good || line.rms > 0.5 * line.y_rms) continue;
            if (line.a < 0) {
                add("sign", Severity::error, column, say("'%s' falls while '%s' is positive", column.c_str(), wheel.speed_column.c_str()),
                    "turn the sign of one of them round", line.a);
            } else if (!count && (line.a < 0.8 || line.a > 1.25)) {
                const UnitSlip *slip = unit_slip('w', line.a), *inverse = unit_slip('w', 1 / line.a);
                add("unit", Severity::error, inverse != nullptr ? wheel.speed_column : column,
                    say("'%s' advances %.4g times as fast as '%s' says%s%s", column.c_str(), line.a, wheel.speed_column.c_str(),
                        slip != nullptr || inverse != nullptr ? ": one of them looks like " : "",
                        slip != nullptr      ? slip->written
                        : inverse != nullptr ? inverse->written
                                             : ""),
                    "bring both to rad and rad/s", line.a);
            } else if (count) {
                per_rad.push_back(line.a);
                wheels.push_back(&wheel);
            }
        }
    }
    for (std::size_t i = 0; i < per_rad.size() && per_rad.size() >= 3; ++i) {
        const double ratio = quantile(per_rad, 0.5) / per_rad[i];
        if (ratio > 0.7 && ratio < 1.4) continue;
        const UnitSlip *slip = unit_slip('w', ratio);
        const std::string &name = wheels[i]->speed_column;
        if (!blamed(name)) {
            add("unit", Severity::error, name,
                say("'%s' has %.4g counts for a radian, the other wheels %.4g%s%s", name.c_str(), per_rad[i], quantile(per_rad, 0.5),
                    slip != nullptr ? ": it looks like " : "", slip != nullptr ? slip->written : ""),
                "bring it to rad/s", ratio);
        }
    }
}

// The path of a machine with wheels that point forward runs along its heading.
void Motion::heading() {
    if (grid_.camera_forward.empty() || !machine_.wheels_point_forward || wheels_blamed()) return;
    const std::vector<double> vx = slope(grid_.camera_x, 5), vy = slope(grid_.camera_y, 5);
    double c = 0, s = 0, cm = 0, sm = 0, n = 0, turned = 0;
    const double moving = 0.3 * quantile(grid_.camera_speed, 0.95);
    double first_direction = not_known;
    for (std::size_t k = 0; k < grid_.count; ++k) {
        if (!straight(k) || !(grid_.camera_speed[k] > moving) || !std::isfinite(grid_.camera_yaw[k])) continue;
        const double sign = grid_.mean_speed[k] > 0 ? 1 : -1, direction = std::atan2(sign * vy[k], sign * vx[k]), yaw = grid_.camera_yaw[k];
        if (!std::isfinite(first_direction)) first_direction = direction;
        turned = std::max(turned, std::fabs(std::remainder(direction - first_direction, 2 * pi)));
        c += std::cos(direction - yaw), s += std::sin(direction - yaw);
        cm += std::cos(-direction - yaw), sm += std::sin(-direction - yaw);
        n += 1;
    }
    if (n < 40) return;
    const double together = std::hypot(c, s) / n, mirrored = std::hypot(cm, sm) / n, offset = std::atan2(s, c);
    // A mean hides a mirror where most of the path runs one way: what the mirror image leaves is compared with what the path leaves.
    const bool is_mirrored = turned > 0.5 && mirrored > 0.9 && (together <= 0.9 || 1 - mirrored < 0.25 * (1 - together));
    heading_fits_ = together > 0.9 && std::fabs(offset) < 0.35 && !is_mirrored;
    if (heading_fits_) return;
    const double widest = std::max(std::fabs(quantile(grid_.camera_yaw, 0.01)), std::fabs(quantile(grid_.camera_yaw, 0.99)));
    if (is_mirrored) {
        add("sign", Severity::error, "camera.y_m", "the camera's path is the mirror image of the one that its heading describes",
            "turn the sign of camera.y_m round (an image has y down), or of the heading", mirrored);
    } else if (together > 0.9 && std::fabs(offset) > 2.8) {
        add("sign", Severity::error, "camera.yaw_rad",
            say("the camera sees the machine drive backwards when its wheels turn forwards (heading off by %.2f rad)", offset),
            "add pi to the heading, or turn the sign of all wheel speeds round", offset);
    } else if (together > 0.9) {
        add("heading", Severity::error, "camera.yaw_rad",
            say("the camera's heading is %.2f rad away from the direction of travel", -offset), say("add %.4f to it (map: offset)", offset),
            -offset);
    } else if (widest > 15) {
        add("unit", Severity::error, "camera.yaw_rad",
            say("'camera.yaw_rad' reaches %.4g and does not point along the path: it looks like degrees", widest),
            "multiply it by 0.0174533", widest);
    } else if (together < 0.6) {
        add("heading", Severity::warning, "camera.yaw_rad",
            say("the camera's heading does not point along the path (agreement %.2f of 1)", together),
            "check the camera's axes, and that wheels 0.. all push forward", together);
    }
}

double Motion::radius_from(const std::vector<double> &speed, double &alike, double &middle) const {
    std::vector<double> ratio, a(grid_.count, not_known), b(grid_.count, not_known);
    for (std::size_t k = 0; k < speed.size(); ++k) {
        if (!straight(k) || !std::isfinite(speed[k])) continue;
        ratio.push_back(std::fabs(speed[k] / grid_.mean_speed[k]));
        a[k] = speed[k], b[k] = grid_.mean_speed[k];
    }
    alike = 0;
    if (ratio.size() < 40) return not_known;
    const Fit line = fit(a, b);
    alike = line.good && line.y_rms > 0 ? std::copysign(1 - line.rms / line.y_rms, line.a) : 0;
    middle = quantile(ratio, 0.5);
    return quantile(ratio, 0.9); // where slip is least
}

void Motion::ground() {
    if (!machine_.wheels_point_forward || grid_.wheel.empty() || wheels_blamed()) return;
    struct Source {
        const char *name;
        const std::vector<double> *speed;
        bool has_sign;
        double radius = not_known, alike = 0, middle = not_known;
        bool absurd = false;
    };
    std::vector<Source> sources;
    if (!grid_.camera_speed.empty()) sources.push_back({"camera.x_m", heading_fits_ ? &grid_.camera_forward : &grid_.camera_speed, false});
    if (!grid_.radar.empty()) sources.push_back({"radar.speed_m_s", &grid_.radar, quantile(grid_.radar, 0.02) < -0.05});
    if (!grid_.carriage.empty()) sources.push_back({"carriage.speed_m_s", &grid_.carriage, true});
    const double known = grid_.speed_is_guessed ? not_known : machine_.wheel_radius_m;
    for (Source &source : sources) {
        source.radius = radius_from(*source.speed, source.alike, source.middle);
        const double ratio = source.radius / known;
        const bool is_unit = unit_slip('v', ratio) != nullptr || unit_slip('w', 1 / ratio) != nullptr;
        source.absurd =
            std::isfinite(known) ? is_unit : source.radius < 0.012 || source.radius > 1.0; // [m] assumed: wheels of 24 mm to 2 m
        if (source.speed == &grid_.carriage) source.absurd = source.radius > 1.0;          // the carriage imposes slip: 0.9 is no mistake
        const bool judged = blamed(source.name) || (source.speed == &grid_.radar && !grid_.camera_speed.empty()); // beside the camera
        if (source.radius > known && source.middle < 2 * known) source.absurd = false; // wheels that are locked now and then
        if (judged || grid_.speed_is_guessed || !machine_.rolls_freely) source.absurd = false;
        if (source.has_sign && source.alike < -0.3) {
            add("sign", Severity::error, source.name, say("'%s' is negative when the wheels turn forwards", source.name),
                "turn its sign round (map: sign = -1)", source.alike);
        }
    }
    std::erase_if(sources, [&](const Source &source) {
        return !std::isfinite(source.radius) || blamed(source.name) || (source.speed == &grid_.radar && !grid_.camera_speed.empty());
    });
    const std::size_t absurd =
        static_cast<std::size_t>(std::count_if(sources.begin(), sources.end(), [](const Source &source) { return source.absurd; }));
    if (absurd == 0) return;
    const double expected = std::isfinite(known) ? known : 0.06; // [m] assumed, to name the likeliest unit
    const auto describe = [&](const Source &source) {
        return say("'%s' and the wheel speeds together mean a wheel radius of %.4g m%s", source.name, source.radius,
                   std::isfinite(known) ? say(" (known: %.4g m)", known).c_str() : "");
    };
    for (const Source &source : sources) {
        if (!source.absurd) continue;
        const UnitSlip *linear = nullptr, *angular = nullptr;
        for (const double doubt : {1.0, 0.5, 2.0}) { // the radius itself is a guess when it is not known
            if (linear == nullptr) linear = unit_slip('v', source.radius / (doubt * expected));
            if (angular == nullptr) angular = unit_slip('w', doubt * expected / source.radius);
            if (std::isfinite(known)) break;
        }
        const bool wheels = absurd == sources.size() && (linear == nullptr || (angular != nullptr && source.radius < expected));
        if (wheels) {
            const std::string column = grid_.wheel.empty() ? "" : grid_.wheel.front().speed_column;
            const bool angles = column.find(".angle_rad") != column.npos;
            add("unit", Severity::error, angles ? "wheel.angle_rad" : "wheel.speed_rad_s",
                describe(source) + (angular == nullptr ? ""
                                    : angles           ? ": the wheels' angles look like " + looks_like(*angular, column)
                                                       : ": the wheel speeds look like " + looks_like(*angular, column)),
                angular == nullptr ? "check the units of both"
                                   : say("multiply all wheel %s by %.6g", angles ? "angles" : "speeds", 1 / angular->factor),
                source.radius);
            return;
        }
        add("unit", Severity::error, source.name,
            describe(source) + (linear != nullptr ? std::string(": it looks like ") + linear->written : ""),
            linear != nullptr ? say("multiply it by %.6g", 1 / linear->factor) : "check its unit", source.radius);
    }
}

// Turns of a second each, by the gyro and by the camera's heading, less the gyro's offset: what they differ by is a scale. Slower than the
// noise of either, faster than a gyro drifts.
void Motion::gyro_turns_as_far() {
    constexpr double least = 0.03; // [1] a calibrated gyro is within a hundredth
    const auto second = static_cast<std::size_t>(std::lround(1 / step_s));
    const std::vector<double> rate = smooth(grid_.gyro, 5); // as the camera's
    std::vector<double> gyro, camera;
    for (std::size_t k = 0; k + second <= grid_.count; k += second) {
        double by_gyro = 0, by_camera = 0;
        for (std::size_t i = k; i < k + second; ++i) by_gyro += rate[i] * step_s, by_camera += grid_.camera_yaw_rate[i] * step_s;
        gyro.push_back(by_gyro), camera.push_back(by_camera);
    }
    const Fit line = fit(gyro, camera, std::vector<double>(gyro.size(), 1.0));
    if (!line.good || gyro.size() < 20 || !(line.rms < 0.2 * line.y_rms)) return;
    const double off = std::fabs(line.a - 1);
    if (off > least && off > 2 * line.error_a)
        add("scale", Severity::warning, "imu.gyro_z_rad_s", say("the gyro turns %.3g times as far as the camera's heading", line.a),
            "calibrate the gyro, or the camera's heading: the lab would take it for another sensor's error", line.a);
}

void Motion::yaw() {
    if (grid_.gyro.empty()) return;
    const double fastest = std::max(std::fabs(quantile(grid_.gyro, 0.01)), std::fabs(quantile(grid_.gyro, 0.99)));
    std::vector<double> apart(grid_.count, not_known); // right minus left; without a model 1, 3 and 0, 2
    const bool known = knows_sides(grid_, machine_);
    const bool sides = (known || grid_.wheel.size() == 4) &&
                       std::none_of(grid_.wheel.begin(), grid_.wheel.end(), [](const Wheel &wheel) { return wheel.speed.empty(); });
    const auto side = [&](std::size_t i) {
        return known ? (left_of(grid_, machine_, i) > 0) - (left_of(grid_, machine_, i) < 0) : i % 2 == 0 ? 1 : -1;
    };
    int left = 0, right = 0;
    for (std::size_t i = 0; i < grid_.wheel.size(); ++i) left += side(i) > 0, right += side(i) < 0;
    const bool two_sides = sides && left > 0 && right > 0;
    for (std::size_t k = 0; two_sides && k < grid_.count; ++k) {
        apart[k] = 0;
        for (std::size_t i = 0; i < grid_.wheel.size(); ++i)
            if (side(i) != 0) apart[k] -= side(i) * grid_.wheel[i].speed[k] / (side(i) > 0 ? left : right);
    }
    // Driven straight ahead a side turns faster than the other where it slips more, and the machine turns towards it.
    const bool turns = quantile(without_sign(smooth(apart, 5)), 0.97) > least_turn * quantile(without_sign(grid_.mean_speed), 0.97);
    const double with_wheels =
        two_sides && turns && machine_.wheels_point_forward && !wheels_blamed() ? correlation(smooth(grid_.gyro, 5), smooth(apart, 5)) : 0;
    if (!grid_.camera_yaw_rate.empty() && !blamed("camera.yaw")) {
        const std::vector<double> gyro = smooth(grid_.gyro, 5);
        const Fit line = fit(gyro, grid_.camera_yaw_rate);
        const double alike = correlation(gyro, grid_.camera_yaw_rate);
        if (line.good && std::fabs(alike) > 0.7) {
            const UnitSlip *gyro_unit = unit_slip('w', std::fabs(line.a)), *yaw_unit = unit_slip('w', 1 / std::fabs(line.a));
            if (gyro_unit != nullptr) {
                add("unit", Severity::error, "imu.gyro_z_rad_s",
                    say("the gyro reads %.3g times the camera's yaw rate: it looks like %s", line.a, gyro_unit->written),
                    say("multiply it by %.6g", 1 / gyro_unit->factor), line.a);
            } else if (yaw_unit != nullptr) {
                add("unit", Severity::error, "camera.yaw_rad",
                    say("the camera's yaw rate is %.3g times the gyro's: it looks like %s", 1 / line.a,
                        yaw_unit->factor > 50 ? "degrees" : yaw_unit->written),
                    say("multiply it by %.6g", 1 / yaw_unit->factor), 1 / line.a);
            } else if (line.a < 0) {
                const bool gyro_wrong = heading_fits_ || with_wheels < -0.5;
                add("sign", Severity::error, gyro_wrong ? "imu.gyro_z_rad_s" : "camera.yaw_rad",
                    say("gyro and camera turn in opposite directions (slope %.3g)", line.a),
                    "turn its sign round: a turn to the left is positive", line.a);
            } else if (std::fabs(alike) > 0.9 && (line.a < 0.7 || line.a > 1.4)) {
                const bool gross = line.a < 0.5 || line.a > 2;
                add("scale", gross ? Severity::error : Severity::warning, "imu.gyro_z_rad_s",
                    say("the gyro reads %.3g times the camera's yaw rate", line.a), "calibrate the gyro", line.a);
            } else {
                gyro_turns_as_far();
            }
            if (line.a > 0 && with_wheels < -0.9) { // on a steep side slope, gravity alone was seen to reach -0.8
                add("swapped_wheels", Severity::error, "wheel.speed_rad_s",
                    say("gyro and camera agree, but the wheels turn the other way (correlation %.2f): left and right are exchanged",
                        with_wheels),
                    known ? "exchange their columns, or mend y_m in the model" : "wheels 0 and 2 are left, 1 and 3 right", with_wheels);
            }
            return;
        }
    }
    if (fastest > 20) { // [rad/s] assumed: three turns a second
        add("unit", Severity::error, "imu.gyro_z_rad_s", say("the gyro reaches %.4g rad/s: it looks like deg/s", fastest),
            "multiply it by 0.0174533", fastest);
        return;
    }
    if (std::fabs(with_wheels) < 0.7) return;
    const Fit line = fit(smooth(grid_.gyro, 5), smooth(apart, 5));
    if (line.a < 0) {
        add("sign", Severity::error, "imu.gyro_z_rad_s",
            say("the gyro turns against the wheels (correlation %.2f): its sign is wrong, or left and right wheels are exchanged",
                with_wheels),
            "turn its sign round: a turn to the left is positive", with_wheels);
    } else if (line.a > 2 && !grid_.speed_is_guessed) { // wheel radius over track is below 1 on any rover
        add("unit", Severity::error, "imu.gyro_z_rad_s",
            say("the gyro reads %.3g times the wheels' difference in speed: it looks like deg/s", line.a), "multiply it by 0.0174533",
            line.a);
    }
}

void Motion::accel() {
    if (grid_.accel.empty()) return;
    const double middle = quantile(grid_.accel, 0.5);
    if (std::fabs(middle) > 4.2) { // [m/s^2] a slope of 25 degrees the whole drive long: loose soil is not steeper
        add("axis", Severity::error, "imu.accel_x_m_s2", say("'imu.accel_x_m_s2' stands at %.3g m/s^2: gravity is in it", middle),
            "log the longitudinal axis; take the tilt of the sensor's mounting out", middle);
        return;
    }
    const bool camera = !grid_.camera_forward.empty() && heading_fits_ && !blamed("camera");
    const double radius =
        std::isfinite(machine_.wheel_radius_m) && !grid_.speed_is_guessed ? machine_.wheel_radius_m : grid_.effective_radius_m;
    if (!camera && (!std::isfinite(radius) || blamed("wheel.speed") || wheels_blamed() || !machine_.wheels_point_forward)) return;
    std::vector<double> reference = slope(camera ? grid_.camera_forward : smooth(grid_.mean_speed, 5), 5),
                        measured = smooth(smooth(grid_.accel, 5), 5);
    for (double &v : reference) v *= camera ? 1.0 : radius;
    for (double &v : measured) v -= middle;
    const double alike = correlation(measured, reference);
    const Fit line = fit(measured, reference);
    if (!line.good || std::fabs(alike) < 0.6) return;
    const UnitSlip *slip = unit_slip('a', std::fabs(line.a));
    if (slip != nullptr && camera) {
        add("unit", Severity::error, "imu.accel_x_m_s2",
            say("the accelerometer reads %.3g of the acceleration that the camera sees: it looks like %s", line.a, slip->written),
            say("multiply it by %.6g", 1 / slip->factor), line.a);
    } else if (line.a < 0 && (line.a > -0.5 || alike > -0.75)) {
        return; // wheels that lock and spin swing against the body
    } else if (line.a < 0) {
        add("sign", Severity::error, "imu.accel_x_m_s2",
            say("the accelerometer is negative when the machine speeds up (slope %.3g)", line.a), "turn its sign round (map: sign = -1)",
            line.a);
    } else if (slip != nullptr) {
        add("unit", Severity::error, "imu.accel_x_m_s2",
            say("the accelerometer reads %.3g of the wheels' acceleration: it looks like %s", line.a, slip->written),
            say("multiply it by %.6g", 1 / slip->factor), line.a);
    }
}

} // namespace

void check_motion(const Grid &grid, const Machine &machine, Findings &findings) { Motion(grid, machine, findings).run(); }

} // namespace traction::check
