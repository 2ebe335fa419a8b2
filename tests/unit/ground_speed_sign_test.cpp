// Which sign, and which track: ground_speed_sign.c, ground_speed_held.c, ground_speed_slide.c, ground_speed_jump.c against (7), (9), (12),
// (15), (17), (18) of ground_speed.h in double, from any state. How a track moves and is corrected is held by ground_speed_track_test.
#include "tests/unit/ground_speed_any.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

namespace {

using any_state::Any, any_state::mean_of, any_state::narrow, any_state::passed, any_state::spread_of, any_state::square, any_state::wide;

const ground_speed_config_t &ours() {
    static const ground_speed_config_t config = rover_config_default().ground_speed;
    return config;
}

constexpr double eps = 1e-5;

void expect_same(const ground_speed_track_t &is, const ground_speed_track_t &track, double scale = 1) {
    EXPECT_NEAR(is.speed_m_s, track.speed_m_s, eps * scale);
    EXPECT_NEAR(is.bias_m_s2, track.bias_m_s2, eps * scale);
    EXPECT_NEAR(is.p_vv, track.p_vv, eps * scale);
    EXPECT_NEAR(is.p_vb, track.p_vb, eps * scale);
    EXPECT_NEAR(is.p_bb, track.p_bb, eps * scale);
}

bool near(double a, double b, double by = 1e-4) { return std::fabs(a - b) < by; }

TEST(GroundSpeedSign, the_rough_logarithm_is_within_six_hundredths) {
    for (double x = 1e-9; x < 1e3; x *= 1.007) {
        EXPECT_NEAR(ground_speed_ln_rough(narrow(x)), std::log(x), 0.0601);
    }
}

double wheel_odds(double measured, double wheel) { // of forward travel
    const double rim = std::fabs(wheel), toward = wheel < 0 ? -1 : 1;
    if (rim <= wide(ours().still_m_s)) return 0;
    if (measured > rim / 2 && measured < 1.5 * rim) return toward * wide(ours().wheel_match); // a slip of -0.33 to 0.5
    return toward * wide(measured < rim ? ours().wheel_spins : ours().wheel_odds);
}

// Cost of each sign by (12), as odds of +.
double force_odds(const ground_speed_state_t &state) {
    const double f = wide(state.value_accel_m_s2) + state.lean_q8 * wide(ours().lean_m_s2_per_q8);
    const double wheel = wide(state.value_wheel_m_s), rim = std::fabs(wheel), told = std::fmin(12, square(4 * f));
    double odds = 0;
    for (const double sign : {1.0, -1.0}) {
        const double u = wheel - sign * wide(state.value_m_s);
        if (f * u >= 0) continue; // the force pushes along the slip, as dry friction does
        const bool overtakes = u * wheel < 0 && rim > wide(ours().still_m_s);
        const double rolling = overtakes ? 0.02 + (state.value_parts ? 0.15 : 0.1) * rim : 0.1 + 0.5 * rim;
        odds -= sign * told * std::clamp((std::fabs(u) - rolling) / rolling, 0.0, 1.0);
    }
    return odds;
}

TEST(GroundSpeedSign, wheels_and_friction_witness_to_the_sign) {
    Any any{{21}};
    std::array<int, 5> seen = {};
    for (int k = 0; k < 1500; ++k) {
        ground_speed_state_t state = {};
        any.value(ours(), state);
        if (any.one_in(8)) state.value_wheel_m_s = narrow(any.between(-0.02, 0.02));
        if (any.one_in(2)) state.value_m_s = narrow(std::fabs(wide(state.value_wheel_m_s)) * any.between(0.9, 1.4));
        state.lean_q8 = any.one_in(2) ? 0 : static_cast<int32_t>(any.between(-1, 1) / wide(ours().lean_m_s2_per_q8));
        const double z = wide(state.value_m_s), wheel = wide(state.value_wheel_m_s);
        const double odds = wheel_odds(z, wheel);
        EXPECT_EQ(ground_speed_wheel_odds(&ours(), state.value_m_s, state.value_wheel_m_s), narrow(odds)) << z << ' ' << wheel;
        seen[odds == 0 ? 0 : std::fabs(odds) == 2 ? 1 : std::fabs(odds) == 6 ? 2 : 3]++;
        const double force = force_odds(state);
        EXPECT_NEAR(ground_speed_force_odds(&ours(), &state), force, 1e-3) << k;
        seen[4] += force != 0 && std::fabs(force) < 12 ? 1 : 0;
    }
    EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 20);
    EXPECT_EQ(ground_speed_wheel_odds(&ours(), 0.2f, 0.4f), ours().wheel_spins); // just half of its rim's: it spins
    EXPECT_EQ(ground_speed_wheel_odds(&ours(), 0.3f, ours().still_m_s), 0);
    EXPECT_EQ(ground_speed_wheel_odds(&ours(), 0.3f, 1.01f * ours().still_m_s), ours().wheel_odds);
}

TEST(GroundSpeedSign, the_slowest_of_wheels_that_part_is_the_hint_where_it_rolls) {
    Any any{{22}};
    int rolled = 0;
    for (int k = 0; k < 4000; ++k) {
        ground_speed_input_t input = {};
        input.slowest_m_s = narrow(any.one_in(4) ? any.between(-0.03, 0.03) : any.between(-1, 1));
        input.wheel_m_s = narrow(any.between(-2, 2));
        const double rim = std::fabs(wide(input.slowest_m_s)), measured = std::fmax(0, rim + any.between(-0.3, 0.3));
        const double slips = std::fabs(wide(narrow(measured)) - rim), may = 0.02 + 0.15 * rim;
        if (near(slips, may)) continue;
        const bool rolls = rim > wide(ours().still_m_s) && slips < may;
        EXPECT_EQ(ground_speed_hint(&ours(), &input, narrow(measured)), rolls ? input.slowest_m_s : input.wheel_m_s);
        rolled += rolls ? 1 : 0;
    }
    EXPECT_GT(rolled, 200);
}

// (9)
TEST(GroundSpeedSign, takes_the_likelier_sign_and_follows_the_other_where_it_is_not_sure) {
    Any any{{23}};
    int sure = 0, split = 0, alone = 0;
    for (int k = 0; k < 1500; ++k) {
        ground_speed_state_t state = any.past(ours());
        any.value(ours(), state);
        if (any.one_in(2)) state.value_accel_m_s2 = narrow(any.between(-0.2, 0.2));
        state.other_alive = any.one_in(4);
        state.doubt_m_s = 1;
        state.doubt_m2_s2 = 1;
        state.other.ticks = 7;
        const ground_speed_state_t was = state;
        const ground_speed_track_t track = any.track();
        const double z = wide(state.value_m_s), wheel = wide(state.value_wheel_m_s);
        const double m = any.between(-0.5, 0.5), S = any.log_between(1e-3, 1), told = 4 * z * m / S; // 2 ln exp(2 z m/S)
        const double odds = told + wheel_odds(z, wheel) + force_odds(state);
        if (near(std::fabs(told), 18, 1e-2) || near(std::fabs(odds), 18, 1e-2) || near(odds, 0, 1e-2)) continue;
        const float sign = ground_speed_choose_sign(&ours(), &state, &track, state.value_m_s, narrow(m), narrow(S), state.value_wheel_m_s);
        if (std::fabs(told) > 18 || was.other_alive) {
            EXPECT_EQ(sign, m < 0 ? -1 : 1);
            EXPECT_EQ(state.other_alive, was.other_alive);
            EXPECT_EQ(state.other.ticks, 7);
            sure++;
            continue;
        }
        EXPECT_EQ(sign, odds < 0 ? -1 : 1);
        EXPECT_NEAR(state.odds, std::fabs(odds), 1e-3 * (1 + std::fabs(odds)));
        EXPECT_EQ(state.other_alive, std::fabs(odds) < 18);
        EXPECT_EQ(state.other.q20, state.integral_q20[state.head]);
        EXPECT_EQ(state.other.ticks, 0);
        EXPECT_EQ(state.doubt_m_s, 0);
        EXPECT_EQ(state.doubt_m2_s2, 0);
        expect_same(state.other.at, track, 0);
        (state.other_alive ? split : alone) += 1;
    }
    EXPECT_GT(std::min({sure, split, alone}), 20);
}

// 1 where the wheels turn with the track, as fast as the radar's value but for 15 % and slip; -1 against it.
int with_wheels(const ground_speed_state_t &state) {
    const double z = wide(state.value_m_s), wheel = wide(state.value_wheel_m_s);
    if (z >= 1.15 * std::fabs(wheel) || std::fabs(wheel_odds(z, wheel)) < 14) return 0;
    return (wheel < 0) == (state.speed_m_s < 0) ? 1 : -1;
}

TEST(GroundSpeedSign, wheels_or_friction_against_the_sign_ask_anew_after_half_a_second_of_values) {
    Any any{{24}};
    int asked = 0, forgot = 0, waited = 0;
    for (int k = 0; k < 1500; ++k) {
        ground_speed_state_t state = any.past(ours());
        any.value(ours(), state);
        if (any.one_in(2)) state.value_m_s = narrow(std::fabs(wide(state.value_wheel_m_s)) * any.between(0.8, 1.25));
        state.against = static_cast<int32_t>(any.next() % 16) - 12; // below 0: (27)
        state.rolls = any.one_in(2);
        const ground_speed_state_t was = state;
        const double z = wide(state.value_m_s), force = force_odds(state), drags = state.speed_m_s < 0 ? force : -force;
        if (near(drags, 1, 1e-3) || near(z, 1.15 * std::fabs(wide(state.value_wheel_m_s)))) continue;
        const bool against = drags > 1 || with_wheels(state) < 0;
        const int count = against ? was.against + (was.rolls ? 2 : 1) : was.against < 0 ? was.against + 1 : 0;
        ground_speed_ask_again(&ours(), &state);
        EXPECT_EQ(state.other_alive, count >= 4) << k;
        EXPECT_EQ(state.against, count >= 4 ? -1 : count); // -1: asked, (27)
        forgot += count == 0 && was.against > 0 ? 1 : 0, waited += against && was.against < -2 ? 1 : 0;
        expect_same(ground_speed_best_of(&state), ground_speed_best_of(&was), 0);
        if (count < 4) continue;
        asked++; // the mirror image of (2) has the value with the other sign, and the bias that mirrors the window's acceleration
        EXPECT_EQ(state.odds, ours().against_odds);
        const double bias = 2 * wide(was.value_accel_m_s2) - wide(was.bias_m_s2), ticks = ours().window->ticks;
        const double p_bb = wide(was.p_bb) + 4 * ticks * wide(was.speed_noise_m2_s2) * square(wide(ours().window->per_s));
        const ground_speed_track_t told = ground_speed_told(&ours(), &was, was.speed_m_s < 0 ? 1 : -1, narrow(bias), narrow(p_bb));
        expect_same(state.other.at, told, 3);
        EXPECT_EQ(state.other.q20, state.integral_q20[state.head]);
    }
    EXPECT_GT(std::min({asked, forgot, waited}), 20);
}

TEST(GroundSpeedSign, the_other_sign_sees_each_value_a_tick_later_and_the_odds_decide) {
    const ground_speed_config_t &config = ours();
    Any any{{25}};
    int won = 0, stayed = 0, merged = 0, given_up = 0, anew = 0, answered = 0, unasked = 0, kept = 0, moot = 0, disowned = 0, late = 0;
    for (int k = 0; k < 9000; ++k) {
        ground_speed_state_t state = any.past(config);
        any.value(config, state);
        if (any.one_in(2)) state.value_m_s = narrow(std::fabs(wide(state.value_wheel_m_s)) * any.between(0.8, 1.1));
        state.value_heard_m_s = state.value_m_s;
        state.value_change_m_s = narrow(any.between(-0.05, 0.05));
        state.speed_m_s = narrow(wide(state.value_sign) * wide(state.value_m_s) + any.between(-0.1, 0.1));
        state.other.at = any.track(1, 0.5);
        state.other.at.speed_m_s =
            narrow(any.one_in(4) ? wide(state.speed_m_s) + any.between(-0.1, 0.1) : -wide(state.speed_m_s) + any.between(-0.2, 0.2));
        state.other.ticks = 3 + static_cast<int32_t>(any.next() % 12);
        state.other.q20 = state.integral_q20[(state.head + GROUND_SPEED_HISTORY - state.other.ticks) % GROUND_SPEED_HISTORY];
        state.other_alive = true;
        state.odds = narrow(any.one_in(3) ? any.between(14, 18) : any.between(0, 18));
        state.rolls = any.one_in(2);
        state.rolls_ticks = any.one_in(4) ? 10 : 0;
        state.rolls_wait = any.one_in(3) ? 50 : 0;
        state.roll_denied = any.one_in(3);
        state.agile_sum = 1;
        state.refused = any.one_in(3) ? 1 + static_cast<int32_t>(any.next() % 4) : 0;
        state.misfit = narrow(any.one_in(2) ? any.between(1, 1.49) : any.between(1.51, 4));
        state.against = any.one_in(2) ? -1 : 1; // asked, or not
        const ground_speed_state_t was = state;
        // until a tick ago, when the best track saw the value
        ground_speed_track_t at = was.other.at;
        const double n = was.other.ticks - 1, tau = wide(was.value_tau_s);
        ground_speed_move(&config, &at, narrow(passed(was, 1, was.other.ticks)), narrow(0.01 * n), narrow(n * wide(was.speed_noise_m2_s2)),
                          narrow(n * wide(config.bias_noise_m2_s4)));
        const ground_speed_value_t value = ground_speed_value_for(&config, &was, &at, was.value_accel_m_s2 - at.bias_m_s2);
        const double z = wide(value.speed_m_s), m = mean_of(at, tau) - wide(was.value_change_m_s),
                     S = spread_of(at, tau) + wide(value.noise_m2_s2);
        const double told = 4 * z * m / S, sign = std::fabs(told) >= 18 ? (m < 0 ? -1 : 1) : -wide(was.value_sign), e = sign * z - m;
        ground_speed_correct(&config, &at, narrow(e), was.value_tau_s, value.noise_m2_s2);
        const int with = with_wheels(was);
        const double force = force_odds(was), cost = e * e / S + wide(ground_speed_ln_rough(narrow(S)));
        double odds = wide(was.odds);
        if (was.rolls && with < 0 && odds > 4) odds = 4, anew++; // (18)
        odds += std::clamp(cost - wide(was.value_cost), -12.0, 12.0) + with * (was.rolls ? 3.0 : 0.5) +
                0.25 * (was.speed_m_s < 0 ? -force : force);
        const bool disowns = was.roll_denied && cost < wide(was.value_cost); // (13): and the other word explains it better
        if (was.roll_denied && near(cost, wide(was.value_cost), 1e-2)) continue;
        odds -= disowns ? 12 : 0;
        if (near(std::fabs(told), 18, 1e-2) || near(odds, 0, 1e-2) || near(std::fabs(odds), 18, 1e-2)) continue;
        if (near(wide(was.value_m_s), 1.15 * std::fabs(wide(was.value_wheel_m_s)))) continue;
        ground_speed_update_other(&config, &state);
        EXPECT_NEAR(state.odds, std::fabs(odds), 1e-2) << k;
        EXPECT_FALSE(state.roll_denied); // one value, once
        disowned += disowns && odds < 0 ? 1 : 0;
        ground_speed_track_t best = ground_speed_best_of(&was), other = at;
        if (odds < 0) { // they change places, as of now
            ground_speed_move(&config, &other, narrow(passed(was, 0, 1)), 0.01f, was.speed_noise_m2_s2, config.bias_noise_m2_s4);
            std::swap(best, other);
            EXPECT_EQ(state.other.q20, state.integral_q20[state.head]);
            EXPECT_EQ(state.other.ticks, 0);
            EXPECT_EQ(state.rolls_ticks, 0); // the wheels' word was wrong
            EXPECT_EQ(state.agile_sum, was.rolls_ticks > 0 || (was.misfit < 1.5f && was.refused == 0) ? 0 : 1); // (26)
            EXPECT_EQ(state.against, was.against);
            EXPECT_NEAR(state.value_cost, cost, 1e-3 * (1 + std::fabs(cost))); // (7) compares with the best, which this is now
            won++, kept += state.agile_sum > 0 ? 1 : 0;
        } else {
            EXPECT_EQ(state.other.ticks, 1);
            EXPECT_EQ(state.other.q20, was.integral_q20[(was.head + GROUND_SPEED_HISTORY - 1) % GROUND_SPEED_HISTORY]);
            EXPECT_EQ(state.rolls_ticks, was.rolls_ticks);
            EXPECT_EQ(state.agile_sum, 1);
            EXPECT_EQ(state.value_cost, was.value_cost);
            const bool answers = odds > 18 && with < 0 && was.against < 0; // (27): the wheels' question
            EXPECT_EQ(state.against, answers ? -12 : was.against) << k;
            stayed++, answered += answers ? 1 : 0, unasked += odds > 18 && with < 0 && was.against > 0 ? 1 : 0;
        }
        expect_same(ground_speed_best_of(&state), best, 10);
        expect_same(state.other.at, other, 10);
        const double apart = wide(best.speed_m_s) - wide(other.speed_m_s), both = (wide(best.p_vv) + wide(other.p_vv)) / 2;
        if (std::fabs(apart * apart / both - 1) < 1e-2) continue;
        const bool one = apart * apart < both;                                      // they have met
        const bool same = std::fabs(told) >= 18 && sign * wide(was.value_sign) > 0; // (34)
        const bool dropped = odds > 0 && same && with < 0 && was.rolls_ticks == 0 && was.rolls_wait == 0;
        const bool alive = !one && !dropped && std::fabs(odds) < 18; // the wheels' word, too, where it has lost
        late += odds > 0 && same && with < 0 && was.rolls_ticks == 0 && was.rolls_wait > 0 && alive ? 1 : 0;
        EXPECT_EQ(state.other_alive, alive) << k;
        const double doubt = 1 / (1 + std::pow(1 + std::fmin(100, std::fabs(odds)) / 16, 8));
        EXPECT_NEAR(state.doubt_m_s, alive ? doubt * apart : 0, 1e-3);
        EXPECT_NEAR(state.doubt_m2_s2, alive ? doubt * (1 - doubt) * apart * apart : 0, 1e-3);
        merged += one ? 1 : 0;
        given_up += !one && std::fabs(odds) > 18 ? 1 : 0;
        moot += dropped && !one && std::fabs(odds) < 18 ? 1 : 0;
    }
    EXPECT_GT(std::min({won, stayed, merged, given_up, anew, answered, unasked, kept, moot, disowned, late}), 20)
        << answered << ' ' << unasked << ' ' << kept << ' ' << moot << ' ' << disowned << ' ' << late;
}

// --- a sign that is held, (17), and wheels that roll, (18)

TEST(GroundSpeedSign, wheels_roll_that_stay_with_the_radar_and_have_not_parted_from_it_for_three_seconds) {
    Any any{{26}};
    int rolled = 0, parted = 0, stayed = 0;
    for (int k = 0; k < 1500; ++k) {
        ground_speed_state_t state = any.past(ours());
        any.value(ours(), state);
        const double rim = std::fabs(wide(state.wheel_mean_m_s));
        state.beside_mean_m_s = narrow(any.between(-0.03 - 0.14 * rim, 0.015 + 0.08 * rim));
        state.value_beside_m_s = narrow(any.one_in(3) ? wide(state.beside_mean_m_s) + any.between(-0.3, 0.3)
                                                      : any.between(-0.03 - 0.14 * rim, 0.015 + 0.08 * rim));
        state.parted_values = any.one_in(2) ? 0 : static_cast<int32_t>(any.next() % 25);
        const ground_speed_state_t was = state;
        const double left2 = square(wide(was.value_beside_m_s) - wide(was.beside_mean_m_s)), may = 16 * wide(was.value_noise_m2_s2) + 4e-4;
        const auto close = [&](float x) { return wide(x) > -0.02 - 0.12 * rim && wide(x) < 0.01 + 0.06 * rim; };
        if (std::fabs(left2 / may - 1) < 1e-3) continue;
        ground_speed_watch_held(&ours(), &state);
        const bool parts = left2 > may && !close(was.value_beside_m_s);                       // (37)
        EXPECT_EQ(state.parted_values, parts ? 24 : std::max(0, was.parted_values - 1)) << k; // 24 values: three seconds
        EXPECT_EQ(state.rolls, state.parted_values == 0 && close(was.value_beside_m_s) && close(was.beside_mean_m_s)) << k;
        rolled += state.rolls ? 1 : 0;
        parted += parts ? 1 : 0, stayed += left2 > may && !parts ? 1 : 0;
    }
    EXPECT_GT(std::min({rolled, parted, stayed}), 20) << rolled << ' ' << parted << ' ' << stayed;
}

// A drive forwards (or backwards) whose radar hears no turn; `but` spoils one value.
ground_speed_state_t drives(double way, int values, const std::function<void(ground_speed_state_t &, int)> &but = {}) {
    ground_speed_state_t state;
    ground_speed_reset(&ours(), &state);
    for (int k = 0; k < values; ++k) {
        state.speed_m_s = narrow(0.5 * way);
        state.p_vv = 1e-4f;
        state.value_heard_m_s = 0.5f;
        state.value_m_s = 0.5f;
        state.value_wheel_m_s = narrow(0.52 * way);
        state.value_accel_m_s2 = 0;
        state.value_tau_s = 0.25f;
        state.value_noise_m2_s2 = 1e-3f;
        state.refused = 0;
        state.other_alive = false;
        if (but) but(state, k);
        ground_speed_watch_held(&ours(), &state);
    }
    return state;
}

// (28): e^2/S over eight seconds, twice of which is 1 where the claim is right; R as it is, and the share of it that is taken off.
TEST(GroundSpeedSign, the_claim_follows_how_values_scatter) {
    Any any{{51}};
    int least = 0, most = 0, between = 0, both = 0, parted = 0, wider = 0;
    for (int k = 0; k < 1500; ++k) {
        ground_speed_state_t state = any.past(ours());
        any.value(ours(), state);
        state.scatter = narrow(any.log_between(0.02, 6));
        state.value_scatter = narrow(any.one_in(4) ? any.between(10, 50) : any.between(0, 3));
        state.other_alive = any.one_in(4);
        const ground_speed_state_t was = state;
        ground_speed_watch_held(&ours(), &state);
        const double scatter = wide(was.scatter) + 0.015 * (std::fmin(12.25, wide(was.value_scatter)) - wide(was.scatter));
        const bool unknown = was.other_alive || was.value_parts;
        const double g = unknown ? 1 : std::clamp(2 * scatter, 0.25, 4.0), R = wide(was.value_noise_m2_s2);
        EXPECT_NEAR(state.scatter, scatter, eps);
        EXPECT_NEAR(state.calm, g, 2 * eps) << k;
        EXPECT_EQ(state.calm_at_m2_s2, was.value_noise_m2_s2);
        EXPECT_NEAR(state.calm_less_m2_s2, (1 - g) * R, 1e-4 * R * (1 + g));
        least += g < 0.251 ? 1 : 0, most += g > 3.999 ? 1 : 0, wider += g > 1.1 && g < 3.9 ? 1 : 0, between += g > 0.3 && g < 0.9 ? 1 : 0;
        both += was.other_alive && scatter < 0.4 ? 1 : 0, parted += was.value_parts && scatter < 0.4 ? 1 : 0;
    }
    EXPECT_GT(std::min({least, most, wider, between, both, parted}), 50);
}

TEST(GroundSpeedSign, a_sign_is_held_from_the_sixth_sure_value_on_and_each_doubt_begins_anew) {
    for (const double way : {1.0, -1.0}) {
        for (int values = 1; values < 9; ++values) {
            EXPECT_EQ(drives(way, values).held_sign, narrow(values < 6 ? 0 : way)) << values;
            EXPECT_EQ(drives(way, values).held_values, std::min(values, 6));
        }
        using S = ground_speed_state_t &;
        const auto holds = [&](const std::function<void(S)> &but, int at = 3) {
            return drives(way, 8, [&](S state, int k) {
                       if (k == at) but(state);
                   }).held_sign != 0;
        };
        EXPECT_TRUE(holds([](S) {}));
        EXPECT_FALSE(holds([](S state) { state.other_alive = true; }));
        EXPECT_FALSE(holds([](S state) { state.refused = 1; }));
        EXPECT_FALSE(holds([](S state) { state.speed_m_s = -state.speed_m_s; }));
        EXPECT_FALSE(holds([](S state) { state.value_wheel_m_s = -state.value_wheel_m_s; }));
        EXPECT_FALSE(holds([](S state) { state.p_vv = 0.029f; })); // three sigma of 0.5 m/s: 0.0278
        EXPECT_TRUE(holds([](S state) { state.p_vv = 0.027f; }));
        // held, it is let go by what may be a turn
        EXPECT_TRUE(holds([](S) {}, 7));
        EXPECT_TRUE(holds([](S state) { state.value_heard_m_s = 0.37f; }, 7));
        EXPECT_FALSE(holds([](S state) { state.value_heard_m_s = 0.33f; }, 7)); // 0.7 of its mean
        EXPECT_TRUE(holds([](S state) { state.value_accel_m_s2 = 1.15f; }, 7));
        EXPECT_TRUE(holds([](S state) { state.value_accel_m_s2 = -1.15f; }, 7));
        EXPECT_FALSE(holds([](S state) { state.value_accel_m_s2 = 1.25f; }, 7));
        EXPECT_FALSE(holds([](S state) { state.value_accel_m_s2 = -1.25f; }, 7));
        EXPECT_TRUE(holds([](S state) { state.value_accel_m_s2 = 1.25f, state.bias_m_s2 = 0.2f; }, 7));
        EXPECT_TRUE(holds([](S state) { state.value_accel_m_s2 = 0.45f, state.lean_q8 = 1; }, 7));
        EXPECT_FALSE(holds([](S state) { state.value_accel_m_s2 = 0.55f, state.lean_q8 = 1; }, 7)); // gyros tell what of it is a slope
        EXPECT_FALSE(holds([&](S state) { state.value_wheel_m_s = narrow(1.05 * way); }, 7));       // half the rim's speed
        EXPECT_TRUE(holds([&](S state) { state.value_wheel_m_s = narrow(0.95 * way); }, 7));
        EXPECT_FALSE(holds([&](S state) { state.value_wheel_m_s = narrow(0.44 * way); }, 7)); // 1.1 times
        EXPECT_TRUE(holds([&](S state) { state.value_wheel_m_s = narrow(0.47 * way); }, 7));
        EXPECT_FALSE(holds([](S state) { state.value_wheel_m_s = -state.value_wheel_m_s; }, 7));
        EXPECT_FALSE(
            holds([](S state) { state.value_heard_m_s = 0.12f, state.held_level_m_s = 0.12f, state.value_wheel_m_s *= 0.24f; }, 7)); // slow
        // its level is the mean of the values: half a second's
        const ground_speed_state_t state = drives(way, 7, [](S s, int k) { s.value_heard_m_s = k == 6 ? 0.54f : 0.5f; });
        EXPECT_NEAR(state.held_level_m_s, 0.51, 1e-6);
    }
}

TEST(GroundSpeedSign, an_estimate_that_ran_through_zero_against_a_held_sign_takes_the_value) {
    for (const double way : {1.0, -1.0}) {
        for (const double share : {-0.2, -0.3, -1.0, 0.1}) { // of the value; a quarter is the limit
            ground_speed_state_t was;
            const ground_speed_state_t is = drives(way, 8, [&](ground_speed_state_t &state, int k) {
                if (k < 7) return;
                state.speed_m_s = narrow(0.5 * way * share);
                state.bias_m_s2 = 0.3f;
                state.p_bb = 0.01f;
                state.rolls_ticks = 4;
                state.gyro_tried = true;
                state.other_alive = true;
                state.one_sided = 1;
                state.agile_sum = 1;
                state.agile_left = 2;
                was = state;
            });
            const bool taken = share < -0.25;
            EXPECT_EQ(is.held_sign, narrow(way));
            EXPECT_EQ(is.other_alive, !taken);
            EXPECT_EQ(is.rolls_ticks, taken ? 0 : 4);
            EXPECT_EQ(is.gyro_tried, !taken);
            EXPECT_EQ(is.one_sided, taken ? 0 : 1);
            EXPECT_EQ(is.agile_sum, taken ? 0 : 1);
            EXPECT_EQ(is.agile_left, taken ? 0 : 2);
            const ground_speed_track_t told = ground_speed_told(&ours(), &was, narrow(way), was.bias_m_s2, was.p_bb + ours().agile_m2_s4);
            expect_same(ground_speed_best_of(&is), taken ? told : ground_speed_best_of(&was), 0);
        }
    }
}

// --- a slide, (15)

struct Line {
    double left = 0, at_mean = 0, slope = 0, t_mean = 0, t_square = 0;
};

// Least squares of y over t.
Line line_through(const std::vector<double> &t, const std::vector<double> &y) {
    Line line;
    const double n = static_cast<double>(t.size());
    for (std::size_t i = 0; i < t.size(); ++i) line.t_mean += t[i] / n, line.at_mean += y[i] / n;
    double ty = 0;
    for (std::size_t i = 0; i < t.size(); ++i) line.t_square += square(t[i] - line.t_mean), ty += (t[i] - line.t_mean) * y[i];
    line.slope = ty / line.t_square;
    for (std::size_t i = 0; i < t.size(); ++i) line.left += square(y[i] - line.at_mean - line.slope * (t[i] - line.t_mean));
    return line;
}

// Whether the magnitudes, oldest first, fall and then rise, but for a tenth of the smaller end, to below 0.8 of it.
bool dips(const std::vector<double> &d) {
    const double end = std::fmin(d.front(), d.back());
    const auto least = static_cast<std::size_t>(std::min_element(d.begin(), d.end()) - d.begin());
    for (std::size_t i = 1; i < d.size(); ++i) {
        if (i <= least ? d[i] - d[i - 1] > 0.1 * end : d[i - 1] - d[i] > 0.1 * end) return false;
    }
    return d[least] < 0.8 * end;
}

TEST(GroundSpeedSign, a_line_through_zero_is_found_where_it_fits_and_the_straight_one_does_not) {
    const ground_speed_config_t &config = ours();
    Any any{{27}};
    std::array<int, 5> seen = {};
    for (int k = 0; k < 4000; ++k) {
        ground_speed_state_t state = any.past(config);
        const int count = any.one_in(2) ? 6 : 5;
        state.slide.ticks = static_cast<uint32_t>(any.next());
        state.slide.newest = static_cast<int32_t>(any.next() % 6);
        state.slide.held = 6;
        state.slide.due = count == 6 ? 2 : 1;
        // oldest first: a body that slides, d = |v0 + a t|, its accelerometer blind to it
        const double way = any.either(), v0 = any.between(0.15, 0.8), a = -any.between(0.6, 3) * v0, noise = any.one_in(2) ? 0.01 : 0.05;
        std::vector<double> t, d, V, tau;
        const uint32_t now = state.slide.ticks - 2 - static_cast<uint32_t>(any.next() % 4);
        const double drift = any.between(-0.3, 0.3), jolt = any.one_in(3) ? 0.1 : 0.005; // what jolts fits no line
        for (int i = 0; i < 6; ++i) {
            const int at = (state.slide.newest + 1 + i) % 6;
            tau.push_back(wide(config.window->tau_s) + any.between(0, 0.03));
            state.slide.came[at] = now - static_cast<uint32_t>(12 * (5 - i) + (i < 5 ? any.next() % 2 : 0));
            const double middle = -0.01 * (now - state.slide.came[at]) - tau.back(), since = 0.8 + middle;
            t.push_back(middle);
            d.push_back(std::fabs(v0 + a * since) + noise * 0.3 * any.normal() + 0.02);
            V.push_back(drift * since + jolt * any.normal());
            state.slide.tau_s[at] = narrow(tau.back());
            state.slide.heard_m_s[at] = narrow(d.back());
            state.slide.alike_m_s[at] = narrow(any.between(0, 0.02));
            state.slide.q20[at] = state.integral_q20[state.head] + static_cast<int32_t>(V.back() * 1048576);
            state.slide.sign[at] = narrow(any.one_in(8) ? -way : way);
        }
        state.speed_m_s = narrow(way * any.between(0.05, 0.5));
        state.value_noise_m2_s2 = narrow(noise * noise);
        state.other_alive = any.one_in(2);
        state.odds = narrow(any.between(0, 18));
        state.held_sign = narrow(way);
        state.held_values = 6;
        const ground_speed_state_t was = state;
        const auto skip = static_cast<std::size_t>(6 - count);
        const double alike = wide(was.slide.alike_m_s[(was.slide.newest + 1) % 6]); // of the oldest of all
        const std::vector<double> tt(t.begin() + static_cast<long>(skip), t.end()), dd(d.begin() + static_cast<long>(skip), d.end());
        const double span = tt.back() - tt.front();
        const auto noise_of = [&](double change) { return noise * noise + alike * alike + square(0.07 * change / span); };
        Line best;
        const auto fit = [&](std::size_t newer) { // so many of the newest have turned
            std::vector<double> y;
            for (std::size_t i = 0; i < tt.size(); ++i) y.push_back((i + newer >= tt.size() ? -way : way) * dd[i] - V[i + skip]);
            return line_through(tt, y);
        };
        best.left = 1e9;
        for (std::size_t newer = 1; newer < tt.size(); ++newer) {
            const Line line = fit(newer);
            if (line.left < best.left) best = line;
        }
        const double R = noise_of(dd.back() + dd.front()), chi2 = best.left / R,
                     told = fit(0).left / noise_of(dd.back() - dd.front()) - chi2;
        const bool went = was.slide.sign[(was.slide.newest + 7 - count) % 6] * narrow(way) < 0;
        const bool close = near(told, 8, 0.05) || near(chi2, 3 * (count - 2), 0.02);
        const bool is = !went && dips(dd) && told > 8 && chi2 < 3 * (count - 2);
        if (close) continue;
        ground_speed_watch_slide(&config, &state);
        seen[static_cast<std::size_t>(is ? 0 : went ? 1 : !dips(dd) ? 2 : chi2 < 3 * (count - 2) ? 3 : 4)]++;
        EXPECT_EQ(state.slide.due, is ? 0 : was.slide.due - 1) << k;
        const double late = -best.t_mean, odds = std::clamp(16 - told, 2.0, 16.0), p_bb = R / best.t_square; // from the values' mean to now
        const double since = 0.01 * (was.slide.ticks - now);
        const double v = best.at_mean + best.slope * (late + since), b = -best.slope; // V of this state has not moved since
        if (!is || near(v, 0, 1e-3) || near(odds, wide(was.odds), 1e-2)) continue;
        const bool taken = v * way < 0 && (!was.other_alive || odds < wide(was.odds));
        EXPECT_EQ(state.other_alive, taken || was.other_alive) << k;
        EXPECT_EQ(state.held_sign, taken ? 0 : was.held_sign);
        EXPECT_EQ(state.held_values, taken ? 0 : 6);
        if (!taken) {
            EXPECT_EQ(state.odds, was.odds);
            continue;
        }
        EXPECT_NEAR(state.odds, odds, 0.02);
        EXPECT_NEAR(state.other.at.speed_m_s, v, 1e-3);
        EXPECT_NEAR(state.other.at.bias_m_s2, std::clamp(b, -3.0, 3.0), 2e-3);
        EXPECT_NEAR(state.other.at.p_vv, R / count + square(late + since) * p_bb, 1e-3 * R);
        EXPECT_NEAR(state.other.at.p_vb, -(late + since) * p_bb, 1e-2 * p_bb);
        EXPECT_NEAR(state.other.at.p_bb, p_bb + 0.25, 1e-3 * p_bb + eps); // the slope need not last: (0.5 m/s^2)^2
        EXPECT_EQ(state.other.q20, state.integral_q20[state.head]);
    }
    for (const int n : seen) {
        EXPECT_GT(n, 15) << testing::PrintToString(seen);
    }
}

TEST(GroundSpeedSign, no_slide_is_looked_for_before_six_values_and_each_is_remembered_as_it_came) {
    Any any{{28}};
    ground_speed_state_t state = any.past(ours());
    for (int k = 1; k <= 20; ++k) {
        any.value(ours(), state);
        state.alike_m_s = narrow(any.uniform());
        state.slide.ticks += 12;
        ground_speed_remember(&state);
        const int at = state.slide.newest;
        EXPECT_EQ(at, k % SLIDE_VALUES);
        EXPECT_EQ(state.slide.held, std::min(k, 6));
        EXPECT_EQ(state.slide.heard_m_s[at], state.value_heard_m_s);
        EXPECT_EQ(state.slide.alike_m_s[at], state.alike_m_s);
        EXPECT_EQ(state.slide.sign[at], state.value_sign);
        EXPECT_EQ(state.slide.came[at], state.slide.ticks);
        EXPECT_EQ(state.slide.tau_s[at], state.value_tau_s);
        const int32_t moved = state.integral_q20[state.head] - state.slide.q20[at]; // V in the window's middle is less by its change
        EXPECT_NEAR(moved / 1048576.0, state.value_change_m_s, 2e-6);
        if (k < 6) {
            state.slide.due = 2;
            const ground_speed_state_t was = state;
            ground_speed_watch_slide(&ours(), &state);
            EXPECT_EQ(state.slide.due, 1);
            EXPECT_FALSE(state.other_alive);
            EXPECT_EQ(state.odds, was.odds);
        }
    }
}

// --- the bias that may jump, (7)

// [v, b] now as it was in the middle of the window of the value of two ticks ago; and back, with the opposite of both.
ground_speed_track_t shifted(const ground_speed_track_t &t, double tau, double change) {
    return {narrow(mean_of(t, tau) - change), t.bias_m_s2, narrow(spread_of(t, tau)), narrow(wide(t.p_vb) + tau * wide(t.p_bb)), t.p_bb};
}

TEST(GroundSpeedSign, the_track_whose_bias_may_jump_is_taken_when_its_sum_tells) {
    const ground_speed_config_t &config = ours();
    Any any{{29}};
    int began = 0, taken = 0, split = 0, sooner = 0, waited = 0, kept = 0, stayed = 0;
    for (int k = 0; k < 8000; ++k) {
        ground_speed_state_t state = any.past(config);
        any.value(config, state);
        if (any.one_in(2)) state.value_m_s = narrow(std::fabs(wide(state.value_wheel_m_s)) * any.between(0.8, 1.1));
        state.value_heard_m_s = state.value_m_s;
        state.p_bb = narrow(any.log_between(1e-3, 0.3));
        state.p_vb = narrow(any.between(-0.9, 0.9) * std::sqrt(wide(state.p_bb) * wide(state.p_vv)));
        state.apart_m_s = narrow(any.one_in(2) ? 0.3 : 0.02);
        state.wheel_mean_m_s = narrow(wide(state.wheel_m_s) + any.either() * (any.one_in(3) ? 0.21 : 0.19)); // (21)
        state.agile.at = any.track(1, 1);
        if (any.one_in(2)) state.agile.at.speed_m_s = narrow(any.either() * wide(state.value_m_s) + any.between(-0.1, 0.1));
        state.agile.ticks = 3 + static_cast<int32_t>(any.next() % 20);
        state.agile_left = any.one_in(4) ? 0 : 1 + static_cast<int32_t>(any.next() % 4);
        state.agile_sum = narrow(any.one_in(3) ? 0 : any.between(0, 20));
        state.refused = 2;
        state.one_sided = 1;
        if (any.one_in(3)) state.other_alive = true, state.other.at = any.track(1, 1), state.odds = narrow(any.between(0, 18));
        const double moved = any.between(-0.2, 0.2), tau = wide(state.value_tau_s) + 0.02;
        const int32_t middle = ground_speed_middle_q20(&state, 2);
        const double to_now = passed(state, 0, 2) + wide(state.value_change_m_s); // V from the window's middle to now
        EXPECT_NEAR(fixed_wrap_difference(state.integral_q20[state.head], middle) / 1048576.0, to_now, 2e-6);
        state.agile.q20 = middle - static_cast<int32_t>(moved * 1048576);
        if (any.one_in(3)) { // just sure of its sign, or just not
            ground_speed_track_t at = state.agile.at;
            const double n = state.agile.ticks - 2;
            ground_speed_move(&config, &at, narrow(moved), narrow(n * 0.01), narrow(n * wide(state.speed_noise_m2_s2)), config.agile_m2_s4);
            const ground_speed_value_t value = ground_speed_value_for(&config, &state, &at, state.value_accel_m_s2 - at.bias_m_s2);
            const double S = wide(at.p_vv) + wide(value.noise_m2_s2),
                         v = any.either() * any.between(16, 21) * S / (4 * wide(value.speed_m_s));
            state.agile.at.speed_m_s += narrow(v - wide(at.speed_m_s));
            state.agile_sum = 25;
        }
        const ground_speed_state_t was = state;
        const ground_speed_track_t best = ground_speed_best_of(&was);
        ground_speed_update_agile(&config, &state);
        EXPECT_EQ(state.agile.q20, middle);
        EXPECT_EQ(state.agile.ticks, 2);
        if (was.agile_left == 0) {
            ground_speed_track_t at = shifted(best, tau, to_now);
            at.p_bb += config.agile_m2_s4;
            ground_speed_hold(&config, &at);
            expect_same(state.agile.at, at, 3);
            EXPECT_EQ(state.agile_left, config.agile_values);
            EXPECT_EQ(state.agile_sum, was.agile_sum);
            began++;
            continue;
        }
        ground_speed_track_t at = was.agile.at;
        const double n = was.agile.ticks - 2;
        ground_speed_move(&config, &at, narrow(moved), narrow(n * 0.01), narrow(n * wide(was.speed_noise_m2_s2)), config.agile_m2_s4);
        const ground_speed_value_t value = ground_speed_value_for(&config, &was, &at, was.value_accel_m_s2 - at.bias_m_s2);
        const double z = wide(value.speed_m_s), S = wide(at.p_vv) + wide(value.noise_m2_s2), told = 4 * z * wide(at.speed_m_s) / S;
        const double odds = told + (std::fabs(told) < 18 ? wheel_odds(z, wide(was.value_wheel_m_s)) + force_odds(was) : 0);
        if (near(std::fabs(told), 18, 1e-2) || near(odds, 0, 2e-2) || near(std::fabs(odds), 18, 2e-2)) continue;
        const double sign = odds < 0 ? -1 : 1, e = sign * z - wide(at.speed_m_s);
        const ground_speed_track_t before = at;
        const double cost = e * e / S + wide(ground_speed_ln_rough(narrow(S)));
        ground_speed_correct(&config, &at, narrow(e), 0, value.noise_m2_s2);
        const double sum = std::fmax(0, wide(was.agile_sum) + std::fmin(wide(was.value_cost) - cost, 10) - wide(config.agile_drift)); // (7)
        const double apart2 = square(wide(was.apart_m_s)) - square(0.06) - 112 * wide(was.speed_noise_m2_s2);
        const bool departs = std::fabs(wide(was.apart_m_s)) > 1.5 * std::fabs(wide(was.wheel_m_s) - wide(was.wheel_mean_m_s));
        const double limit =
            apart2 > 0 && was.p_bb < 0.09f && departs ? 5 : 20; // where the body, accelerometer and wheels part, and the bias is known
        if (near(apart2, 0, 1e-5) || near(sum, limit, 2e-2) || near(sum, 0, 2e-2) || near(wide(was.p_bb), 0.09)) continue;
        expect_same(state.agile.at, at, 10);
        if (sum < limit) {
            EXPECT_NEAR(state.agile_sum, sum, 1e-2) << k;
            EXPECT_EQ(state.agile_left, was.agile_left == 1 && sum > 0 ? 1 : was.agile_left - 1); // not while it is about to win
            EXPECT_EQ(state.refused, 2);
            EXPECT_EQ(state.one_sided, 1);
            expect_same(ground_speed_best_of(&state), best, 0);
            EXPECT_EQ(state.other_alive, was.other_alive);
            waited++;
            continue;
        }
        EXPECT_EQ(state.agile_sum, 0);
        EXPECT_EQ(state.agile_left, 0);
        EXPECT_EQ(state.refused, 0);
        EXPECT_EQ(state.one_sided, 0);
        ground_speed_track_t now = shifted(at, -tau, -to_now);
        ground_speed_hold(&config, &now);
        expect_same(ground_speed_best_of(&state), now, 10);
        taken++;
        sooner += limit < 10 ? 1 : 0;
        if (std::fabs(odds) > 18) { // (35): what was best before, sure of its slope, stays as the other sign
            const double across = wide(best.speed_m_s) * wide(now.speed_m_s) + square(wide(config.slow_m_s));
            if (near(sum, 18, 2e-2) || near(across, 0, 1e-4) || near(wide(best.p_bb), 0.01, 1e-5)) continue;
            const bool turned = best.p_bb < 0.01f && across < 0, stays = turned && sum < 18;
            const double other_across = wide(was.other.at.speed_m_s) * wide(now.speed_m_s) + square(wide(config.slow_m_s));
            if (was.other_alive && near(other_across, 0, 1e-4)) continue;
            const bool other_stays = !turned && was.other_alive && other_across < 0; // (36)
            EXPECT_EQ(state.other_alive, stays || other_stays) << k;
            if (other_stays) {
                expect_same(state.other.at, was.other.at, 0);
                EXPECT_NEAR(state.odds, std::fmax(0, wide(was.odds) - 12), 1e-5) << k;
                stayed++;
            }
            if (!stays) continue;
            expect_same(state.other.at, best, 0);
            EXPECT_NEAR(state.odds, sum, 1e-2);
            EXPECT_EQ(state.other.q20, state.integral_q20[state.head]);
            EXPECT_EQ(state.other.ticks, 0);
            kept++;
            continue;
        }
        EXPECT_TRUE(state.other_alive) << k;
        ground_speed_track_t mirrored = before; // the same value with the other sign
        ground_speed_correct(&config, &mirrored, narrow(-sign * z - wide(before.speed_m_s)), 0, value.noise_m2_s2);
        mirrored = shifted(mirrored, -tau, -to_now);
        ground_speed_hold(&config, &mirrored);
        expect_same(state.other.at, mirrored, 10);
        EXPECT_NEAR(state.odds, std::fabs(odds), 2e-2);
        EXPECT_EQ(state.other.q20, state.integral_q20[state.head]);
        split++;
    }
    EXPECT_GT(std::min({began, taken, split, sooner, waited, kept, stayed}), 20)
        << began << ' ' << taken << ' ' << split << ' ' << sooner << ' ' << waited << ' ' << kept << ' ' << stayed;
}

} // namespace
