// The rows of spoilt logs.
#include "spoil.h"
#include "tamper.h"

#include <algorithm>
#include <cstdint>

namespace traction::gate {

const std::vector<Row> &spoilt_logs() {
    using log::Log;
    static const std::vector<Row> rows = {
        {"speeds in rpm", [](Log &l) { scale_motion(l, "wheel", 30 / pi); }},
        {"speeds in deg/s", [](Log &l) { scale_motion(l, "wheel", 180 / pi); }},
        {"one speed in rpm", [](Log &l) { scale_motion(l, "wheel2", 30 / pi); }},
        {"one encoder negated", [](Log &l) { scale_motion(l, "wheel1", -1); }},
        {"all encoders negated", [](Log &l) { scale_motion(l, "wheel", -1); }},
        {"counts x 4", [](Log &l) { scale_motion(l, "wheel", 4); }},
        {"counts x 4 of one wheel", [](Log &l) { scale_motion(l, "wheel3", 4); }},
        {"counts halved", [](Log &l) { scale_motion(l, "wheel", 0.5); }},
        {"counts x 1.45", [](Log &l) { scale_motion(l, "wheel", 1.45); }},
        {"one motor mounted the other way", [](Log &l) { scale_motion(l, "wheel1", -1), scale(l, "wheel1", ".current_A", -1), scale(l, "wheel1", ".duty", -1); }},
        {"currents in mA", [](Log &l) { scale(l, "wheel", ".current_A", 1000); }},
        {"one current in mA", [](Log &l) { scale(l, "wheel3", ".current_A", 1000); }},
        {"one current negated", [](Log &l) { scale(l, "wheel1", ".current_A", -1); }},
        {"all currents negated", [](Log &l) { scale(l, "wheel", ".current_A", -1); }},
        {"currents as magnitudes", [](Log &l) { fold(l, "wheel", ".current_A"); }},
        {"one current as a magnitude", [](Log &l) { fold(l, "wheel2", ".current_A"); }},
        {"currents x 5", [](Log &l) { scale(l, "wheel", ".current_A", 5); }},
        {"currents / 5", [](Log &l) { scale(l, "wheel", ".current_A", 0.2); }},
        {"one current x 3", [](Log &l) { scale(l, "wheel0", ".current_A", 3); }},
        {"one current dead", [](Log &l) { scale(l, "wheel2", ".current_A", 0); }},
        {"one current stands for half the drive", [](Log &l) { hold(l, "wheel2", ".current_A", 20, 50); }},
        {"one encoder stands for a quarter of the drive",
         [](Log &l) {
             for (const char *column : motion_columns) hold(l, "wheel2", column, 20, 35);
         }},
        {"currents of two wheels exchanged", [](Log &l) { reorder(l, {".current_A"}, {3, 1, 2, 0}); }},
        {"currents round a ring", [](Log &l) { reorder(l, {".current_A"}, {1, 2, 3, 0}); }},
        {"duties of two wheels exchanged", [](Log &l) { reorder(l, {".duty"}, {2, 1, 0, 3}); }},
        {"duties round a ring", [](Log &l) { reorder(l, {".duty"}, {3, 0, 1, 2}); }},
        {"speeds of two wheels exchanged", [](Log &l) { reorder(l, {".speed_rad_s", ".angle_rad", ".encoder_count"}, {0, 2, 1, 3}); }},
        {"speeds round a ring", [](Log &l) { reorder(l, {".speed_rad_s", ".angle_rad", ".encoder_count"}, {2, 0, 3, 1}); }},
        {"left and right exchanged",
         [](Log &l) { reorder(l, {".speed_rad_s", ".angle_rad", ".encoder_count", ".current_A", ".duty"}, {1, 0, 3, 2}); }},
        {"duty in percent", [](Log &l) { scale(l, "wheel", ".duty", 100); }},
        {"duty of 8 bits", [](Log &l) { scale(l, "wheel", ".duty", 255); }},
        {"duties negated", [](Log &l) { scale(l, "wheel", ".duty", -1); }},
        {"one duty negated", [](Log &l) { scale(l, "wheel0", ".duty", -1); }},
        {"duties as magnitudes", [](Log &l) { fold(l, "wheel", ".duty"); }},
        {"battery in mV", [](Log &l) { scale(l, "battery", "_V", 1000); }},
        {"battery halved", [](Log &l) { scale(l, "battery", "_V", 0.5); }},
        {"battery doubled", [](Log &l) { scale(l, "battery", "_V", 2); }},
        {"battery negated", [](Log &l) { scale(l, "battery", "_V", -1); }},
        {"battery in kV", [](Log &l) { scale(l, "battery", "_V", 0.001); }},
        {"clock x 1.1", [](Log &l) { stretch(l, 1.1); }},
        {"clock x 0.8", [](Log &l) { stretch(l, 0.8); }},
        {"clock x 2", [](Log &l) { stretch(l, 2); }},
        {"times in ms", [](Log &l) { stretch(l, 1000); }},
        {"clock jumps by 7 s",
         [](Log &l) {
             for (log::Signal &s : l.signals)
                 for (double &t : s.t_s) t += t > 20 ? 7 : 0;
         }},
        {"currents 0.5 s late", [](Log &l) { late(l, "wheel", ".current_A", 0.5); }},
        {"duties 0.5 s late", [](Log &l) { late(l, "wheel", ".duty", 0.5); }},
        {"one current 0.7 s early", [](Log &l) { late(l, "wheel3", ".current_A", -0.7); }},
        {"wheels 1 s late",
         [](Log &l) {
             for (const char *column : motion_columns) late(l, "wheel", column, 1);
         }},
        {"camera 1.2 s late", [](Log &l) { late(l, "camera", "", 1.2); }},
        {"gyro in deg/s", [](Log &l) { scale(l, "imu.gyro_z", "_rad_s", 180 / pi); }},
        {"gyro negated", [](Log &l) { scale(l, "imu.gyro_z", "_rad_s", -1); }},
        {"gyro 1.2 s late", [](Log &l) { late(l, "imu.gyro_z", "_rad_s", 1.2); }},
        {"gyro clipped", [](Log &l) { clip(l, "imu.gyro_z", "_rad_s", 0.15); }},
        {"accelerometer in g", [](Log &l) { scale(l, "imu.accel_x", "_m_s2", 1 / 9.80665); }},
        {"accelerometer in mg", [](Log &l) { scale(l, "imu.accel_x", "_m_s2", 1000 / 9.80665); }},
        {"accelerometer negated", [](Log &l) { scale(l, "imu.accel_x", "_m_s2", -1); }},
        {"vertical acceleration logged",
         [](Log &l) {
             scale(l, "imu.accel_x", "_m_s2", 0.1);
             each(l, "imu.accel_x", "_m_s2", [](log::Signal &s) {
                 for (double &v : s.value) v += 9.81;
             });
         }},
        {"accelerometer dead", [](Log &l) { scale(l, "imu.accel_x", "_m_s2", 0); }},
        {"accelerometer backwards in time", [](Log &l) { reverse_values(l, "imu.accel_x", "_m_s2"); }},
        {"radar negated", [](Log &l) { scale(l, "radar.speed", "_m_s", -1); }},
        {"radar in cm/s", [](Log &l) { scale(l, "radar.speed", "_m_s", 100); }},
        {"radar in km/h", [](Log &l) { scale(l, "radar.speed", "_m_s", 3.6); }},
        {"radar backwards in time", [](Log &l) { reverse_values(l, "radar.speed", "_m_s"); }},
        {"camera in mm", [](Log &l) { scale(l, "camera", "_m", 1000); }},
        {"camera mirrored", [](Log &l) { scale(l, "camera.y", "_m", -1); }},
        {"camera's heading in degrees", [](Log &l) { scale(l, "camera.yaw", "_rad", 180 / pi); }},
        {"camera's heading turned by 1 rad",
         [](Log &l) {
             each(l, "camera.yaw", "_rad", [](log::Signal &s) {
                 for (double &v : s.value) v += 1;
             });
         }},
        {"camera's heading negated", [](Log &l) { scale(l, "camera.yaw", "_rad", -1); }},
        {"camera stands for half the drive",
         [](Log &l) { hold(l, "camera", "_m", 20, 50), hold(l, "camera", "_rad", 20, 50); }},
        {"a third of the rows lost",
         [](Log &l) { keep_rows(l, [](double t) { return (static_cast<std::uint64_t>(std::llround(t * 100)) * 2654435761U >> 7U) % 10 > 2; }); }},
        {"one row", [](Log &l) { keep_rows(l, [](double t) { return t >= 30 && t < 30.005; }); }},
        {"a third of a second", [](Log &l) { keep_rows(l, [](double t) { return t >= 30 && t < 30.3; }); }},
        {"standing still", [](Log &l) { keep_rows(l, [](double t) { return t < 1.5; }); }},
        {"currents drowned in noise", [](Log &l) { noise(l, "wheel", ".current_A", 200); }},
        {"everything drowned in noise",
         [](Log &l) {
             noise(l, "wheel", ".current_A", 200), noise(l, "imu", "", 400), noise(l, "camera", "_m", 20), noise(l, "radar.speed", "_m_s", 100);
         }},
        {"currents clipped", [](Log &l) { clip(l, "wheel", ".current_A", 0.25); }},
        {"angles start again with every turn",
         [](Log &l) { wrap(l, ".angle_rad", 2 * pi), wrap(l, ".encoder_count", 6000), erase(l, "wheel", ".speed_rad_s"); }},
        {"counters of 12 bits", [](Log &l) { wrap(l, ".encoder_count", 4096), wrap(l, ".angle_rad", 4.29), erase(l, "wheel", ".speed_rad_s"); }},
        {"counters reset half-way",
         [](Log &l) {
             for (const char *tail : {".encoder_count", ".angle_rad"})
                 each(l, "wheel", tail, [](log::Signal &s) {
                     const auto half = s.value.size() / 2;
                     const double at = s.value[half] + (ends(s.name, "count") ? 40000 : 42);
                     for (std::size_t i = half; i < s.value.size(); ++i) s.value[i] -= at;
                 });
             erase(l, "wheel", ".speed_rad_s");
         }},
        {"currents backwards in time", [](Log &l) { reverse_values(l, "wheel", ".current_A"); }},
        {"duties backwards in time", [](Log &l) { reverse_values(l, "wheel", ".duty"); }},
        {"wheels backwards in time",
         [](Log &l) {
             for (const char *column : motion_columns) reverse_values(l, "wheel", column);
         }},
        {"everything backwards in time", [](Log &l) { reverse_values(l, "", ""); }},
        // units
        {"speeds in turns per second", [](Log &l) { scale_motion(l, "wheel", 0.5 / pi); }},
        {"speeds of the rim in m/s", [](Log &l) { scale_motion(l, "wheel", 0.057); }},
        {"speeds of the motor's shaft", [](Log &l) { scale_motion(l, "wheel", 19); }},
        {"counts x 2", [](Log &l) { scale_motion(l, "wheel", 2); }},
        {"counts x 1.7", [](Log &l) { scale_motion(l, "wheel", 1.7); }},
        {"counts x 0.6", [](Log &l) { scale_motion(l, "wheel", 0.6); }},
        {"every second count of one wheel", [](Log &l) { scale_motion(l, "wheel2", 0.5); }},
        {"battery x 1.7", [](Log &l) { scale(l, "battery", "_V", 1.7); }},
        {"battery's charge in percent",
         [](Log &l) {
             each(l, "battery", "_V", [](log::Signal &s) {
                 for (double &v : s.value) v = 100 - 10 * (7.2 - v);
             });
         }},
        {"battery x 0.1", [](Log &l) { scale(l, "battery", "_V", 0.1); }},
        {"currents in counts of a converter", [](Log &l) { scale(l, "wheel", ".current_A", 40), add(l, "wheel", ".current_A", 2048); }},
        {"currents x 10", [](Log &l) { scale(l, "wheel", ".current_A", 10); }},
        {"camera in cm", [](Log &l) { scale(l, "camera", "_m", 100); }},
        {"camera in pixels, y down", [](Log &l) { scale(l, "camera.x", "_m", 400), scale(l, "camera.y", "_m", -400); }},
        {"camera in feet", [](Log &l) { scale(l, "camera", "_m", 3.28084); }},
        {"radar in mph", [](Log &l) { scale(l, "radar.speed", "_m_s", 2.23694); }},
        {"radar in mm/s", [](Log &l) { scale(l, "radar.speed", "_m_s", 1000); }},
        {"gyro in mrad/s", [](Log &l) { scale(l, "imu.gyro_z", "_rad_s", 1000); }},
        {"gyro in deg/s and negated", [](Log &l) { scale(l, "imu.gyro_z", "_rad_s", -180 / pi); }},
        {"duty from 0 to 1, half of it is rest",
         [](Log &l) {
             each(l, "wheel", ".duty", [](log::Signal &s) {
                 for (double &v : s.value) v = 0.5 + 0.5 * v;
             });
         }},
        {"clock x 0.9", [](Log &l) { stretch(l, 0.9); }},
        {"clock x 1.25", [](Log &l) { stretch(l, 1.25); }},
        {"times in minutes", [](Log &l) { stretch(l, 1.0 / 60); }},
        {"times in us", [](Log &l) { stretch(l, 1e6); }},
        // signs
        {"speeds as magnitudes",
         [](Log &l) {
             each(l, "wheel", "", [](log::Signal &s) {
                 if (ends(s.name, ".speed_rad_s"))
                     for (double &v : s.value) v = std::fabs(v);
                 if (!ends(s.name, ".angle_rad") && !ends(s.name, ".encoder_count")) return;
                 double sum = s.value.empty() ? 0 : s.value.front(), before = sum; // a counter without direction
                 for (double &v : s.value) {
                     const double now = v;
                     sum += std::fabs(now - before), before = now, v = sum;
                 }
             });
         }},
        {"gyro as a magnitude", [](Log &l) { fold(l, "imu.gyro_z", "_rad_s"); }},
        {"left motors mounted the other way", [](Log &l) {
             for (const char *wheel : {"wheel0", "wheel2"}) scale_motion(l, wheel, -1), scale(l, wheel, ".current_A", -1), scale(l, wheel, ".duty", -1);
         }},
        {"left encoders negated", [](Log &l) { scale_motion(l, "wheel0", -1), scale_motion(l, "wheel2", -1); }},
        {"camera's x negated", [](Log &l) { scale(l, "camera.x", "_m", -1); }},
        // order
        {"one wheel's current copied to another", [](Log &l) { copy_column(l, "wheel0.current_A", "wheel2.current_A"); }},
        {"one wheel's current copied to all", [](Log &l) { for (const char *to : {"wheel1", "wheel2", "wheel3"}) copy_column(l, "wheel0.current_A", std::string(to) + ".current_A"); }},
        {"one wheel's speed copied to another", [](Log &l) { for (const char *tail : motion_columns) copy_column(l, std::string("wheel0") + tail, std::string("wheel3") + tail); }},
        {"one wheel's duty copied to another", [](Log &l) { copy_column(l, "wheel1.duty", "wheel0.duty"); }},
        {"currents and speeds of two wheels exchanged", [](Log &l) { reorder(l, {".current_A", ".speed_rad_s", ".angle_rad", ".encoder_count"}, {1, 0, 2, 3}); }},
        {"camera's x and y exchanged",
         [](Log &l) {
             const Log was = l;
             copy_column(l, "camera.y_m", "camera.x_m");
             if (const log::Signal *x = was.find("camera.x_m"))
                 each(l, "camera.y", "_m", [&](log::Signal &s) { s.t_s = x->t_s, s.value = x->value; });
         }},
        {"roll rate for yaw rate", [](Log &l) { scale(l, "imu.gyro_z", "_rad_s", 0), noise(l, "imu.gyro_z", "_rad_s", 0.02); }},
        {"sideways for longitudinal acceleration", [](Log &l) { scale(l, "imu.accel_x", "_m_s2", 0), noise(l, "imu.accel_x", "_m_s2", 0.1); }},
        {"speeds for duties",
         [](Log &l) {
             const Log was = l;
             for (int i = 0; i < 4; ++i) {
                 const std::string wheel = "wheel" + std::to_string(i);
                 for (const char *tail : {".speed_rad_s", ".set_speed_rad_s"})
                     if (was.find(wheel + tail) != nullptr) {
                         copy_column(l, wheel + tail, wheel + ".duty");
                         break;
                     }
                 scale(l, wheel, ".duty", was.find(wheel + ".speed_rad_s") != nullptr ? 0.05 : 1);
             }
             if (was.find("wheel0.speed_rad_s") == nullptr) scale(l, "wheel", ".duty", 100);
         }},
        // time
        {"currents of another part of the drive", [](Log &l) { roll(l, "wheel", ".current_A", 37); }},
        {"duties of another part of the drive", [](Log &l) { roll(l, "wheel", ".duty", 37); }},
        {"camera of another part of the drive", [](Log &l) { roll(l, "camera", "", 37); }},
        {"radar of another part of the drive", [](Log &l) { roll(l, "radar.speed", "_m_s", 37); }},
        {"imu of another part of the drive", [](Log &l) { roll(l, "imu", "", 37); }},
        {"camera backwards in time", [](Log &l) { reverse_values(l, "camera", ""); }},
        {"gyro backwards in time", [](Log &l) { reverse_values(l, "imu.gyro_z", "_rad_s"); }},
        {"a part of the drive pasted once more", [](Log &l) { paste_again(l, 20, 50); }},
        {"two logs pasted", [](Log &l) { paste_again(l, 0, 1e9); }},
        {"clock jumps by 0.6 s", [](Log &l) {
             for (log::Signal &s : l.signals)
                 for (double &t : s.t_s) t += t > 27 ? 0.6 : 0;
         }},
        {"clock drifts by 15 % from half-way", [](Log &l) {
             for (log::Signal &s : l.signals)
                 for (double &t : s.t_s) t += t > 60 ? 0.15 * (t - 60) : 0;
         }},
        {"stamps of whole buffers of 0.5 s", [](Log &l) { stamp_by_buffer(l, 0.5); }},
        {"everything but the wheels 1 s late", [](Log &l) { late(l, "imu", "", 1), late(l, "camera", "", 1), late(l, "radar.speed", "", 1); }},
        {"accelerometer 0.5 s late", [](Log &l) { late(l, "imu.accel_x", "_m_s2", 0.5); }},
        {"radar 1.5 s late", [](Log &l) { late(l, "radar.speed", "_m_s", 1.5); }},
        // sensors
        {"one current clipped", [](Log &l) { clip(l, "wheel1", ".current_A", 0.25); }},
        {"accelerometer clipped", [](Log &l) { clip(l, "imu.accel_x", "_m_s2", 0.3); }},
        {"speeds clipped", [](Log &l) {
             each(l, "wheel", "", [](log::Signal &s) {
                 if (ends(s.name, ".speed_rad_s"))
                     for (double &v : s.value) v = std::clamp(v, -3.0, 3.0);
             });
             for (const char *tail : {".angle_rad", ".encoder_count"})
                 each(l, "wheel", tail, [&](log::Signal &s) {
                     const double rate = ends(s.name, "count") ? 3 * 6000 / (2 * pi) : 3;
                     double sum = s.value.empty() ? 0 : s.value.front(), before = sum;
                     for (std::size_t i = 1; i < s.value.size(); ++i) {
                         const double now = s.value[i], most = rate * (s.t_s[i] - s.t_s[i - 1]);
                         sum += std::clamp(now - before, -most, most), before = now, s.value[i] = sum;
                     }
                 });
         }},
        {"radar stands", [](Log &l) { hold(l, "radar.speed", "_m_s", 10, 60); }},
        {"gyro dead", [](Log &l) { scale(l, "imu.gyro_z", "_rad_s", 0); }},
        {"radar dead", [](Log &l) { scale(l, "radar.speed", "_m_s", 0); }},
        {"accelerometer stands for half the drive", [](Log &l) { hold(l, "imu.accel_x", "_m_s2", 20, 60); }},
        {"gyro stands for half the drive", [](Log &l) { hold(l, "imu.gyro_z", "_rad_s", 20, 60); }},
        {"one duty stands for half the drive", [](Log &l) { hold(l, "wheel1", ".duty", 20, 60); }},
        {"all encoders stand",
         [](Log &l) {
             scale_motion(l, "wheel", 0);
             add(l, "wheel", ".speed_rad_s", 3);
         }},
        {"all speeds stand at one value, no voltage",
         [](Log &l) {
             if (l.find("wheel0.speed_rad_s") == nullptr) return;
             for (const char *tail : {".duty", ".set_speed_rad_s", ".command_speed_rad_s", ".encoder_count", ".angle_rad"}) erase(l, "wheel", tail);
             scale(l, "wheel", ".speed_rad_s", 0), add(l, "wheel", ".speed_rad_s", 3);
         }},
        {"one encoder dead", [](Log &l) { scale_motion(l, "wheel2", 0); }},
        {"currents through a filter of 2 s", [](Log &l) { low_pass(l, "wheel", ".current_A", 2); }},
        {"duties through a filter of 2 s", [](Log &l) { low_pass(l, "wheel", ".duty", 2); }},
        {"one current is a temperature", [](Log &l) {
             each(l, "wheel3", ".current_A", [](log::Signal &s) {
                 for (std::size_t i = 0; i < s.value.size(); ++i) s.value[i] = 20 + 10 * (1 - std::exp(-s.t_s[i] / 60));
             });
             noise(l, "wheel3", ".current_A", 0.05);
         }},
        {"accelerometer drowned in noise", [](Log &l) { noise(l, "imu.accel_x", "_m_s2", 50); }},
        {"camera drowned in noise", [](Log &l) { noise(l, "camera", "_m", 1); }},
        {"radar drowned in noise", [](Log &l) { noise(l, "radar.speed", "_m_s", 1); }},
        {"accelerometer tilted by 30 degrees", [](Log &l) { add(l, "imu.accel_x", "_m_s2", 4.9); }},
        {"currents with an offset of 3 A", [](Log &l) { add(l, "wheel", ".current_A", 3); }},
        {"battery low on every second sample", [](Log &l) {
             each(l, "battery", "_V", [](log::Signal &s) {
                 for (std::size_t i = 0; i < s.value.size(); i += 2) s.value[i] = 0;
             });
         }},
        {"spikes in one encoder", [](Log &l) {
             for (const char *tail : motion_columns)
                 each(l, "wheel1", tail, [](log::Signal &s) {
                     const double size = 20 * (*std::max_element(s.value.begin(), s.value.end()) + 1);
                     for (std::size_t i = 7; i < s.value.size(); i += 13) s.value[i] += i % 2 == 0 ? size : -size;
                 });
         }},
    };
    return rows;
}

} // namespace traction::gate
