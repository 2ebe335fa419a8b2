// The bus of docs/can.md: checksum, the computer's side, wheel nodes and sensor node; every refusal, every limit of time.
#include "hal/can/can_master.h"
#include "hal/node/sensor_node.h"
#include "hal/node/wheel_node.h"

#include "traction_can.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <random>
#include <vector>

namespace {

constexpr can_master_config_t everything{true, true, true};

can_frame_t order_of(drive_state_t drive, int16_t duty, std::uint32_t sequence, std::uint32_t wheel = 0) {
    actuator_frame_t actuator{};
    actuator.sequence = sequence;
    actuator.drive = drive;
    for (int16_t &d : actuator.duty_q15) d = duty;
    can_frame_t orders[WHEEL_COUNT];
    can_master_orders(&actuator, orders);
    return orders[wheel];
}

// A rover's nodes on a wire that loses nothing.
struct Wire {
    can_master_state_t master{};
    wheel_node_state_t wheel[WHEEL_COUNT]{};
    sensor_frame_t inputs{};
    std::uint32_t now_ms = 0;

    std::vector<can_frame_t> answers_to_sync() {
        can_frame_t sync;
        can_master_sync(&everything, &master, &sync);
        std::vector<can_frame_t> all;
        for (std::uint8_t i = 0; i < WHEEL_COUNT; i++) {
            const wheel_node_config_t config{i, 0};
            const wheel_node_input_t input{inputs.encoder_count[i], inputs.current_count[i], inputs.bridge_status[i]};
            can_frame_t answer[WHEEL_NODE_ANSWERS];
            const std::size_t n = wheel_node_receive(&config, &wheel[i], now_ms, &input, &sync, answer);
            all.insert(all.end(), answer, answer + n);
        }
        can_frame_t answer[SENSOR_NODE_ANSWERS];
        const std::size_t n = sensor_node_receive(&inputs, &sync, answer);
        all.insert(all.end(), answer, answer + n);
        return all;
    }
    sensor_frame_t tick() {
        for (const can_frame_t &frame : answers_to_sync()) can_master_receive(&everything, &master, &frame);
        sensor_frame_t out{};
        can_master_take(&master, &out);
        return out;
    }
};

sensor_frame_t some_inputs() {
    sensor_frame_t in{};
    in.present = FRAME_ALL;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        in.encoder_count[i] = i % 2 == 0 ? INT32_MIN + i : INT32_MAX - i;
        in.current_count[i] = static_cast<std::uint16_t>(65535 - 1000 * i);
        in.bridge_status[i] = static_cast<std::uint8_t>(1 << i);
    }
    in.battery_count = 4095;
    in.accel_x_count = INT16_MIN;
    in.accel_y_count = INT16_MAX;
    in.accel_z_count = -1;
    in.gyro_x_count = 1;
    in.gyro_y_count = -32767;
    in.gyro_z_count = 12345;
    in.radar_samples = 6;
    in.radar_sequence = 8190; // passes the 13 bits
    for (int i = 0; i < 6; i++) in.radar_count[i] = static_cast<std::uint16_t>(1023 - i);
    in.emergency_stop = true;
    return in;
}

} // namespace

TEST(can_crc, is_that_of_sae_j1850) {
    EXPECT_EQ(can_crc8(reinterpret_cast<const std::uint8_t *>("123456789"), 9), 0x4b); // the catalogue's check value
    EXPECT_EQ(can_crc8(nullptr, 0), 0x00);                                             // 0xff inverted
}

TEST(can_crc, sees_every_one_and_two_bit_error_and_every_burst_of_eight) {
    can_frame_t frame{CAN_WHEEL, 8, {1, 2, 3, 4, 5, 6, 7, 0}};
    can_seal(&frame);
    ASSERT_TRUE(can_sound(&frame, 8));
    const auto flip = [](can_frame_t f, int bit) {
        f.data[bit / 8] = static_cast<std::uint8_t>(f.data[bit / 8] ^ (0x80u >> (bit % 8)));
        return f;
    };
    for (int a = 0; a < 64; a++) {
        const can_frame_t one = flip(frame, a);
        EXPECT_FALSE(can_sound(&one, 8));
        for (int b = a + 1; b < 64; b++) {
            const can_frame_t two = flip(flip(frame, a), b);
            EXPECT_FALSE(can_sound(&two, 8)) << a << ' ' << b;
        }
    }
    for (int at = 0; at + 8 <= 64; at++)
        for (unsigned pattern = 1; pattern < 256; pattern++) {
            can_frame_t burst = frame;
            for (int i = 0; i < 8; i++)
                if ((pattern >> i & 1u) != 0) burst = flip(burst, at + i);
            EXPECT_FALSE(can_sound(&burst, 8));
        }
    can_frame_t other = frame; // the same data under another node's identifier
    for (std::uint32_t id = 0; id < 0x800; id++) {
        other.id = id;
        if (id != CAN_WHEEL && (id ^ CAN_WHEEL) < 0x100) {
            EXPECT_FALSE(can_sound(&other, 8)) << id;
        }
    }
}

TEST(can_bus, carries_every_count_to_the_ends_of_its_range) {
    Wire wire;
    wire.inputs = some_inputs();
    const sensor_frame_t out = wire.tick();
    EXPECT_EQ(out.present, static_cast<std::uint32_t>(FRAME_ALL & ~FRAME_TIME)); // time is the computer's
    EXPECT_EQ(std::memcmp(out.encoder_count, wire.inputs.encoder_count, sizeof out.encoder_count), 0);
    EXPECT_EQ(std::memcmp(out.current_count, wire.inputs.current_count, sizeof out.current_count), 0);
    EXPECT_EQ(std::memcmp(out.bridge_status, wire.inputs.bridge_status, sizeof out.bridge_status), 0);
    EXPECT_EQ(std::memcmp(out.radar_count, wire.inputs.radar_count, sizeof out.radar_count), 0);
    EXPECT_EQ(out.radar_samples, 6);
    EXPECT_EQ(out.radar_sequence, 8190u);
    EXPECT_EQ(out.battery_count, 4095);
    EXPECT_EQ(out.accel_x_count, INT16_MIN);
    EXPECT_EQ(out.accel_y_count, INT16_MAX);
    EXPECT_EQ(out.accel_z_count, -1);
    EXPECT_EQ(out.gyro_x_count, 1);
    EXPECT_EQ(out.gyro_y_count, -32767);
    EXPECT_EQ(out.gyro_z_count, 12345);
    EXPECT_TRUE(out.emergency_stop);
}

TEST(can_bus, numbers_the_radars_samples_beyond_thirteen_bits_and_over_gaps) {
    Wire wire;
    wire.inputs = some_inputs();
    wire.inputs.radar_sequence = 0;
    for (std::uint32_t n = 0; n < 20000; n += 5) { // 20000 samples: the 13 bits go round twice
        wire.inputs.radar_sequence = n;
        wire.inputs.radar_samples = 5;
        const sensor_frame_t out = wire.tick();
        ASSERT_EQ(out.radar_sequence, n);
        ASSERT_EQ(out.radar_samples, 5);
    }
    wire.inputs.radar_sequence = 20000 + 37; // lost on the way
    EXPECT_EQ(wire.tick().radar_sequence, 20037u);
    EXPECT_EQ(wire.master.counts.radar_lost, 37u);
    wire.inputs.radar_samples = 0; // read, and nothing new
    wire.inputs.radar_sequence = 20042;
    const sensor_frame_t none = wire.tick();
    EXPECT_NE(none.present & FRAME_RADAR, 0u);
    EXPECT_EQ(none.radar_samples, 0);
    wire.inputs.present &= ~static_cast<std::uint32_t>(FRAME_RADAR); // silent for longer than numbers are sure
    for (int i = 0; i < 120; i++) EXPECT_EQ(wire.tick().present & FRAME_RADAR, 0u);
    wire.inputs.present = FRAME_ALL;
    wire.inputs.radar_samples = 5;
    wire.inputs.radar_sequence = 20042; // as if nothing had been missed: a gap all the same
    EXPECT_GE(wire.tick().radar_sequence, 20042u + 8192u);
}

TEST(can_master, takes_an_answer_once_and_in_its_own_tick) {
    Wire wire;
    wire.inputs = some_inputs();
    std::vector<can_frame_t> old = wire.answers_to_sync();
    std::erase_if(old, [](const can_frame_t &frame) { return frame.id >= CAN_DIAGNOSIS; }); // of no tick
    EXPECT_EQ(can_master_complete(&everything, &wire.master), false);
    for (const can_frame_t &frame : old) EXPECT_TRUE(can_master_receive(&everything, &wire.master, &frame));
    EXPECT_TRUE(can_master_complete(&everything, &wire.master));
    for (const can_frame_t &frame : old) EXPECT_FALSE(can_master_receive(&everything, &wire.master, &frame)) << "twice";
    (void)wire.answers_to_sync();
    for (const can_frame_t &frame : old) EXPECT_FALSE(can_master_receive(&everything, &wire.master, &frame)) << "late";
    sensor_frame_t out{};
    can_master_take(&wire.master, &out);
    EXPECT_EQ(out.present, 0u);
    EXPECT_EQ(wire.master.counts.refused_crc, 0u);
    EXPECT_EQ(wire.master.counts.refused_age, 2 * old.size());
}

TEST(can_master, refuses_a_wrong_checksum_a_wrong_length_and_a_strange_identifier) {
    Wire wire;
    wire.inputs = some_inputs();
    for (can_frame_t frame : wire.answers_to_sync()) {
        frame.data[0] = static_cast<std::uint8_t>(frame.data[0] ^ 0x10u);
        EXPECT_FALSE(can_master_receive(&everything, &wire.master, &frame));
        frame.data[0] = static_cast<std::uint8_t>(frame.data[0] ^ 0x10u);
        frame.length--;
        can_seal(&frame); // right for what it is, but not what it should be
        EXPECT_FALSE(can_master_receive(&everything, &wire.master, &frame));
    }
    const can_frame_t strange{0x7ff, 8, {}};
    EXPECT_FALSE(can_master_receive(&everything, &wire.master, &strange));
    EXPECT_EQ(wire.master.counts.unknown, 1u);
    EXPECT_EQ(wire.master.answered, 0u);
}

TEST(can_master, holds_a_duty_and_a_drive_that_are_none) {
    actuator_frame_t actuator{};
    const int unknown = 9;
    std::memcpy(&actuator.drive, &unknown, sizeof actuator.drive);
    actuator.duty_q15[0] = INT16_MIN;
    can_frame_t orders[WHEEL_COUNT];
    can_master_orders(&actuator, orders);
    traction_can_order0_t order{};
    ASSERT_EQ(traction_can_order0_unpack(&order, orders[0].data, orders[0].length), 0);
    EXPECT_EQ(order.duty, -32767);
    EXPECT_EQ(order.drive, DRIVE_OFF);
    for (std::uint32_t i = 0; i < WHEEL_COUNT; i++) EXPECT_EQ(orders[i].id, CAN_ORDER + i);
}

TEST(wheel_node, does_nothing_before_its_first_order_and_lets_go_after_fifty_milliseconds) {
    const wheel_node_config_t config{0, 0};
    const wheel_node_input_t input{};
    can_frame_t answer[WHEEL_NODE_ANSWERS];
    for (const std::uint32_t begin : {std::uint32_t{0}, UINT32_MAX - 20}) { // the clock may wrap
        wheel_node_state_t node{};
        EXPECT_EQ(wheel_node_output(&node, begin).drive, DRIVE_OFF);
        const can_frame_t order = order_of(DRIVE_ON, -32767, 1);
        EXPECT_EQ(wheel_node_receive(&config, &node, begin, &input, &order, answer), 0u);
        for (std::uint32_t ms = 0; ms <= BRIDGE_RELEASE_MS; ms++) {
            EXPECT_EQ(wheel_node_output(&node, begin + ms).drive, DRIVE_ON) << ms;
            EXPECT_EQ(wheel_node_output(&node, begin + ms).duty_q15, -32767);
        }
        EXPECT_EQ(wheel_node_output(&node, begin + BRIDGE_RELEASE_MS + 1).drive, DRIVE_COAST);
        EXPECT_EQ(wheel_node_output(&node, begin + BRIDGE_RELEASE_MS + 1).duty_q15, 0);
        EXPECT_EQ(node.releases, 1);
        const can_frame_t again = order_of(DRIVE_BRAKE, 0, 1); // whatever its number: the computer may have begun anew
        wheel_node_receive(&config, &node, begin + 1000, &input, &again, answer);
        EXPECT_EQ(wheel_node_output(&node, begin + 1000).drive, DRIVE_BRAKE);
    }
}

TEST(wheel_node, obeys_newer_orders_alone) {
    const wheel_node_config_t config{2, 0};
    const wheel_node_input_t input{};
    can_frame_t answer[WHEEL_NODE_ANSWERS];
    for (unsigned last = 0; last < 256; last++)
        for (unsigned next = 0; next < 256; next++) {
            wheel_node_state_t node{};
            can_frame_t order = order_of(DRIVE_ON, 100, last, 2);
            wheel_node_receive(&config, &node, 0, &input, &order, answer);
            order = order_of(DRIVE_ON, 200, next, 2);
            wheel_node_receive(&config, &node, 30, &input, &order, answer);
            const unsigned newer = (next - last) & 255u;
            ASSERT_EQ(node.duty_q15, newer >= 1 && newer <= 127 ? 200 : 100) << last << ' ' << next;
            ASSERT_EQ(node.heard_ms, newer >= 1 && newer <= 127 ? 30u : 0u); // a repeated order does not keep the bridge alive
        }
    wheel_node_state_t node{};
    can_frame_t spoilt = order_of(DRIVE_ON, 100, 1, 2);
    spoilt.data[2] = static_cast<std::uint8_t>(spoilt.data[2] ^ 1u);
    wheel_node_receive(&config, &node, 0, &input, &spoilt, answer);
    const can_frame_t others = order_of(DRIVE_ON, 100, 1, 1);
    wheel_node_receive(&config, &node, 0, &input, &others, answer);
    EXPECT_EQ(wheel_node_output(&node, 0).drive, DRIVE_OFF);
    EXPECT_EQ(node.crc_errors, 1);
}

TEST(wheel_node, tells_what_it_has_refused) {
    Wire wire;
    wire.inputs = some_inputs();
    const wheel_node_config_t config{3, 0};
    const wheel_node_input_t input{};
    can_frame_t answer[WHEEL_NODE_ANSWERS];
    can_frame_t order = order_of(DRIVE_ON, 1, 7, 3);
    wheel_node_receive(&config, &wire.wheel[3], 0, &input, &order, answer);
    wheel_node_receive(&config, &wire.wheel[3], 0, &input, &order, answer); // twice
    order.data[0] = static_cast<std::uint8_t>(order.data[0] ^ 1u);
    wheel_node_receive(&config, &wire.wheel[3], 0, &input, &order, answer); // spoilt
    wire.now_ms = 60;                                                       // released
    for (int i = 0; i < 256; i++) {
        const sensor_frame_t out = wire.tick();
        EXPECT_NE(out.bridge_status[3] & BRIDGE_RELEASED, 0);
        EXPECT_EQ(out.bridge_status[0] & BRIDGE_RELEASED, 0);
    }
    const std::uint8_t expected[4] = {1, 1, 1, 0};
    EXPECT_EQ(std::memcmp(wire.master.counts.node_refused[3], expected, 4), 0);
    EXPECT_EQ(wire.master.counts.protocol[3], CAN_PROTOCOL);
}

// 20,000 here in the suite; CAN_FRAMES=1000000 for the campaign of docs/can.md.
TEST(can_decoders, take_any_frames_without_undefined_behaviour_and_obey_no_forged_order) {
    const char *asked = std::getenv("CAN_FRAMES");
    const long frames = asked != nullptr ? std::strtol(asked, nullptr, 10) : 20000;
    std::mt19937 generator(20261122);
    const auto random = [&generator] { return static_cast<std::uint32_t>(generator()); };
    Wire wire;
    wire.inputs = some_inputs();
    const wheel_node_config_t config{1, 0};
    const wheel_node_input_t input{};
    long obeyed = 0, sealed_orders = 0;
    for (long n = 0; n < frames; n++) {
        can_frame_t frame{};
        const std::uint32_t ids[] = {CAN_SYNC,
                                     CAN_ORDER + random() % 4,
                                     CAN_WHEEL + random() % 4,
                                     CAN_ACCEL,
                                     CAN_RATES,
                                     CAN_SUPPLY,
                                     CAN_RADAR,
                                     CAN_DIAGNOSIS + random() % 4,
                                     random()};
        frame.id = ids[random() % 9];
        frame.length = static_cast<std::uint8_t>(random() % (random() % 8 == 0 ? 256 : 9));
        for (std::uint8_t &byte : frame.data) byte = static_cast<std::uint8_t>(random());
        const bool sealed = random() % 2 == 0; // or else no decoder behind the checksum would see any
        if (sealed) can_seal(&frame);
        if (n % 7 == 0) (void)wire.answers_to_sync();
        can_master_receive(&everything, &wire.master, &frame);
        sensor_frame_t out{};
        if (n % 5 == 0) can_master_take(&wire.master, &out);
        ASSERT_LE(out.radar_samples, RADAR_SAMPLES_PER_TICK_MAX);
        can_frame_t answer[WHEEL_NODE_ANSWERS], sensors[SENSOR_NODE_ANSWERS];
        wheel_node_state_t node{};
        ASSERT_LE(wheel_node_receive(&config, &node, random(), &input, &frame, answer), 2u);
        ASSERT_LE(sensor_node_receive(&wire.inputs, &frame, sensors), static_cast<std::size_t>(SENSOR_NODE_ANSWERS));
        const bool right = frame.id == CAN_ORDER + 1 && can_sound(&frame, 5);
        sealed_orders += right ? 1 : 0;
        obeyed += node.in_force ? 1 : 0;
        ASSERT_EQ(node.in_force, right);
        ASSERT_GE(node.duty_q15, -32767);
    }
    EXPECT_EQ(obeyed, sealed_orders);
    EXPECT_GT(obeyed, 0);
}
