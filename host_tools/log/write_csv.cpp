#include "csv_text.h"
#include "log.h"
#include "write_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <set>

namespace traction::log {

namespace {

// 00 to 99.
constexpr auto pairs = [] {
    std::array<char, 200> out{};
    for (std::size_t i = 0; i < 100; ++i) out[2 * i] = static_cast<char>('0' + i / 10), out[2 * i + 1] = static_cast<char>('0' + i % 10);
    return out;
}();

// 000 to 999, and how many digits there are up to the last that is not 0: no loop that ends here or there.
struct Three {
    std::array<char, 3> text;
    char until;
};
constexpr auto threes = [] {
    std::array<Three, 1000> out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        const auto digit = [](std::size_t d) { return static_cast<char>('0' + d); };
        out[i] = {{digit(i / 100), digit(i / 10 % 10), digit(i % 10)},
                  static_cast<char>(i % 10 != 0    ? 3
                                    : i % 100 != 0 ? 2
                                    : i != 0       ? 1
                                                   : 0)};
    }
    return out;
}();

char *put_pair(char *to, std::uint64_t number) {
    std::memcpy(to, &pairs[2 * number], 2);
    return to + 2;
}

// Below 10000.
char *put_four(char *to, std::uint32_t number) {
    if (number >= 1000) return put_pair(put_pair(to, number / 100), number % 100);
    if (number >= 100) {
        *to = static_cast<char>('0' + number / 100);
        return put_pair(to + 1, number % 100);
    }
    if (number >= 10) return put_pair(to, number);
    *to = static_cast<char>('0' + number);
    return to + 1;
}

char *put_digits(char *to, std::uint32_t number) {
    if (number < 10000) return put_four(to, number);
    const std::uint32_t above = number / 10000, below = number % 10000;
    to = above < 10000 ? put_four(to, above) : put_pair(put_pair(put_four(to, above / 10000), above / 100 % 100), above % 100);
    return put_pair(put_pair(to, below / 100), below % 100);
}

// Below a thousandth, 1 to 999 millionths: as std::to_chars, the shorter of 0.000123 and 1.23e-04, the first where they are equal.
char *put_small(char *to, std::uint64_t millionths) {
    char digits[3];
    std::size_t count = 0, places = 6;
    for (; millionths % 10 == 0; millionths /= 10) --places;
    for (std::uint64_t by = millionths >= 100 ? 100 : millionths >= 10 ? 10 : 1; by > 0; by /= 10)
        digits[count++] = static_cast<char>('0' + millionths / by % 10);
    if ((count == 1 ? 5 : count + 5) < places + 2) {
        *to++ = digits[0];
        if (count > 1) *to++ = '.';
        to = std::copy(digits + 1, digits + count, to);
        std::memcpy(to, "e-0", 3);
        to[3] = static_cast<char>('0' + places - count + 1);
        return to + 4;
    }
    std::memcpy(to, "0.000000", 8);
    std::copy(digits, digits + count, to + 2 + places - count);
    return to + 2 + places;
}

// The times of a radar's samples are 512ths of a second: point and digits behind it, none where it is whole.
struct Fraction {
    std::array<char, 15> text;
    char size;
};
constexpr std::uint32_t binary_parts = 512;
constexpr auto fractions = [] {
    std::array<Fraction, binary_parts> all{};
    for (std::uint32_t i = 1; i < binary_parts; ++i) {
        Fraction &one = all[i];
        one.text[0] = '.', one.size = 1;
        for (std::uint32_t rest = i; rest != 0; rest = rest * 10 % binary_parts)
            one.text[static_cast<std::size_t>(one.size++)] = static_cast<char>('0' + rest * 10 / binary_parts);
    }
    return all;
}();

// Null where the time is none.
char *put_binary(char *to, double size) {
    const auto parts = static_cast<std::uint32_t>(size * binary_parts);
    if (static_cast<double>(parts) != size * binary_parts) return nullptr;
    const Fraction &fraction = fractions[parts % binary_parts];
    to = put_digits(to, parts / binary_parts);
    std::memcpy(to, fraction.text.data(), fraction.text.size());
    return to + fraction.size;
}

// Nearly every value is a count or a whole number of millionths (recorder.h), and a time of the radar's of billionths: its digits are those
// of a whole number. No two decimals of 15 digits are the same double, so no shorter text reads back to it: the text is that of
// std::to_chars. Where that would write an exponent, or in doubt, it does the work (null).
char *put_decimals(char *to, double value) {
    const double size = std::fabs(value);
    if (size < 1e5) {
        const auto count = static_cast<std::uint32_t>(size);
        if (static_cast<double>(count) == size) {
            if (std::signbit(value)) {
                if (count == 0) return nullptr; // -0
                *to++ = '-';
            }
            return put_digits(to, count);
        }
    }
    if (size >= 1 && size < 1e5) { // 15 digits at most: the text is the shortest
        if (char *end = put_binary(value < 0 ? to + 1 : to, size)) {
            if (value < 0) *to = '-';
            return end;
        }
    }
    if (!(size >= 1e-6 && size < 1e9)) return nullptr;
    std::uint32_t above = 0, below = 0; // billionths
    if (size >= 1e-3 && size < 1e6) {
        const auto finer = static_cast<std::uint64_t>(size * 1e9 + 0.5); // whole millionths among them: the same quotient, rounded once
        if (static_cast<double>(finer) / 1e9 != size) return nullptr;
        above = static_cast<std::uint32_t>(finer / 1000000000), below = static_cast<std::uint32_t>(finer % 1000000000);
    } else {
        const auto whole = static_cast<std::uint64_t>(size * 1e6 + 0.5);
        if (static_cast<double>(whole) / 1e6 != size) return nullptr;
        if (whole < 1000) {
            if (value < 0) *to++ = '-';
            return put_small(to, whole);
        }
        above = static_cast<std::uint32_t>(whole / 1000000), below = static_cast<std::uint32_t>(whole % 1000000) * 1000;
    }
    if (below == 0 && above >= 100000 && above % 10 == 0) return nullptr; // 1e+05 is shorter
    if (value < 0) *to++ = '-';
    to = put_digits(to, above);
    if (below == 0) return to;
    *to++ = '.';
    const std::uint32_t first = below / 100000, last = below % 100000; // four digits, and five
    to = put_pair(put_pair(put_pair(put_pair(to, first / 100), first % 100), last / 1000), last / 10 % 100);
    *to++ = static_cast<char>('0' + last % 10);
    while (to[-1] == '0') --to;
    return to;
}

// Quotes where the text would not survive without.
std::string name_cell(const std::string &name) {
    if (name.find_first_of(",\";\t#") == std::string::npos && name.front() != ' ' && name.back() != ' ') return name;
    std::string out(1, '"');
    for (const char c : name) {
        out += c;
        if (c == '"') out += c;
    }
    out += '"';
    return out;
}

void require(bool good, const std::string &path, const std::string &what, const std::string &mend) {
    if (!good) throw LogError(path, 0, 0, what, mend);
}

bool one_clean_line(const std::string &text) {
    const bool padded = !text.empty() && (std::strchr(" \t", text.front()) != nullptr || std::strchr(" \t", text.back()) != nullptr);
    return !padded && text.find_first_of("\r\n") == std::string::npos && text.find('\0') == std::string::npos;
}

// Walks through the merged times. Signals that share their times share one clock, and most do.
class Clocks {
  public:
    static constexpr std::size_t silent = static_cast<std::size_t>(-1);
    explicit Clocks(const Log &log) {
        for (const Signal &signal : log.signals) {
            std::size_t i = 0;
            while (i < clocks_.size() && *clocks_[i].t_s != signal.t_s) ++i;
            if (i == clocks_.size()) clocks_.push_back({&signal.t_s, 0, silent});
            clock_of_.push_back(i);
        }
    }
    double next() { // the next time in the log, or never
        double t_s = never;
        for (const Clock &clock : clocks_)
            if (clock.next < clock.t_s->size()) t_s = std::min(t_s, (*clock.t_s)[clock.next]);
        for (Clock &clock : clocks_) {
            const bool due = clock.next < clock.t_s->size() && (*clock.t_s)[clock.next] == t_s;
            clock.now = due ? clock.next++ : silent;
        }
        return t_s;
    }
    std::size_t sample(std::size_t signal) const { return clocks_[clock_of_[signal]].now; } // silent: none at this time

  private:
    struct Clock {
        const std::vector<double> *t_s;
        std::size_t next, now;
    };
    std::vector<Clock> clocks_;
    std::vector<std::size_t> clock_of_;
};

} // namespace

char *put_number(char *to, double value) {
    if (char *end = put_decimals(to, value)) return end;
    return std::to_chars(to, to + number_room, value).ptr;
}

double value_of(Unit unit, std::int32_t whole) {
    switch (unit) {
    case Unit::millionth:
        return whole / 1e6;
    case Unit::count:
        return whole;
    case Unit::natural:
        return static_cast<std::uint32_t>(whole);
    case Unit::exact:
        break;
    }
    std::array<char, number_room> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), std::bit_cast<float>(whole)).ptr;
    double value = 0;
    std::from_chars(text.data(), end, value);
    return value;
}

namespace {

char *put_count(char *to, std::int64_t count) {
    const auto size = static_cast<std::uint32_t>(std::abs(count));
    if (size >= 100000 && size % 10 == 0) return put_number(to, static_cast<double>(count)); // 1e+05 is shorter
    if (count < 0) *to++ = '-';
    return put_digits(to, size);
}

char *put_millionths(char *to, std::int32_t millionths) {
    if (millionths == 0) {
        *to = '0';
        return to + 1;
    }
    if (millionths < 0) *to++ = '-';
    const auto whole = static_cast<std::uint32_t>(std::abs(static_cast<std::int64_t>(millionths)));
    if (whole < 1000) return put_small(to, whole);
    const std::uint32_t above = whole / 1000000, below = whole % 1000000;
    if (above < 10)
        *to++ = static_cast<char>('0' + above);
    else
        to = put_digits(to, above);
    if (below == 0) return to;
    *to++ = '.';
    const Three &first = threes[below / 1000], &last = threes[below % 1000];
    std::memcpy(to, &first, sizeof first); // a byte more than its digits, which the others write over
    std::memcpy(to + 3, &last, sizeof last);
    return to + (last.until == 0 ? first.until : 3 + last.until);
}

} // namespace

char *put_whole(char *to, Unit unit, std::int32_t whole) {
    if (unit == Unit::millionth) return put_millionths(to, whole);
    if (unit == Unit::exact) return put_number(to, value_of(unit, whole));
    return put_count(to, unit == Unit::count ? std::int64_t{whole} : std::int64_t{static_cast<std::uint32_t>(whole)});
}

void append_number(std::string &text, double value) {
    char buffer[number_room];
    text.append(buffer, put_number(buffer, value));
}

std::string csv_head(const std::map<std::string, std::string> &header, const std::vector<std::string> &names, const std::string &path) {
    std::string text = "t_s"; // the names first: what reads CSV looks for them in the first line
    std::set<std::string> seen{"t_s"};
    for (const std::string &name : names) {
        double number = 0;
        const auto parsed = std::from_chars(name.data(), name.data() + name.size(), number);
        require(!name.empty() && name.find_first_of("\r\n\t") == std::string::npos && name.find('\0') == std::string::npos &&
                    parsed.ptr != name.data() + name.size(),
                path, "signal name '" + name + "' cannot be written", "use '<object>.<quantity>_<unit>'");
        require(seen.insert(name).second, path, "signal '" + name + "' stands twice", "give every signal its own name");
        text.append(1, ',').append(name_cell(name));
    }
    text += "\n# format: traction-log 1\n";
    for (const auto &[key, value] : header) {
        require(!key.empty() && key != "format" && one_clean_line(key) && key.find(':') == std::string::npos && one_clean_line(value), path,
                "header line '" + key + ": " + value + "' cannot be written",
                "keep keys and values to one line without blanks at the ends, keys without ':', not 'format'");
        text.append("# ").append(key).append(": ").append(value).append(1, '\n');
    }
    return text;
}

void check_sample(const std::string &name, std::size_t index, double previous_s, double t_s, double value, const std::string &path) {
    // the message is put together only when it is needed: every sample comes here
    if (!(std::isfinite(t_s) && t_s > previous_s))
        require(false, path, "times of '" + name + "' do not increase at sample " + std::to_string(index), "sort them and drop duplicates");
    if (!std::isfinite(value))
        require(false, path, "'" + name + "' is not finite at sample " + std::to_string(index), "leave the sample out");
}

void write_csv(const Log &log, const std::string &path) {
    std::vector<std::string> names;
    for (const Signal &signal : log.signals) {
        names.push_back(signal.name);
        require(signal.t_s.size() == signal.value.size(), path,
                "signal '" + signal.name + "' has " + std::to_string(signal.t_s.size()) + " times and " +
                    std::to_string(signal.value.size()) + " values",
                "give every sample a time");
        double previous = -never;
        for (std::size_t i = 0; i < signal.t_s.size(); previous = signal.t_s[i++])
            check_sample(signal.name, i, previous, signal.t_s[i], signal.value[i], path);
    }
    std::string text = csv_head(log.header, names, path);
    WholeFile file(path);
    Clocks clocks(log);
    for (double t_s = clocks.next(); t_s != never; t_s = clocks.next()) {
        append_number(text, t_s);
        for (std::size_t i = 0; i < log.signals.size(); ++i) {
            text += ',';
            const std::size_t sample = clocks.sample(i);
            if (sample != Clocks::silent) append_number(text, log.signals[i].value[sample]);
        }
        text += '\n';
        if (text.size() > std::size_t{1} << 20) {
            file.write(text);
            text.clear();
        }
    }
    file.write(text);
    file.keep();
}

} // namespace traction::log
