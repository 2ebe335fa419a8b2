// fault.h - a sensor that fails at scripted times: what, how, when. hal/sim carries it out on the raw counts.
#pragma once

#include <cstddef>

namespace traction::sim {

enum class FaultySensor { encoder, current, battery, accel, gyro, radar, camera, bridge, emergency_stop };
inline constexpr std::size_t faulty_sensor_count = static_cast<std::size_t>(FaultySensor::emergency_stop) + 1; // the last one
enum class FaultKind {
    stuck,    // repeats its last value
    noisy,    // adds noise of standard deviation `amount` (SI unit of the sensor; pulses for an encoder, counts for the radar)
    dropped,  // says nothing
    delayed,  // says what it measured `amount` seconds ago
    timeout,  // says nothing, and reading the devices ends with a time-out
    offset,   // reads `amount` too much (SI unit; pulses for an encoder, counts for the radar)
    drift,    // reads `amount` more with every second
    spike,    // reads `amount` too much in the first tick, and right again after it
    dead,     // radar: no echo, and noise of `amount` counts
    slipping, // encoder: loses `amount` of its pulses, 0..1
    lost,     // radar: each sample is lost with probability `amount`; a frame gives what follows the last loss in it, or precedes the first
};
inline constexpr std::size_t fault_kind_count = static_cast<std::size_t>(FaultKind::lost) + 1; // the last one

struct SensorFault {
    FaultySensor sensor = FaultySensor::encoder;
    int wheel = -1; // encoder and current: which one; -1 all
    int axis = 0;   // accelerometer and gyro, of offset, drift and spike: 0 x, 1 y, 2 z
    FaultKind kind = FaultKind::dropped;
    double from_s = 0, to_s = 0;
    double amount = 0;
};

} // namespace traction::sim
