#include "can_master.h"

#include "traction_can.h"

#include <string.h>

enum {
    COUNTER_MASK = 7,       // three bits of SYNC's counter come back
    RADAR_NUMBERS = 8192,   // of (2)
    RADAR_SURE_TICKS = 100, // an older number then is that of a node that began anew
    RADAR_FRAME_SAMPLES = 4,
};

static const uint32_t wheel_bits = FRAME_ENCODER_0 | FRAME_CURRENT_0 | FRAME_BRIDGE_0; // << wheel

uint32_t can_master_expects(const can_master_config_t *config) {
    const uint32_t wheels = config->wheels ? 0xfu * wheel_bits : 0u;
    const uint32_t sensors =
        config->sensors ? (uint32_t)(FRAME_BATTERY | FRAME_ACCEL | FRAME_ACCEL_YZ | FRAME_GYRO | FRAME_GYRO_XY | FRAME_RADAR) : 0u;
    return wheels | sensors | (config->sensors && config->emergency_stop ? (uint32_t)FRAME_EMERGENCY_STOP : 0u);
}

void can_master_sync(const can_master_config_t *config, can_master_state_t *state, can_frame_t *sync) {
    (void)config;
    state->counter = (uint8_t)(state->counter + 1u);
    state->synced = true;
    state->answered = 0;
    const struct traction_can_sync_t message = {.counter = state->counter};
    *sync = (can_frame_t){.id = CAN_SYNC, .length = TRACTION_CAN_SYNC_LENGTH};
    (void)traction_can_sync_pack(sync->data, &message, sizeof sync->data);
    can_seal(sync);
    if (state->radar_silent_ticks < UINT32_MAX) {
        state->radar_silent_ticks++;
    }
}

// An answer to this tick's SYNC that has not come yet.
static bool fresh(can_master_state_t *state, uint8_t counter, uint32_t bits) {
    const bool good = state->synced && counter == (state->counter & COUNTER_MASK) && (state->answered & bits) == 0u;
    state->counts.refused_age += good ? 0u : 1u;
    return good;
}

static bool take_wheel(can_master_state_t *state, const can_frame_t *frame, uint32_t wheel) {
    struct traction_can_wheel0_state_t message; // the four are laid out alike
    (void)traction_can_wheel0_state_unpack(&message, frame->data, frame->length);
    if (!fresh(state, message.counter, wheel_bits << wheel)) {
        return false;
    }
    state->frame.encoder_count[wheel] = message.encoder;
    state->frame.current_count[wheel] = message.current;
    state->frame.bridge_status[wheel] = message.bridge;
    state->answered |= wheel_bits << wheel;
    return true;
}

static bool take_axes(can_master_state_t *state, const can_frame_t *frame) {
    struct traction_can_accel_t message; // RATES is laid out alike
    (void)traction_can_accel_unpack(&message, frame->data, frame->length);
    const bool accel = frame->id == CAN_ACCEL;
    const uint32_t drive_bit = accel ? FRAME_ACCEL : FRAME_GYRO, other_bit = accel ? FRAME_ACCEL_YZ : FRAME_GYRO_XY;
    if (!fresh(state, message.counter, drive_bit | other_bit)) {
        return false;
    }
    if (accel) {
        state->frame.accel_x_count = message.x;
        state->frame.accel_y_count = message.y;
        state->frame.accel_z_count = message.z;
    } else {
        state->frame.gyro_x_count = message.x;
        state->frame.gyro_y_count = message.y;
        state->frame.gyro_z_count = message.z;
    }
    state->answered |= (message.drive_axis_read != 0u ? drive_bit : 0u) | (message.other_axes_read != 0u ? other_bit : 0u);
    return true;
}

static bool take_supply(const can_master_config_t *config, can_master_state_t *state, const can_frame_t *frame) {
    struct traction_can_supply_t message;
    (void)traction_can_supply_unpack(&message, frame->data, frame->length);
    if (!fresh(state, message.counter, FRAME_BATTERY | FRAME_EMERGENCY_STOP)) {
        return false;
    }
    state->frame.battery_count = message.battery;
    state->answered |= message.battery_read != 0u ? (uint32_t)FRAME_BATTERY : 0u;
    if (config->emergency_stop && message.emergency_stop_read != 0u) {
        state->frame.emergency_stop = message.emergency_stop != 0u;
        state->answered |= FRAME_EMERGENCY_STOP;
    }
    return true;
}

// One run of samples is kept, the newest: a frame has one number for them.
static bool take_radar(can_master_state_t *state, const can_frame_t *frame) {
    struct traction_can_radar_t message;
    (void)traction_can_radar_unpack(&message, frame->data, frame->length);
    if (message.samples > RADAR_FRAME_SAMPLES) {
        state->counts.refused_crc++;
        return false;
    }
    const uint32_t gap = (message.first - state->radar_next) & (RADAR_NUMBERS - 1u);
    if (state->radar_seen && gap >= RADAR_NUMBERS / 2u && state->radar_silent_ticks < RADAR_SURE_TICKS) {
        state->counts.refused_age++; // samples that were here before
        return false;
    }
    const uint32_t jump = state->radar_silent_ticks >= RADAR_SURE_TICKS ? (uint32_t)RADAR_NUMBERS : 0u;
    const uint32_t first = state->radar_seen ? state->radar_next + gap + jump : message.first;
    state->counts.radar_lost += state->radar_seen ? gap + jump : 0u;
    sensor_frame_t *out = &state->frame;
    if (out->radar_samples == 0 || first != state->radar_next || out->radar_samples + message.samples > RADAR_SAMPLES_PER_TICK_MAX) {
        out->radar_samples = 0;
        out->radar_sequence = first;
    }
    const uint16_t sample[RADAR_FRAME_SAMPLES] = {message.sample0, message.sample1, message.sample2, message.sample3};
    for (uint8_t i = 0; i < message.samples; i++) {
        out->radar_count[out->radar_samples++] = sample[i];
    }
    state->radar_seen = true;
    state->radar_next = first + message.samples;
    state->radar_silent_ticks = 0;
    state->answered |= FRAME_RADAR;
    return true;
}

static bool take_diagnosis(can_master_state_t *state, const can_frame_t *frame, uint32_t wheel) {
    struct traction_can_wheel0_diagnosis_t message;
    (void)traction_can_wheel0_diagnosis_unpack(&message, frame->data, frame->length);
    const uint8_t told[4] = {message.crc_errors, message.sequence_errors, message.releases, message.bus_offs};
    memcpy(state->counts.node_refused[wheel], told, sizeof told);
    state->counts.protocol[wheel] = message.protocol;
    return true;
}

bool can_master_receive(const can_master_config_t *config, can_master_state_t *state, const can_frame_t *frame) {
    const uint32_t id = frame->id;
    const bool wheel = config->wheels && id >= CAN_WHEEL && id < CAN_WHEEL + WHEEL_COUNT;
    const bool diagnosis = config->wheels && id >= CAN_DIAGNOSIS && id < CAN_DIAGNOSIS + WHEEL_COUNT;
    const bool sensor = config->sensors && id >= CAN_ACCEL && id <= CAN_RADAR;
    if (!wheel && !diagnosis && !sensor) {
        state->counts.unknown++;
        return false;
    }
    uint8_t length = TRACTION_CAN_WHEEL0_STATE_LENGTH; // as ACCEL's, RATES' and RADAR's
    length = diagnosis ? TRACTION_CAN_WHEEL0_DIAGNOSIS_LENGTH : length;
    length = id == CAN_SUPPLY ? TRACTION_CAN_SUPPLY_LENGTH : length;
    if (!can_sound(frame, length)) {
        state->counts.refused_crc++;
        return false;
    }
    if (wheel) {
        return take_wheel(state, frame, id - CAN_WHEEL);
    }
    if (diagnosis) {
        return take_diagnosis(state, frame, id - CAN_DIAGNOSIS);
    }
    if (id == CAN_SUPPLY) {
        return take_supply(config, state, frame);
    }
    return id == CAN_RADAR ? take_radar(state, frame) : take_axes(state, frame);
}

bool can_master_complete(const can_master_config_t *config, const can_master_state_t *state) {
    const uint32_t expected = can_master_expects(config);
    return (state->answered & expected) == expected;
}

void can_master_take(can_master_state_t *state, sensor_frame_t *frame) {
    const sensor_frame_t own = *frame;
    *frame = state->frame;
    frame->tick = own.tick;
    frame->elapsed_ticks = own.elapsed_ticks;
    frame->time_us = own.time_us;
    frame->present = own.present | state->answered;
    if ((state->answered & FRAME_EMERGENCY_STOP) == 0u) {
        frame->emergency_stop = own.emergency_stop;
    }
    for (uint32_t i = frame->radar_samples; i < RADAR_SAMPLES_PER_TICK_MAX; i++) {
        frame->radar_count[i] = 0;
    }
    state->frame.radar_samples = 0;
    state->answered = 0; // a second reading of the same tick brings nothing
}

void can_master_orders(const actuator_frame_t *actuator, can_frame_t orders[WHEEL_COUNT]) {
    const int32_t drive = (int32_t)actuator->drive;
    for (uint32_t wheel = 0; wheel < WHEEL_COUNT; wheel++) {
        const int16_t duty = actuator->duty_q15[wheel];
        const struct traction_can_order0_t message = {
            .sequence = (uint8_t)actuator->sequence,
            .drive = drive >= (int32_t)DRIVE_OFF && drive <= (int32_t)DRIVE_ON ? (uint8_t)drive : (uint8_t)DRIVE_OFF,
            .duty = duty == INT16_MIN ? -INT16_MAX : duty,
        };
        orders[wheel] = (can_frame_t){.id = CAN_ORDER + wheel, .length = TRACTION_CAN_ORDER0_LENGTH};
        (void)traction_can_order0_pack(orders[wheel].data, &message, sizeof orders[wheel].data);
        can_seal(&orders[wheel]);
    }
}
