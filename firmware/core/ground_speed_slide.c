#include "ground_speed_parts.h"

#include "fixed.h"

#include <math.h>

static const float smear_s = 0.07f;          // [s] times the acceleration: what a window that it crosses reads wrong, assumed
static const float fits_most = 3.0f;         // chi^2 over its degrees of freedom: 5 % of all lines have more
static const float slope_ends_m2_s4 = 0.25f; // (0.5 m/s^2)^2: the slope that it slides on need not last, assumed
static const float slide_prior = 16.0f;      // 2 ln of the odds against a slide, assumed: exp(8) to one
static const float slide_least = 8.0f;       // that the values must tell before it is asked
static const float slide_sure = 2.0f;        // it is never taken at once: the next value decides
static const float waver = 0.1f;
static const float dip = 0.8f;                                 // [1] assumed: the values spread by 2 to 8 %
static const float through_share = 0.25f, through_m_s = 0.08f; // of (41): assumed, a step of six is a fifth of the ends' sum

typedef struct {
    float t_s[SLIDE_VALUES];   // of the windows' middles, from the newest one's; the newest first
    float v_m_s[SLIDE_VALUES]; // V there, the same
    float d_m_s[SLIDE_VALUES];
    float noise_m2_s2; // of a value
} recent_t;

// Lines through y = s - V over t, s the values with their signs: what does not depend on the signs, and the sums that do.
typedef struct {
    int32_t count;
    float per_count;
    float t_mean_s, t_square_s2, per_square_1_s2; // sum of (t - mean)^2
    float y, ty, yy;                              // sums of y, (t - mean) y, y^2
} sums_t;

void ground_speed_remember(ground_speed_state_t *state)
{
    const int32_t at = (state->slide.newest + 1) % SLIDE_VALUES;
    state->slide.newest = at;
    state->slide.held += state->slide.held < SLIDE_VALUES ? 1 : 0;
    state->slide.heard_m_s[at] = state->value_heard_m_s;
    state->slide.alike_m_s[at] = state->alike_m_s;
    state->slide.sign[at] = state->value_sign; // in the middle of its window
    state->slide.came[at] = state->slide.ticks;
    state->slide.q20[at] = ground_speed_middle_q20(state, 0u);
    state->slide.tau_s[at] = state->value_tau_s;
}

static recent_t recent(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const int32_t newest = state->slide.newest;
    const float alike = state->slide.alike_m_s[(newest + 1) % SLIDE_VALUES]; // of the oldest: the slide makes its own
    recent_t out = {.noise_m2_s2 = state->value_noise_m2_s2 + ground_speed_square(alike)};
    for (int32_t i = 0; i < SLIDE_VALUES; i++) {
        const int32_t at = (newest + SLIDE_VALUES - i) % SLIDE_VALUES;
        out.t_s[i] = state->slide.tau_s[newest] - state->slide.tau_s[at] +
                     (float)(int32_t)(state->slide.came[at] - state->slide.came[newest]) * config->tick_s;
        out.v_m_s[i] = (float)fixed_wrap_difference(state->slide.q20[at], state->slide.q20[newest]) * (1.0f / 1048576.0f);
        out.d_m_s[i] = state->slide.heard_m_s[at];
    }
    return out;
}

// All values with the sign `sign`.
static sums_t sums_of(const recent_t *recent, int32_t count, float sign)
{
    sums_t out = {.count = count, .per_count = count == SLIDE_VALUES ? 1.0f / (float)SLIDE_VALUES : 1.0f / (float)(SLIDE_VALUES - 1)};
    for (int32_t i = 0; i < count; i++) {
        out.t_mean_s += recent->t_s[i];
    }
    out.t_mean_s *= out.per_count;
    for (int32_t i = 0; i < count; i++) {
        const float t = recent->t_s[i] - out.t_mean_s;
        const float y = sign * recent->d_m_s[i] - recent->v_m_s[i];
        out.t_square_s2 += t * t;
        out.y += y;
        out.ty += t * y;
        out.yy += y * y;
    }
    out.t_square_s2 = fixed_clamp(out.t_square_s2, 1e-3f, 10.0f);
    out.per_square_1_s2 = 1.0f / out.t_square_s2;
    return out;
}

// Value i has the sign `sign`, and had the other one.
static void turn(sums_t *sums, const recent_t *recent, int32_t i, float sign)
{
    const float s2 = 2.0f * sign * recent->d_m_s[i];
    sums->y += s2;
    sums->ty += (recent->t_s[i] - sums->t_mean_s) * s2;
    sums->yy -= 2.0f * s2 * recent->v_m_s[i];
}

// Sum of squares that the line leaves.
static float left_by(const sums_t *sums)
{
    return sums->yy - sums->y * sums->y * sums->per_count - sums->ty * sums->ty * sums->per_square_1_s2;
}

// Of a value whose window's speed changes from the oldest to the newest: R, and what it reads wrong.
static float noise_of(const recent_t *recent, int32_t count, float change_m_s)
{
    const float accel = change_m_s / fixed_clamp(-recent->t_s[count - 1], 0.1f, 10.0f);
    return recent->noise_m2_s2 + ground_speed_square(smear_s * accel);
}

// The line's speed now, and its bias.
static ground_speed_track_t track_of(const ground_speed_config_t *config, const ground_speed_state_t *state, const sums_t *sums,
                                     float noise)
{
    const int32_t newest = state->slide.newest;
    const float since = (float)fixed_wrap_difference(state->integral_q20[state->head], state->slide.q20[newest]) * (1.0f / 1048576.0f);
    const float late = state->slide.tau_s[newest] + (float)(int32_t)(state->slide.ticks - state->slide.came[newest]) * config->tick_s;
    const float slope = sums->ty * sums->per_square_1_s2;
    const float p_bb = noise * sums->per_square_1_s2;
    const float along = late - sums->t_mean_s; // from the values' mean to now
    const ground_speed_track_t out = {
        .speed_m_s = sums->y * sums->per_count + slope * along + since,
        .bias_m_s2 = -slope,
        .p_vv = sums->per_count * noise + along * along * p_bb,
        .p_vb = -along * p_bb,
        .p_bb = p_bb + slope_ends_m2_s4,
    };
    return out;
}

static void propose(const ground_speed_config_t *config, ground_speed_state_t *state, ground_speed_track_t track, float odds)
{
    ground_speed_hold(config, &track);
    const bool same = (track.speed_m_s < 0.0f) == (state->speed_m_s < 0.0f);
    if (same || (state->other_alive && state->odds <= odds)) {
        return;
    }
    ground_speed_split(state, &state->other, &track);
    state->other_alive = true;
    state->odds = odds;
    state->held_sign = 0.0f;
    state->held_values = 0;
}

// A magnitude that passes through zero falls, and rises again, once.
static bool dips(const recent_t *recent, int32_t count)
{
    const float newest = recent->d_m_s[0];
    const float oldest = recent->d_m_s[count - 1];
    const float end = fixed_greater(oldest, newest) ? newest : oldest;
    int32_t least = 0;
    for (int32_t i = 1; i < count; i++) {
        least = fixed_greater(recent->d_m_s[least], recent->d_m_s[i]) ? i : least;
    }
    for (int32_t i = 1; i < count; i++) {
        const float step = recent->d_m_s[i] - recent->d_m_s[i - 1]; // falls up to the least one, rises from there on
        if (fixed_greater(i <= least ? step : -step, waver * end)) {
            return false;
        }
    }
    const float through = through_m_s + through_share * (oldest + newest);
    return fixed_greater(dip * end, recent->d_m_s[least]) && fixed_greater(through, recent->d_m_s[least]);
}

// (15) over `count` values; true where it has told.
static bool look(const ground_speed_config_t *config, ground_speed_state_t *state, const recent_t *values, int32_t count)
{
    const int32_t first = (state->slide.newest + SLIDE_VALUES + 1 - count) % SLIDE_VALUES;
    const bool went = (state->slide.sign[first] < 0.0f) != (state->speed_m_s < 0.0f);
    if (went || !dips(values, count)) { // the best track has passed through zero itself, or nothing has
        return false;
    }
    const float sign = state->speed_m_s < 0.0f ? 1.0f : -1.0f; // of the newest, if it slides
    sums_t sums = sums_of(values, count, -sign);
    const float newest = values->d_m_s[0];
    const float oldest = values->d_m_s[count - 1];
    const float straight = left_by(&sums) / noise_of(values, count, newest - oldest);
    sums_t best = sums;
    float least = 1e9f;
    for (int32_t i = 0; i < count - 1; i++) {
        turn(&sums, values, i, sign);
        const float left = left_by(&sums);
        if (fixed_greater(least, left)) {
            least = left;
            best = sums;
        }
    }
    const float noise = noise_of(values, count, newest + oldest);
    const float chi2 = least / noise;
    const float told = straight - chi2;
    if (!fixed_greater(told, slide_least) || !fixed_greater(fits_most * (float)(count - 2), chi2)) {
        return false;
    }
    propose(config, state, track_of(config, state, &best, noise), fixed_clamp(slide_prior - told, slide_sure, slide_prior));
    return true;
}

void ground_speed_watch_slide(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const int32_t count = state->slide.due == 2 ? SLIDE_VALUES : SLIDE_VALUES - 1;
    state->slide.due--;
    if (state->slide.held >= SLIDE_VALUES) {
        const recent_t values = recent(config, state);
        state->slide.due = look(config, state, &values, count) ? 0 : state->slide.due;
    }
}
