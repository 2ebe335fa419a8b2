// fault_hal.h - a HAL that wraps a HAL and makes its sensors fail at scripted times. Works on raw counts, so on any HAL.
//
// The wrapped HAL is always read, and what it says is always passed on in the same tick: a dead sensor never stalls the loop.
#pragma once

#include "counts.h"

#include "hal/hal.h"
#include "sim/scenario/scenario.h"
#include "sim/sensors/fault.h"
#include "sim/sensors/random.h"

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

namespace traction::hal {

struct FaultScript {
    std::vector<sim::SensorFault> sensors;                   // camera faults are not the HAL's: it carries no camera
    std::vector<std::pair<double, double>> emergency_stop_s; // [from, to)
    std::vector<sim::MissedTicks> missed_ticks{};
};

class FaultHal {
  public:
    // `inner` must outlive this object. Noise is drawn from `seed`.
    FaultHal(const hal_t &inner, FaultScript script, const CountScale &scale, std::uint64_t seed);
    FaultHal(const FaultHal &) = delete;
    FaultHal &operator=(const FaultHal &) = delete;

    hal_t hal();
    const hal_t &inner() const { return inner_; }

  private:
    static constexpr std::size_t memory_ticks = 201; // longest delay: 2 s
    void apply(std::size_t index, const sim::SensorFault &fault, sensor_frame_t *frame);
    void apply_radar(std::size_t index, const sim::SensorFault &fault, sensor_frame_t *frame);
    void add_noise(std::uint32_t bit, double amount, sensor_frame_t *frame);
    void add(std::uint32_t bit, int axis, double amount, sensor_frame_t *frame);
    void lose_samples(double share, sensor_frame_t *frame);
    hal_result_t wait_tick();

    hal_t inner_;
    FaultScript script_;
    CountScale scale_;
    sim::Random random_;
    double t_s_ = 0;                       // of the tick that wait_tick gave last
    std::uint64_t waited_ = 0;             // ticks, the missed ones counted
    std::deque<sensor_frame_t> past_;      // as the inner HAL gave them, newest last
    std::deque<std::uint16_t> past_radar_; // samples likewise
    std::vector<bool> holding_;            // per fault: `held_` is filled
    std::vector<sensor_frame_t> held_;
    std::vector<std::size_t> missed_;                      // per entry of missed_ticks: how often it was carried out
    std::vector<std::array<double, WHEEL_COUNT>> slipped_; // per fault: pulses lost so far
};

} // namespace traction::hal
