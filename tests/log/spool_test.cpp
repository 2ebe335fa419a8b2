// A log that is written while it grows is the log that is written at once; nothing of it is lost or kept twice.
#include "host_tools/log/csv_text.h"
#include "host_tools/log/spool.h"
#include "host_tools/log/ulog.h"
#include "host_tools/log/write_file.h"

#include "files.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <utility>

namespace traction::log {
namespace {

// Three columns of different clocks and lengths around a block's edge, one that is always 0, one that never held anything.
void fill(Spool &spool, std::size_t samples) {
    const std::size_t fast = spool.add("radar.adc_count"), slow = spool.add("wheel0.speed_rad_s"), rare = spool.add("camera.x_m"),
                      zero = spool.add("command.slip", true);
    spool.add("wheel1.speed_rad_s");
    for (std::size_t k = 0; k < samples; ++k) {
        const double t_s = static_cast<double>(k) / 512;
        spool.put(fast, t_s, static_cast<double>(k * 37 % 1024));
        if (k % 5 == 0) spool.put(slow, t_s, std::ldexp(static_cast<double>(k % 77) - 38, -7));
        if (k % 1000 == 3) spool.put(rare, t_s + 1e-4, 1.0 / static_cast<double>(k + 1));
        if (k % 5 == 0) spool.put(zero, t_s, 0);
    }
}

TEST(Spool, writes_the_bytes_that_write_csv_writes) {
    const std::map<std::string, std::string> header{{"seed", "7"}, {"title", "a run"}};
    for (const std::size_t samples :
         {std::size_t{0}, std::size_t{1}, Spool::block - 1, Spool::block, Spool::block + 1, 7 * Spool::block + 11}) {
        const test::File at_once("spool_at_once.csv", ""), grown("spool_grown.csv", "");
        Spool memory, disk(grown.path());
        fill(memory, samples);
        fill(disk, samples);
        Log log = memory.take();
        log.header = header;
        EXPECT_EQ(log.find("command.slip"), nullptr) << "absent is 0";
        EXPECT_EQ(log.find("wheel1.speed_rad_s"), nullptr) << "it never held anything";
        write_csv(log, at_once.path());
        disk.write(header);
        EXPECT_EQ(at_once.text(), grown.text()) << samples;
    }
}

// Rows are kept as they come: whatever comes between, before, late or alone must stand where write_csv puts it.
TEST(Spool, writes_those_bytes_in_whatever_order_the_columns_come) {
    const auto fill_apart = [](Spool &spool) {
        const std::size_t a = spool.add("a.x_m"), b = spool.add("b.x_m"), c = spool.add("c.x_m"), zero = spool.add("z.x_m", true);
        for (int k = 0; k < 3000; ++k) spool.put(a, k * 0.01, k % 7 == 0 ? 0.5 : -0.0); // one column whole, then the next from the start
        for (int k = 0; k < 3000; ++k) spool.put(b, k * 0.015, k);
        for (int k = 0; k < 3000; ++k) {
            spool.put(b, 60 + k * 0.01, k / 100); // back on the times of others
            if (k % 3 != 0) spool.put(a, 60 + k * 0.01, 1.0 / (k + 1));
            if (k % 50 == 1) spool.put(c, 60 + k * 0.01 - 0.004, k);    // late, between two rows that are there
            if (k % 50 == 2) spool.put(zero, 60 + k * 0.01 + 0.001, 0); // alone in its row, and left out with it
        }
        const std::size_t p = spool.add("p.x_m"), q = spool.add("q.x_m");
        for (int k = 0; k < 3000; ++k) { // the last column first; and p, of the first lane, stands behind b, which is in another
            spool.put(q, 100 + k * 0.01, k);
            spool.put(p, 100 + k * 0.01, -k);
            spool.put(b, 100 + k * 0.01, 0.5 * k);
        }
    };
    const test::File at_once("spool_apart.csv", ""), grown("spool_apart_grown.csv", "");
    Spool memory, disk(grown.path());
    fill_apart(memory);
    fill_apart(disk);
    write_csv(memory.take(), at_once.path());
    disk.write({});
    EXPECT_EQ(at_once.text(), grown.text());
}

TEST(Spool, writes_the_ulog_that_write_ulog_writes) {
    for (const std::size_t samples : {std::size_t{0}, std::size_t{1}, Spool::block, 7 * Spool::block + 11}) {
        const test::File at_once("spool_at_once.ulg", ""), grown("spool_grown.ulg", "");
        Spool memory, disk(grown.path());
        fill(memory, samples);
        fill(disk, samples);
        Log log = memory.take();
        log.header = {{"seed", "7"}, {"title", "a run"}};
        write_ulog(log, at_once.path());
        disk.write(log.header);
        EXPECT_EQ(at_once.text(), grown.text()) << samples;
    }
}

TEST(Spool, refuses_what_cannot_stand_in_a_log) {
    const test::File kept("spool_refused.csv", "as it was");
    const double last_s = 3 * Spool::block - 1, never = std::numeric_limits<double>::infinity();
    const std::pair<double, double> refused[] = {{5.0, 1},     {last_s, 1},
                                                 {never, 1},   {std::numeric_limits<double>::quiet_NaN(), 1},
                                                 {1e9, never}, {1e9, std::numeric_limits<double>::quiet_NaN()}};
    for (const auto &[t_s, value] : refused) {
        Spool spool(kept.path());
        const std::size_t column = spool.add("wheel0.speed_rad_s");
        for (std::size_t k = 0; k < 3 * Spool::block; ++k) spool.put(column, static_cast<double>(k), 1);
        spool.put(column, t_s, value);
        spool.put(column, 2e9, 1); // what is right after it does not mend it
        EXPECT_THROW(spool.write({}), LogError) << t_s << ' ' << value;
        std::remove((kept.path() + ".part").c_str()); // it stays where no log was made
        EXPECT_EQ(kept.text(), "as it was") << "nothing half-written";
    }
}

TEST(Spool, tells_where_it_cannot_write) {
    Spool spool("/nowhere/at/all.csv");
    const std::size_t column = spool.add("wheel0.speed_rad_s");
    try {
        for (std::size_t k = 0; k <= RowSpool::chunk_bytes / 16; ++k) spool.put(column, static_cast<double>(k), 1); // a row has 16 bytes
        spool.instant_is_over();
        FAIL() << "a folder that is not there";
    } catch (const FileError &error) {
        EXPECT_NE(std::string(error.what()).find("/nowhere/at/all.csv"), std::string::npos) << error.what();
    }
}

// A whole number of millionths is the number that it is: as text, and in a column where others come between.
TEST(Spool, millionths_are_written_as_their_number) {
    const auto expect_same = [](std::int32_t millionths) {
        char whole[number_room], number[number_room];
        const std::string a(whole, put_whole(whole, Unit::millionth, millionths)), b(number, put_number(number, millionths / 1e6));
        ASSERT_EQ(a, b) << millionths;
    };
    for (std::int32_t n = -20000; n <= 20000; ++n) expect_same(n);
    for (std::int64_t n = std::numeric_limits<std::int32_t>::min(); n <= std::numeric_limits<std::int32_t>::max(); n += 65521)
        expect_same(static_cast<std::int32_t>(n));
    for (const std::int32_t n : {1000000, 10000000, 100000000, 1000000000, 2000000000, 999999, 9999999, 1000001, 100000001}) {
        for (const std::int32_t off : {-1, 0, 1}) expect_same(n + off), expect_same(-(n + off));
    }
    expect_same(std::numeric_limits<std::int32_t>::max());
}

TEST(Spool, counts_are_written_as_their_number) {
    const auto expect_same = [](std::int32_t bits) {
        for (const Unit unit : {Unit::count, Unit::natural}) {
            const double value = unit == Unit::count ? bits : static_cast<double>(static_cast<std::uint32_t>(bits));
            char whole[number_room], number[number_room];
            const std::string a(whole, put_whole(whole, unit, bits)), b(number, put_number(number, value));
            ASSERT_EQ(a, b) << bits;
            ASSERT_EQ(value_of(unit, bits), value);
        }
    };
    for (std::int32_t n = -20000; n <= 20000; ++n) expect_same(n);
    for (std::int64_t n = std::numeric_limits<std::int32_t>::min(); n <= std::numeric_limits<std::int32_t>::max(); n += 65521)
        expect_same(static_cast<std::int32_t>(n));
    for (std::int64_t power = 1; power < std::int64_t{1} << 31; power *= 10)
        for (const std::int64_t off : {-1, 0, 1, 10})
            expect_same(static_cast<std::int32_t>(power + off)), expect_same(-static_cast<std::int32_t>(power + off));
}

// A float is told by the shortest text that reads back to it.
TEST(Spool, floats_are_written_as_their_shortest_text) {
    std::mt19937 random(20261126);
    for (int i = 0; i < 100000; ++i) {
        const auto bits = static_cast<std::int32_t>(random());
        const auto value = std::bit_cast<float>(bits);
        if (!std::isfinite(value)) continue;
        ASSERT_EQ(static_cast<float>(value_of(Unit::exact, bits)), value);
        char ours[number_room], shortest[64];
        const std::string a(ours, put_whole(ours, Unit::exact, bits));
        double read = 0;
        std::from_chars(shortest, std::to_chars(shortest, shortest + sizeof shortest, value).ptr, read);
        ASSERT_EQ(value_of(Unit::exact, bits), read);
        char theirs[64];
        ASSERT_EQ(a, std::string(theirs, std::to_chars(theirs, theirs + sizeof theirs, read).ptr));
    }
}

// Columns that come together, some of them now and then, one large now and then, beside others of their own: as if they came one by one.
TEST(Spool, columns_that_come_together_are_written_as_one_by_one) {
    for (const char *name : {"spool_grown.csv", "spool_grown.ulg"}) {
        const test::File at_once(std::string("spool_at_once") + (name + 11), ""), grown(name, "");
        Spool memory, disk(grown.path());
        const Unit units[] = {Unit::millionth, Unit::count, Unit::natural, Unit::exact, Unit::millionth, Unit::count, Unit::count};
        const auto whole_of = [](int k, std::size_t i) {
            const int held = k / (i % 3 == 0 ? 1 : 40); // one changes always, others seldom
            if (i == 5) return 0;
            if (i == 6) return k == 20000 ? 3 : 0; // once, in a row that lacks nothing
            return i == 3 ? std::bit_cast<std::int32_t>(0.1f * static_cast<float>(held % 13))
                          : (held * 7919 + static_cast<int>(i)) % 2000003 - (i == 2 ? 0 : 700);
        };
        const auto absent = [](int k, std::size_t i) { return (i == 1 && k % 5 == 2) || (i == 4 && k < 900) || (i == 0 && k == 0); };
        const auto large = [](int k, std::size_t i) { return i == 0 && (k % 1000 == 7 || k % 1000 == 8); };
        std::vector<std::size_t> bound;
        for (Spool *spool : {&memory, &disk}) {
            bound.clear();
            std::size_t alone = 0, own = 0;
            for (std::size_t i = 0; i < std::size(units); ++i) {
                bound.push_back(spool->add("a" + std::to_string(i) + ".x_m", i >= 5, 0, units[i]));
                if (i == 2) alone = spool->add("b.x_m"), own = spool->add("c.adc_count", false, 0, Unit::count);
            }
            const std::size_t together = spool == &disk ? spool->bind(bound) : 0;
            for (int k = 0; k < 30000; ++k) {
                const double t_s = k * 0.01;
                std::int32_t whole[std::size(units)];
                Absent left_out{};
                std::vector<Other> others;
                for (std::size_t i = 0; i < std::size(units); ++i) {
                    whole[i] = whole_of(k, i);
                    if (absent(k, i)) left_out[0] |= 1u << i;
                    if (large(k, i) && !absent(k, i)) others.push_back({i, 1e5 + k});
                    if (spool == &memory && large(k, i) && !absent(k, i))
                        spool->put(bound[i], t_s, 1e5 + k);
                    else if (spool == &memory && !absent(k, i))
                        spool->put_whole(bound[i], t_s, whole[i]);
                }
                if (spool == &disk) spool->put_together(together, t_s, whole, left_out, others);
                if (k % 3 == 0) spool->put(alone, t_s, 1.0 / (k + 1));
                spool->put_whole(own, t_s - 0.004, k % 1024);
                spool->instant_is_over();
            }
        }
        Log log = memory.take();
        log.header = {{"seed", "7"}};
        if (names_a_ulog(grown.path()))
            write_ulog(log, at_once.path());
        else
            write_csv(log, at_once.path());
        disk.write(log.header);
        EXPECT_TRUE(at_once.text() == grown.text()) << name;
        EXPECT_EQ(log.find("a5.x_m"), nullptr) << "absent is 0";
        EXPECT_NE(log.find("a6.x_m"), nullptr);
    }
}

// Runs of every length, one longer than a row of the spool takes, none; times that other columns have too, before and behind; a clock
// beside it, and one that is always 0.
TEST(Spool, samples_of_a_clock_are_written_as_one_by_one) {
    for (const char *name : {"spool_grown.csv", "spool_grown.ulg"}) {
        const test::File at_once(std::string("spool_at_once") + (name + 11), ""), grown(name, "");
        Spool memory, disk(grown.path());
        for (Spool *spool : {&memory, &disk}) {
            const std::size_t fast = spool->add("a.adc_count", false, 0, Unit::count), tick = spool->add("b.x_m"),
                              twin = spool->add("c.x_m", false, 0, Unit::millionth), zero = spool->add("d.adc_count", true, 0, Unit::count),
                              once = spool->add("e.adc_count", true, 0, Unit::count);
            const auto put = [spool, &memory](std::size_t column, std::uint32_t first, double rate_Hz,
                                              const std::vector<std::int32_t> &whole) {
                if (spool != &memory)
                    spool->put_by_clock(column, first, rate_Hz, whole);
                else
                    for (std::size_t i = 0; i < whole.size(); ++i)
                        spool->put_whole(column, static_cast<double>(first + i) / rate_Hz, whole[i]);
            };
            std::uint32_t next = 1;
            for (std::uint32_t k = 0; k < 20000; ++k) {
                std::vector<std::int32_t> whole(k % 1000 == 999 ? 700 : k % 7), zeros(whole.size()), other;
                for (std::size_t i = 0; i < whole.size(); ++i) whole[i] = static_cast<std::int32_t>((next + i) * 37 % 1024) - 512;
                for (const std::int32_t one : whole) other.push_back(one * 1000 + 1);
                spool->put(tick, next / 512.0, k);
                put(fast, next, 512, whole);
                put(twin, next, 512, other);
                if (k > 3) put(zero, next, 512, zeros);
                if (k == 15000) zeros.assign(zeros.size(), 1);
                put(once, next, 512, zeros);
                next += static_cast<std::uint32_t>(whole.size());
                if (!whole.empty() && k % 3 == 0)
                    spool->put(tick, (next - 1) / 512.0 + (whole.size() == 1 ? 1e-3 : 0), 0.5); // its last time
                next += k % 11 == 0 ? 5 : 1;                                                    // lost ones
                spool->instant_is_over();
            }
        }
        const Log log = memory.take();
        if (names_a_ulog(grown.path()))
            write_ulog(log, at_once.path());
        else
            write_csv(log, at_once.path());
        disk.write({});
        EXPECT_TRUE(at_once.text() == grown.text()) << name;
        EXPECT_EQ(log.find("d.adc_count"), nullptr) << "absent is 0";
        EXPECT_NE(log.find("e.adc_count"), nullptr);
    }
}

TEST(Spool, refuses_a_clock_that_goes_back) {
    const test::File kept("spool_refused.csv", "as it was");
    const std::vector<std::int32_t> whole{1, 2, 3, 4, 5};
    for (const auto &[first, rate_Hz] : std::vector<std::pair<std::uint32_t, double>>{
             {104, 512}, {1, 512}, {200, 0}, {200, -512}, {200, std::numeric_limits<double>::quiet_NaN()}, {0xfffffffeu, 512}}) {
        Spool spool(kept.path());
        const std::size_t column = spool.add("radar.adc_count", false, 0, Unit::count);
        spool.put_by_clock(column, 100, 512, whole);
        spool.put_by_clock(column, first, rate_Hz, whole); // the last: its numbers begin anew, and so do its times
        try {
            spool.write({});
            ADD_FAILURE() << first << ' ' << rate_Hz;
        } catch (const LogError &error) {
            const std::string sample = first == 0xfffffffeu ? "sample 7;" : "sample 5;";
            EXPECT_NE(std::string(error.what()).find(sample), std::string::npos) << error.what();
        }
        std::remove((kept.path() + ".part").c_str());
        EXPECT_EQ(kept.text(), "as it was");
    }
}

// Up to 256 columns a row names each with a byte, beyond with two.
TEST(Spool, many_columns_are_written_as_at_once) {
    for (const std::size_t count : {std::size_t{256}, std::size_t{257}, std::size_t{600}}) {
        const test::File at_once("spool_at_once.csv", ""), grown("spool_grown.csv", "");
        Spool memory, disk(grown.path());
        for (Spool *spool : {&memory, &disk}) {
            std::vector<std::size_t> columns;
            for (std::size_t i = 0; i < count; ++i) columns.push_back(spool->add("a" + std::to_string(i) + ".x_m"));
            for (int k = 0; k < 400; ++k)
                for (std::size_t i = 0; i < count; ++i) {
                    const int number = k * (static_cast<int>(i % 7) + 1);
                    if (i % 3 == 0)
                        spool->put(columns[i], k * 0.01, 1.0 / (number + 1));
                    else
                        spool->put_whole(columns[i], k * 0.01, number);
                }
        }
        write_csv(memory.take(), at_once.path());
        disk.write({});
        EXPECT_TRUE(at_once.text() == grown.text()) << count;
    }
}

TEST(Spool, refuses_columns_that_come_together_twice) {
    const test::File kept("spool_refused.csv", "as it was");
    for (const double second_s : {1.0, 0.5, std::numeric_limits<double>::quiet_NaN()}) {
        Spool spool(kept.path());
        const std::size_t both = spool.bind({spool.add("a.x_m"), spool.add("b.x_m")});
        const std::int32_t whole[2] = {1, 2};
        spool.put_together(both, 1, whole, {}, {});
        spool.put_together(both, second_s, whole, {}, {});
        EXPECT_THROW(spool.write({}), LogError) << second_s;
    }
    Spool spool(kept.path());
    const std::size_t one = spool.bind({spool.add("a.x_m")});
    const std::int32_t whole[1] = {0};
    const Other other[1] = {{0, std::numeric_limits<double>::infinity()}};
    spool.put_together(one, 1, whole, {}, other);
    EXPECT_THROW(spool.write({}), LogError);
    EXPECT_EQ(kept.text(), "as it was");
}

// Numbers take ways of their own to their digits: counts, millionths, billionths. All end where the library's shortest text does.
TEST(Spool, numbers_are_written_as_the_library_writes_them) {
    const auto expect_same = [](double value) {
        char ours[number_room], theirs[64];
        const std::string a(ours, put_number(ours, value)), b(theirs, std::to_chars(theirs, theirs + sizeof theirs, value).ptr);
        ASSERT_EQ(a, b);
    };
    const auto expect_around = [&](double value) {
        for (const double size : {std::nextafter(value, 0.0), value, std::nextafter(value, 1e300)}) expect_same(size), expect_same(-size);
    };
    for (int n = 0; n < 130000; ++n) expect_around(n);
    for (double power = 1e-12; power < 1e18; power *= 10)
        for (const double by : {1.0, 1.5, 9.0, 9.99, 9.999999, 1.000001, 1.000000001}) expect_around(power * by);
    for (int n = 1; n < 60000; ++n) expect_around(n / 512.0), expect_around(n / 640.0), expect_around(n / 100.0), expect_around(n / 1e9);
    std::mt19937_64 random(20261125);
    for (int i = 0; i < 300000; ++i) {
        const auto bits = random();
        expect_same(static_cast<double>(bits % 2000000000) / 1e6);
        expect_same(static_cast<double>(bits % 1000000000000000) / 1e9);
        expect_same(static_cast<double>(bits % 1000000) / 1e9);
        expect_same(static_cast<double>(static_cast<std::int32_t>(bits)));
        if (const auto any = std::bit_cast<double>(bits); std::isfinite(any)) expect_same(any);
    }
}

TEST(Spool, a_column_of_millionths_and_other_numbers_is_written_as_at_once) {
    for (const char *name : {"spool_grown.csv", "spool_grown.ulg"}) {
        const test::File at_once(std::string("spool_at_once") + (name + 11), ""), grown(name, "");
        Spool memory, disk(grown.path());
        for (Spool *spool : {&memory, &disk}) {
            const std::size_t mixed = spool->add("a.x_m"), zero = spool->add("b.x_m", true), held = spool->add("c.x_m");
            for (int k = 0; k < 20000; ++k) {
                const double t_s = k * 0.01;
                if (k % 7 == 3)
                    spool->put(mixed, t_s, 0.1 * k);
                else if (k % 7 == 4)
                    spool->put(mixed, t_s, (k - 1) / 1e6); // what the last millionths were, as a number
                else
                    spool->put_whole(mixed, t_s, k / 3 * 3);
                spool->put_whole(zero, t_s, 0);
                if (k % 3 == 0) spool->put_whole(held, t_s, k < 9000 ? 0 : -5);
            }
        }
        Log log = memory.take();
        log.header = {{"seed", "7"}};
        if (names_a_ulog(grown.path()))
            write_ulog(log, at_once.path());
        else
            write_csv(log, at_once.path());
        disk.write(log.header);
        EXPECT_EQ(at_once.text(), grown.text()) << name;
    }
}

// What is in full chunks waits on the disk, in the middle of a run.
TEST(Spool, a_run_of_many_chunks_is_written_as_at_once) {
    const test::File at_once("spool_at_once.csv", ""), grown("spool_grown.csv", "");
    Spool memory, disk(grown.path());
    constexpr int samples = 20 * RowSpool::chunk_bytes / 26; // a row of one number: 16 bytes and 10
    for (Spool *spool : {&memory, &disk}) {
        const std::size_t column = spool->add("a.x_m");
        for (int k = 0; k < samples; ++k) spool->put(column, k * 0.25, 1.0 / (k + 1));
    }
    write_csv(memory.take(), at_once.path());
    disk.write({});
    EXPECT_TRUE(at_once.text() == grown.text());
}

} // namespace
} // namespace traction::log
