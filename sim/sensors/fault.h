// fault.h - a sensor that fails at scripted times: what, how, when. hal/sim carries it out on the raw counts.
#pragma once

namespace traction::sim {

enum class FaultySensor { encoder, current, battery, accel, gyro, radar, camera };
enum class FaultKind {
    stuck,   // repeats its last value
    noisy,   // adds noise of standard deviation `amount` (SI unit of the sensor; pulses for an encoder, counts for the radar)
    dropped, // says nothing
    delayed, // says what it measured `amount` seconds ago
    timeout, // says nothing, and reading the devices ends with a time-out
};

struct SensorFault {
    FaultySensor sensor = FaultySensor::encoder;
    int wheel = -1; // encoder and current: which one; -1 all
    FaultKind kind = FaultKind::dropped;
    double from_s = 0, to_s = 0;
    double amount = 0;
};

} // namespace traction::sim
