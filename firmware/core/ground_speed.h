// ground_speed.h - signed ground speed from the accelerometer and the radar's speed magnitude.
//
//   paper: v[k+1] = v[k] + a T,  P += Qv;  Doppler: K = P/(P + R)                     (1)  = (13), (14)
//   ours:  v[k+1] = v[k] + (a - b) T,  b[k+1] = b[k]                                  (2)
//          z + sum_j w_j (V(t) - V(t - s_j)) = v + tau b + n,  tau = sum_j w_j s_j    (3)
//
//   m[k] = m[k-1] + c (e |e|/S - m[k-1]), e the innovation of (3), S its variance      (4)
//   |m| > limit: P_bb += jump, m = 0                                                   (5)  the bias has drifted: a gentle slope
//   Qv = max(stated, q1, min(q4, 3 q1)),  q_n = mean (V[j] - 2 V[j-n] + V[j-2n])^2/(2 n)  (6)  the accelerometer's noise
//   L = max(0, L + min(c_best - c_agile, most) - drift),  c = e^2/S + ln S              (7)
//   R = f R0,  f *= 1 + share (min(e^2/S, gate^2) - 1)                                  (8)
//   odds of + over - = exp(((z + m)^2 - (z - m)^2)/2S) = exp(2 z m/S)                   (9)  m: the speed that (3) expects
//   X[k] = (X[k-1] + (a - b) T - (Rw[k] - Rw[k-1])) (1 - T/0.25 s)                     (10)
//   z = sqrt(d^2 - min((k a)^2, d^2/2)),  d the Doppler value, a the acceleration      (11)
//   cost of a sign: (f/s_f)^2 g(|u|) where f u < 0,  u = R w - v,  f the raw accelerometer's mean  (12)
//
// (3): a Doppler value is the mean of the speed over its window; V is the running integral of the raw accelerometer, w the
// window's weight. So the window's delay is exact without a longer state (derived in docs/firmware.md).
// (6): a rover's own acceleration hardly changes from tick to tick, white noise changes by sqrt(2) of itself (derived here): q1 = q4. Noise
// that lasts longer, as of a sensor's filter or of a body that rattles, walks further than its steps tell, and q4 is more; beyond three
// times it is the rover's own motion (assumed).
// (7): Page's cumulative sum for a change from one model to another. The other is a second filter whose bias may jump, as it does where a
// slope begins; when L passes its limit, it is taken.
// (8): values that scatter more than they should are trusted less.
// (9): a mixer tells |v| alone. Where one sign is not far more likely than the other, both are followed, each with its own [v, b], until
// the values tell; the wheels' sign is a weak witness, and of wheels that part the slowest speaks, if its rim agrees with d: it rolls
// beside others that spin. While both live, the standard deviation holds both. (10): what the accelerometer
// lets the speed change and the wheels do not, as long as no Doppler value tells of it, is slip or a slope: the variance grows by a share
// of X^2 - least^2, and (7) needs less. (11): the likelihood follows the window's fastest part; through zero it hears k |a| where the mean
// is 0. (12): an accelerometer feels no gravity that the body gives way to; it feels what the wheels do to the body, and dry friction acts
// along the slip's velocity u on any ground and any slope. A sign for which it would act against it is the less likely, beyond what the
// device's own bias may be; g goes from 0 for what rolling and its slip may be to 1.
// (13): where (10) passes its limit, slip is the reason only if the force pushes along the slip that it would be, -X: f sign(-X) > least.
// Else it is a slope that begins, under wheels that roll on: the best track keeps to the wheels' changes of speed for a window's length,
// its bias free to jump, and the one that believes the accelerometer is followed beside it, as the other sign is, until the radar's values
// tell. A slope that the gyros have just told of (lean.h) is no reason: then it is slip.
// (14): reported is v - c X (1 - X^2/(16 var X))^2 within four sigma of X: the accelerometer's white noise since the window's middle is in
// v, and no radar value has seen it; X holds the same noise and the wheels do not. c = cov/var X: 2 (1 - exp(-tau/0.25 s)) where that noise
// is all of X (derived here), and less by as much as the mean of X^2 is more. It is no more than 1.14 c sigma wrong where X is slip.
// (15): a body that slides back under wheels that drive forwards passes through zero, and neither wheels nor accelerometer need feel it:
//   s_i = -+d_i = c + V(t_i) - b (t_i - t_0),  the older of the last 5 or 6 values with the old sign, the newer with the other
// Where their magnitude falls and rises again, that line is laid for every place of the turn. If the best of them fits, and better by 16
// than the line without a turn, it is followed as the other sign from here on. Both signs are reported by their odds. What a line of
// interference had told is forgotten when it is taken off (doppler_relieved): speed, slope and sign begin anew.
//   r += T/(g t1 t2) (b - m) s^2/(s^2 + var X),  m += T/t1 (b - m)                    (16)
// r: what the gyro about y reads too much since its offset was learned. A lean that its offset turns is no slope, so b runs against it at
// g r; of a slope that the gyro tells rightly b sees nothing. What sways tells less of it. Until a gyro has told of anything m is b, for
// the slope on which it wakes up is none of its doing. Var v grows by (|b - m| beyond its noise)^2 s^2.
// Where (13) has an accuser in the lean itself, but value after value the radar stays with the wheels, the wheels' word is tried as well:
// if it stands, the gyro lies, and what it turned last is its offset. So it is where b nears its limit against the lean. While no value
// comes, nothing tells of a lean that runs off: the bias is known the less the longer that lasts.
//   |d| > 0.12 m/s,  |d| > 0.7 m,  |a - b| < 1.2 m/s^2,  0.5 |Rw| < m < 1.1 |Rw|         (17)  m: mean of |d| since the sign was sure
// A body that turns round passes through zero, and the radar hears it slow down, but for a turn within a window, which the accelerometer
// feels (0.5 m/s^2 where gyros tell what of it is a slope). A sign that was alone and sure (3 sigma) for six values, and is the wheels', is
// held while (17) holds: an estimate that has passed zero by |d|/4 all the same takes the value with that sign, and its bias is free to
// jump. (18): wheels whose rim has stayed with the radar's value for half a second (12 % and 2 cm/s slower, 6 % and 1 cm/s faster), and
// never parted from it within the last three, roll: their sign is a witness of exp(3/2) per value, and asks twice as soon.
//   |V(t) - V(t - 1 s) - b 1 s| > slow/2                                                (19)
// What stood and is loud a second later was pushed, and felt it; else the values are a lamp's, a fan's or a creep's remains, and for two
// minutes, in which a line is learnt, it stands on. Less than half of it is the noise of a second, and what the bias lags (assumed).
//   |R w| < slow,  d < slow,  d < |m| + 0.05 m/s,  |R w - R w'| < 0.05 m/s:  v = R w + n,  var n = 4 (0.015 m/s + |R w|/5)^2  (20)
// m: mean of R w; eight times a second, R w' the time before: wheels that spin up pass through such speeds. Where the radar's band-pass is
// deaf, wheels that creep as slowly are the better witness of speed and sign: their slip is a share of little. Each tells the same again,
// hence 4 (assumed; on simulated rovers they are 1 cm/s off there). The radar's own values have a variance of (2 cm/s)^2 more below 0.09
// m/s, less up to slow (its errors on a second generator: 1.7 to 2.2 cm/s). (12) takes a body to overtake its wheels 5 % later where they
// part and the slowest of them speaks: it is the inner one of a turn.
//   |X| > 1.5 |Rw - mean Rw|                                                          (21)
// X holds what the wheels did as well, forgotten as their mean follows: wheels alone make |X| = |Rw - mean Rw|. Only beyond it the body
// departs, and only then (13) and (23) are asked and (7) needs less. Where a rim
// leaps by more than 10 m/s^2 times the tick, X leaves it out, and what follows is no rolling: (13) waits for a second.
//   d < slow, d at the end of the grid or noise/echo > 1/20:  |v| < d                 (22)
// The search cannot end below the grid's first speed, and noise, which is even in frequency, draws it up: such a value is a limit. Within
// it nothing is told and nothing corrected, unless less than that is known (then 0, give or take d); beyond it, it is a value as any.
//   k = 1 - (9 var X + least^2)/X^2 > 0:  v -= k X,  b += k X/0.25 s,  X -= k X,  P_vv += k X^2/4,  P_bb >= (1 - k) X^2/(0.25 s)^2  (23)
// X has the mean 0.25 s (a - b - d(Rw)/dt). Wheels that roll, (18), and creep, (20), do as the body does, so this is the bias's error: a
// slope that comes too slowly for (13) and for lean.h. A slide would look the same until the radar hears it; so wheels that roll are
// followed up to 5 cm/s (0.2 m/s^2) while the radar's value stays beside them, those that creep, below what it hears, always.
//   m += (Rw - m)/16 while |Rw| < still;  at rest: |m| < still/4                      (24)
// One count a tick is rest, a mean of a quarter of one is not: coarse encoders creep at several cm/s with a count in some ticks.
//   (Rw - v)^2 > 6.25 (P_vv + n^2):  P_vv += (Rw - v)^2                               (25)  n: the noise of (20), once
// A track with the wrong sign near zero agrees with every value of a deaf radar and is sure of itself; creeping wheels that are 2.5 sigma
// off show that it is not.
// (26): where the other sign wins, L of (7) is about a track that is the best no longer, and begins anew. Not while the best refuses
// values or they scatter, f > 1.5: a line that is being learnt makes either win by chance, and a bias that may jump is the way out; but
// what that value tells, it tells against the winner's cost. (27): that values have refuted the sign that the wheels had asked for answers
// them; they do not ask again for two seconds, unless a line was taken off. A refutation that nobody asked for, as at a start, answers
// nothing.
//   std^2 = P' + ...,  P' = P - (1 - g) min(P, R),  P = P_vv + Q tau,  g = 2 mean e^2/S, from 0.25 to 4         (28)
// Values share three quarters of their samples with the one before, and R counts each as if it stood alone: where the claim is right, e^2/S
// is a half in the mean (outdoors_bench --only calm: 0.46 to 0.65), and so it is taken to be at first. Where it is less for eight seconds,
// this radar on this ground is better than R, and so is the claim; where it is more, on ground of few scatterers or under a body that
// sways, the claim is wider: (8) begins at twice as much. The filter's gains, odds and limits stay with R. Not while both signs live or
// wheels part; nor is it wider while (38) holds, where no value comes that could scatter.
//   at rest:  std^2 = min(P_vv, 0.16 mean X^2 + m^2)                                  (29)  m of (24)
// What moves a standing estimate is the accelerometer's noise q a tick, held by v = 0 give or take 1 cm/s in each of them: (1 - k)^2 q/(1 -
// (1 - k)^2) = 2 q with the gain k = 0.18 of the stated noise, and X has 12.5 q (derived here). A body that rocks on its wheels is in X
// as well; m is what a wheel may creep by. It ends in the tick in which the rest ends.
//   Q = min(Qv, max(u1, u4)),  u *= q > u ? 2 : 0.85, q of the last look              (30)
// What the accelerometer's noise has done since the window's middle is claimed as most looks find it, four of five (ln 2 over ln 2 - ln
// 0.85): Qv is at least the stated noise and a mean, in which a start or a turn stays for seconds. The filter keeps Qv.
// (31): X widens the claim by a ninth where it is the wheels' own, beyond noise and not beyond (21), or within a second of a rim's leap,
// which X has left out while the body follows it. Not where the estimate runs against the wheels: then one of both is wrong by more than
// X.
//   |d - d'| > slow/2                                                                 (32)  d' the loud value before
// What changes so fast from one value to the next while (19) has felt nothing is not the body: grass in the wind, a person's feet. The two
// minutes of (19) begin anew. And what has stood knows that it stood: no value after it is a first one, which nothing gates.
// (33): where it stands and its wheels part it turns on the spot, on a slope through gravity's share. It rests, so X is the bias's error
// and is followed as in (23), whatever the radar says of it: a hum that it hears meanwhile is loud.
// (34): a second track whose sign is surely the best's, against the wheels', is no other sign: it is dropped, and the wheels may ask. Not
// for a second after (13) has ended: the wheels' word, which has lost, and the accelerometer's have had one sign a window ago, and it may
// come back.
// (43): a value that leaves its own mean refutes the wheels' word of (13) only where the accelerometer's word explains it better, and then
// with 12 of the odds, as much as one value may tell of a sign: the word that has lost is followed as the other. A value that both miss, of
// few scatterers or of a body that pitches onto the slope, tells little between them.
// (44): a value that is a limit, (22), does not contradict wheels that creep below it; nor does silence, where the last value was below
// slow: what hears no echo of a body that creeps hears its own noise, quiet or like no echo at all. Where such wheels are below still_m_s,
// (38) begins there as at the end of a rest: wheels that are held creep by a count now and then, and never rest.
// (35): where (7) wins with the other sign, what was best before it stays as that sign, at the odds of L, if it was sure of its slope (0.1
// m/s^2): a bias that jumped to and fro tells the same as a body that turned round, until the values tell.
// (36): where (7) wins with the best's own sign while the other lives, the other stays: a bias that jumps is the best's excuse, and costs
// it 12 of the odds. (37): a value that leaves the mean of (18) and is still as close to the rim as (18) asks has not parted from it: what
// sets off with its wheels is read too fast at first, and too slow while it speeds up.
//   e = v_r + V(t) - V(t_r) - b_r (t - t_r);  |R w| > 0.6 slow,  e sign(R w) > |R w|/2      (38)
// r: the oldest of the values that (15) keeps, or the end of the last rest, whichever is newer, within 3 s. An echo that falls silent while
// the wheels turn is of a body that has stopped, or of a radar that sees nothing any more: covered, in water, out of order. A stop is felt:
// by the speed that was known last and what the accelerometer has felt since, with the bias of before, the body still goes where (38)
// holds, and quiet values are none until a loud one comes or the wheels are slow. Where it does not hold after a value it stands, whatever
// (13) has made of it. Neither is told by less than a sigma of the accelerometer's noise and of the bias, (t - t_r)/T Qv + ((t - t_r)
// 0.02 m/s^2)^2, or by as much more as that bias was unsure; of one that had not settled (0.04 m/s^2) a newer value is r. A stop is two
// sigma below half of the rim, and no faster than what is quiet: a radar hears nothing of a body that changes its speed by much in a window
// either, and its wheels pass zero. Each quiet value asks anew: what has stopped may set off. Later than 3 s the estimate stands for e.
//   |v'| < 0.12 m/s,  t_13 < 0.35 s,  no gyros                                        (39)  v': the accelerometer's word beside (13)
// A body that a wall or soft ground stops at once is to (13) a slope that begins. Its echo falls silent, so a window in which it stopped
// hears the part in which it moved, as fast as ever: where (39) holds, values tell nothing between the two words. If what was felt is over,
// as of a slope it is not (8 ticks within 0.5 m/s^2 of the bias before), the odds for the wheels are 2 at most. And from (13) to the first
// value std is at least half of what the wheels' word has taken away: nothing has told yet.
// (40): where (7) wins and neither (10) nor (21) tells of a body that departs, wheels and accelerometer agree that nothing has happened: a
// line may have begun. The claim holds what the speed leapt by, and 0.85 of it a value later.
//   |d - d'| > 3 sqrt(R) + ...,  e^2/S > 9                                            (41)  while (18) holds and (10) and (21) tell of
//   nothing
// A body's window shares three quarters with the one before, so what neither wheels nor accelerometer feel begins slowly in it. A value
// that leaps away at once is a line's, or noise, and tells nothing for two seconds, in which the first of them is told by its steadiness
// (doppler.h); the claim covers 0.7 of what it leaves. A value that comes back ends it, and so does one that goes on: a slide that the
// other values had hidden. (15) needs a value near zero: half of a step between values, and what a window that crosses it reads.
//   v = R w + (d - R w)',  n = 0.02 m/s + |R w|/10                                    (42)  ()': mean until the radar was covered
// Where no value comes, or (38) finds the radar covered, wheels that held (18) within the last second of values roll on until (10) and
// (21) tell that the body departs: beyond n they are asked as in (20), and below slow they creep as there. Below 1.25 slow a quiet echo
// tells of a stop only if it was felt. A covered radar hears its own noise now and then: fewer than four loud values in a row that
// leave what is known are none.
#ifndef TRACTION_FIRMWARE_CORE_GROUND_SPEED_H
#define TRACTION_FIRMWARE_CORE_GROUND_SPEED_H

#include "doppler.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { GROUND_SPEED_HISTORY = 2 * DOPPLER_WINDOW_TICKS_MAX }; // a window, and what came since

typedef enum { GROUND_SPEED_PAPER = 0, GROUND_SPEED_BIAS } ground_speed_method_t;

typedef struct {
    ground_speed_method_t method;
    const doppler_window_t *window; // w_j and tau of (3): the radar's
    float tick_s;                   // T
    float per_tick_1_s;             // 1/T
    float tick_q20_s;               // 2^20 T
    float speed_noise_m2_s2;        // Qv per tick, at least
    float speed_noise_max_m2_s2;    // and at most; at or below the other, (6) is off
    float blind_noise_m2_s2;        // Qv per tick without an accelerometer
    float bias_noise_m2_s4;         // Qb per tick
    float bias_start_m_s2;          // standard deviation of the bias at reset
    float bias_max_m_s2;            // |b| limit
    float speed_max_m_s;            // |v| limit, of what the radar tells too
    float doppler_noise_m2_s2;      // R = trust (this + doppler_noise_m_s |v| + doppler_accel_s2 a^2)
    float doppler_noise_m_s;
    float doppler_accel_s2;
    float deaf_noise_m2_s2, per_slow_s_m; // of a value below slow_m_s; 1/slow_m_s
    float lowest_m_s;                     // of (22): the lowest speed that a value can tell
    float doppler_spread_s;               // k of (11)
    float gate_sigma;                     // innovations beyond this many sigma are refused
    int32_t gate_patience;                // refusals in a row after which (7) is believed
    float jump_share;                     // c of (4)
    float jump_limit;                     // |m| of (4) that tells of a jump of the bias
    float jump_m2_s4;                     // by how much its variance grows then
    float agile_m2_s4;                    // by how much the bias's variance grows per value of (7)
    float agile_limit;                    // of (7)
    float agile_sure;                     // of (7), where (10) tells of a slope, too
    float apart_told_m_s;                 // |X| beyond which it does
    float agile_drift;                    // what every value must tell more than
    float agile_most;                     // what one value tells at most
    float apart_forget;                   // of (10): T/0.25 s
    float apart_share;                    // of (10), squared
    float apart_least_m_s;                // of (10): what slip makes
    float apart_noise;                    // of (10): Qv of its noise, nine times
    float felt_share, felt_noise;         // of (14): c where X is nothing but noise, and var X over Qv
    float roll_told_m_s;                  // of (13): its limit
    float slip_force_m_s2;                // of (13): the least force of wheels that slip
    float roll_odds;                      // 2 ln of the odds that (13) starts with
    float roll_noise_m2_s2;               // Qv per tick of a speed that changes as the wheels' does
    float roll_share;                     // of a tick's rest that enters the bias
    float roll_bias_m2_s4;                // its variance then
    int32_t agile_values;                 // after which (7) starts from the best anew
    float misfit_share;                   // c of (8)
    float misfit_max;                     // limit of (8)
    int32_t quiet_needed;                 // quiet Doppler values in a row that mean a speed too low to be heard
    float lean_m_s2_per_q8;               // unit of the input's lean
    int32_t lean_told_q8;                 // of (13): a change of the lean that tells of the slope
    float gyro_slow;                      // of (16): T/t1
    float gyro_learns_q8_s2_m;            // of (16): T/(g t1 t2) [2^-8 count of the gyro per m/s^2]
    float gyro_turns;                     // its offset in 2^-8 counts over the lean less its mean in lean_m_s2_per_q8
    float gyro_runs_m2_s6;                // how fast a lean runs off that no radar value sees, squared
    float gyro_sure_m_s2;                 // of (16): |b - m| that noise makes
    float gyro_steady_m2_s2;              // of (16): s^2
    float quiet_noise_m2_s2;              // R of that speed, taken as 0
    float still_m_s;                      // rim speed below which the wheels are at rest; 0: there are none to ask
    float rest_m_s;                       // of (24): a quarter of it
    int32_t still_needed;                 // ticks of rest before the rover can be standing
    int32_t parked_needed;                // and before it is, where the radar tells of no speed
    int32_t loud_needed;                  // loud Doppler values in a row that end a standing
    float standing_noise_m2_s2;           // R of speed 0 in each standing tick
    float slow_m_s;                       // |v| below which standing needs no quiet echo
    float sign_sure;                      // 2 ln of the odds beyond which one sign is taken alone
    float wheel_spins;                    // 2 ln of the odds that the sign of wheels has that outrun the radar's value
    float wheel_odds, wheel_match;        // 2 ln of the odds that the wheels' sign has; when their speed agrees with the radar's, too
    float wheel_pull;                     // 2 ln of the odds that they give per value while their speed agrees
    int32_t against_values;               // values against which they turn before the other sign is asked anew
    float against_odds;                   // and the odds that it then starts with
    float force_per_s2_m;                 // 1/standard deviation of the device's bias, against which (12) is judged
    float force_most, force_pull;         // of (12): at most; its share per value while both signs live
    float wheel_noise_m_s;                // standard deviation of the wheels' speed as the body's: this + wheel_slip |R w|
    float wheel_slip;
} ground_speed_config_t;

typedef struct {
    float speed_m_s;
    float bias_m_s2;
    float p_vv, p_vb, p_bb;
} ground_speed_track_t;

enum { SLIDE_VALUES = 6 };

// The last values, of (15).
typedef struct {
    int32_t newest, held;
    int32_t due; // looks that are still to come
    float heard_m_s[SLIDE_VALUES];
    float alike_m_s[SLIDE_VALUES];
    float sign[SLIDE_VALUES];           // of the best track in the middle of its window
    float tau_s[SLIDE_VALUES];          // of (3), when it came
    float bias_m_s2[SLIDE_VALUES];      // before its window, nearly
    float bias_m2_s4[SLIDE_VALUES];     // and the variance that it had then
    uint32_t ticks, came[SLIDE_VALUES]; // a count of ticks, and where it stood then
    int32_t q20[SLIDE_VALUES];          // V in its window's middle
} ground_speed_slide_t;

enum { GROUND_SPEED_BEFORE = 3 };

// Of (38): what a quiet echo stands for.
typedef struct {
    bool on;      // the radar is covered: no value
    bool stopped; // the body was felt to stop
    bool judged;  // and which it is stands until a loud value, or slow wheels
    bool rested;  // the end of the last rest is known
    uint32_t rest_ended;
    int32_t rest_q20;
    float rest_bias_m_s2;                    // then
    float before_m_s2[GROUND_SPEED_BEFORE];  // that the last values left: within a window (13) may have made a slope of a stop
    float before_m2_s4[GROUND_SPEED_BEFORE]; // and its variance; 0, as if it had settled, until there are so many values
} ground_speed_cover_t;

// A track that moves on at Doppler values alone.
typedef struct {
    ground_speed_track_t at;
    int32_t ticks; // since it was last moved on
    int32_t q20;   // V then
} ground_speed_side_t;

typedef struct {
    float speed_m_s;
    float bias_m_s2;
    float p_vv, p_vb, p_bb;                     // of the speed as (3) sees it: without the accelerometer's noise since the window's middle
    float std_m_s;                              // of the speed
    float accel_noise_m2_s2;                    // mean of (6) per tick
    float slow_noise_m2_s2;                     // the same of four ticks at a time
    float speed_noise_m2_s2;                    // Qv in force
    float usual_noise_m2_s2, usual_slow_m2_s2;  // q1 and q4 that most looks have found, (30)
    float unseen_m2_s2;                         // of the claim: what the accelerometer's noise does since the window's middle
    float apart_claim_m2_s2;                    // and X, (31)
    int32_t integral_q20[GROUND_SPEED_HISTORY]; // V, a ring [2^-20 m/s]
    int32_t head;
    int32_t behind_ticks; // that the covariance has not seen, and Qv in them
    float behind_noise_m2_s2;
    float integral_rest_m_s;                    // part of V below one unit
    float one_sided;                            // m of (4)
    float misfit;                               // of (8), 1 or more
    bool value_at_most;                         // (22) of the last value
    bool roll_denied;                           // of (13): the last value left its mean while the best track rolled
    float scatter;                              // of (28): mean of e^2/S
    float calm, calm_at_m2_s2, calm_less_m2_s2; // g, R, (1 - g) R
    float apart_m_s;                            // X of (10)
    float alike_m_s;                            // error that values of a strange spectrum may share: their mean does not make it smaller
    float felt_m_s;                             // what (14) takes off
    float felt_trust;                           // of (14): its c over that of nothing but noise
    float per_felt_most_s2_m2;
    float apart_long_m2_s2; // mean of X^2 over seconds
    float wheel_m_s;        // when X was looked at last, and V then, and the ticks since
    int32_t wheel_q20;
    int32_t wheel_ticks;
    int32_t lean_q8, lean_mean_q8; // of the last input, and over a third of a second
    int32_t gyro_q8;               // r [2^-8 count] and m of (16)
    float bias_mean_m_s2;
    float gyro_doubt_m2_s2;                  // and what it adds to the variance
    uint32_t gyro_asked;                     // when (16) was looked at last, in slide.ticks
    int32_t gyro_denied;                     // values in a row for which the radar was with the wheels, against the lean
    int32_t gyro_alone_ticks;                // since a value was taken
    bool gyro_tried;                         // (13) is under way against the lean
    float apart_m2_s2, apart_mean_m_s;       // means of X^2 and X over a quarter of a second
    float value_beside_m_s, beside_mean_m_s; // the last value less the wheels' mean, and the mean of those before
    float rest_mean_m_s;                     // of (24)
    float wheel_mean_m_s;                    // over a quarter of a second
    float asked_m_s;                         // R w' of (20)
    int32_t rolls_ticks;                     // for which (13) still holds the wheels' word, and until it may begin again
    int32_t rolls_wait;
    float rolled_m_s; // what its word has taken away since it began, while no value has told
    int32_t refused;
    float held_sign, held_level_m_s; // of (17): 0 where no sign is sure; the mean of the last values
    int32_t held_values;             // for which it was the same
    int32_t parted_values;           // of (18): until which it is not forgotten that radar and wheels have parted
    bool rolls;                      // of (18)
    int32_t rolled_values;           // of (42): for which it may have held until the radar was covered
    uint32_t chore;                  // of a turn of CHORES, one a tick that has time
    int32_t quiet;
    int32_t loud;
    float loud_m_s;        // the last such value while it stood
    int32_t unheard_ticks; // since the last Doppler value, quiet or not
    int32_t against;
    int32_t still_ticks;
    bool standstill;
    bool relieved; // what a line had told is forgotten
    bool heard;    // a Doppler value has come since the reset
    bool accepted; // and one has corrected
    ground_speed_slide_t slide;
    ground_speed_cover_t cover;
    ground_speed_side_t other; // the other sign, (9)
    bool other_alive;
    float odds;                                           // 2 ln of the odds against it
    float less_m_s;                                       // by what is reported less than the best
    float doubt_m_s, doubt_m2_s2;                         // what it takes off the mean, and adds to the variance
    ground_speed_side_t agile;                            // (7)
    float agile_sum;                                      // of (7)
    int32_t agile_left;                                   // values until it starts anew
    float leap_from_m_s, leap_m_s;                        // of (41): the last value; what it left
    int32_t leap_left;                                    // values that may still be refused
    float jolt_m_s;                                       // of (40)
    int32_t waits;                                        // tracks that have not seen the last Doppler value: 2 both, 1 the agile one
    float value_heard_m_s, value_accel_m_s2, value_trust; // the value as it came, the raw acceleration in its window
    float value_m_s, value_noise_m2_s2;
    float value_tau_s, value_change_m_s; // tau and the sum of (3)
    float value_cost;                    // e^2/S + ln S of the best
    float value_scatter;                 // its e^2/S
    float value_sign, value_wheel_m_s;
    bool value_parts; // the wheels, when it came
} ground_speed_state_t;

typedef struct {
    float accel_x_m_s2;   // less the lean
    float doppler_m_s;    // magnitude
    float doppler_late_s; // age of the window's end; negative for a shorter window
    float wheel_m_s;      // rim speed of the wheels as a hint for the sign
    float slowest_m_s;    // rim speed of the slowest wheel, where they part and all turn one way; else 0
    bool wheels_part;     // they turn at speeds so different that their mean tells little
    bool accel_valid;
    bool doppler_fresh;
    bool doppler_quiet;
    bool doppler_dead;      // the front end makes no noise at all
    bool busy;              // this tick has a transform or a search: chores wait
    float doppler_trust;    // how much larger its variance is than a calm echo's [1]; 0 counts as 1
    float doppler_misfit;   // share of it that may be wrong for all values alike [1]
    bool doppler_relieved;  // the values before this one told of an interfering line
    uint32_t elapsed_ticks; // since the call before; 0 counts as 1
    int32_t lean_q8;        // what the accelerometer is less by, lean.h [lean_m_s2_per_q8]: (12) and (13) want the force as it was felt
} ground_speed_input_t;

typedef struct {
    float speed_m_s;
    float std_m_s;
    float bias_m_s2;
    bool standstill;
    int32_t gyro_q8; // r of (16), for lean.h [2^-8 count]
} ground_speed_output_t;

void ground_speed_reset(const ground_speed_config_t *config, ground_speed_state_t *state);

// Any value is accepted; NaN or infinity in a measurement counts as "no measurement".
ground_speed_output_t ground_speed_step(const ground_speed_config_t *config, ground_speed_state_t *state,
                                        const ground_speed_input_t *input);

#ifdef __cplusplus
}
#endif

#endif
