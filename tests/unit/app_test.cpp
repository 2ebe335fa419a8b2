// The daemon's loop on a scripted HAL, and its parameter file: right, wrong and hostile.
#include "firmware/app/daemon.h"
#include "firmware/app/parameters.h"
#include "firmware/app/store.h"
#include "firmware/app/trace_queue.h"
#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include <time.h>
#include <unistd.h>

namespace {

// A rover on blocks: every device answers, nothing moves.
struct Bench {
    int ticks = 50, fail_read_at = -1, fail_write_at = -1, done = 0, stops = 0, writes = 0, logged = 0;
    int fail_writes = 1, kicks = 0;
    hal_result_t failure = HAL_ERR_IO, write_failure = HAL_ERR_IO;
    bool silent = false; // devices time out from tick 10 on
    std::vector<actuator_frame_t> written;

    hal_t hal() {
        return {.context = this,
                .wait_tick =
                    [](void *c) {
                        auto &b = *static_cast<Bench *>(c);
                        return b.done++ < b.ticks ? HAL_OK : HAL_END;
                    },
                .read =
                    [](void *c, sensor_frame_t *frame) {
                        auto &b = *static_cast<Bench *>(c);
                        frame->tick = static_cast<uint32_t>(b.done - 1);
                        if (b.done - 1 == b.fail_read_at) return b.failure;
                        if (b.silent && b.done > 10) return HAL_ERR_TIMEOUT;
                        frame->present = FRAME_ALL;
                        for (auto &count : frame->current_count) count = 2048;
                        if (b.writes > 0) frame->current_count[0] = 2048 + 278; // duty 0.25 of 7.2 V over 3.24 ohm
                        frame->battery_count = 1800;                            // 7.2 V
                        frame->radar_samples = 5;
                        for (int i = 0; i < 5; ++i) frame->radar_count[i] = static_cast<uint16_t>(512 + (i + b.done) % 2);
                        return HAL_OK;
                    },
                .write =
                    [](void *c, const actuator_frame_t *actuator) {
                        auto &b = *static_cast<Bench *>(c);
                        b.written.push_back(*actuator);
                        const bool fails =
                            b.fail_write_at >= 0 && b.writes >= b.fail_write_at && b.writes < b.fail_write_at + b.fail_writes;
                        b.writes++;
                        return fails ? b.write_failure : HAL_OK;
                    },
                .safe_stop = [](void *c) { static_cast<Bench *>(c)->stops++; },
                .open = nullptr,
                .self_test = nullptr,
                .status = nullptr,
                .kick_watchdog = [](void *c) { static_cast<Bench *>(c)->kicks++; },
                .close = nullptr};
    }
    daemon_link_t link() {
        return {.context = this,
                .command =
                    [](void *, const sensor_frame_t *, command_t *command) {
                        command->mode = MODE_OPEN_LOOP;
                        command->duty[0] = 0.25f;
                    },
                .log = [](void *c, const sensor_frame_t *, const command_t *, const trace_t *) { static_cast<Bench *>(c)->logged++; }};
    }
    daemon_result_t run() {
        const control_config_t config = rover_config_default();
        const hal_t world = hal();
        const daemon_link_t person = link();
        return daemon_run(&world, &config, &person);
    }
};

TEST(Daemon, drives_logs_every_tick_and_ends_with_the_motors_stopped) {
    Bench bench;
    const daemon_result_t result = bench.run();
    EXPECT_EQ(result.ended_by, HAL_END);
    EXPECT_EQ(result.ticks, 50u);
    EXPECT_EQ(bench.logged, 50);
    EXPECT_EQ(bench.stops, 1);
    EXPECT_EQ(result.faults, 0u);
    EXPECT_NEAR(bench.written.back().duty_q15[0], 0.25 * 32767, 1);
}

TEST(Daemon, stops_the_rover_when_a_device_is_lost) {
    for (const hal_result_t failure : {HAL_ERR_IO, HAL_ERR_CONFIG}) {
        Bench bench;
        bench.fail_read_at = 20;
        bench.failure = failure;
        EXPECT_EQ(bench.run().ended_by, failure);
        EXPECT_EQ(bench.stops, 1);
        EXPECT_EQ(bench.writes, 20); // nothing is written on what was not read
    }
    Bench bench;
    bench.fail_write_at = 20;
    EXPECT_EQ(bench.run().ended_by, HAL_ERR_IO);
    EXPECT_EQ(bench.stops, 1);
    EXPECT_EQ(bench.writes, 21);
}

TEST(Daemon, survives_lost_orders_until_the_bridges_release_themselves) {
    for (const int lost : {1, 4, 5}) {
        Bench bench;
        bench.fail_write_at = 20;
        bench.fail_writes = lost;
        bench.write_failure = HAL_ERR_TIMEOUT;
        const daemon_result_t result = bench.run();
        EXPECT_EQ(result.ended_by, lost < 5 ? HAL_END : HAL_ERR_TIMEOUT) << lost; // 50 ms
        EXPECT_EQ(bench.stops, 1);
        EXPECT_EQ(bench.kicks, lost < 5 ? 50 : 24) << lost; // alive: the watchdog is kicked in every tick
    }
}

TEST(Daemon, leaves_a_silent_device_to_safety) {
    Bench bench;
    bench.silent = true;
    const daemon_result_t result = bench.run();
    EXPECT_EQ(result.ended_by, HAL_END); // the loop never stalls
    EXPECT_NE(result.faults & FAULT_ENCODER_LOST, 0u);
    EXPECT_NE(bench.written.back().drive, DRIVE_ON);
    int off = 0;
    while (bench.written[static_cast<std::size_t>(off)].drive == DRIVE_ON) ++off;
    EXPECT_LE(off, 10 + 10); // 100 ms after the first silent tick
}

std::string text_of(const std::string &path) {
    std::string text;
    if (FILE *file = std::fopen(path.c_str(), "r")) {
        for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
        std::fclose(file);
    }
    return text;
}

TEST(Store, comes_back_bit_for_bit_and_a_damaged_one_is_refused) {
    const std::string path = ::testing::TempDir() + "store_test.txt";
    std::remove(path.c_str());
    const store_t given = {{12.5f, 0.1f, 94.0f, 1e-3f}};
    store_t read = {};
    char message[STORE_MESSAGE];
    EXPECT_FALSE(store_read(path.c_str(), &read, message));
    EXPECT_NE(std::string(message).find("cannot be read"), std::string::npos) << message;
    ASSERT_TRUE(store_write(path.c_str(), &given, message)) << message;
    ASSERT_TRUE(store_read(path.c_str(), &read, message)) << message;
    EXPECT_EQ(std::memcmp(&given, &read, sizeof given), 0);
    const std::string whole = text_of(path);
    for (std::size_t at = 0; at < whole.size(); ++at) { // one wrong character anywhere, or a file cut there
        for (const bool cut : {true, false}) {
            std::string bad = cut ? whole.substr(0, at) : whole;
            if (!cut) bad[at] = bad[at] == '0' ? '1' : '0';
            FILE *file = std::fopen(path.c_str(), "w");
            std::fputs(bad.c_str(), file);
            std::fclose(file);
            EXPECT_FALSE(store_read(path.c_str(), &read, message)) << at << (cut ? " cut" : " changed");
        }
    }
    EXPECT_FALSE(store_write("/no/such/folder/store", &given, message));
    EXPECT_NE(std::string(message).find("/no/such/folder/store: cannot be written"), std::string::npos) << message;
    std::remove(path.c_str());
}

// A reader that takes nothing: the tick that logs does not wait for it, and every lost line is counted.
TEST(TraceQueue, a_stalled_file_costs_lines_and_no_tick) {
    int pipe_ends[2];
    ASSERT_EQ(pipe(pipe_ends), 0);
    static trace_queue_t queue;
    queue = {};
    queue.file = fdopen(pipe_ends[1], "w");
    ASSERT_TRUE(trace_queue_start(&queue));
    constexpr int lines = 2000;
    const std::string line(500, 'x');
    timespec before, after;
    clock_gettime(CLOCK_MONOTONIC, &before);
    for (int i = 0; i < lines; ++i) trace_queue_put(&queue, (line + "\n").c_str()); // a pipe holds 64 kB: 130 of them
    clock_gettime(CLOCK_MONOTONIC, &after);
    EXPECT_LT(static_cast<double>(after.tv_sec - before.tv_sec) + 1e-9 * static_cast<double>(after.tv_nsec - before.tv_nsec), 5.0);
    std::size_t read_lines = 0;
    std::thread reader([&] {
        char buffer[4096];
        for (ssize_t n = 1; n > 0;) {
            n = read(pipe_ends[0], buffer, sizeof buffer);
            for (ssize_t i = 0; i < n; ++i) read_lines += buffer[i] == '\n';
        }
    });
    const unsigned long lost = trace_queue_finish(&queue);
    std::fclose(queue.file);
    reader.join();
    EXPECT_GT(lost, 1000u);
    EXPECT_EQ(read_lines + lost, static_cast<std::size_t>(lines));
    close(pipe_ends[0]);
}

TEST(TraceQueue, a_patient_one_keeps_every_line) {
    static trace_queue_t queue;
    queue = {};
    queue.file = std::tmpfile();
    queue.patient = true;
    ASSERT_TRUE(trace_queue_start(&queue));
    for (int i = 0; i < 5000; ++i) trace_queue_put(&queue, (std::to_string(i) + "\n").c_str());
    EXPECT_EQ(trace_queue_finish(&queue), 0u);
    std::rewind(queue.file);
    int line = -1, expected = 0;
    while (std::fscanf(queue.file, "%d", &line) == 1) EXPECT_EQ(line, expected++);
    EXPECT_EQ(expected, 5000);
    std::fclose(queue.file);
}

TEST(Daemon, starts_with_the_windings_as_warm_as_it_is_told) {
    Bench bench;
    const control_config_t config = rover_config_default();
    const hal_t world = bench.hal();
    const daemon_link_t person = bench.link();
    volatile float out_K[WHEEL_COUNT] = {};
    const float kept_K[WHEEL_COUNT] = {10, 20, 30, 40};
    daemon_start_t start = {};
    start.rise_out_K = out_K;
    daemon_run_from(&world, &config, &person, &start);
    EXPECT_LT(out_K[3], 1.0f);
    start.warm = true;
    start.rise_K = kept_K;
    bench.done = 0;
    daemon_run_from(&world, &config, &person, &start);
    EXPECT_NEAR(out_K[3], 40, 1); // 0.5 s of a minute's time constant
    start.rise_K = nullptr;
    bench.done = 0;
    daemon_run_from(&world, &config, &person, &start);
    EXPECT_NEAR(out_K[3], 76, 1); // 0.8 of 95 K
}

std::string refused(const std::string &text) {
    control_config_t config = rover_config_default();
    const control_config_t before = config;
    char message[PARAMETERS_MESSAGE];
    if (parameters_parse(text.data(), text.size(), "rover.txt", &config, nullptr, message)) return "accepted";
    EXPECT_EQ(config.motor.resistance_ohm, before.motor.resistance_ohm);
    EXPECT_EQ(config.geometry.wheel_radius_m, before.geometry.wheel_radius_m);
    return message;
}

const std::string format = "format = \"traction.firmware/1\"\n";

TEST(Parameters, set_what_they_name_and_all_that_follows_from_it) {
    const std::string text =
        "# from a model\r\n" + format +
        "wheel_radius_m = 0.06 # m\n\ntorque_constant_Nm_A=0.3\nresistance_ohm = 4\nviscous_Nms = 2e-3\n"
        "coulomb_Nm = 0.05\ninertia_kg_m2 = 6e-3\nmass_kg = 3\ndoppler_scale = 1.02\nwheel_kp_s = 0.1\nwheel_ki_1 = 0.5\n";
    control_config_t config = rover_config_default();
    const control_config_t before = config;
    char message[PARAMETERS_MESSAGE];
    ASSERT_TRUE(parameters_parse(text.data(), text.size(), "rover.txt", &config, nullptr, message)) << message;
    EXPECT_FLOAT_EQ(config.slip.wheel_radius_m, 0.06f);
    EXPECT_FLOAT_EQ(config.motor.per_radius_1_m, 1 / 0.06f);
    EXPECT_FLOAT_EQ(config.speed_control.half_track_per_radius, 0.12f / 0.06f);
    EXPECT_FLOAT_EQ(config.soil_sweep.ramp_1_m, 0.01f / (0.06f * 10));        // (15)
    EXPECT_FLOAT_EQ(config.motor.volt_per_speed_Vs, 4 * 2e-3f / 0.3f + 0.3f); // (a) and (18)
    EXPECT_FLOAT_EQ(config.motor.volt_dry_V, 4 * 0.05f / 0.3f);
    EXPECT_FLOAT_EQ(config.safety.heating_K_A2, before.safety.heating_K_A2 * 4 / 3.24f);
    EXPECT_FLOAT_EQ(config.doppler.scale, 1.02f);
    EXPECT_FLOAT_EQ(config.wheel_pid.ki_T_s, 0.005f);
}

TEST(Parameters, an_empty_list_changes_nothing) {
    control_config_t config = rover_config_default();
    const control_config_t before = config;
    char message[PARAMETERS_MESSAGE];
    ASSERT_TRUE(parameters_parse(format.data(), format.size(), "x", &config, nullptr, message));
    EXPECT_EQ(config.motor.volt_per_speed_Vs, before.motor.volt_per_speed_Vs);
    EXPECT_EQ(config.soil_sweep.ramp_1_m, before.soil_sweep.ramp_1_m);
}

std::string config_bits(const control_config_t &c) {
    std::string out;
    const auto put = [&out](const auto &part) { out.append(reinterpret_cast<const char *>(&part), sizeof part); };
    put(c.geometry), put(c.sense), put(c.circuit), put(c.slip), put(c.motor), put(c.wheel_pid), put(c.slip_pi), put(c.speed_control),
        put(c.soil_sweep);
    put(c.safety), put(c.doppler.beam), put(c.doppler.offset_count), put(c.doppler.scale), put(c.doppler.quiet_power_count2);
    put(c.ground_speed.window), put(c.ground_speed.still_m_s), put(c.steering);
    return out;
}

// Every key is read, and changes the configuration. No key is read and forgotten.
TEST(Parameters, every_key_of_the_list_is_read_and_reaches_the_configuration) {
    for (int32_t i = 0; i < ROVER_PARAMETER_COUNT; ++i) {
        const std::string key = rover_parameter_name(i);
        const float low = rover_parameter_low(i), high = rover_parameter_high(i);
        rover_parameters_t reference;
        rover_parameters_reference(&reference);
        const float now = reference.value[i], other = key.starts_with("encoder_sign") ? -1.0f
                                                      : now != 0                      ? now * 0.7f
                                                                                      : 0.25f * (high > 0 ? high : low);
        ASSERT_TRUE(other >= low && other <= high) << key;
        char text[160];
        (void)std::snprintf(text, sizeof text, "%s%s = %.9g\n", format.c_str(), key.c_str(), static_cast<double>(other));
        parameters_t read;
        char message[PARAMETERS_MESSAGE];
        ASSERT_TRUE(parameters_parse_rover(text, std::strlen(text), "x", &read, nullptr, message)) << message;
        EXPECT_TRUE(read.given[i]);
        EXPECT_EQ(read.rover.value[i], other);
        control_config_t built, before;
        control_config_build(&read.rover, &built);
        control_config_build(&reference, &before);
        EXPECT_NE(config_bits(built), config_bits(before)) << key;
    }
}

// What is written gives the same bits when it is read: for the reference, and for a rover none of whose numbers is the reference's.
TEST(Parameters, what_is_written_reads_back_bit_for_bit) {
    uint32_t random = 7;
    for (int repeat = 0; repeat < 200; ++repeat) {
        parameters_t written{};
        rover_parameters_reference(&written.rover);
        written.rover.radar = repeat % ROVER_RADAR_LINKED;
        for (int32_t i = 0; i < ROVER_PARAMETER_COUNT; ++i) {
            random = random * 1664525u + 1013904223u;
            written.given[i] = repeat > 0 && (random >> 20) % 3 != 0;
            const float share = static_cast<float>(random >> 8) / 16777216.0f;
            const float low = rover_parameter_low(i), high = rover_parameter_high(i);
            if (written.given[i]) written.rover.value[i] = fminf(low + (high - low) * share * share, high);
        }
        rover_parameters_scale(&written.rover, written.given);
        for (int32_t i = 0; i < ROVER_PARAMETER_COUNT; ++i) // a scaled number is not read, so it may be anything
            if (!rover_parameter_scaled(i)) written.given[i] = true;
        char text[PARAMETERS_TEXT], message[PARAMETERS_MESSAGE];
        const size_t length = parameters_write(&written, "a rover", text);
        ASSERT_LT(length, sizeof text);
        parameters_t read;
        ASSERT_TRUE(parameters_parse_rover(text, length, "x", &read, nullptr, message)) << message;
        EXPECT_EQ(std::memcmp(read.rover.value, written.rover.value, sizeof read.rover.value), 0) << text;
        EXPECT_EQ(read.rover.radar, written.rover.radar);
        EXPECT_EQ(std::memcmp(read.given, written.given, sizeof read.given), 0);
    }
}

TEST(Parameters, a_rover_that_cannot_work_is_refused_with_the_line_of_its_key) {
    EXPECT_EQ(refused(format + "mass_kg = 3\nstall_current_A = 5 # too much\n"),
              "rover.txt:3: stall_current_A = 5: a stalled wheel takes V/Ra, which is less: a stall would never be seen; lower it");
    const std::string weak = refused(format + "current_A_per_count = 0.0005\n"); // +-1 A
    EXPECT_NE(weak.find("rover.txt: current_offset_count_0 = 2048 (not given: the reference rover's): the converter's rail"),
              std::string::npos)
        << weak;
    const std::string made = refused(format + "wheel_max_rad_s = 3\nencoder_absurd_rad_s = 200\nencoder_counts_per_turn = 400000\n");
    EXPECT_NE(made.find("rover.txt:4: encoder_counts_per_turn = 400000: more than 65535 pulses"), std::string::npos) << made;
    EXPECT_NE(refused(format + "radar = \"X\"\n").find("rover.txt:2: radar = \"X\": no template; use \"MDU1130\""), std::string::npos);
    EXPECT_NE(refused(format + "radar = \"DRS1000\"\nradar = \"DRS1000\"\n").find("given twice"), std::string::npos);
    EXPECT_NE(refused(format + "radar_rate_Hz = 500\n").find("rover.txt:2: radar_rate_Hz = 500: the radar's template"), std::string::npos);
}

TEST(Parameters, a_mistake_is_told_with_file_line_key_value_and_mend) {
    EXPECT_EQ(refused(format + "mass_kg = heavy\n"), "rover.txt:2: mass_kg = heavy: not a finite number");
    EXPECT_EQ(refused(format + "mass_kg = nan\n"), "rover.txt:2: mass_kg = nan: not a finite number");
    EXPECT_EQ(refused(format + "\nwheel_radius_m = 57\n"),
              "rover.txt:3: wheel_radius_m = 57: out of range; give a number from 0.01 to 0.5");
    EXPECT_NE(refused(format + "radius = 1\n").find("rover.txt:2: radius = 1: unknown key"), std::string::npos);
    EXPECT_NE(refused(format + "mass_kg = 3\nmass_kg = 3\n").find("given twice"), std::string::npos);
    EXPECT_NE(refused(format + "mass_kg 3\n").find("no '='"), std::string::npos);
    EXPECT_NE(refused("mass_kg = 3\n").find("format"), std::string::npos);
    EXPECT_NE(refused("format = \"traction.firmware/9\"\n").find("this firmware reads"), std::string::npos);
    EXPECT_NE(refused(format + std::string(5000, 'x')).find("too long"), std::string::npos);
    EXPECT_NE(refused(format + std::string("mass\0kg = 3", 11)).find("not text"), std::string::npos);
    control_config_t config = rover_config_default();
    char message[PARAMETERS_MESSAGE];
    EXPECT_FALSE(parameters_read("no/such/file", &config, nullptr, message));
    EXPECT_NE(std::string(message).find("no/such/file: cannot be read"), std::string::npos);
}

TEST(Parameters, any_bytes_are_read_or_refused) {
    uint32_t random = 1;
    const std::string alphabet = "=#\n\" .e-+0123456789mass_kgformatraction/wheel\r\t";
    for (int repeat = 0; repeat < 2000; ++repeat) {
        std::string text = repeat % 2 == 0 ? format : "";
        for (int i = 0; i < 60; ++i) {
            random = random * 1664525u + 1013904223u;
            text += alphabet[(random >> 16) % alphabet.size()];
        }
        control_config_t config = rover_config_default();
        char message[PARAMETERS_MESSAGE];
        const bool read = parameters_parse(text.data(), text.size(), "x", &config, nullptr, message);
        EXPECT_NE(read, std::strlen(message) > 0);
        EXPECT_GT(config.motor.resistance_ohm, 0.0f);
    }
}

} // namespace
