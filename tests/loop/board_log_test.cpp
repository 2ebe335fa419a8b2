// What tractiond logs on board comes back as the log that simulate records of the same drive: every column, every sample; replayed, the
// same traces; cut anywhere, the ticks before the cut.
#include "firmware/app/log_ring.h"
#include "firmware/core/rover_config.h"
#include "hal/sim/plan_operator.h"
#include "hal/sim/sim_rover.h"
#include "host_tools/board/board_log.h"
#include "host_tools/loop/loop.h"
#include "host_tools/replay/replay_log.h"
#include "host_tools/simulate/simulate.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>

using namespace traction;

namespace {

const std::string text =
    "duration_s = 8\nseed = 4\n[ground]\nsoil = \"sand\"\n[[drive]]\nfor_s = 1\nmode = \"stop\"\n[[drive]]\nfor_s = 4\n"
    "mode = \"platform_speed\"\nspeed_m_s = [0.0, 0.3]\nyaw_rate_rad_s = 0.1\n[[drive]]\nfor_s = 3\nmode = \"slip\"\n"
    "speed_m_s = 0.2\nslip = 0.3\nslip_wheels = [1, 2]\n[[fault]]\nwhat = \"emergency_stop\"\nfrom_s = 7.0\n";

struct Operator final : Link {
    explicit Operator(const sim::Scenario &scenario) : plan(scenario), ring(std::make_unique<log_ring_t>()) {}
    void command(const sensor_frame_t &frame, command_t &command) override { command = plan.command_at(frame.tick); }
    void log(const sensor_frame_t &frame, const command_t &command, const trace_t &trace) override {
        log_ring_put(ring.get(), &frame, &command, &trace);
    }
    hal::PlanOperator plan;
    std::unique_ptr<log_ring_t> ring;
};

class BoardLog : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        std::string name = (std::filesystem::temp_directory_path() / "traction_board_XXXXXX").string();
        folder = mkdtemp(name.data());
        const sim::Scenario scenario = sim::parse_scenario(text, "drive.toml");
        hal::SimRover rover(scenario, {}, scenario.seed);
        Operator link(scenario);
        char message[LOG_RING_MESSAGE];
        link.ring->patient = true;
        ASSERT_TRUE(log_ring_start(link.ring.get(), folder.c_str(), 64000000, message)) << message;
        run_loop(rover.hal(), rover_config_default(), link);
        ASSERT_EQ(log_ring_finish(link.ring.get()), 0u);
        file = folder + "/log_000001.ulg";
    }
    static void TearDownTestSuite() { std::filesystem::remove_all(folder); }
    static std::string folder, file;
};
std::string BoardLog::folder, BoardLog::file;

std::string bytes_of(const std::string &path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

TEST_F(BoardLog, is_the_log_that_simulate_records_of_the_same_drive) {
    const SimulationResult simulated = simulate(sim::parse_scenario(text, "drive.toml"));
    ASSERT_TRUE(board::is_ulog(file));
    const board::BoardLog read = board::read_board_log(file);
    EXPECT_EQ(read.ticks.size(), 800u);
    EXPECT_TRUE(read.mended.empty());
    EXPECT_FALSE(read.version.empty());
    ASSERT_EQ(read.text.size(), 1u); // the stop
    EXPECT_EQ(read.text[0].substr(0, 24), "7.000 s: fault 00000001,");
    const log::Log log = board::to_log(read, sim::RoverDescription());
    std::size_t compared = 0;
    for (const log::Signal &expected : simulated.log.signals) {
        if (expected.name.starts_with("camera")) continue; // no device of the rover's
        const log::Signal *found = log.find(expected.name);
        ASSERT_NE(found, nullptr) << expected.name;
        EXPECT_EQ(found->t_s, expected.t_s) << expected.name;
        EXPECT_EQ(found->value, expected.value) << expected.name;
        compared++;
    }
    EXPECT_GT(compared, 60u);
    for (const auto &[key, value] : simulated.log.header) // what a user knows of the rover
        if (key.starts_with("quantum") || key.starts_with("window") || key.starts_with("encoder") || key.starts_with("radar")) {
            EXPECT_EQ(log.header.at(key), value) << key;
        }
}

TEST_F(BoardLog, replays_bit_for_bit) {
    const log::Log log = board::to_log(board::read_board_log(file), sim::RoverDescription());
    const auto comparison = replay::replay_log(log, replay::logged_ticks(log));
    EXPECT_EQ(comparison.ticks, 800u);
    EXPECT_EQ(comparison.differing, 0u) << comparison.first_signal;
}

TEST_F(BoardLog, cut_or_spoilt_anywhere_is_read_up_to_there_and_says_so) {
    const std::string bytes = bytes_of(file);
    const board::BoardLog whole = board::read_board_log(file);
    std::mt19937 random(9);
    const std::string cut_file = folder + "/cut.ulg";
    for (int n = 0; n < 200; n++) {
        const std::size_t cut = 16 + random() % (bytes.size() - 16);
        std::ofstream(cut_file, std::ios::binary) << bytes.substr(0, cut);
        try {
            const board::BoardLog read = board::read_board_log(cut_file);
            // a tick is 400 bytes and more: all but the last one before the cut, at least
            EXPECT_GE(static_cast<double>(read.ticks.size()) + 2,
                      (static_cast<double>(cut) - 3000) / static_cast<double>(bytes.size()) * 800)
                << cut;
            EXPECT_EQ(read.ticks.back().frame.time_us, whole.ticks[read.ticks.size() - 1].frame.time_us);
            EXPECT_LE(read.mended.size(), 1u);
        } catch (const log::LogError &error) { // no tick was whole
            EXPECT_LT(cut, 3000u) << error.what();
        }
    }
    for (int n = 0; n < 300; n++) { // any bytes do no harm
        std::string spoilt = bytes.substr(0, 20000);
        for (int i = 0; i < 20; i++) spoilt[8 + random() % (spoilt.size() - 8)] = static_cast<char>(random());
        std::ofstream(cut_file, std::ios::binary) << spoilt;
        try {
            const log::Log log = board::to_log(board::read_board_log(cut_file), sim::RoverDescription());
            EXPECT_FALSE(log.signals.empty());
        } catch (const log::LogError &) {
        }
    }
    std::ofstream(cut_file, std::ios::binary) << "t_s,wheel0.speed_rad_s\n";
    EXPECT_FALSE(board::is_ulog(cut_file));
    EXPECT_THROW(board::read_board_log(cut_file), log::LogError);
    EXPECT_THROW(board::read_board_log(folder + "/none.ulg"), log::FileError);
}
