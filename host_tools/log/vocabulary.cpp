#include "vocabulary.h"

#include <array>
#include <charconv>
#include <numbers>

namespace traction::log {

namespace {

constexpr std::array table{
    // wheels
    Quantity{"wheel<i>", "speed", "rad_s", Kind::measured, "angular speed at the wheel, positive drives forward"},
    Quantity{"wheel<i>", "angle", "rad", Kind::measured, "angle turned at the wheel, continuous (not wrapped)"},
    Quantity{"wheel<i>", "encoder", "count", Kind::raw, "cumulative encoder pulses"},
    Quantity{"wheel<i>", "current", "A", Kind::measured, "motor current, positive drives forward"},
    Quantity{"wheel<i>", "current", "count", Kind::raw, "current converter, offset binary, 12 bit"},
    Quantity{"wheel<i>", "duty", "", Kind::measured, "PWM rate written to the bridge, -1..1"},
    Quantity{"wheel<i>", "voltage", "V", Kind::measured,
             "mean voltage at the motor's terminals (where measured, instead of duty times battery)"},
    Quantity{"wheel<i>", "torque", "Nm", Kind::measured, "torque at the wheel's shaft from a torque sensor"},
    Quantity{"wheel<i>", "temperature", "degC", Kind::measured, "winding temperature"},
    Quantity{"wheel<i>", "set_speed", "rad_s", Kind::command, "reference of the wheel's speed loop"},
    Quantity{"wheel<i>", "slip", "", Kind::estimate, "slip, (1), -1..1; on a bench that imposes it, the imposed slip"},
    Quantity{"wheel<i>", "motor_torque", "Nm", Kind::estimate, "KG times current, at the wheel"},
    Quantity{"wheel<i>", "traction", "N", Kind::estimate, "traction estimated by (19)"},
    Quantity{"wheel<i>", "slip_std", "", Kind::estimate, "standard deviation of the slip; a wrong radius is not in it"},
    Quantity{"wheel<i>", "slip_valid", "", Kind::estimate,
             "1 where the wheel is fast enough, and its slip known to 0.25, for slip to mean something"},
    Quantity{"wheel<i>", "saturated", "", Kind::estimate, "1 while the controller wants more duty than a limit leaves it"},
    Quantity{"wheel<i>", "encoder_refused", "", Kind::estimate, "1 while the speed is the motor circuit's, the encoder's being impossible"},
    Quantity{"wheel<i>", "bridge_status", "", Kind::raw, "what the bridge says of itself, BRIDGE_* bits as one number; 0: it works"},
    Quantity{"wheel<i>", "drawbar_pull", "N", Kind::measured, "net pull on the rig's force sensor, positive forward"},
    Quantity{"wheel<i>", "side_force", "N", Kind::measured, "force along the wheel's axle on the rig's sensor"},
    Quantity{"wheel<i>", "normal", "N", Kind::measured, "vertical load, positive presses the wheel down"},
    Quantity{"wheel<i>", "sinkage", "m", Kind::measured, "depth of the rim below the free surface, positive down"},
    Quantity{"wheel<i>", "slip_angle", "rad", Kind::measured, "angle between wheel heading and travel"},
    // rover
    Quantity{"battery", "voltage", "V", Kind::measured, "at the terminals, under load"},
    Quantity{"battery", "voltage", "count", Kind::raw, "battery converter, 12 bit"},
    Quantity{"radar", "adc", "count", Kind::raw, "radar converter, offset binary, 10 bit"},
    Quantity{"radar", "speed", "m_s", Kind::measured, "ground speed from the Doppler peak (mean over the window that ends here)"},
    Quantity{"imu", "accel_x", "m_s2", Kind::measured, "longitudinal specific force, forward positive"},
    Quantity{"imu", "accel_y", "count", Kind::raw, "accelerometer to the left, two's complement"},
    Quantity{"imu", "accel_z", "count", Kind::raw, "accelerometer up, two's complement"},
    Quantity{"imu", "gyro_x", "count", Kind::raw, "gyro about x (roll), two's complement"},
    Quantity{"imu", "gyro_y", "count", Kind::raw, "gyro about y (pitch), two's complement"},
    Quantity{"imu", "accel_y", "m_s2", Kind::measured, "lateral specific force, left positive"},
    Quantity{"imu", "accel_z", "m_s2", Kind::measured, "vertical specific force, up positive (about 9.81 at rest)"},
    Quantity{"imu", "accel_x", "count", Kind::raw, "accelerometer, two's complement"},
    Quantity{"imu", "gyro_z", "rad_s", Kind::measured, "yaw rate, left turn positive"},
    Quantity{"imu", "gyro_z", "count", Kind::raw, "gyro, two's complement"},
    Quantity{"camera", "x", "m", Kind::measured, "position of the rover over ground, world frame"},
    Quantity{"camera", "y", "m", Kind::measured, "position of the rover over ground, world frame"},
    Quantity{"camera", "yaw", "rad", Kind::measured, "heading in the world frame, left turn positive"},
    Quantity{"estimate", "speed", "m_s", Kind::estimate, "fused ground speed (13)-(14)"},
    Quantity{"estimate", "speed_std", "m_s", Kind::estimate, "its standard deviation as the filter believes it"},
    Quantity{"estimate", "accel_bias", "m_s2", Kind::estimate, "accelerometer bias as the filter believes it"},
    Quantity{"estimate", "standstill", "", Kind::estimate, "1 while the firmware believes the rover stands"},
    Quantity{"control", "mode", "", Kind::estimate, "mode in force, number of control_mode_t"},
    Quantity{"control", "faults", "", Kind::estimate, "latched fault_t bits, as one number"},
    // commands
    Quantity{"command", "mode", "", Kind::command, "mode asked for, number of control_mode_t"},
    Quantity{"command", "speed", "m_s", Kind::command, "platform speed asked for, forward"},
    Quantity{"command", "speed_y", "m_s", Kind::command, "platform speed asked for, to the left (machines that can)"},
    Quantity{"wheel<i>", "command_speed", "rad_s", Kind::command, "wheel speed asked for, in wheel speed mode"},
    Quantity{"wheel<i>", "command_duty", "", Kind::command, "duty asked for, in open loop mode"},
    Quantity{"command", "yaw_rate", "rad_s", Kind::command, "yaw rate asked for"},
    Quantity{"command", "slip", "", Kind::command, "slip asked for"},
    Quantity{"frame", "present", "", Kind::raw, "which parts of the sensor frame were fresh, FRAME_* bits as one number"},
    Quantity{"frame", "time", "us", Kind::raw, "monotonic clock when the encoders were latched, wraps at 2^32"},
    Quantity{"frame", "elapsed_ticks", "", Kind::raw, "ticks of 10 ms since the frame before; an empty cell is 1"},
    Quantity{"frame", "radar_sequence", "", Kind::raw, "number of the frame's first radar sample among all conversions, wraps"},
    Quantity{"frame", "radar_samples", "", Kind::raw, "radar samples in the frame"},
    Quantity{"frame", "emergency_stop", "", Kind::raw, "1 while the emergency-stop line is active"},
    Quantity{"actuator", "drive", "", Kind::command,
             "what the bridges were told, number of drive_state_t: 0 off, 1 coast, 2 brake, 3 drive"},
    Quantity{"actuator", "curvature", "1_m", Kind::command, "order of the steering servo: curvature of the path, left turn positive"},
    Quantity{"control", "fault_wheels", "", Kind::estimate, "bit i: a latched fault is wheel i's"},
    Quantity{"actuator", "motor_enable", "", Kind::command,
             "1 while the bridges drive or brake the motors, 0 while they are released and no current flows"},
    // benches
    Quantity{"carriage", "speed", "m_s", Kind::measured, "speed of the carriage that leads a single wheel"},
    Quantity{"carriage", "x", "m", Kind::measured, "position of that carriage"},
    Quantity{"plate", "sinkage", "m", Kind::measured, "depth of a pressed plate, positive down"},
    Quantity{"plate", "normal", "N", Kind::measured, "load on a pressed plate, positive presses down"},
    // truth: the simulator's; `truth.` before an object or a quantity of its own
    Quantity{"truth", "speed", "m_s", Kind::truth, "true speed of the body along x"},
    Quantity{"truth", "x", "m", Kind::truth, "true position"},
    Quantity{"truth", "y", "m", Kind::truth, "true position"},
    Quantity{"truth", "yaw", "rad", Kind::truth, "true heading, continuous"},
};

struct Conversion {
    std::string_view written, si;
    double factor;
};
constexpr double rad_per_deg = std::numbers::pi / 180;
constexpr std::array conversions{
    Conversion{"rpm", "rad_s", std::numbers::pi / 30},
    Conversion{"deg_s", "rad_s", rad_per_deg},
    Conversion{"rev_s", "rad_s", 2 * std::numbers::pi},
    Conversion{"deg", "rad", rad_per_deg},
    Conversion{"mA", "A", 1e-3},
    Conversion{"mV", "V", 1e-3},
    Conversion{"mm", "m", 1e-3},
    Conversion{"cm", "m", 1e-2},
    Conversion{"mm_s", "m_s", 1e-3},
    Conversion{"cm_s", "m_s", 1e-2},
    Conversion{"km_h", "m_s", 1 / 3.6},
    Conversion{"g", "m_s2", 9.80665},
    Conversion{"mg", "m_s2", 9.80665e-3},
    Conversion{"mps", "m_s", 1.0},
    Conversion{"radps", "rad_s", 1.0},
    Conversion{"mNm", "Nm", 1e-3},
    Conversion{"percent", "", 1e-2},
    Conversion{"kN", "N", 1e3},
};

bool same_object(std::string_view object, std::string_view pattern) {
    if (pattern != "wheel<i>") return object == pattern;
    return object.size() > 5 && object.substr(0, 5) == "wheel" && object.find_first_not_of("0123456789", 5) == std::string_view::npos;
}

} // namespace

std::span<const Quantity> vocabulary() { return table; }

const Quantity *find_quantity(std::string_view name) {
    const std::size_t dot = name.find('.');
    if (dot == std::string_view::npos) return nullptr;
    const std::string_view object = name.substr(0, dot), rest = name.substr(dot + 1);
    for (const Quantity &entry : table) {
        if (!same_object(object, entry.object)) continue;
        if (rest.substr(0, entry.quantity.size()) != entry.quantity) continue;
        const std::string_view suffix = rest.substr(entry.quantity.size());
        if (entry.unit.empty() ? suffix.empty()
                               : suffix.size() == entry.unit.size() + 1 && suffix[0] == '_' && suffix.substr(1) == entry.unit)
            return &entry;
    }
    return nullptr;
}

int wheel_of(std::string_view name) {
    const std::size_t dot = name.find('.');
    if (dot == std::string_view::npos || dot > 8 || !same_object(name.substr(0, dot), "wheel<i>")) return -1;
    int index = -1;
    std::from_chars(name.data() + 5, name.data() + dot, index);
    return index;
}

bool convert_unit(std::string_view name, std::string &si_name, double &factor) {
    if (find_quantity(name) != nullptr) return false;
    for (const Conversion &conversion : conversions) {
        if (name.size() <= conversion.written.size() + 1) continue;
        const std::size_t at = name.size() - conversion.written.size();
        if (name.substr(at) != conversion.written || name[at - 1] != '_') continue;
        std::string candidate(name.substr(0, conversion.si.empty() ? at - 1 : at));
        candidate += conversion.si;
        if (find_quantity(candidate) == nullptr) continue;
        si_name = candidate;
        factor = conversion.factor;
        return true;
    }
    return false;
}

std::string_view kind_name(Kind kind) {
    switch (kind) {
    case Kind::raw:
        return "raw";
    case Kind::measured:
        return "measured";
    case Kind::estimate:
        return "estimate";
    case Kind::command:
        return "command";
    case Kind::truth:
        return "truth";
    }
    return "";
}

} // namespace traction::log
