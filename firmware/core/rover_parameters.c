#include "rover_parameters.h"

#include "doppler_template.h"

#include <math.h>

enum { OWN = 0, SCALED = 1 };

// Arrays, not pointers: a pointer in a constant must be relocated, hence lies in writable memory.
typedef struct {
    char name[28];
    float reference, low, high;
    int32_t kind;
} row_t;

static const row_t rows[ROVER_PARAMETER_COUNT] = {
#define ROVER_PARAMETER_ROW(key, kind_, value_, low_, high_)                                                                               \
    [ROVER_##key] = {.name = #key, .reference = (value_), .low = (low_), .high = (high_), .kind = (kind_)},
    ROVER_PARAMETER_LIST(ROVER_PARAMETER_ROW)
#undef ROVER_PARAMETER_ROW
};

static const char radar_names[ROVER_RADAR_COUNT][16] = {"MDU1130", "DJ Radar II", "DJ Radar III", "DRS1000", "own"};

static int32_t within(int32_t index, int32_t count) { return index < 0 || index >= count ? 0 : index; }

const char *rover_parameter_name(int32_t index) { return rows[within(index, ROVER_PARAMETER_COUNT)].name; }
float rover_parameter_low(int32_t index) { return rows[within(index, ROVER_PARAMETER_COUNT)].low; }
float rover_parameter_high(int32_t index) { return rows[within(index, ROVER_PARAMETER_COUNT)].high; }
bool rover_parameter_scaled(int32_t index) { return rows[within(index, ROVER_PARAMETER_COUNT)].kind == SCALED; }

const doppler_template_t *rover_template(const rover_parameters_t *parameters)
{
    return parameters->beam != 0 ? parameters->beam : doppler_template_of(parameters->radar);
}

const char *rover_radar_name(int32_t radar) { return radar_names[within(radar, ROVER_RADAR_COUNT)]; }

void rover_parameters_reference(rover_parameters_t *parameters)
{
    for (int32_t i = 0; i < ROVER_PARAMETER_COUNT; i++) {
        parameters->value[i] = rows[i].reference;
    }
    parameters->radar = ROVER_RADAR_MDU1130;
    parameters->beam = 0;
}

// --- (1)-(3); the same operations for a rover and for the reference, so that the reference's ratios are exactly 1

static const float grip = 0.8f;          // mu of (1), assumed: firm ground
static const float gravity_m_s2 = 9.81f; // [m/s^2]
static const float radar_share = 0.95f;  // [1] of the radar's highest speed that is used, assumed

static float grip_current_A(const float *v)
{
    const float traction_N = grip * v[ROVER_mass_kg] * gravity_m_s2 * 0.25f;
    return (traction_N * v[ROVER_wheel_radius_m] + v[ROVER_coulomb_Nm]) / v[ROVER_torque_constant_Nm_A]; // (1)
}

static float wheel_gain(const float *v)
{
    return v[ROVER_battery_voltage_V] * v[ROVER_torque_constant_Nm_A] / (v[ROVER_resistance_ohm] * v[ROVER_inertia_kg_m2]); // (2)
}

static float wheel_pole_1_s(const float *v)
{
    return v[ROVER_torque_constant_Nm_A] * v[ROVER_back_emf_Vs_rad] / (v[ROVER_resistance_ohm] * v[ROVER_inertia_kg_m2]) +
           v[ROVER_viscous_Nms] / v[ROVER_inertia_kg_m2]; // (2)
}

// Square of the current that heats the winding to its limit in the end.
static float heat_room_A2(const float *v) { return v[ROVER_winding_rise_max_K] / (v[ROVER_resistance_ohm] * v[ROVER_winding_K_W]); }

static float stalled_A(const float *v) { return v[ROVER_battery_voltage_V] / v[ROVER_resistance_ohm]; }

static float free_speed_rad_s(const float *v) { return v[ROVER_battery_voltage_V] / v[ROVER_back_emf_Vs_rad]; } // (3)

static float pulse_rad(const float *v) { return 1.0f / v[ROVER_encoder_counts_per_turn]; } // up to 2 pi, which every ratio loses

static float ratio(float (*law)(const float *v), const float *v, const float *reference) { return law(v) / law(reference); }

static float over(const float *v, const float *reference, rover_parameter_t key) { return v[key] / reference[key]; }

// What key `i` of a rover with the numbers v is by (4)-(6).
static float scaled(rover_parameter_t i, const rover_parameters_t *parameters, const float *r)
{
    const float *v = parameters->value;
    const float current = ratio(grip_current_A, v, r);
    const float radius = over(v, r, ROVER_wheel_radius_m);
    switch ((int)i) { // SCALED keys alone
    case ROVER_back_emf_Vs_rad:
        return v[ROVER_torque_constant_Nm_A];
    case ROVER_doppler_scale: {
        if (parameters->beam != 0) {
            return r[i]; // that template is made for this very depression
        }
        const float per_deg = parameters->radar == ROVER_RADAR_MDU1130 ? 0.004f : 0.00635f;      // 0.00635 = tan 20 deg * pi/180
        return r[i] + per_deg * (v[ROVER_radar_depression_deg] - r[ROVER_radar_depression_deg]); // (7)
    }
    case ROVER_stall_current_A: {
        const float stalled = ratio(stalled_A, v, r);
        return r[i] * (stalled < current ? stalled : current); // (4)
    }
    case ROVER_current_continuous_A: {
        const float borne = sqrtf(ratio(heat_room_A2, v, r));
        return r[i] * (borne < current ? borne : current); // (4)
    }
    case ROVER_current_peak_A2s: {
        const float continuous = over(v, r, ROVER_current_continuous_A);
        return r[i] * (continuous * continuous); // (4)
    }
    case ROVER_battery_min_V:
        return r[i] * over(v, r, ROVER_battery_voltage_V);
    case ROVER_stall_speed_rad_s:
    case ROVER_encoder_absurd_rad_s:
    case ROVER_wheel_max_rad_s:
    case ROVER_speed_integral_max_rad_s:
        return r[i] * ratio(free_speed_rad_s, v, r); // (6)
    case ROVER_speed_max_m_s: {
        const float speed = r[i] * (over(v, r, ROVER_wheel_max_rad_s) * radius);
        const doppler_template_t *beam = rover_template(parameters);
        const float heard = beam != 0 ? radar_share * beam->speed_m_s[beam->speeds - 1] : speed;
        return speed < heard ? speed : heard; // (6)
    }
    case ROVER_yaw_rate_max_rad_s:
        return r[i] * (over(v, r, ROVER_speed_max_m_s) / over(v, r, ROVER_half_track_m)); // (6)
    case ROVER_disagree_m_s:
        return r[i] * over(v, r, ROVER_speed_max_m_s); // (6)
    case ROVER_still_m_s:
        return r[i] * (ratio(pulse_rad, v, r) * radius); // one pulse a tick at the rim
    case ROVER_dry_speed_rad_s:
        return r[i] * ratio(pulse_rad, v, r); // five steps of the speed's rounding noise
    case ROVER_wheel_kp_s:
        return r[i] / ratio(wheel_gain, v, r); // (5)
    case ROVER_wheel_ki_1:
        return r[i] * (over(v, r, ROVER_wheel_kp_s) * ratio(wheel_pole_1_s, v, r)); // (5)
    case ROVER_wheel_slew_rad_s2:
        return r[i] * ratio(wheel_gain, v, r); // (5)
    case ROVER_slip_kp_1:
        return r[i] * (over(v, r, ROVER_wheel_kp_s) / radius); // (5)
    case ROVER_slip_ki_1_s:
        return r[i] * (over(v, r, ROVER_wheel_ki_1) / radius); // (5)
    case ROVER_speed_kv_rad_m:
    case ROVER_speed_ki_rad_m_s:
        return r[i] / radius; // (5)
    default:
        return v[i];
    }
}

void rover_parameters_scale(rover_parameters_t *parameters, const bool given[ROVER_PARAMETER_COUNT])
{
    rover_parameters_t reference;
    rover_parameters_reference(&reference);
    for (int32_t i = 0; i < ROVER_PARAMETER_COUNT; i++) {
        if (rows[i].kind == SCALED && !given[i]) {
            parameters->value[i] = scaled((rover_parameter_t)i, parameters, reference.value);
        }
    }
}
