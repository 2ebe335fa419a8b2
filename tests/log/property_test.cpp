// What holds for any log: written and read is the same; however the file is damaged, reading ends in a log or a message.
#include "files.h"

#include "host_tools/log/read.h"
#include "host_tools/log/ulog.h"

#include <cstdint>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

using namespace traction::log;
using traction::test::File;

namespace {

// Doubles of all sizes, denormals and -0 included.
rc::Gen<double> any_double() {
    return rc::gen::map(rc::gen::pair(rc::gen::arbitrary<std::uint64_t>(), rc::gen::inRange(0, 3)),
                        [](const std::pair<std::uint64_t, int> &raw) {
                            double value = 0;
                            std::memcpy(&value, &raw.first, sizeof value);
                            if (raw.second == 0 || !std::isfinite(value))
                                value = static_cast<double>(static_cast<std::int64_t>(raw.first % 2000001) - 1000000) / 1000.0;
                            return value;
                        });
}

Log any_log() {
    const char *const names[] = {"wheel0.speed_rad_s", "camera.x_m", "arm.joint, left", "say \"hi\"", "a;b", "imu.gyro_z_rad_s",
                                 " padded ",           "x#1"};
    Log log;
    const int count = *rc::gen::inRange(0, 8);
    for (int k = 0; k < count; ++k) {
        Signal signal{names[k], {}, {}};
        std::set<double> times;
        for (const double t : *rc::gen::container<std::vector<double>>(any_double())) times.insert(t);
        signal.t_s.assign(times.begin(), times.end());
        for (std::size_t i = 0; i < signal.t_s.size(); ++i) signal.value.push_back(*any_double());
        log.signals.push_back(std::move(signal));
    }
    const auto word = rc::gen::container<std::string>(rc::gen::element('a', 'Z', '0', '.', '_', '-', ','));
    for (int k = *rc::gen::inRange(0, 4); k > 0; --k) {
        std::string key(1, 'k');
        key.append(*word);
        log.header[key] = *word;
        if (*rc::gen::arbitrary<bool>()) log.header[key].append("x: y = z");
    }
    return log;
}

void expect_sound(const Log &log) {
    for (const Signal &signal : log.signals) {
        RC_ASSERT(signal.t_s.size() == signal.value.size());
        for (std::size_t i = 0; i < signal.t_s.size(); ++i) {
            // in parentheses: RC_ASSERT takes its expression apart, and then || no longer stops at its first true side
            RC_ASSERT((std::isfinite(signal.t_s[i]) && std::isfinite(signal.value[i])));
            RC_ASSERT((i == 0 || signal.t_s[i] > signal.t_s[i - 1]));
        }
    }
}

const char *const map_text =
    "format = \"traction-map 1\"\nskip_rows = 0\n[time]\ncolumn = \"t_s\"\nscale = 1.0\n[header]\na = \"b\"\n[[signal]]\nname = "
    "\"wheel0.speed_rad_s\"\n"
    "column = \"wheel0.speed_rad_s\"\nscale = 2.0\nunwrap = true\ndifferentiate = true\n[[where]]\ncolumn = \"t_s\"\nmin = 0\n";

std::string damaged(std::string text) {
    for (int k = *rc::gen::inRange(1, 6); k > 0 && !text.empty(); --k) {
        const std::size_t at = *rc::gen::inRange<std::size_t>(0, text.size());
        switch (*rc::gen::inRange(0, 6)) {
        case 0:
            text[at] = static_cast<char>(*rc::gen::inRange(0, 256));
            break;
        case 1:
            text.erase(at, *rc::gen::inRange<std::size_t>(1, 20));
            break;
        case 2:
            text.insert(at, text.substr(*rc::gen::inRange<std::size_t>(0, text.size()), 30));
            break;
        case 3:
            text.insert(
                at, *rc::gen::element<std::string>("\"", ",", ";", "\n", "\r\n", "nan", "-", "1e999", "#", "\t", "=", "[", "-1e308", "0"));
            break;
        case 4:
            text.resize(at);
            break;
        default:
            std::swap(text[at], text[*rc::gen::inRange<std::size_t>(0, text.size())]);
            break;
        }
    }
    return text;
}

} // namespace

RC_GTEST_PROP(AnyLog, written_and_read_is_the_same, ()) {
    const Log log = any_log();
    RC_PRE(std::any_of(log.signals.begin(), log.signals.end(), [](const Signal &s) { return !s.t_s.empty(); })); // names alone are refused
    const File file("property.csv", "");
    write_csv(log, file.path());
    const Log again = read_csv(file.path());
    RC_ASSERT(again.header == log.header);
    RC_ASSERT(again.signals.size() == log.signals.size());
    for (std::size_t k = 0; k < log.signals.size(); ++k) {
        RC_ASSERT(again.signals[k].name == log.signals[k].name);
        RC_ASSERT(again.signals[k].t_s == log.signals[k].t_s);
        RC_ASSERT(again.signals[k].value == log.signals[k].value);
    }
    const std::string first = file.text();
    write_csv(again, file.path());
    RC_ASSERT(file.text() == first); // bytes too, -0 included
}

RC_GTEST_PROP(AnyLog, written_as_ulog_and_read_is_the_same, ()) {
    const Log log = any_log();
    const File file("property.ulg", "");
    write_ulog(log, file.path());
    const Log again = read_csv(file.path());
    RC_ASSERT(again.header == log.header);
    RC_ASSERT(again.signals.size() == log.signals.size());
    for (std::size_t k = 0; k < log.signals.size(); ++k) {
        RC_ASSERT(again.signals[k].name == log.signals[k].name);
        RC_ASSERT(again.signals[k].t_s == log.signals[k].t_s);
        RC_ASSERT(again.signals[k].value == log.signals[k].value);
    }
    const std::string first = file.text();
    write_ulog(again, file.path());
    RC_ASSERT(file.text() == first);
}

RC_GTEST_PROP(AnyDamage, to_a_log_ends_in_a_sound_log_or_a_message, ()) {
    const File good("good.csv", "");
    write_csv(any_log(), good.path());
    const File bad("bad.csv", damaged(good.text()));
    try {
        expect_sound(read_csv(bad.path()));
    } catch (const LogError &error) {
        RC_ASSERT(std::string(error.what()).find("; to mend: ") != std::string::npos);
    }
}

RC_GTEST_PROP(AnyDamage, to_a_ulog_ends_in_a_sound_log_or_a_message, ()) {
    const File good("good.ulg", "");
    write_ulog(any_log(), good.path());
    const File bad("bad.ulg", damaged(good.text()));
    try {
        expect_sound(read_csv(bad.path()));
    } catch (const LogError &error) {
        RC_ASSERT(std::string(error.what()).find("; to mend: ") != std::string::npos);
    }
}

RC_GTEST_PROP(AnyDamage, to_a_map_or_a_mapped_log_ends_in_a_sound_log_or_a_message, ()) {
    std::string text = "t_s,wheel0.speed_rad_s\n";
    for (int i = 0; i < 20; ++i) text += std::to_string(0.1 * i) + "," + std::to_string(0.3 * i) + "\n";
    const bool map_too = *rc::gen::arbitrary<bool>();
    const File log("mapped.csv", damaged(text)), map("map.toml", map_too ? damaged(map_text) : map_text);
    try {
        expect_sound(read_csv(log.path(), map.path()));
    } catch (const LogError &error) {
        RC_ASSERT(std::string(error.what()).find("; to mend: ") != std::string::npos);
    }
}
