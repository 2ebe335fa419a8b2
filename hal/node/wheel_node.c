#include "wheel_node.h"

#include "traction_can.h"

static void obey(wheel_node_state_t *state, uint32_t now_ms, const can_frame_t *frame) {
    struct traction_can_order0_t order; // the four are laid out alike
    (void)traction_can_order0_unpack(&order, frame->data, frame->length);
    const uint32_t newer = (uint8_t)(order.sequence - state->sequence);
    if (state->in_force && (newer == 0u || newer > 127u)) {
        state->sequence_errors++;
        return;
    }
    state->sequence = order.sequence;
    state->drive = (drive_state_t)order.drive; // two bits: every value is one
    state->duty_q15 = order.duty == INT16_MIN ? -INT16_MAX : order.duty;
    state->heard_ms = now_ms;
    state->in_force = true;
    state->released = false;
}

static can_frame_t state_frame(const wheel_node_config_t *config, const wheel_node_state_t *state, const wheel_node_input_t *input,
                               uint8_t counter) {
    const uint32_t bridge = input->bridge_status | (state->released ? (uint32_t)BRIDGE_RELEASED : 0u);
    const struct traction_can_wheel0_state_t message = {
        .encoder = input->encoder_count, .current = input->current_count, .counter = counter & 7u, .bridge = (uint8_t)(bridge & 31u)};
    can_frame_t frame = {.id = CAN_WHEEL + config->wheel, .length = TRACTION_CAN_WHEEL0_STATE_LENGTH};
    (void)traction_can_wheel0_state_pack(frame.data, &message, sizeof frame.data);
    can_seal(&frame);
    return frame;
}

static can_frame_t diagnosis_frame(const wheel_node_config_t *config, const wheel_node_state_t *state) {
    const struct traction_can_wheel0_diagnosis_t message = {.crc_errors = state->crc_errors,
                                                            .sequence_errors = state->sequence_errors,
                                                            .releases = state->releases,
                                                            .bus_offs = config->bus_off_count,
                                                            .protocol = CAN_PROTOCOL,
                                                            .drive = (uint8_t)state->drive};
    can_frame_t frame = {.id = CAN_DIAGNOSIS + config->wheel, .length = TRACTION_CAN_WHEEL0_DIAGNOSIS_LENGTH};
    (void)traction_can_wheel0_diagnosis_pack(frame.data, &message, sizeof frame.data);
    can_seal(&frame);
    return frame;
}

wheel_node_output_t wheel_node_output(wheel_node_state_t *state, uint32_t now_ms) {
    if (state->in_force && now_ms - state->heard_ms > BRIDGE_RELEASE_MS) {
        state->in_force = false;
        state->released = true;
        state->drive = DRIVE_COAST;
        state->duty_q15 = 0;
        state->releases++;
    }
    const wheel_node_output_t output = {.drive = state->drive, .duty_q15 = state->duty_q15};
    return output;
}

size_t wheel_node_receive(const wheel_node_config_t *config, wheel_node_state_t *state, uint32_t now_ms, const wheel_node_input_t *input,
                          const can_frame_t *frame, can_frame_t answer[WHEEL_NODE_ANSWERS]) {
    const bool order = frame->id == CAN_ORDER + (uint32_t)config->wheel;
    if (!order && frame->id != CAN_SYNC) {
        return 0;
    }
    if (!can_sound(frame, order ? TRACTION_CAN_ORDER0_LENGTH : TRACTION_CAN_SYNC_LENGTH)) {
        state->crc_errors++;
        return 0;
    }
    (void)wheel_node_output(state, now_ms); // an order that comes too late finds the bridge released
    if (order) {
        obey(state, now_ms, frame);
        return 0;
    }
    struct traction_can_sync_t sync;
    (void)traction_can_sync_unpack(&sync, frame->data, frame->length);
    answer[0] = state_frame(config, state, input, sync.counter);
    if (sync.counter != config->wheel) { // once in 2.56 s, each wheel at its own time
        return 1;
    }
    answer[1] = diagnosis_frame(config, state);
    return 2;
}
