// What a run leaves that is killed: the log that it would have written then, whole; and nothing damaged is taken for a log.
#include "host_tools/log/part.h"
#include "host_tools/log/read.h"
#include "host_tools/log/recover.h"
#include "host_tools/log/spool.h"

#include "files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <gtest/gtest.h>
#include <map>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace traction::log {
namespace {

// Thousands of logs, each put through to the disk: in memory, where the system has files there.
[[maybe_unused]] const bool in_memory = access("/dev/shm", W_OK) == 0 && setenv("TEST_TMPDIR", "/dev/shm/", 1) == 0;

const std::map<std::string, std::string> header{{"seed", "7"}, {"title", "a run: with a colon"}};

// Removes a log's parts when a test ends, as a run that goes on would have.
struct Parts {
    explicit Parts(std::string of) : log(std::move(of)) {}
    ~Parts() {
        for (const char *ending : {".part", ".2.part", ".3.part"}) std::filesystem::remove(log + ending);
    }
    std::string log;
};

std::string bytes_of(const std::string &path) {
    std::ostringstream out;
    out << std::ifstream(path, std::ios::binary).rdbuf();
    return out.str();
}

double wheel_value(int k) { return k % 5 == 0 ? 0.1 * k : (k / 3) / 1e6; }

// A column that is fast, one that comes late and changes its lane, whole millionths and other numbers in turn, one that is always 0.
class Drive {
  public:
    explicit Drive(Spool &spool) : spool_(spool) {
        spool.begin(header);
        fast_ = spool.add("radar.adc_count"), wheel_ = spool.add("wheel0.speed_rad_s"), late_ = spool.add("camera.x_m");
        zero_ = spool.add("command.slip", true), spool.add("wheel1.speed_rad_s");
        clocked_ = spool.add("imu.accel_x_count", false, 0, Unit::count);
    }
    void step(int k) {
        const double t_s = k / 100.0;
        if (k % 5 == 0)
            spool_.put(wheel_, t_s, wheel_value(k));
        else
            spool_.put_whole(wheel_, t_s, k / 3);
        spool_.put(zero_, t_s, 0);
        for (int i = 0; i < 3; ++i) spool_.put(fast_, t_s - 0.009 + i * 0.003, 37 * k % 1024);
        const std::int32_t five[] = {k, 2 * k, 0, 3, -k};
        spool_.put_by_clock(clocked_, static_cast<std::uint32_t>(5 * k + 1), 512, five);
        if (k % 7 == 3) spool_.put(late_, t_s - (k % 2 == 0 ? 0.055 : 0.0), 1.0 / k);
        spool_.instant_is_over();
    }

  private:
    Spool &spool_;
    std::size_t fast_ = 0, wheel_ = 0, late_ = 0, zero_ = 0, clocked_ = 0;
};

// Every sample of `log` is one of the run's, none is left out before its last one, all end at one step. How many steps.
std::size_t expect_of_the_run(const Log &log) {
    EXPECT_EQ(log.header.at("ended"), "interrupted");
    EXPECT_EQ(log.header.at("title"), header.at("title"));
    EXPECT_EQ(log.repairs, std::vector<std::string>()) << "a whole log needs no mending";
    EXPECT_EQ(log.find("command.slip"), nullptr);
    EXPECT_EQ(log.find("wheel1.speed_rad_s"), nullptr);
    std::size_t count = 0;
    if (const Signal *wheel = log.find("wheel0.speed_rad_s"); wheel != nullptr) {
        count = wheel->value.size();
        for (std::size_t k = 0; k < count; ++k) {
            EXPECT_EQ(wheel->t_s[k], static_cast<double>(k) / 100);
            EXPECT_EQ(wheel->value[k], wheel_value(static_cast<int>(k)));
        }
    }
    const auto values = [&log](const char *name) {
        const Signal *signal = log.find(name);
        return signal == nullptr ? std::vector<double>{} : signal->value;
    };
    const std::vector<double> fast = values("radar.adc_count"), late = values("camera.x_m");
    EXPECT_EQ(fast.size(), 3 * count);
    EXPECT_EQ(late.size(), (count + 3) / 7);
    for (std::size_t k = 0; k < fast.size(); ++k) EXPECT_EQ(fast[k], static_cast<double>(37 * (k / 3) % 1024));
    for (std::size_t k = 0; k < late.size(); ++k) EXPECT_EQ(late[k], 1.0 / (3 + 7 * static_cast<double>(k)));
    const std::vector<double> clocked = values("imu.accel_x_count");
    EXPECT_EQ(clocked.size(), 5 * count);
    for (std::size_t n = 0; n < clocked.size(); ++n) {
        const double k = static_cast<double>(n / 5);
        EXPECT_EQ(clocked[n], (std::array{k, 2 * k, 0.0, 3.0, -k})[n % 5]);
        EXPECT_EQ(log.find("imu.accel_x_count")->t_s[n], static_cast<double>(n + 1) / 512);
    }
    return count;
}

// The part of a small run, in blocks of a few rows.
std::string small_part(const std::string &log, int steps) {
    const Parts parts(log);
    Spool spool(log);
    Drive run(spool);
    for (int k = 0; k < steps; ++k) {
        run.step(k);
        if (k % 3 == 2) spool.put_by();
    }
    spool.put_by();
    return bytes_of(log + ".part");
}

// Where its blocks begin, and its end.
std::vector<std::size_t> blocks_of(const std::string &bytes) {
    std::vector<std::size_t> begins{part::magic.size()};
    while (begins.back() < bytes.size()) {
        part::BlockHead head{};
        std::memcpy(&head, bytes.data() + begins.back(), sizeof head);
        begins.push_back(begins.back() + sizeof head + head.size);
    }
    EXPECT_EQ(begins.back(), bytes.size());
    return begins;
}

class Recover : public ::testing::TestWithParam<const char *> {
  protected:
    const test::File log_{std::string("recover_run") + GetParam(), ""}, out_{std::string("recovered") + GetParam(), ""};
};

TEST_P(Recover, a_part_cut_at_any_byte_is_a_whole_log_of_the_blocks_before) {
    const std::string bytes = small_part(log_.path(), 9);
    const std::vector<std::size_t> begins = blocks_of(bytes);
    std::size_t before = 0;
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
        const test::File cut("recover_cut.part", bytes.substr(0, size));
        try {
            const Recovered told = recover(cut.path(), out_.path());
            EXPECT_EQ(told.damage, "") << size;
            EXPECT_EQ(told.lost_at, *(std::upper_bound(begins.begin(), begins.end(), size) - 1)) << size;
            EXPECT_EQ(told.lost_at + told.lost_bytes, size);
            const std::size_t count = expect_of_the_run(read_csv(out_.path()));
            EXPECT_GE(count, before) << size;
            before = count;
        } catch (const LogError &) { // nothing is there yet
            EXPECT_EQ(before, 0u) << size;
        }
        if (HasFailure()) return;
    }
    EXPECT_EQ(before, 9u);
}

TEST_P(Recover, every_changed_byte_is_told_and_nothing_behind_it_is_taken) {
    const std::string bytes = small_part(log_.path(), 9);
    const std::vector<std::size_t> begins = blocks_of(bytes);
    std::mt19937 random(20261125);
    std::size_t logs = 0;
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        std::string changed = bytes;
        changed[at] = static_cast<char>(changed[at] ^ (1 + random() % 255));
        const test::File part("recover_changed.part", changed);
        try {
            const Recovered told = recover(part.path(), out_.path());
            EXPECT_NE(told.damage, "") << at;
            EXPECT_EQ(told.lost_at, *(std::upper_bound(begins.begin(), begins.end(), at) - 1)) << at;
            expect_of_the_run(read_csv(out_.path()));
            ++logs;
        } catch (const LogError &error) { // no part at all, or damaged before the first row
            EXPECT_TRUE(at < part::magic.size() || std::string(error.what()).find("damaged") != std::string::npos) << error.what();
        }
        if (HasFailure()) return;
    }
    EXPECT_GT(logs, bytes.size() / 3);
}

TEST_P(Recover, a_run_that_is_killed_at_any_instant_leaves_what_it_had) {
    const Parts parts(log_.path());
    std::mt19937 random(20261125);
    std::size_t most = 0;
    for (int i = 0; i < 40; ++i) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            Spool spool(log_.path());
            Drive run(spool);
            for (int k = 0;; ++k) run.step(k);
        }
        const std::string part = log_.path() + ".part";
        for (int wait = 0; wait < 5000 && (!std::filesystem::exists(part) || std::filesystem::file_size(part) < 20000); ++wait)
            usleep(1000);
        usleep(static_cast<useconds_t>(random() % 4000)); // the length of about thirty stretches
        kill(child, SIGKILL);
        ASSERT_EQ(waitpid(child, nullptr, 0), child);
        const Recovered told = recover(part, out_.path());
        EXPECT_EQ(told.damage, "");
        EXPECT_EQ(log_.text(), "") << "the log itself is not there";
        most = std::max(most, expect_of_the_run(read_csv(out_.path())));
        std::filesystem::remove(part);
        if (HasFailure()) return;
    }
    EXPECT_GT(most, 1000u);
}

TEST_P(Recover, a_part_is_there_while_a_log_is_made_and_gone_when_it_stands) {
    Spool spool(log_.path());
    Drive run(spool);
    for (int k = 0; k < 30000; ++k) run.step(k);
    const std::string part = log_.path() + ".part";
    ASSERT_TRUE(std::filesystem::exists(part));
    EXPECT_THROW(recover(part, out_.path()), FileError) << "its run goes on";
    spool.write(header);
    EXPECT_FALSE(std::filesystem::exists(part));
    EXPECT_EQ(read_csv(log_.path()).find("wheel0.speed_rad_s")->value.size(), 30000u);
}

INSTANTIATE_TEST_SUITE_P(FromRowsAndFromColumns, Recover, ::testing::Values(".csv", ".ulg"),
                         [](const auto &of) { return std::string(of.param + 1); });

TEST(Part, what_stands_under_its_name_is_neither_followed_nor_overwritten) {
    const test::File log("part_name.csv", ""), other("part_victim", "as it was");
    const Parts parts(log.path());
    std::filesystem::create_symlink(other.path(), log.path() + ".part");
    std::ofstream(log.path() + ".2.part") << "of another run";
    Spool spool(log.path());
    Drive run(spool);
    for (int k = 0; k < 100; ++k) run.step(k);
    spool.put_by();
    EXPECT_EQ(other.text(), "as it was");
    EXPECT_EQ(bytes_of(log.path() + ".2.part"), "of another run");
    EXPECT_TRUE(part::begins_as_part(bytes_of(log.path() + ".3.part")));
    spool.write(header);
    EXPECT_TRUE(std::filesystem::is_symlink(log.path() + ".part"));
    EXPECT_EQ(bytes_of(log.path() + ".2.part"), "of another run");
    EXPECT_FALSE(std::filesystem::exists(log.path() + ".3.part"));
}

TEST(Part, lies_beside_what_a_link_leads_to_with_the_logs_own_mode) {
    const test::File log("part_target.csv", "old");
    ASSERT_EQ(chmod(log.path().c_str(), 0640), 0);
    const std::string link = log.path() + ".link";
    const Parts parts(log.path());
    std::filesystem::create_symlink(log.path(), link);
    {
        Spool spool(link);
        Drive run(spool);
        for (int k = 0; k < 100; ++k) run.step(k);
        spool.put_by();
        struct stat made {};
        ASSERT_EQ(stat((log.path() + ".part").c_str(), &made), 0);
        EXPECT_EQ(made.st_mode & 0777, 0640u);
        spool.write(header);
    }
    std::filesystem::remove(link);
}

TEST(Part, a_device_has_none) {
    Spool spool("/dev/null");
    Drive run(spool);
    for (int k = 0; k < 30000; ++k) run.step(k);
    EXPECT_FALSE(std::filesystem::exists("/dev/null.part"));
    spool.write(header);
    struct stat there {};
    ASSERT_EQ(stat("/dev/null", &there), 0);
    EXPECT_TRUE(S_ISCHR(there.st_mode));
}

// A block whose checks are right, and whose content no run writes.
TEST(Part, content_that_cannot_be_is_told) {
    const auto block = [](part::Kind kind, const std::string &payload) {
        part::BlockHead head{static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(payload.size()),
                             part::crc_after(0, payload.data(), payload.size()), 0, 0};
        head.check = part::head_check(head);
        return std::string(reinterpret_cast<const char *>(&head), sizeof head) + payload;
    };
    const auto words = [](std::vector<std::uint32_t> numbers) { return std::string(part::bytes_of(numbers)); };
    const auto row = [](double t_s, std::uint32_t pattern, std::uint16_t column, double value) {
        const part::RowHead head{t_s, pattern, 0, 1};
        std::string text(reinterpret_cast<const char *>(&head), sizeof head);
        text.append(reinterpret_cast<const char *>(&column), sizeof column);
        return text.append(reinterpret_cast<const char *>(&value), sizeof value);
    };
    const auto clock = [](double rate_Hz, std::uint32_t pattern, std::vector<std::int32_t> whole) {
        const part::RowHead head{2, pattern | part::RowHead::by_clock, static_cast<std::uint16_t>(whole.size()), 0};
        const part::Clock begun{rate_Hz, 1, 0};
        std::string text(reinterpret_cast<const char *>(&head), sizeof head);
        text.append(reinterpret_cast<const char *>(&begun), sizeof begun);
        return text.append(part::bytes_of(whole));
    };
    const auto lane = [&](const std::string &rows) { return words({1, static_cast<std::uint32_t>(rows.size())}) + rows; };
    const std::string good = std::string(part::magic) + block(part::Kind::columns, "- a.x_m\n- b.x_m\n") +
                             block(part::Kind::pattern, words({0})) + block(part::Kind::pattern, words({1})) +
                             block(part::Kind::pattern, words({0, 1})) + block(part::Kind::rows, lane(row(1, 0, 0, 5)));
    const test::File out("part_content.csv", "");
    const auto told = [&](const std::string &more) {
        const test::File file("part_content.part", good + more);
        return recover(file.path(), out.path());
    };
    EXPECT_EQ(told("").damage, "");
    EXPECT_EQ(told(block(part::Kind::rows, lane(row(2, 0, 0, 6)))).samples, 2u);
    EXPECT_EQ(told(block(part::Kind::rows, lane(clock(0.25, 0, {6, 7, 8})))).samples, 4u);
    EXPECT_EQ(told(block(part::Kind::filling, std::string(77, '\0')) + block(part::Kind::rows, lane(row(2, 0, 0, 6)))).samples, 2u);
    for (const std::string &bad : {
             block(part::Kind::rows, lane(row(2, 3, 0, 6))),                       // a pattern that is not
             block(part::Kind::rows, lane(row(2, 0, 2, 6))),                       // a column that is not
             block(part::Kind::rows, lane(row(2, 1, 0, 6))),                       // a sample of b, which holds nothing
             block(part::Kind::rows, lane(row(std::nan(""), 0, 0, 6))),            // no time
             block(part::Kind::rows, lane(row(2, 0, 0, 6).substr(0, 20))),         // half a row
             block(part::Kind::rows, words({2, 16}) + row(2, 0, 0, 6)),            // half a list of lanes
             block(part::Kind::rows, words({0xffffffffu, 16})),                    // lanes without end
             block(part::Kind::rows, words({1, 0xffffffffu})),                     // a lane beyond its end
             block(part::Kind::rows, ""),                                          // nothing
             block(part::Kind::rows, lane(clock(0.25, 3, {6, 7, 8}))),             // a clock's
             block(part::Kind::rows, lane(clock(0.25, 2, {6, 7, 8}))),             // a clock of two columns
             block(part::Kind::rows, lane(clock(0.25, 0, {}))),                    // of nothing
             block(part::Kind::rows, lane(clock(0.25, 0, {6, 7}).substr(0, 39))),  // cut
             block(part::Kind::samples, words({1, 2, 1}) + std::string(16, '\0')), // a column that is not
             block(part::Kind::samples, words({1, 0, 9}) + std::string(16, '\0')), // more samples than there are
             block(part::Kind::columns, "c.x_m\n"),                                // neither kept nor left out
             block(part::Kind::columns, "- c.x_m"),                                // no end
             block(part::Kind::pattern, words({7})),                               // of a column that is not
             block(part::Kind::header, "no value\n"),
             block(static_cast<part::Kind>(9), "of a later version"),
         }) {
        const Recovered found = told(bad);
        EXPECT_NE(found.damage, "") << found.samples;
        EXPECT_EQ(found.samples, 1u) << found.damage;
        EXPECT_EQ(found.lost_at, good.size());
    }
}

// What a run appends begins and ends where stretches of the file do, but for the first blocks and what is put by between.
TEST(Part, its_blocks_are_as_long_as_a_stretch) {
    const test::File log("part_stretch.csv", "");
    const Parts parts(log.path());
    std::string bytes;
    {
        Spool spool(log.path());
        Drive run(spool);
        for (int k = 0; k < 20000; ++k) {
            run.step(k);
            if (k < 3000 && k % 97 == 0) spool.put_by(); // wherever that ends
        }
        bytes = bytes_of(log.path() + ".part");
    }
    const std::vector<std::size_t> begins = blocks_of(bytes);
    ASSERT_GT(bytes.size(), 8 * Scratch::stretch);
    const auto at_a_stretch = std::count_if(begins.begin(), begins.end(), [](std::size_t at) { return at % Scratch::stretch == 0; });
    EXPECT_GE(static_cast<std::size_t>(at_a_stretch), bytes.size() / Scratch::stretch - 4);
    std::size_t filled = 0, longest = 0;
    for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
        part::BlockHead head{};
        std::memcpy(&head, bytes.data() + begins[i], sizeof head);
        longest = std::max<std::size_t>(longest, head.size);
        filled += head.kind == static_cast<std::uint32_t>(part::Kind::filling) ? sizeof head + head.size : 0;
    }
    EXPECT_LT(filled, bytes.size() / 20);
    EXPECT_LE(longest, Scratch::stretch * 3 / 2);
}

TEST(Part, is_no_log_and_says_what_makes_one) {
    const test::File part("part_read.csv.part", std::string(part::magic));
    try {
        read_csv(part.path());
        FAIL() << "read as a log";
    } catch (const LogError &error) {
        EXPECT_NE(std::string(error.what()).find("traction recover " + part.path() + " --out"), std::string::npos) << error.what();
    }
    const test::File csv("part_no.csv", "t_s,a.x_m\n0,1\n"), out("part_no_out.csv", "");
    EXPECT_THROW(recover(csv.path(), out.path()), LogError);
    EXPECT_THROW(recover("/nowhere/x.part", out.path()), FileError);
    EXPECT_EQ(out.text(), "");
}

TEST(Part, its_check_is_crc_32c_by_words_and_by_bytes) {
    EXPECT_EQ(part::crc_after(0, "123456789", 9), 0xe3069283u);                   // RFC 3720, appendix B.4, and every list of CRCs
    EXPECT_EQ(part::crc_after(0, std::string(32, '\0').data(), 32), 0x8a9136aau); // RFC 3720, B.4
    EXPECT_EQ(part::crc_after(0, std::string(32, '\xff').data(), 32), 0x62a8ab43u);
    std::mt19937 random(3);
    std::string bytes(300, ' ');
    for (char &byte : bytes) byte = static_cast<char>(random());
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
        EXPECT_EQ(part::crc_after(5, bytes.data(), size), part::crc_by_bytes(5, bytes.data(), size));
        const std::uint32_t first = part::crc_after(0, bytes.data(), size);
        EXPECT_EQ(part::crc_after(first, bytes.data() + size, bytes.size() - size), part::crc_after(0, bytes.data(), bytes.size()));
    }
}

} // namespace
} // namespace traction::log
