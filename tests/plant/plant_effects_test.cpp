// Every effect of the catalogue that acts in the plant: it disturbs the balances it claims, no other, and nothing at zero strength.
//
// The balances are those of the baseline (docs/sources.md sections 2 and 3), computed from the truth by this file's own formulas; without
// an effect each residual vanishes, so a residual is the effect itself.
#include "sim/plant/plant.h"

#include <algorithm>
#include <cstdint>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

using namespace traction::sim;

namespace {

enum Balance { torque, voltage, strength, rolling, load, body, slipping, sideways, balances };
constexpr const char *balance_name[] = {"torque", "voltage", "strength", "rolling", "load", "body", "slip", "sideways"};

// Above its floor a balance counts as disturbed. Floors: ten times what the baseline run itself leaves (printed by the first test).
struct Residuals {
    std::array<double, balances> rms{};
};

PlantConfig configuration(const std::vector<ActiveEffect> &effects) {
    PlantConfig config;
    config.ground.soil = *find_soil("sand");
    config.rover.centre_height_m = 0.05;
    config.effects = effects;
    return config;
}

// Pull, brake, turn, reverse: 12 s.
double duty_at(double t_s, int wheel) {
    const bool left = wheel % 2 == 0;
    if (t_s < 3) return wheel < 2 ? 0.7 : 0.45; // rear wheels push the front ones
    if (t_s < 4) return 0.1;
    if (t_s < 6) return left ? 0.3 : 0.6;
    if (t_s < 9) return -0.6;
    return left ? 0.5 : 0.55;
}

double janosi(double s, double sc) { return s < 1e-9 ? 0 : 1 - sc / s * (1 - std::exp(-s / sc)); }

// Loads from the moment balances of the header of plant.h: halves in pitch, the whole in roll.
std::array<double, 4> expected_loads(const Truth &t, double wheel_spin[4]) {
    const RoverParameters r;
    std::array<double, 4> fn{};
    double across = 0;
    for (const WheelTruth &w : t.wheel) across += w.lateral_N;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t mate = (i + 2) % 4;
        double pitch = 0.05 * (t.wheel[i].traction_N + t.wheel[mate].traction_N);
        for (const std::size_t k : {i, mate}) {
            pitch -= 0.05 * t.wheel[k].rolling_N * t.wheel[k].rolling_share;
            pitch += 0.5 * r.wheel_mass_kg * r.wheel_radius_m * r.wheel_radius_m * wheel_spin[k];
        }
        fn[i] = r.mass_kg * r.gravity_m_s2 / 4 + (i < 2 ? 1 : -1) * pitch / (4 * r.half_wheelbase_m) * 2 +
                (i % 2 == 0 ? -1 : 1) * across * 0.05 / (4 * r.half_track_m);
    }
    return fn;
}

Residuals run(const std::vector<ActiveEffect> &effects, std::uint64_t *hash = nullptr) {
    const PlantConfig config = configuration(effects);
    const RoverParameters &r = config.rover;
    const Soil &soil = config.ground.soil;
    Plant plant(config);
    std::array<double, balances> square{}, count{};
    const auto add = [&](Balance b, double residual) { square[b] += residual * residual, count[b] += 1; };
    for (int k = 0; k < 12000; ++k) {
        const Truth before = plant.truth();
        for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, duty_at(0.001 * k, i));
        plant.step();
        const Truth &t = plant.truth();
        double along = 0, spin[4];
        bool rolling_all = true;
        for (std::size_t i = 0; i < 4; ++i) {
            const WheelTruth &w = t.wheel[i], &o = before.wheel[i];
            spin[i] = (w.speed_rad_s - o.speed_rad_s) / config.dt_s;
            along += w.traction_N - w.rolling_share * w.rolling_N;
            const bool turns = std::fabs(w.speed_rad_s) > 0.5 && std::fabs(o.speed_rad_s) > 0.5;
            rolling_all = rolling_all && std::fabs(w.ground_speed_m_s) > 0.02;
            if (turns) // (17), (18)
                add(torque, r.drive.torque_constant_Nm_A * w.current_A - r.drive.viscous_Nms * w.speed_rad_s -
                                r.drive.coulomb_Nm * (w.speed_rad_s > 0 ? 1 : -1) - r.drive.inertia_kg_m2 * spin[i] -
                                r.wheel_radius_m * w.traction_N);
            // the winding sees the motor's speed at the beginning of the step
            add(voltage,
                w.duty * t.battery_voltage_V - r.drive.torque_constant_Nm_A * o.motor_speed_rad_s - r.drive.resistance_ohm * w.current_A);
            // (20) with the combined slip; straight parts only, where the sideways slip is nil
            const double rim = r.wheel_radius_m * o.speed_rad_s, v = w.ground_speed_m_s, fast = std::max(std::fabs(rim), std::fabs(v));
            if (std::fabs(t.rate_body_rad_s[2]) < 1e-9 && fast > 0.25)
                add(strength, std::fabs(w.traction_N) - soil.fm_per_fn * w.normal_N * janosi(std::fabs(w.slip), soil.shear_slip));
            add(rolling, w.rolling_N - soil.rolling_coefficient * w.normal_N);
            // relaxation equation of the baseline, times the step; below 5 cm/s a stopping wheel gives slip up, (4) of contact.h
            const double h = config.dt_s / r.relaxation_length_m;
            if (fast > 0.05 && std::fabs(w.slip) < 1 && std::fabs(o.slip) < 1) // the truth is held at +-1
                add(slipping, w.slip * (1 + h * fast) - o.slip - h * (rim - v));
            add(sideways, w.lateral_N);
        }
        if (rolling_all) {
            const std::array<double, 4> fn = expected_loads(t, spin);
            for (std::size_t i = 0; i < 4; ++i) add(load, t.wheel[i].normal_N - fn[i]);
            const double accel = (t.v_body_m_s[0] - before.v_body_m_s[0]) / config.dt_s - t.rate_body_rad_s[2] * t.v_body_m_s[1];
            add(body, r.mass_kg * accel - along);
        }
    }
    Residuals out;
    for (std::size_t b = 0; b < balances; ++b) out.rms[b] = count[b] > 0 ? std::sqrt(square[b] / count[b]) : 0;
    if (hash != nullptr) *hash = plant.state_hash();
    return out;
}

ActiveEffect active(const std::string &name, double scale) {
    ActiveEffect effect;
    effect.effect = find_effect(name);
    for (const EffectParameter &p : effect.effect->parameters) effect.values.push_back(p.strength ? scale * p.typical : p.typical);
    return effect;
}

// Which balances an effect must disturb. Those not named must stay at the baseline's floor; `sideways` is compared separately.
const std::map<std::string, std::vector<Balance>> &claims() {
    static const std::map<std::string, std::vector<Balance>> all{
        {"coulomb_friction", {torque}},
        {"viscous_friction", {torque}},
        {"stribeck_friction", {torque}},
        {"mesh_loss", {torque}},
        {"wear_in", {torque}},
        {"reverse_friction", {torque}},
        {"churning_friction", {torque}},
        {"gear_speed_loss", {torque}},
        {"shared_lead", {voltage}},
        {"backlash", {torque}},
        {"torque_ripple", {torque}},
        {"winding_heating", {torque, voltage}},
        {"wiring_resistance", {voltage}},
        {"bridge_dead_time", {voltage}},
        {"torque_constant", {torque, voltage}},
        {"rolling_resistance", {rolling}},
        {"slip_sinkage", {rolling}},
        {"speed_resistance", {rolling}},
        {"squared_resistance", {rolling}},
        {"resistance_patch", {rolling}},
        {"shear_peak", {}}, // that drive stays below its knee: a test of its own
        {"multi_pass", {strength}},
        {"load_transfer", {load}},
        {"mass_offset_x", {load}},
        {"mass_offset_y", {load}},
        {"soil_patch", {strength}},
        {"soil_gradient", {strength}},
        {"relaxation_length", {slipping}},
        {"sliding_speed_loss", {strength}},
        {"shear_stiffness", {strength}},
        {"wheel_radius", {torque, slipping}},
        {"lateral_scrub", {}},
        {"grade", {body}},
        {"tether_drag", {body}},
        {"body_drag", {body}},
        {"fluid_drag", {body}},
    };
    return all;
}

// Ten times the baseline's own residual. The load balance is quasi-static: bounce after each step of duty is its floor.
std::array<double, balances> floors() {
    static const std::array<double, balances> value = [] {
        const Residuals clean = run({});
        std::array<double, balances> out{};
        for (std::size_t b = 0; b < balances; ++b) {
            out[b] = std::max(10 * clean.rms[b], 1e-9);
            std::printf("baseline residual of %s: %.2e\n", balance_name[b], clean.rms[b]);
        }
        out[load] = 3 * clean.rms[load];
        return out;
    }();
    return value;
}

TEST(baseline, obeys_every_balance_of_the_specification) {
    const Residuals clean = run({});
    EXPECT_LT(clean.rms[torque], 1e-12); // discretised exactly so
    EXPECT_LT(clean.rms[voltage], 1e-12);
    EXPECT_LT(clean.rms[rolling], 1e-12);
    EXPECT_LT(clean.rms[slipping], 1e-12);
    EXPECT_LT(clean.rms[strength], 1e-9); // series of (20) near zero slip: 5e-11 of 5 N
    EXPECT_LT(clean.rms[body], 1e-3);     // N; pitch of 1e-3 rad turns the wheels' pull of a few N by its square
    EXPECT_LT(clean.rms[load], 0.07);     // 1 % of a wheel's load: the bounce after the five steps of duty
}

TEST(effects, each_disturbs_what_it_claims_and_no_other_balance) {
    const std::array<double, balances> floor = floors();
    for (const auto &[name, claimed] : claims()) {
        const Residuals with = run({active(name, 1)});
        for (std::size_t b = 0; b < sideways; ++b) {
            const bool must = std::find(claimed.begin(), claimed.end(), static_cast<Balance>(b)) != claimed.end();
            if (must)
                EXPECT_GT(with.rms[b], floor[b]) << name << " should disturb " << balance_name[b];
            else
                EXPECT_LT(with.rms[b], floor[b]) << name << " should leave " << balance_name[b] << " alone";
        }
    }
}

TEST(lateral_scrub, resists_turning_and_leaves_straight_driving_alone) {
    double turned[2], travelled[2];
    for (int on = 0; on < 2; ++on) {
        Plant turning(configuration({active("lateral_scrub", on)})), straight(configuration({active("lateral_scrub", on)}));
        for (int k = 0; k < 4000; ++k) {
            for (int i = 0; i < wheel_count; ++i) turning.set_duty(i, i % 2 == 0 ? -0.5 : 0.5), straight.set_duty(i, 0.5);
            turning.step();
            straight.step();
        }
        turned[on] = turning.truth().yaw_rad;
        travelled[on] = straight.truth().position_m[0];
    }
    EXPECT_GT(turned[0], 0.5);
    EXPECT_LT(turned[1], 0.95 * turned[0]);
    EXPECT_NEAR(travelled[0], travelled[1], 1e-9); // rounding makes sideways speeds of 1e-17 m/s, on which the scrub acts
}

// Wheels that turn against the motion slip by 1; sand's knee is at 2 sc = 0.54, so a share of 0.5 leaves 1 - 0.5 * 0.46.
TEST(shear_peak, takes_its_share_of_the_pull_beyond_the_knee) {
    double pull[2];
    for (int on = 0; on < 2; ++on) {
        Plant plant(configuration({active("shear_peak", on)}));
        for (int k = 0; k < 1000; ++k) {
            for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, k < 600 ? 0.7 : i < 2 ? 1.0 : -0.8);
            plant.step();
        }
        const WheelTruth &front = plant.truth().wheel[2];
        EXPECT_LT(front.slip, -0.99);
        pull[on] = front.traction_N / front.normal_N;
    }
    EXPECT_NEAR(pull[1] / pull[0], 1 - 0.5 * 0.46, 0.05); // the plant's slip follows over 5 mm of way
}

TEST(effects, zero_strength_gives_the_same_bits_as_absence) {
    std::uint64_t absent = 0;
    run({}, &absent);
    for (const auto &[name, claimed] : claims()) {
        std::uint64_t hash = 0;
        run({active(name, 0)}, &hash);
        EXPECT_EQ(hash, absent) << name;
    }
}

TEST(effects, on_one_wheel_leave_the_other_three_alone) {
    for (const char *name : {"coulomb_friction", "torque_constant", "rolling_resistance", "backlash"}) {
        ActiveEffect effect = active(name, 1);
        effect.wheel = 2;
        Plant plant(configuration({effect})), clean(configuration({}));
        for (int k = 0; k < 20; ++k) { // before the body tells the others
            for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, 0.7), clean.set_duty(i, 0.7);
            plant.step();
            clean.step();
        }
        EXPECT_NE(plant.truth().wheel[2].motor_speed_rad_s + plant.truth().wheel[2].rolling_N,
                  clean.truth().wheel[2].motor_speed_rad_s + clean.truth().wheel[2].rolling_N)
            << name;
        for (const std::size_t other : {0u, 1u, 3u})
            EXPECT_NEAR(plant.truth().wheel[other].speed_rad_s, clean.truth().wheel[other].speed_rad_s, 2e-2) << name;
    }
}

TEST(every_effect, of_the_catalogue_acts_in_the_plant_or_in_a_sensor) {
    for (const Effect &effect : catalogue()) {
        const bool elsewhere = effect.acts_on == ActsOn::sensor || effect.name == "actuation_delay";
        EXPECT_EQ(claims().count(std::string(effect.name)), elsewhere ? 0u : 1u) << effect.name;
    }
}

// Sizes against the catalogue's equations, at a steady straight drive.
TEST(sizes, of_forces_on_the_body_are_those_of_the_catalogue) {
    const auto pull = [](const std::vector<ActiveEffect> &effects) {
        Plant plant(configuration(effects));
        for (int k = 0; k < 6000; ++k) {
            for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, 0.6);
            plant.step();
        }
        double net = 0;
        const double before = plant.truth().v_body_m_s[0], x = plant.truth().position_m[0];
        plant.step();
        for (const WheelTruth &w : plant.truth().wheel) net += w.traction_N - w.rolling_N;
        net -= 2.88 * (plant.truth().v_body_m_s[0] - before) / 0.001;
        return std::pair{net, x};
    };
    // less M*a, the wheels' pull is the effect's force; pitch takes 1e-4 of it
    EXPECT_NEAR(pull({active("body_drag", 1)}).first, 1.2, 2e-3);
    EXPECT_NEAR(pull({active("grade", 1)}).first, 2.88 * 9.81 * std::sin(0.06), 2e-3);
    const auto [net, x] = pull({active("tether_drag", 1)});
    EXPECT_NEAR(net, 0.6 * x, 2e-3);
}

} // namespace
