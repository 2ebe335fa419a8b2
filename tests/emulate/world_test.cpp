// The world of the emulated board without the board: a computer that speaks CAN and lines to it at the times that the test gives it, as
// tractiond does through board_init, beside the simulation in process.
#include "firmware/app/trace_text.h"
#include "hal/can/can_master.h"
#include "hal/sim/plan_operator.h"
#include "host_tools/emulate/world.h"
#include "host_tools/loop/loop.h"
#include "host_tools/rover/rover.h"
#include "sim/scenario/scenario.h"
#include "sim/scenario/scenario_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

using namespace traction;

namespace {

constexpr std::uint64_t seed = 5;

sim::Scenario scenario_of(const std::string &top, const std::string &more, const std::string &soil = "sand") {
    return sim::parse_scenario(top + "duration_s = 3\n[ground]\nsoil = \"" + soil +
                                   "\"\n[[drive]]\nfor_s = 3\nmode = \"platform_speed\"\nspeed_m_s = 0.3\n" + more,
                               "world.toml");
}

struct Times {
    std::int64_t late_ns = 40000, order_ns = 600000; // SYNC after its tick, orders after their SYNC
    unsigned order_late_every = 0;                   // ticks; 3 ms more
    int silent_from = -1, silent_ticks = 0;          // the program hangs
};

// The rover's computer, as hal/linux has it: nodes on the bus, the stop on lines.
class Computer {
  public:
    Computer(emulate::World &world, const Times &times) : world_(world), times_(times) {}

    hal_t hal() {
        hal_t hal{};
        hal.context = this;
        hal.wait_tick = [](void *c) { return static_cast<Computer *>(c)->wait_tick(); };
        hal.read = [](void *c, sensor_frame_t *frame) { return static_cast<Computer *>(c)->read(frame); };
        hal.write = [](void *c, const actuator_frame_t *orders) { return static_cast<Computer *>(c)->write(*orders); };
        hal.safe_stop = [](void *) {};
        return hal;
    }

  private:
    emulate::WorldSays say(std::int64_t time_ns, const can_frame_t *frame) {
        emulate::BoardSays board;
        board.head.version = LOCKSTEP_VERSION;
        board.head.time_ns = time_ns;
        board.head.lines = enabled_ ? 1u << LOCKSTEP_LINE_MOTOR_ENABLE : 0u;
        if (frame != nullptr) {
            lockstep_frame_t sent{.id = frame->id, .length = frame->length, .zero = {}, .data = {}};
            std::memcpy(sent.data, frame->data, sizeof sent.data);
            board.frames.push_back(sent);
        }
        board.head.frames = static_cast<std::uint32_t>(board.frames.size());
        return world_.hear(board);
    }
    hal_result_t wait_tick() {
        if (static_cast<int>(tick_) == times_.silent_from) {
            for (int i = 0; i < times_.silent_ticks; i++, tick_++) (void)say(due_ns() + times_.late_ns, nullptr);
            elapsed_ += static_cast<std::uint32_t>(times_.silent_ticks);
        }
        sync_ns_ = due_ns() + (tick_ % 2 == 0 ? times_.late_ns : 0);
        can_frame_t sync;
        can_master_sync(&everything_, &master_, &sync);
        heard_ = say(sync_ns_, &sync);
        tick_++;
        for (const lockstep_frame_t &answer : heard_.frames) {
            can_frame_t frame{.id = answer.id, .length = answer.length, .data = {}};
            std::memcpy(frame.data, answer.data, sizeof frame.data);
            (void)can_master_receive(&everything_, &master_, &frame);
        }
        return heard_.head.stop != 0u ? HAL_END : HAL_OK;
    }
    hal_result_t read(sensor_frame_t *frame) {
        *frame = {};
        frame->tick = tick_ - 1;
        frame->elapsed_ticks = elapsed_;
        frame->time_us = tick_ * TICK_US; // as in process; the trace has no times
        frame->present = FRAME_TIME;
        elapsed_ = 1;
        can_master_take(&master_, frame);
        if ((heard_.head.lines >> LOCKSTEP_LINE_STOP_PRESENT & 1u) != 0u) {
            frame->emergency_stop = (heard_.head.lines >> LOCKSTEP_LINE_STOP & 1u) != 0u;
            frame->present |= FRAME_EMERGENCY_STOP;
        }
        return HAL_OK;
    }
    hal_result_t write(const actuator_frame_t &actuator) {
        enabled_ = actuator.drive != DRIVE_OFF;
        can_frame_t orders[WHEEL_COUNT];
        can_master_orders(&actuator, orders);
        const bool late = times_.order_late_every != 0 && tick_ % times_.order_late_every == 0;
        for (const can_frame_t &order : orders) (void)say(sync_ns_ + times_.order_ns + (late ? 3000000 : 0), &order);
        return HAL_OK;
    }
    std::int64_t due_ns() const { return 1000000000 + std::int64_t{TICK_US} * 1000 * tick_; }

    emulate::World &world_;
    Times times_;
    can_master_config_t everything_{true, true, false};
    can_master_state_t master_{};
    emulate::WorldSays heard_;
    std::uint32_t tick_ = 0, elapsed_ = 1;
    std::int64_t sync_ns_ = 0;
    bool enabled_ = false;
};

struct Traces {
    std::vector<std::string> lines;
    std::vector<drive_state_t> drives;
    std::uint32_t faults = 0;
};

class Recording : public Link {
  public:
    explicit Recording(const sim::Scenario &scenario) : plan_(scenario) {}
    void command(const sensor_frame_t &frame, command_t &command) override { command = plan_.command_at(frame.tick); }
    void log(const sensor_frame_t &, const command_t &, const trace_t &trace) override {
        char line[TRACE_TEXT];
        trace_text(&trace, line);
        traces.lines.emplace_back(line);
        traces.faults |= trace.faults;
        traces.drives.push_back(trace.actuator.drive);
    }
    Traces traces;

  private:
    hal::PlanOperator plan_;
};

Traces on_board(const sim::Scenario &scenario, const Times &times, emulate::Counts *counts = nullptr) {
    emulate::World world(scenario, scenario.effects, seed, emulate::Sensors::can);
    Computer computer(world, times);
    Recording recording(scenario);
    (void)run_loop(computer.hal(), firmware_of(scenario), recording);
    if (counts != nullptr) *counts = world.counts();
    return recording.traces;
}

Traces in_process(const sim::Scenario &scenario, int order_ms = 0, std::vector<std::array<int, WHEEL_COUNT>> order_late_ms = {}) {
    const hal::SimHalConfig world = hal::world_of(scenario, scenario.effects, seed);
    auto bus = hal::make_can_bus({.faults = scenario.can_faults,
                                  .latency_ms = world.bus_latency_ms + order_ms,
                                  .seed = seed,
                                  .order_late_ms = std::move(order_late_ms),
                                  .stop_wired = true});
    hal::SimRover rover(scenario, scenario.effects, world, std::move(bus));
    Recording recording(scenario);
    (void)run_loop(rover.hal(), firmware_of(scenario), recording);
    return recording.traces;
}

const std::string stop = "[[fault]]\nwhat = \"emergency_stop\"\nfrom_s = 1.0\nto_s = 1.5\n";

std::string can(const std::string &how, const std::string &node, const std::string &more = "") {
    return "[[fault]]\nwhat = \"can\"\nhow = \"" + how + "\"\nnode = \"" + node + "\"\nfrom_s = 1.0\n" + more;
}

} // namespace

TEST(emulated_world, a_computer_that_talks_in_time_drives_as_the_simulation_does) {
    for (const char *soil : {"sand", "concrete"}) {
        const sim::Scenario scenario = scenario_of("", "", soil);
        emulate::Counts counts;
        const Traces board = on_board(scenario, {}, &counts);
        EXPECT_EQ(board.lines.size(), 300u);
        EXPECT_EQ(board.lines, in_process(scenario).lines) << soil;
        EXPECT_EQ(counts.unread, 0u);
        EXPECT_EQ(counts.frames_from, 301u + 4u * 300u); // the last SYNC is answered by the end
        EXPECT_EQ(counts.order_late_ms, (std::vector<std::array<int, WHEEL_COUNT>>(300)));
    }
}

TEST(emulated_world, an_order_that_is_out_after_a_millisecond_acts_a_millisecond_later) {
    const sim::Scenario scenario = scenario_of("", "");
    Times times;
    times.order_ns = 1400000;
    const Traces board = on_board(scenario, times);
    EXPECT_EQ(board.lines, in_process(scenario, 1).lines);
    EXPECT_NE(board.lines, in_process(scenario, 0).lines);
}

// a computer that waits 3 ms for a node that does not answer has its orders out late in that tick, and not in the next
TEST(emulated_world, orders_that_are_late_in_some_ticks_act_late_in_those) {
    const sim::Scenario scenario = scenario_of("", "");
    Times times;
    times.order_late_every = 7;
    emulate::Counts counts;
    const Traces board = on_board(scenario, times, &counts);
    EXPECT_EQ(counts.order_late_ms[6], (std::array<int, WHEEL_COUNT>{3, 3, 3, 3}));
    EXPECT_EQ(counts.order_late_ms[7], (std::array<int, WHEEL_COUNT>{}));
    EXPECT_EQ(board.lines, in_process(scenario, 0, counts.order_late_ms).lines);
    EXPECT_NE(board.lines, in_process(scenario).lines);
}

TEST(emulated_world, late_motors_are_as_late) {
    const sim::Scenario scenario = scenario_of("", "[[effect]]\nname = \"actuation_delay\"\ndelay_s = 0.027\n");
    EXPECT_EQ(on_board(scenario, {}).lines, in_process(scenario).lines);
}

TEST(emulated_world, the_stop_comes_by_its_line_and_stops_the_rover) {
    const sim::Scenario scenario = scenario_of("", stop);
    const Traces board = on_board(scenario, {});
    EXPECT_EQ(board.lines, in_process(scenario).lines);
    EXPECT_EQ(board.faults, static_cast<std::uint32_t>(FAULT_EMERGENCY_STOP));
    EXPECT_EQ(board.drives[90], DRIVE_ON);
    EXPECT_NE(board.drives[102], DRIVE_ON); // two ticks (fault_test)
    EXPECT_NE(board.drives[299], DRIVE_ON); // latched
}

TEST(emulated_world, faults_of_the_bus_are_those_of_the_simulation) {
    for (const std::string &fault :
         {can("lost", "all", "share = 0.1\n"), can("corrupted", "all", "share = 0.1\n"), can("late", "all", "share = 0.1\n"),
          can("duplicated", "all", "share = 1.0\n"), can("silent", "wheel2"), can("silent", "sensors")}) {
        const sim::Scenario scenario = scenario_of("bus = \"can\"\n", fault);
        EXPECT_EQ(on_board(scenario, {}).lines, in_process(scenario).lines) << fault;
    }
}

TEST(emulated_world, goes_on_while_the_program_hangs_and_bridges_let_go) {
    Times times;
    times.silent_from = 100;
    times.silent_ticks = 20;
    emulate::Counts counts;
    const Traces board = on_board(scenario_of("", ""), times, &counts);
    EXPECT_EQ(counts.unread, 20u);
    EXPECT_EQ(board.lines.size(), 280u);
    EXPECT_NE(board.faults & FAULT_MISSED_TICKS, 0u);
}

TEST(emulated_world, refuses_what_no_wire_carries) {
    for (const std::string &fault :
         {std::string("[[fault]]\nwhat = \"missed_ticks\"\nticks = 3\nfrom_s = 0.5\n"), can("bus_off", "computer"),
          std::string("[[fault]]\nwhat = \"sensor\"\nsensor = \"encoder\"\nwheel = 1\nhow = \"dropped\"\nfrom_s = 1.0\n")}) {
        const sim::Scenario scenario = scenario_of("bus = \"can\"\n", fault);
        EXPECT_THROW(emulate::World(scenario, {}, seed, emulate::Sensors::can), sim::ScenarioError) << fault;
    }
}

TEST(emulated_world, refuses_a_rover_that_its_nodes_cannot_drive_and_names_what) {
    for (const auto &[name, key] :
         {std::pair{"ackermann", "steering"}, std::pair{"two_wheels", "layout.wheels"}, std::pair{"two_motors", "layout.drives"}}) {
        const sim::Scenario scenario = sim::read_scenario(std::string(TRACTION_SOURCE_DIR "/scenarios/") + name + ".toml");
        for (const auto sensors : {emulate::Sensors::can, emulate::Sensors::iio}) {
            std::string said;
            try {
                emulate::World(scenario, {}, seed, sensors);
            } catch (const sim::ScenarioError &error) {
                said = error.what();
            }
            EXPECT_NE(said.find(key), std::string::npos) << name << ": " << said;
            EXPECT_NE(said.find("traction simulate"), std::string::npos) << "no way out told: " << said;
        }
    }
}
