#include "circuit.h"

#include "fixed.h"

#include <math.h>

static float left_V(const circuit_config_t *config, float duty, float supply_V, float current_A)
{
    return fixed_finite(duty * supply_V - config->resistance_ohm * current_A); // ke w_c of (1)
}

// A speed as the circuit has it, from a tick of before, and how far the encoder's is from all that lies between the two. An encoder tells
// the mean over its tick, a current the tick's end: what stops within the tick is somewhere in between.
typedef struct {
    float expected_rad_s, off_rad_s;
    bool believed;
} judged_t;

static judged_t judge(const circuit_config_t *config, float said_rad_s, float old_rad_s, float change_V, float through_A)
{
    const float change = fixed_finite(change_V * config->per_back_emf_1_Vs);
    judged_t out = {.expected_rad_s = fixed_clamp(old_rad_s + change, -1000.0f, 1000.0f)}; // [rad/s] beyond any wheel: keeps it finite
    const bool rises = fixed_greater(out.expected_rad_s, old_rad_s);
    const float low = rises ? old_rad_s : out.expected_rad_s;
    const float high = rises ? out.expected_rad_s : old_rad_s;
    out.off_rad_s = fixed_greater(low, said_rad_s) ? low - said_rad_s : fixed_greater(said_rad_s, high) ? said_rad_s - high : 0.0f;
    // the winding's resistance is known to a share: so is what a change of current tells
    const float unsure = config->contradict_current * config->per_back_emf_1_Vs * fabsf(fixed_finite(config->resistance_ohm * through_A));
    // the encoder is right where the circuit explains at least half of the jump, or where it has come back
    const bool explained = fixed_greater(fabsf(said_rad_s - old_rad_s), out.off_rad_s + out.off_rad_s);
    out.believed = explained || !fixed_greater(out.off_rad_s, config->jump_rad_s + fixed_finite(unsure));
    return out;
}

static float left_in(const circuit_config_t *config, const circuit_past_t *past, int i)
{
    return left_V(config, past->duty[i], past->supply_V, past->current_A[i]);
}

// The speed that wheel `i` is given in this tick: the encoder's, or what the circuit says since it was last believed.
static void judge_jump(const circuit_config_t *config, circuit_state_t *state, const circuit_input_t *input,
                       const sense_config_t *sense_config, sense_state_t *sense_state, sense_output_t *sense, int i)
{
    const uint32_t bit = 1u << (uint32_t)i;
    const bool was_refused = (state->refused & bit) != 0u;
    const circuit_past_t *last = &state->past[state->newest & 1u];
    const circuit_past_t *before = &state->past[(state->newest + 1u) & 1u];
    const float said = fixed_finite(sense->speed_rad_s[i]);
    const float now_V = left_V(config, input->duty[i], sense->battery_V, sense->current_A[i]);
    const float before_V = was_refused ? state->circuit_V[i] : left_in(config, last, i);
    const float from_A = was_refused ? state->refused_A[i] : last->current_A[i];
    const judged_t one = judge(config, said, fixed_finite(last->speed_rad_s[i]), now_V - before_V, sense->current_A[i] - from_A);
    bool believed = one.believed;
    if (!believed && !was_refused && before->driven) { // what stopped at the last tick's end was in its current already
        believed = judge(config, said, fixed_finite(before->speed_rad_s[i]), now_V - left_in(config, before, i),
                         sense->current_A[i] - before->current_A[i])
                       .believed;
    }
    if (believed) {
        state->refused &= ~bit;
        state->refused_ticks[i] = 0;
        return;
    }
    state->refused |= bit;
    state->refused_ticks[i] += state->refused_ticks[i] < UINT32_MAX ? 1u : 0u;
    state->circuit_V[i] = now_V;
    state->refused_A[i] = from_A;
    sense_replace(sense_config, sense_state, sense, i, one.expected_rad_s);
}

// Nothing to judge a jump by: no motor drives. What lasts is believed, a glitch is gone before.
static void hold_jump(const circuit_config_t *config, circuit_state_t *state, const sense_config_t *sense_config,
                      sense_state_t *sense_state, sense_output_t *sense, int i)
{
    const uint32_t bit = 1u << (uint32_t)i;
    const circuit_past_t *last = &state->past[state->newest & 1u];
    const float old = fixed_finite(last->speed_rad_s[i]);
    const bool back = !fixed_greater(fabsf(fixed_finite(sense->speed_rad_s[i]) - old), config->jump_rad_s);
    state->refused_ticks[i] += state->refused_ticks[i] < UINT32_MAX ? 1u : 0u;
    if (back || state->refused_ticks[i] > config->hold_ticks) {
        state->refused &= ~bit;
        state->refused_ticks[i] = 0;
        return;
    }
    state->refused |= bit;
    state->circuit_V[i] = left_in(config, last, i);
    state->refused_A[i] = last->current_A[i];
    sense_replace(sense_config, sense_state, sense, i, old);
}

static bool agreed(uint8_t *looks, bool bad, uint32_t needed)
{
    *looks = !bad ? 0u : (uint8_t)(*looks + (*looks < UINT8_MAX ? 1u : 0u));
    return *looks >= needed;
}

static float across_V(const circuit_config_t *config, const circuit_input_t *input, const sense_output_t *sense, int i)
{
    return fixed_finite(input->duty[i] * sense->battery_V - config->back_emf_Vs * sense->speed_rad_s[i]);
}

// (3), its second half: another motor draws current on no more voltage than this one has. A dead band of all bridges is no open winding.
static bool others_draw(const circuit_config_t *config, const circuit_input_t *input, const sense_output_t *sense, int i, float mine_V)
{
    for (int other = 0; other < WHEEL_COUNT; other++) {
        const bool draws = other != i && (sense->usable & ((uint32_t)FRAME_CURRENT_0 << (uint32_t)other)) != 0u &&
                           fixed_greater(fabsf(sense->current_A[other]), 2.0f * config->open_A);
        if (draws && fixed_greater(mine_V, fabsf(across_V(config, input, sense, other)))) {
            return true;
        }
    }
    return false;
}

// (2) and (3) for one wheel.
static void look(const circuit_config_t *config, circuit_state_t *state, const circuit_input_t *input, const sense_output_t *sense, int i,
                 bool was_driven, circuit_output_t *out)
{
    const uint32_t needed = ((uint32_t)FRAME_ENCODER_0 | (uint32_t)FRAME_CURRENT_0) << (uint32_t)i;
    const bool known = (sense->usable & needed) == needed && (sense->usable & FRAME_BATTERY) != 0u && input->driven && was_driven;
    bool contradicts = false;
    bool broken = false;
    if (known) {
        const float emf_V = config->back_emf_Vs * sense->speed_rad_s[i];
        const float drop_V = config->resistance_ohm * sense->current_A[i];
        const float mine_V = across_V(config, input, sense, i);
        const float about_V = config->contradict_speed * fabsf(emf_V);
        const float over_V = fabsf(mine_V) - config->open_speed * fabsf(emf_V);
        broken = fixed_greater(config->open_A, fabsf(sense->current_A[i])) && fixed_greater(over_V, config->open_V) &&
                 (fixed_greater(over_V, config->dead_V) || others_draw(config, input, sense, i, fabsf(mine_V)));
        contradicts =
            !broken && fixed_greater(fabsf(mine_V - drop_V), config->contradict_V + config->contradict_current * fabsf(drop_V) + about_V);
    }
    const uint32_t bit = 1u << (uint32_t)i;
    out->contradict |= agreed(&state->contradict_looks[i], contradicts, config->contradict_looks) ? bit : 0u;
    out->broken |= agreed(&state->open_looks[i], broken, config->open_looks) ? bit : 0u;
}

circuit_output_t circuit_step(const circuit_config_t *config, circuit_state_t *state, const circuit_input_t *input,
                              const sense_config_t *sense_config, sense_state_t *sense_state, sense_output_t *sense)
{
    circuit_output_t out = {0};
    const bool was_driven = state->past[state->newest & 1u].driven;
    const uint32_t doubtful = sense->jumped | state->refused;
    for (int i = 0; doubtful != 0u && i < WHEEL_COUNT; i++) {
        const uint32_t bit = 1u << (uint32_t)i;
        const bool judged = (doubtful & sense->usable & bit) != 0u;
        if (judged && input->driven && was_driven && (sense->usable & ((uint32_t)FRAME_CURRENT_0 << (uint32_t)i)) != 0u) {
            judge_jump(config, state, input, sense_config, sense_state, sense, i);
        } else if (judged) {
            hold_jump(config, state, sense_config, sense_state, sense, i);
        }
        out.contradict |= state->refused_ticks[i] > config->refused_ticks ? bit : 0u;
    }
    if (input->look) {
        look(config, state, input, sense, (int)(state->turn % WHEEL_COUNT), was_driven, &out);
        state->turn = (state->turn + 1u) % WHEEL_COUNT;
    }
    circuit_past_t *now = &state->past[(state->newest + 1u) & 1u];
    for (int i = 0; i < WHEEL_COUNT; i++) {
        now->speed_rad_s[i] = sense->speed_rad_s[i];
        now->current_A[i] = sense->current_A[i];
        now->duty[i] = input->duty[i];
    }
    now->supply_V = sense->battery_V;
    now->driven = input->driven;
    state->newest++;
    out.refused = state->refused;
    return out;
}
