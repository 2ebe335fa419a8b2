// A log as ULog and back: the same log, every bit of every number; however the file is damaged, reading ends in a log or a message.
#include "files.h"

#include "host_tools/log/read.h"
#include "host_tools/log/ulog.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

using namespace traction::log;
using traction::test::File;

namespace {

Log odd_log() {
    Log log;
    log.header = {{"machine", "one: with a colon"}, {"note", "blanks  within"}, {"scenario", "x"}};
    Signal fast{"radar.adc_count", {}, {}}, fine{"truth.x_m", {}, {}}, slow{"wheel0.speed_rad_s", {}, {}}, flag{"a, b", {}, {}};
    for (int i = 0; i < 512; i++) {
        fast.t_s.push_back(i / 512.0); // is no whole number of microseconds
        fast.value.push_back(i % 255 - 127);
        fine.t_s.push_back(i / 512.0);
        fine.value.push_back(std::sqrt(static_cast<double>(i)) * (i % 2 == 0 ? 1e-300 : 1e300));
    }
    for (int i = 0; i < 100; i++) {
        slow.t_s.push_back(i / 100.0);
        slow.value.push_back(i == 3 ? -0.0 : static_cast<double>(static_cast<float>(0.1 * i)));
        flag.t_s.push_back(i / 100.0);
        flag.value.push_back(i % 2);
    }
    log.signals = {
        fast, slow, Signal{"imu.gyro_z_rad_s", {}, {}}, flag, Signal{"7up", {0.25}, {4e9}}, Signal{"7_up", {0.5}, {-2147483648.0}}, fine};
    return log;
}

void expect_same(const Log &a, const Log &b) {
    EXPECT_EQ(a.header, b.header);
    ASSERT_EQ(a.signals.size(), b.signals.size());
    for (std::size_t i = 0; i < a.signals.size(); i++) {
        const Signal &one = a.signals[i], &two = b.signals[i];
        EXPECT_EQ(one.name, two.name);
        ASSERT_EQ(one.t_s.size(), two.t_s.size()) << one.name;
        for (std::size_t k = 0; k < one.t_s.size(); k++) {
            EXPECT_EQ(std::bit_cast<std::uint64_t>(one.t_s[k]), std::bit_cast<std::uint64_t>(two.t_s[k])) << one.name << ' ' << k;
            EXPECT_EQ(std::bit_cast<std::uint64_t>(one.value[k]), std::bit_cast<std::uint64_t>(two.value[k])) << one.name << ' ' << k;
        }
    }
}

std::string bytes_of(const Log &log) {
    const File file("made.ulg", "");
    write_ulog(log, file.path());
    return file.text();
}

} // namespace

TEST(ulog, is_read_back_bit_for_bit_by_whoever_reads_a_log) {
    const Log log = odd_log();
    const File file("odd.ulg", "");
    write_ulog(log, file.path());
    EXPECT_TRUE(is_own_ulog(file.path()));
    expect_same(log, read_csv(file.path()));
    EXPECT_EQ(bytes_of(log), bytes_of(read_csv(file.path()))); // and written again it is the same file
}

TEST(ulog, a_log_that_begins_before_0_keeps_its_times) {
    Log log = odd_log();
    for (Signal &signal : log.signals)
        for (double &t_s : signal.t_s) t_s -= 1700.3;
    const File file("before.ulg", bytes_of(log));
    expect_same(log, read_csv(file.path()));
}

// A column that is all small whole numbers costs a byte a sample and no empty cell: 13 bytes of a message and 1 + 8 of radar and fine,
// against the text's commas and digits.
TEST(ulog, a_fast_column_costs_no_empty_cells) {
    Log log = odd_log();
    log.signals = {log.signals[0], log.signals[1]};
    const File csv("size.csv", "");
    write_csv(log, csv.path());
    const std::string bytes = bytes_of(log);
    const std::size_t messages = 512 * (3 + 2 + 8 + 8 + 1) + 100 * (3 + 2 + 8 + 8); // the second with a -0, in double or float: 4 at least
    EXPECT_LT(bytes.size(), messages + 1000);
    EXPECT_GT(bytes.size(), std::size_t{512 * (3 + 2 + 8 + 8 + 1)});
}

TEST(ulog, cut_anywhere_it_is_read_up_to_there) {
    const std::string whole = bytes_of(odd_log());
    const Log all = odd_log();
    std::size_t told = 0, most = 0;
    for (std::size_t length = 600; length < whole.size(); length += 97) {
        const File cut("cut.ulg", whole.substr(0, length));
        std::vector<Repair> repairs;
        const Log log = read_csv(cut.path(), "", repairs);
        told += static_cast<std::size_t>(!repairs.empty());
        for (std::size_t i = 0; i < log.signals.size() && i < all.signals.size(); i++) {
            const Signal &part = log.signals[i], &full = all.signals[i];
            ASSERT_LE(part.value.size(), full.value.size());
            for (std::size_t k = 0; k < part.value.size(); k++) ASSERT_EQ(part.value[k], full.value[k]) << part.name << ' ' << k;
        }
        if (!log.signals.empty()) most = std::max(most, log.signals[0].value.size());
    }
    EXPECT_GT(told, (whole.size() - 600) / 97 * 9 / 10); // a cut between two messages is no damage that a reader could see
    EXPECT_GT(most, 500u);
}

TEST(ulog, however_it_is_damaged_reading_ends_in_a_log_or_a_message) {
    const std::string whole = bytes_of(odd_log());
    std::mt19937_64 random(20261123);
    for (int i = 0; i < 3000; i++) {
        std::string bytes = whole.substr(0, 1500 + random() % 3000);
        for (int changes = 1 + static_cast<int>(random() % 4); changes > 0; changes--)
            bytes[7 + random() % (bytes.size() - 7)] = static_cast<char>(random());
        std::vector<Repair> repairs;
        try {
            const Log log = read_ulog(bytes, "damaged.ulg", {}, repairs);
            for (const Signal &signal : log.signals) ASSERT_EQ(signal.t_s.size(), signal.value.size());
        } catch (const LogError &error) {
            ASSERT_NE(std::string(error.what()).find("damaged.ulg"), std::string::npos);
        }
    }
}

TEST(ulog, what_is_not_ours_is_refused_with_the_mend) {
    std::string foreign = bytes_of(odd_log());
    foreign.replace(foreign.find("traction-log"), 12, "PX4-FMU-v5xx");
    const File file("px4.ulg", foreign);
    EXPECT_FALSE(is_own_ulog(file.path()));
    try {
        (void)read_csv(file.path());
        FAIL();
    } catch (const LogError &error) {
        EXPECT_NE(error.mend.find("traction convert"), std::string::npos);
    }
    EXPECT_THROW(read_csv(File("mapped.ulg", bytes_of(odd_log())).path(), "some_map.toml"), LogError);
}

TEST(ulog, more_samples_than_the_limit_are_refused) {
    const std::string bytes = bytes_of(odd_log());
    std::vector<Repair> repairs;
    ReadLimits limits;
    limits.samples = 1000;
    EXPECT_THROW((void)read_ulog(bytes, "large.ulg", limits, repairs), LogError);
}

TEST(ulog, what_a_csv_cannot_hold_it_does_not_hold_either) {
    const File file("kept.ulg", "as it was");
    Log twice = odd_log();
    twice.signals[1].name = twice.signals[0].name;
    EXPECT_THROW(write_ulog(twice, file.path()), LogError);
    Log infinite = odd_log();
    infinite.signals[0].value[7] = std::numeric_limits<double>::infinity();
    EXPECT_THROW(write_ulog(infinite, file.path()), LogError);
    Log backwards = odd_log();
    backwards.signals[0].t_s[7] = 0;
    EXPECT_THROW(write_ulog(backwards, file.path()), LogError);
    EXPECT_EQ(file.text(), "as it was");
}

TEST(ulog, hundreds_of_signals_of_one_clock_are_several_topics) {
    Log log;
    for (int i = 0; i < 1000; i++) log.signals.push_back({"x" + std::to_string(i) + ".value", {0.01, 0.02}, {1.0 * i, 1e-9 * i}});
    const File file("many.ulg", bytes_of(log));
    expect_same(log, read_csv(file.path()));
}
