#include "plan_operator.h"

namespace traction::hal {

command_t command_of(const sim::Demand &demand) {
    command_t command{};
    switch (demand.mode) {
    case sim::DriveMode::stop:
        command.mode = MODE_STOP;
        break;
    case sim::DriveMode::open_loop:
        command.mode = MODE_OPEN_LOOP;
        break;
    case sim::DriveMode::wheel_speed:
        command.mode = MODE_WHEEL_SPEED;
        break;
    case sim::DriveMode::platform_speed:
        command.mode = MODE_PLATFORM_SPEED;
        break;
    case sim::DriveMode::slip:
        command.mode = MODE_SLIP;
        break;
    case sim::DriveMode::soil_sweep:
        command.mode = MODE_SOIL_SWEEP;
        break;
    }
    command.platform_speed_m_s = static_cast<float>(demand.speed_m_s);
    command.yaw_rate_rad_s = static_cast<float>(demand.yaw_rate_rad_s);
    command.slip_ref = static_cast<float>(demand.slip);
    for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
        command.wheel_speed_rad_s[i] = static_cast<float>(demand.wheel_speed_rad_s[i]);
        command.duty[i] = static_cast<float>(demand.duty[i]);
        if (demand.slip_wheel[i]) command.slip_wheels = static_cast<std::uint8_t>(command.slip_wheels | 1u << i);
    }
    return command;
}

const command_t &PlanOperator::command_at(std::uint32_t tick) {
    const double t_s = tick / 100.0;
    bool lost = false;
    for (const auto &[from_s, to_s] : scenario_.command_losses) lost = lost || (t_s >= from_s && t_s < to_s);
    if (lost) {
        last_.age_ticks++;
    } else {
        last_ = command_of(sim::demand_at(scenario_.drive, t_s));
    }
    return last_;
}

} // namespace traction::hal
