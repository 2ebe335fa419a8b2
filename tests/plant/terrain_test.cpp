// Ground that is not flat, against closed forms: where a disc rests, what a slope takes, what a step asks for, the spectrum of ISO 8608.
#include "sim/plant/plant.h"

#include <cstdint>
#include <gtest/gtest.h>
#include <stdexcept>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

using namespace traction::sim;

namespace {

constexpr double R = 0.057, width = 0.042, pi = 3.14159265358979323846;

Terrain profile(std::vector<ProfilePoint> points, double direction_rad = 0) {
    Terrain terrain;
    terrain.profile = std::move(points);
    terrain.profile_direction_rad = direction_rad;
    return terrain;
}

PlantConfig on(const Terrain &terrain, const std::string &soil = "concrete", ContactLaw contact = ContactLaw::aggregated) {
    PlantConfig config;
    config.ground.soil = *find_soil(soil);
    config.ground.contact = contact;
    config.ground.terrain = terrain;
    config.rover.centre_height_m = 0.08;
    return config;
}

void drive(Plant &plant, double duty, double seconds) {
    for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, duty);
    for (int k = 0; k < static_cast<int>(seconds * 1000); ++k) plant.step();
}

TEST(Terrain, a_disc_touches_an_edge_as_geometry_says) {
    const double step = R / 3;
    Relief relief(profile({{1, 0}, {1, step}}), 1);
    for (const double before : {0.044, 0.035, 0.02, 0.01, 0.002, 0.0}) { // of the axle before the edge
        const Rest rest = relief.rest(1 - before, 0, 1, 0, R, width);
        const double arc = step + std::sqrt(R * R - before * before) - R;
        if (arc > 0) {
            EXPECT_NEAR(rest.height_m, arc, 1e-9) << before;
            EXPECT_NEAR(rest.rise_ahead, before / std::sqrt(R * R - before * before), 1e-6) << before;
        } else {
            EXPECT_NEAR(rest.height_m, 0, 1e-9) << before;
            EXPECT_NEAR(rest.rise_ahead, 0, 1e-6) << before;
        }
        EXPECT_NEAR(rest.rise_left, 0, 1e-9);
    }
}

TEST(Terrain, on_a_ramp_a_disc_stands_upright_to_it_whichever_way_it_heads) {
    const double slope = 0.2;
    Relief relief(profile({{-10, -10 * slope}, {10, 10 * slope}}, 0.7), 1);
    for (const double heading : {0.7, 0.0, 2.0, 3.8}) {
        const double c = std::cos(heading), s = std::sin(heading), ahead = slope * std::cos(heading - 0.7),
                     left = slope * std::sin(0.7 - heading);
        const Rest rest = relief.rest(0.3, -0.2, c, s, R, width);
        const double here = slope * (0.3 * std::cos(0.7) - 0.2 * std::sin(0.7));
        EXPECT_NEAR(rest.height_m, here + R * (std::sqrt(1 + ahead * ahead) - 1), 1e-8) << heading; // a plane's tangent
        EXPECT_NEAR(rest.rise_ahead, ahead, 1e-4) << heading;
        EXPECT_NEAR(rest.rise_left, left, 1e-6) << heading;
    }
}

// (5): the rise is the gradient of the height it is carried to, or an elastic ground would give energy.
TEST(Terrain, the_rise_is_the_slope_of_the_height) {
    Terrain rough = profile({{0.5, 0}, {0.5, 0.015}}, 0.3);
    rough.roughness_m3 = iso_8608_m3('C');
    Relief relief(rough, 3);
    const double c = std::cos(0.5), s = std::sin(0.5), h = 1e-5;
    int seen = 0;
    for (double x = 0.2; x < 0.9; x += 0.013) {
        const Rest at = relief.rest(x, 0.1, c, s, R, width), ahead = relief.rest(x + h * c, 0.1 + h * s, c, s, R, width),
                   behind = relief.rest(x - h * c, 0.1 - h * s, c, s, R, width);
        const double slope = (ahead.height_m - behind.height_m) / (2 * h);
        if (std::fabs(ahead.rise_ahead - behind.rise_ahead) > 0.05) continue; // it changes from one contact to another
        EXPECT_NEAR(at.rise_ahead, slope, 0.01) << x;
        ++seen;
    }
    EXPECT_GT(seen, 40);
}

// Mean square of the waves from `low` to `high` cycles per metre along a track, by its Fourier series over the length.
double band_m2(Relief &relief, double x_m, double y_m, double heading, double length_m, double low, double high) {
    const int n = static_cast<int>(length_m / 0.02);
    std::vector<double> height;
    for (int k = 0; k < n; ++k) {
        const double hann = 1 - std::cos(2 * pi * k / n), d = 0.02 * k; // mean square of the window: 1.5
        height.push_back(hann * relief.height_m(x_m + d * std::cos(heading), y_m + d * std::sin(heading)));
    }
    double sum = 0;
    for (int m = static_cast<int>(std::ceil(low * length_m)); m <= static_cast<int>(high * length_m); ++m) {
        double re = 0, im = 0;
        for (int k = 0; k < n; ++k)
            re += height[static_cast<std::size_t>(k)] * std::cos(2 * pi * m * k / n),
                im += height[static_cast<std::size_t>(k)] * std::sin(2 * pi * m * k / n);
        sum += 2 * (re * re + im * im) / (static_cast<double>(n) * n) / 1.5;
    }
    return sum;
}

TEST(Terrain, roughness_has_the_spectrum_of_iso_8608_along_every_track) {
    Terrain terrain;
    terrain.roughness_m3 = iso_8608_m3('C');
    terrain.shortest_m = 0.2;
    EXPECT_NEAR(terrain.roughness_m3, 256e-6, 1e-12); // the standard's geometric mean of class C
    for (const double heading : {0.0, 0.6, 1.57, 2.4})
        for (const auto &[low, high] : {std::pair{0.4, 1.0}, {1.0, 2.5}}) {
            double sum = 0;
            const int tracks = 24;
            for (int i = 0; i < tracks; ++i) {
                Relief relief(terrain, static_cast<std::uint64_t>(100 + i));
                sum += band_m2(relief, 3.1 * i, -2.3 * i, heading, 20, low, high);
            }
            const double standard = terrain.roughness_m3 * 0.01 * (1 / low - 1 / high); // (1) over the band
            // about four waves of the ring's neighbourhood carry a band of a track, exponential powers: 24 tracks leave 10 % of spread;
            // three of it
            EXPECT_NEAR(sum / tracks / standard, 1, 0.3) << heading << ' ' << low;
        }
}

TEST(Terrain, a_level_profile_is_the_plane) {
    for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc}) {
        PlantConfig config = on(profile({{0, 0}, {1, 0}}), "sand", contact), plane = on(Terrain{}, "sand", contact);
        Plant a(config), b(plane);
        for (Plant *plant : {&a, &b})
            for (int i = 0; i < wheel_count; ++i) plant->set_duty(i, i % 2 == 0 ? 0.6 : 0.5);
        for (int k = 0; k < 3000; ++k) a.step(), b.step();
        // the plane's contact turns with the body, the terrain's does not: the body leans by some mrad
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(a.truth().position_m[k], b.truth().position_m[k], 2e-3) << k << ' ' << static_cast<int>(contact);
        EXPECT_NEAR(a.truth().yaw_rad, b.truth().yaw_rad, 0.02);
    }
}

// The wheels carry what the slope asks for: sum of traction less rolling resistance is m g sin, and the loads are m g cos.
TEST(Terrain, a_slope_takes_its_share_of_the_weight) {
    const double slope = std::tan(8 * pi / 180);
    PlantConfig config = on(profile({{0, 0}, {100, 100 * slope}}), "gravel");
    config.ground.grip_noise = 0;
    config.x_m = 20;
    Plant plant(config);
    drive(plant, 0.6, 6);
    double along = 0, load = 0;
    const int ticks = 500;
    const double speed = plant.truth().v_body_m_s[0];
    for (int k = 0; k < ticks; ++k) {
        plant.step();
        for (const WheelTruth &w : plant.truth().wheel)
            along += (w.traction_N - w.rolling_share * w.rolling_N) / ticks, load += w.normal_N / ticks;
    }
    const double weight = config.rover.mass_kg * config.rover.gravity_m_s2;
    const double gained = config.rover.mass_kg * (plant.truth().v_body_m_s[0] - speed) / (0.001 * ticks);
    EXPECT_NEAR(along, weight * std::sin(8 * pi / 180) + gained, 0.005 * weight);
    EXPECT_NEAR(load, weight * std::cos(8 * pi / 180), 0.005 * weight);
    EXPECT_NEAR(plant.truth().pitch_rad, -8 * pi / 180, 0.005);
    EXPECT_GT(plant.truth().position_m[2], config.x_m * slope + 0.1); // it climbs
}

TEST(Terrain, across_a_slope_the_wheels_hold_it_sideways) {
    const double slope = std::tan(6 * pi / 180);
    PlantConfig config = on(profile({{-100, -100 * slope}, {100, 100 * slope}}, pi / 2), "concrete"); // the left side is up
    Plant plant(config);
    for (int k = 0; k < 3000; ++k) plant.step();
    double sideways = 0, load = 0;
    for (const WheelTruth &w : plant.truth().wheel) sideways += w.lateral_N, load += w.normal_N;
    const double weight = config.rover.mass_kg * config.rover.gravity_m_s2;
    EXPECT_NEAR(sideways, weight * std::sin(6 * pi / 180), 0.01 * weight);
    EXPECT_NEAR(load, weight * std::cos(6 * pi / 180), 0.01 * weight);
    EXPECT_NEAR(plant.truth().roll_rad, 6 * pi / 180, 0.01);
}

// What the normal forces have taken must be in the tyres, and is back when the rover stands again: without damping nothing else takes it.
TEST(Terrain, an_edge_takes_no_energy_that_it_does_not_give_back) {
    for (const double direction : {0.0, 0.5, -1.0}) {
        PlantConfig config = on(profile({{0.4, 0}, {0.4, 0.019}, {0.8, 0.019}, {0.8, 0}}, direction));
        config.rover.contact_damping_Ns_m = 0;
        Plant plant(config);
        drive(plant, 0.4, 7);
        drive(plant, 0, 3);
        const double along = plant.truth().position_m[0] * std::cos(direction) + plant.truth().position_m[1] * std::sin(direction);
        EXPECT_GT(along, 1.0) << direction;                     // it has crossed both edges
        EXPECT_NEAR(plant.energy().body, 0, 0.02) << direction; // 4 k (1.2 mm)^2/2 = 0.017 J is all that the tyres hold at rest
    }
}

TEST(Terrain, parked_on_a_ramp_or_on_rough_ground_it_stays) {
    Terrain rough;
    rough.roughness_m3 = iso_8608_m3('C');
    for (const Terrain &terrain : {profile({{-9, -9 * 0.1}, {9, 9 * 0.1}}), rough})
        for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc}) {
            Plant plant(on(terrain, "sand", contact));
            for (int k = 0; k < 1000; ++k) plant.step();
            const double x = plant.truth().position_m[0], y = plant.truth().position_m[1];
            for (int k = 0; k < 10000; ++k) plant.step();
            EXPECT_NEAR(plant.truth().position_m[0], x, 1e-3) << static_cast<int>(contact);
            EXPECT_NEAR(plant.truth().position_m[1], y, 1e-3) << static_cast<int>(contact);
        }
}

TEST(Terrain, rough_ground_and_steps_give_no_energy) {
    Terrain rough = profile({{0.6, 0}, {0.6, 0.019}, {1.1, 0.019}, {1.1, 0}}, 0.3);
    rough.roughness_m3 = iso_8608_m3('D');
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        PlantConfig config = on(rough);
        config.ground.seed = seed;
        config.rover.contact_damping_Ns_m = 0; // nothing takes up an error
        config.yaw_rad = 0.2 * static_cast<double>(seed);
        Plant plant(config);
        drive(plant, 0.4, 8);
        const Energy &e = plant.energy();
        const double out = e.kinetic + e.potential + e.friction + e.slip + e.rolling + e.body;
        EXPECT_NEAR(e.motor, out, 0.02 * e.motor) << seed; // every joule is somewhere
        EXPECT_GT(plant.truth().path_m, 1.2) << seed;      // and it went over both edges
        EXPECT_LT(e.potential + e.kinetic, e.motor) << seed;
        for (const WheelTruth &w : plant.truth().wheel) EXPECT_LT(w.normal_N, 60) << seed;
    }
}

// Statics of a rover whose front wheels stand at an edge of a third of their radius: the grip (over load, all four wheels sliding) at which
// they just lift. Force balance along and up, and moments about the centre of mass, of rear contact and edge.
double grip_for_step() {
    const double sine = std::sqrt(1 - 4.0 / 9), cosine = 2.0 / 3, half = 0.083, height = 0.08;
    double low = 0.2, high = 1.1;
    for (int i = 0; i < 60; ++i) {
        const double grip = 0.5 * (low + high);
        const double front = grip / (sine - grip * cosine); // load at the edge per load of the rear wheels, from the balance along
        const double ahead_N = front * (grip * cosine - sine), up_N = front * (cosine + grip * sine);
        const double x = half + R * sine, z = -height + R * (1 - cosine);
        const double moment = -half + height * grip + x * up_N - z * ahead_N; // nose up positive, of all forces on the rover
        (moment < 0 ? low : high) = grip;                                     // too little lifts: more grip
    }
    return 0.5 * (low + high);
}

TEST(Terrain, a_step_of_a_third_of_the_wheels_radius_asks_for_the_grip_of_statics) {
    const double needed = grip_for_step();
    ASSERT_GT(needed, 0.3);
    ASSERT_LT(needed, 1.0);
    for (const double share : {0.85, 1.15}) {
        PlantConfig config = on(profile({{0.5, 0}, {0.5, R / 3}}));
        config.ground.soil.adhesion_N = 0;
        config.ground.soil.fm_per_fn = share * needed;
        config.ground.soil.rolling_coefficient = 0;
        config.ground.grip_noise = 0;
        config.x_m = 0.5 - 0.083 - R * std::sqrt(1 - 4.0 / 9) - 0.001; // a millimetre before the edge
        Plant plant(config);
        for (int k = 0; k < 8000; ++k) { // pushed slowly, so that no run-up helps
            for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, std::min(0.6, 0.1e-3 * k));
            plant.step();
        }
        if (share < 1)
            EXPECT_LT(plant.truth().position_m[0], 0.45) << "it climbed with too little grip";
        else
            EXPECT_GT(plant.truth().position_m[0], 0.6) << "it did not climb";
    }
}

TEST(Terrain, a_path_does_not_depend_on_where_the_world_lies) {
    std::vector<double> x, y;
    for (const double turn : {0.0, 0.9, -2.2}) {
        PlantConfig config = on(profile({{0.4, 0}, {0.4, 0.015}, {1.5, 0.15}}, turn), "gravel");
        config.ground.grip_noise = 0;
        config.yaw_rad = turn + 0.15;
        Plant plant(config);
        drive(plant, 0.5, 5);
        const double c = std::cos(turn), s = std::sin(turn);
        x.push_back(c * plant.truth().position_m[0] + s * plant.truth().position_m[1]);
        y.push_back(-s * plant.truth().position_m[0] + c * plant.truth().position_m[1]);
    }
    for (std::size_t i = 1; i < x.size(); ++i) {
        EXPECT_NEAR(x[i], x[0], 1e-5);
        EXPECT_NEAR(y[i], y[0], 1e-5);
    }
}

TEST(Terrain, a_map_is_read_and_what_is_wrong_in_it_is_named) {
    const std::string path = testing::TempDir() + "terrain_map.csv";
    const auto write = [&path](const std::string &text) { std::ofstream(path) << text; };
    write("# a ramp along x\n0, 0.1, 0.2\n0, 0.1, 0.2\n");
    Terrain terrain;
    terrain.map = std::make_shared<const HeightMap>(read_height_map(path, 0.5, 2));
    Relief relief(terrain, 1);
    EXPECT_NEAR(relief.height_m(0.5, 0.3), 0.2, 1e-12);
    EXPECT_NEAR(relief.height_m(1e9, -1e9), 0.4, 1e-12); // beyond the edge it goes on level
    const auto told = [&](const std::string &text) {
        write(text);
        try {
            read_height_map(path, 0.5, 1);
        } catch (const std::runtime_error &error) {
            return std::string(error.what()).substr(path.size());
        }
        return std::string("nothing");
    };
    EXPECT_EQ(told("0,1\n0,x\n"), ":2, field 2: 'x' is not a number; write heights in metres, between commas");
    EXPECT_EQ(told("0,1\n0,nan\n"), ":2, field 2: 'nan' is not a number; write heights in metres, between commas");
    EXPECT_EQ(told("0,1\n0\n"), ":2: 1 heights where the first row has 2; give every row as many");
    EXPECT_EQ(told("0,1\n"), ": a height map needs two rows and two columns at least");
    EXPECT_THROW(read_height_map(path + ".none", 0.5, 1), std::runtime_error);
}

} // namespace
