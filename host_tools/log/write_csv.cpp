#include "log.h"
#include "write_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>

namespace traction::log {

namespace {

// Nearly every value is a whole number of millionths (recorder.h): its digits are those of a whole number. The text is that of
// std::to_chars all the same; where that would write an exponent, or in doubt, it does the work.
bool append_millionths(std::string &text, double value) {
    const double size = std::fabs(value);
    if (size == 0 && !std::signbit(value)) {
        text += '0';
        return true;
    }
    if (!(size >= 1e-3 && size < 1e9)) return false;
    const auto whole = static_cast<std::uint64_t>(size * 1e6 + 0.5);
    if (static_cast<double>(whole) / 1e6 != size) return false;
    std::uint64_t above = whole / 1000000, below = whole % 1000000;
    if (below == 0 && above >= 100000 && above % 10 == 0) return false; // 1e+05 is shorter
    char buffer[24], *first = buffer + sizeof buffer;
    if (below != 0) {
        int places = 6;
        for (; below % 10 == 0; below /= 10) --places;
        for (; places > 0; --places, below /= 10) *--first = static_cast<char>('0' + below % 10);
        *--first = '.';
    }
    do *--first = static_cast<char>('0' + above % 10);
    while ((above /= 10) != 0);
    if (value < 0) *--first = '-';
    text.append(first, buffer + sizeof buffer);
    return true;
}

void append_number(std::string &text, double value) {
    if (append_millionths(text, value)) return;
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    text.append(buffer, end);
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

void check(const Log &log, const std::string &path) {
    for (const auto &[key, value] : log.header) {
        require(!key.empty() && key != "format" && one_clean_line(key) && key.find(':') == std::string::npos && one_clean_line(value), path,
                "header line '" + key + ": " + value + "' cannot be written",
                "keep keys and values to one line without blanks at the ends, keys without ':', not 'format'");
    }
    std::set<std::string> names{"t_s"};
    for (const Signal &signal : log.signals) {
        double number = 0;
        const auto parsed = std::from_chars(signal.name.data(), signal.name.data() + signal.name.size(), number);
        require(!signal.name.empty() && signal.name.find_first_of("\r\n\t") == std::string::npos &&
                    signal.name.find('\0') == std::string::npos && parsed.ptr != signal.name.data() + signal.name.size(),
                path, "signal name '" + signal.name + "' cannot be written", "use '<object>.<quantity>_<unit>'");
        require(names.insert(signal.name).second, path, "signal '" + signal.name + "' stands twice", "give every signal its own name");
        require(signal.t_s.size() == signal.value.size(), path,
                "signal '" + signal.name + "' has " + std::to_string(signal.t_s.size()) + " times and " +
                    std::to_string(signal.value.size()) + " values",
                "give every sample a time");
        double previous = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < signal.t_s.size(); ++i) {
            // the message is put together only when it is needed: this loop sees every sample
            if (!(std::isfinite(signal.t_s[i]) && signal.t_s[i] > previous))
                require(false, path, "times of '" + signal.name + "' do not increase at sample " + std::to_string(i),
                        "sort them and drop duplicates");
            if (!std::isfinite(signal.value[i]))
                require(false, path, "'" + signal.name + "' is not finite at sample " + std::to_string(i), "leave the sample out");
            previous = signal.t_s[i];
        }
    }
}

constexpr double never = std::numeric_limits<double>::infinity();

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

void write_csv(const Log &log, const std::string &path) {
    check(log, path);
    WholeFile file(path);
    std::string text = "# format: traction-log 1\n";
    for (const auto &[key, value] : log.header) text.append("# ").append(key).append(": ").append(value).append(1, '\n');
    text += "t_s";
    for (const Signal &signal : log.signals) text.append(1, ',').append(name_cell(signal.name));
    text += '\n';
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
