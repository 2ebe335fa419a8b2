#include "sensor_node.h"

#include "traction_can.h"

enum { FRAME_SAMPLES = 4, SAMPLE_MAX = 1023, NUMBER_MASK = 8191 };

static bool has(const sensor_frame_t *input, uint32_t bit) { return (input->present & bit) != 0u; }

static uint16_t sample_of(const sensor_frame_t *input, uint32_t at, uint32_t end) {
    const uint16_t count = at < end ? input->radar_count[at] : 0;
    return count > SAMPLE_MAX ? SAMPLE_MAX : count;
}

static can_frame_t radar_frame(const sensor_frame_t *input, uint32_t at, uint32_t end) {
    const struct traction_can_radar_t message = {.sample0 = sample_of(input, at, end),
                                                 .sample1 = sample_of(input, at + 1u, end),
                                                 .sample2 = sample_of(input, at + 2u, end),
                                                 .sample3 = sample_of(input, at + 3u, end),
                                                 .first = (uint16_t)((input->radar_sequence + at) & NUMBER_MASK),
                                                 .samples = (uint8_t)(end - at < FRAME_SAMPLES ? end - at : FRAME_SAMPLES)};
    can_frame_t frame = {.id = CAN_RADAR, .length = TRACTION_CAN_RADAR_LENGTH};
    (void)traction_can_radar_pack(frame.data, &message, sizeof frame.data);
    can_seal(&frame);
    return frame;
}

static can_frame_t axes_frame(const sensor_frame_t *input, uint32_t id, uint8_t counter) {
    const bool accel = id == CAN_ACCEL;
    const struct traction_can_accel_t message = {.x = accel ? input->accel_x_count : input->gyro_x_count,
                                                 .y = accel ? input->accel_y_count : input->gyro_y_count,
                                                 .z = accel ? input->accel_z_count : input->gyro_z_count,
                                                 .counter = counter,
                                                 .drive_axis_read = has(input, accel ? FRAME_ACCEL : FRAME_GYRO),
                                                 .other_axes_read = has(input, accel ? FRAME_ACCEL_YZ : FRAME_GYRO_XY)};
    can_frame_t frame = {.id = id, .length = TRACTION_CAN_ACCEL_LENGTH};
    (void)traction_can_accel_pack(frame.data, &message, sizeof frame.data);
    can_seal(&frame);
    return frame;
}

static can_frame_t supply_frame(const sensor_frame_t *input, uint8_t counter) {
    const struct traction_can_supply_t message = {.battery = input->battery_count,
                                                  .counter = counter,
                                                  .battery_read = has(input, FRAME_BATTERY),
                                                  .emergency_stop_read = has(input, FRAME_EMERGENCY_STOP),
                                                  .emergency_stop = input->emergency_stop};
    can_frame_t frame = {.id = CAN_SUPPLY, .length = TRACTION_CAN_SUPPLY_LENGTH};
    (void)traction_can_supply_pack(frame.data, &message, sizeof frame.data);
    can_seal(&frame);
    return frame;
}

size_t sensor_node_receive(const sensor_frame_t *input, const can_frame_t *frame, can_frame_t answer[SENSOR_NODE_ANSWERS]) {
    if (frame->id != CAN_SYNC || !can_sound(frame, TRACTION_CAN_SYNC_LENGTH)) {
        return 0;
    }
    struct traction_can_sync_t sync;
    (void)traction_can_sync_unpack(&sync, frame->data, frame->length);
    const uint8_t counter = sync.counter & 7u;
    answer[0] = axes_frame(input, CAN_ACCEL, counter);
    answer[1] = axes_frame(input, CAN_RATES, counter);
    answer[2] = supply_frame(input, counter);
    size_t count = 3;
    const uint32_t held = input->radar_samples < RADAR_SAMPLES_PER_TICK_MAX ? input->radar_samples : RADAR_SAMPLES_PER_TICK_MAX;
    uint32_t at = 0; // one frame also when there is no sample: the radar was read
    do {
        answer[count] = radar_frame(input, at, held);
        count += has(input, FRAME_RADAR) ? 1u : 0u;
        at += FRAME_SAMPLES;
    } while (at < held);
    return count;
}
