// plan_operator.h - who asks for something: a scenario's drive plan as commands, and what the link loses of it.
#pragma once

#include "firmware/core/signals.h"
#include "sim/scenario/scenario.h"

#include <cstdint>

namespace traction::hal {

// The demand of the drive plan in the firmware's terms; age_ticks is 0.
command_t command_of(const sim::Demand &demand);

class PlanOperator {
  public:
    // `scenario` must outlive this object.
    explicit PlanOperator(const sim::Scenario &scenario) : scenario_(scenario) {}

    // The command in force in this tick. While the link is lost, the last one, growing older: call once a tick, in order.
    const command_t &command_at(std::uint32_t tick);

  private:
    const sim::Scenario &scenario_;
    command_t last_{};
};

} // namespace traction::hal
