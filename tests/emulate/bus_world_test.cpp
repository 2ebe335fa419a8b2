// `traction simulate --can`: the rover's nodes on a bus, for a computer whose clock is its own. The bus is a socket pair here; on a
// kernel's vcan, with the real programs at both ends, tests/emulate/vcan.sh drives it.
#include "hal/can/can_master.h"
#include "hal/linux/linux_hal.h"
#include "host_tools/bus_world/bus_world.h"
#include "sim/scenario/scenario.h"
#include "sim/scenario/scenario_error.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <stdexcept>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include <sys/socket.h>
#include <unistd.h>

using namespace traction;
using bus_world::BusWorld;
using bus_world::SyncClock;

namespace {

constexpr std::int64_t tick_ns = std::int64_t{TICK_US} * 1000, ms = 1000000;

sim::Scenario scenario_of(const std::string &more = "") {
    return sim::parse_scenario("duration_s = 60\n[ground]\nsoil = \"concrete\"\n[[drive]]\nfor_s = 60\nmode = \"stop\"\n" + more,
                               "bus.toml");
}

// -most to most, the same each time.
struct Jitter {
    std::uint32_t state = 7;
    std::int64_t operator()(std::int64_t most_ns) {
        state = state * 1664525u + 1013904223u;
        return static_cast<std::int64_t>(state >> 8) % (2 * most_ns + 1) - most_ns;
    }
};

// A computer that sends SYNC when it is told to, and orders 0.6 ms later; what it heard.
std::vector<can_frame_t> heard_by_computer(BusWorld &world, const std::vector<std::int64_t> &sync_ns) {
    const can_master_config_t all{.wheels = true, .sensors = true, .emergency_stop = true};
    can_master_state_t master{};
    std::vector<can_frame_t> heard;
    std::uint8_t sequence = 0;
    for (const std::int64_t now_ns : sync_ns) {
        can_frame_t frame;
        can_master_sync(&all, &master, &frame);
        for (const can_frame_t &answer : world.hear(now_ns, &frame)) heard.push_back(answer);
        actuator_frame_t order{};
        order.drive = DRIVE_ON;
        order.sequence = ++sequence;
        for (std::int16_t &duty : order.duty_q15) duty = 9000;
        can_frame_t orders[WHEEL_COUNT];
        can_master_orders(&order, orders);
        for (const can_frame_t &one : orders) EXPECT_TRUE(world.hear(now_ns + 600000, &one).empty());
    }
    return heard;
}

std::array<int, 2> wire() {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()), 0);
    return ends;
}

} // namespace

TEST(sync_clock, counts_ticks_under_jitter_and_another_clocks_drift) {
    for (const double drift : {0.0, 1e-4, -1e-4, 1e-2, -1e-2}) { // of a quartz at most 1e-4; what its header claims
        SyncClock clock;
        Jitter jitter;
        for (std::int64_t k = 0; k < 20000; k++) {
            const std::int64_t now_ns =
                123456789 + static_cast<std::int64_t>(static_cast<double>(k * tick_ns) * (1 + drift)) + jitter(2 * ms);
            ASSERT_EQ(clock.sync(now_ns), k * tick_ns) << "drift " << drift;
            ASSERT_EQ(clock.at(now_ns + 3 * ms), k * tick_ns + 3 * ms);
        }
    }
}

TEST(sync_clock, a_tick_without_a_sync_passes_and_a_repeated_sync_is_none) {
    SyncClock clock;
    EXPECT_EQ(clock.at(5), 0);
    EXPECT_FALSE(clock.running());
    EXPECT_EQ(clock.sync(1000 * ms), 0);
    EXPECT_EQ(clock.sync(1010 * ms), tick_ns);
    EXPECT_EQ(clock.sync(1011 * ms), tick_ns);     // again
    EXPECT_EQ(clock.sync(1041 * ms), 4 * tick_ns); // two were lost
    EXPECT_EQ(clock.at(1000 * ms), 4 * tick_ns);   // never back
}

TEST(sync_clock, a_computer_that_starts_again_brings_a_phase_of_its_own) {
    SyncClock clock;
    std::int64_t now_ns = 0;
    for (int k = 0; k < 10; k++, now_ns += tick_ns) clock.sync(now_ns);
    now_ns += 100 * tick_ns + 4900000; // almost half a tick beside the old phase
    Jitter jitter;
    std::int64_t plant_ns = clock.sync(now_ns);
    for (int k = 0; k < 100; k++) {
        now_ns += tick_ns;
        const std::int64_t next_ns = clock.sync(now_ns + jitter(2 * ms));
        ASSERT_EQ(next_ns - plant_ns, tick_ns);
        plant_ns = next_ns;
    }
}

TEST(bus_world, when_the_computer_is_early_or_late_its_frames_do_not_show_it) {
    const sim::Scenario scenario = scenario_of();
    Jitter jitter;
    std::vector<std::int64_t> steady, shaken;
    for (std::int64_t k = 0; k < 600; k++) {
        steady.push_back(1 + k * tick_ns);
        shaken.push_back(777 + k * tick_ns + k * tick_ns / 200 + jitter(2 * ms)); // and 0.5 % slow: three ticks in all
    }
    BusWorld first(scenario, {}, 5), second(scenario, {}, 5);
    const std::vector<can_frame_t> a = heard_by_computer(first, steady), b = heard_by_computer(second, shaken);
    ASSERT_GT(a.size(), 600u * 7); // four wheels, three of the sensor node, and radar
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); i++) {
        ASSERT_EQ(a[i].id, b[i].id) << i;
        ASSERT_TRUE(std::equal(a[i].data, a[i].data + 8, b[i].data)) << i;
    }
    EXPECT_EQ(first.counts().unread + second.counts().unread, 0u);
    // the frames tell of a rover that drives: wheel 0's encoder, lower 16 bits of the first and the last
    const auto encoder = [](const can_frame_t &frame) { return frame.data[0] | frame.data[1] << 8; };
    std::vector<int> counts;
    for (const can_frame_t &frame : a)
        if (frame.id == CAN_WHEEL) counts.push_back(encoder(frame));
    EXPECT_NE(counts.front(), counts.back());
}

TEST(bus_world, the_plant_goes_on_when_the_computer_does_not) {
    const sim::Scenario scenario = scenario_of();
    BusWorld world(scenario, {}, 5);
    can_frame_t order{.id = CAN_ORDER, .length = 5, .data = {}};
    EXPECT_TRUE(world.hear(0, nullptr).empty());
    EXPECT_TRUE(world.hear(5 * ms, &order).empty()); // nobody has begun
    EXPECT_FALSE(world.begun());
    (void)heard_by_computer(world, {10 * ms, 20 * ms});
    EXPECT_EQ(world.counts().ticks, 2u);
    for (std::int64_t now_ns = 21 * ms; now_ns <= 1020 * ms; now_ns += ms) (void)world.hear(now_ns, nullptr);
    EXPECT_EQ(world.counts().ticks, 101u); // one second later, half a tick of it still forgiven
    EXPECT_EQ(world.counts().unread, 99u);
}

// hal/linux itself at the other end, in real time: how many ticks pass is the machine's business, that they drive is ours.
TEST(bus_world, answers_the_rovers_own_hal) {
    const sim::Scenario scenario = scenario_of();
    BusWorld world(scenario, {}, 5);
    const std::array<int, 2> ends = wire();
    std::atomic<bool> over{false};
    bus_world::Run run;
    std::thread nodes([&] {
        can_socket_t bus;
        can_socket_adopt(&bus, ends[1]);
        run = bus_world::answer(world, bus, "pair", {.stopped = [&] { return over.load(); }, .begun = {}, .after_second = {}});
        can_socket_close(&bus);
    });
    const std::string text = "[hardware]\nwheels = \"can\"\nsensors = \"can\"\nemergency_stop = \"can\"\ncan_interface = \"pair\"\n";
    hardware_t hardware;
    char message[HARDWARE_MESSAGE];
    EXPECT_TRUE(hardware_parse(text.data(), text.size(), "rover.toml", &hardware, message)) << message;
    linux_hal_t devices;
    linux_hal_begin(&devices, &hardware, "");
    can_socket_adopt(&devices.bus, ends[0]);
    const hal_t hal = linux_hal(&devices);
    EXPECT_EQ(hal.open(hal.context), HAL_OK) << devices.trouble;
    sensor_frame_t frame{};
    std::uint32_t seen = 0;
    std::int32_t first = 0, last = 0;
    bool any = false, good = true;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (std::uint32_t k = 1; good && last - first < 1000 && std::chrono::steady_clock::now() < end; k++) {
        good = hal.wait_tick(hal.context) == HAL_OK && hal.read(hal.context, &frame) != HAL_ERR_IO; // a node that is late is no loss
        seen |= frame.present;
        if ((frame.present & FRAME_ENCODER_0) != 0u) {
            first = any ? first : frame.encoder_count[0];
            last = frame.encoder_count[0];
            any = true;
        }
        actuator_frame_t order{};
        order.drive = DRIVE_ON;
        order.sequence = k;
        for (std::int16_t &duty : order.duty_q15) duty = 12000;
        good = good && hal.write(hal.context, &order) == HAL_OK;
    }
    EXPECT_TRUE(good) << devices.trouble;
    over = true;
    nodes.join();
    hal.close(hal.context);
    EXPECT_GE(last - first, 1000); // a fifth of a turn of the wheel or more
    EXPECT_EQ(seen & FRAME_ALL, static_cast<std::uint32_t>(FRAME_ALL));
    EXPECT_TRUE(run.interrupted);
    EXPECT_GT(run.counts.frames_to, 0u);
    EXPECT_EQ(run.lost, 0u);
}

TEST(bus_world, what_cannot_be_had_is_told) {
    EXPECT_THROW(BusWorld(scenario_of("[[fault]]\nwhat = \"missed_ticks\"\nticks = 3\nfrom_s = 0.5\n"), {}, 5), sim::ScenarioError);
    try {
        (void)bus_world::open_bus("nosuch7");
        FAIL();
    } catch (const std::runtime_error &error) {
        const std::string said = error.what();
        EXPECT_EQ(said.find("--can nosuch7: "), 0u) << said;
        EXPECT_NE(said.find("modprobe"), std::string::npos) << said; // how to mend it, whether the kernel has CAN or not
    }
    const sim::Scenario scenario = scenario_of();
    BusWorld world(scenario, {}, 5);
    const std::array<int, 2> ends = wire();
    close(ends[0]);
    can_socket_t bus;
    can_socket_adopt(&bus, ends[1]);
    EXPECT_THROW((void)bus_world::answer(world, bus, "pair", {}), std::runtime_error);
    can_socket_close(&bus);
}
