// Seeded frames as the rover's C packs them, one a line with the values that went in: for cantools_check.py.
#include "hal/can/can_master.h"
#include "hal/node/sensor_node.h"
#include "hal/node/wheel_node.h"

#include <cstdint>
#include <cstdio>
#include <random>

namespace {
void print(const can_frame_t &frame) {
    std::printf("%03X#", frame.id);
    for (int i = 0; i < frame.length; i++) std::printf("%02X", frame.data[i]);
    std::printf(" ; crc=%d", frame.data[frame.length - 1]);
}
} // namespace

int main() {
    std::mt19937 random(7);
    const auto draw = [&random](int low, int high) {
        return static_cast<int>(static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(std::int64_t{high} - low + 1)) + low);
    };
    for (unsigned n = 0; n < 200; n++) {
        actuator_frame_t actuator{};
        actuator.sequence = n;
        actuator.drive = static_cast<drive_state_t>(n % 4);
        for (int16_t &duty : actuator.duty_q15) duty = static_cast<int16_t>(draw(-32767, 32767));
        can_frame_t orders[WHEEL_COUNT];
        can_master_orders(&actuator, orders);
        for (int i = 0; i < WHEEL_COUNT; i++) {
            print(orders[i]);
            std::printf(" sequence=%u drive=%u duty=%d\n", n % 256, n % 4, actuator.duty_q15[i]);
        }
        const can_master_config_t config{true, true, true};
        static can_master_state_t master;
        can_frame_t sync, answer[SENSOR_NODE_ANSWERS];
        can_master_sync(&config, &master, &sync);
        print(sync);
        std::printf(" counter=%d\n", master.counter);
        sensor_frame_t in{};
        in.present = FRAME_ALL;
        in.battery_count = static_cast<std::uint16_t>(draw(0, 65535));
        in.accel_x_count = static_cast<std::int16_t>(draw(-32768, 32767));
        in.gyro_z_count = static_cast<std::int16_t>(draw(-32768, 32767));
        in.radar_sequence = static_cast<std::uint32_t>(random());
        in.radar_samples = 4;
        for (std::uint16_t &count : in.radar_count) count = static_cast<std::uint16_t>(draw(0, 1023));
        for (unsigned wheel = 0; wheel < WHEEL_COUNT; wheel++) {
            const wheel_node_config_t node{static_cast<std::uint8_t>(wheel), static_cast<std::uint8_t>(n)};
            const wheel_node_input_t input{draw(INT32_MIN, INT32_MAX), static_cast<std::uint16_t>(draw(0, 65535)),
                                           static_cast<std::uint8_t>(draw(0, 31))};
            static wheel_node_state_t state[WHEEL_COUNT];
            const std::size_t answers = wheel_node_receive(&node, &state[wheel], 0, &input, &sync, answer);
            print(answer[0]);
            std::printf(" encoder=%d current=%d bridge=%d counter=%d\n", input.encoder_count, input.current_count, input.bridge_status,
                        master.counter & 7);
            if (answers == 2) {
                print(answer[1]);
                std::printf(" protocol=%d bus_offs=%d\n", CAN_PROTOCOL, static_cast<int>(n));
            }
        }
        const std::size_t answers = sensor_node_receive(&in, &sync, answer);
        print(answer[0]);
        std::printf(" x=%d drive_axis_read=1\n", in.accel_x_count);
        print(answer[1]);
        std::printf(" z=%d other_axes_read=1\n", in.gyro_z_count);
        print(answer[2]);
        std::printf(" battery=%d emergency_stop_read=1 emergency_stop=0\n", in.battery_count);
        for (std::size_t i = 3; i < answers; i++) {
            print(answer[i]);
            std::printf(" sample0=%d sample3=%d first=%u samples=4\n", in.radar_count[0], in.radar_count[3], in.radar_sequence & 8191u);
        }
    }
    return 0;
}
