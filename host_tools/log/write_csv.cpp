#include "log.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <set>
#include <unistd.h>
#include <utility>

namespace traction::log {

namespace {

// A file that appears under its name only when it is whole.
class WholeFile {
  public:
    explicit WholeFile(const std::string &path) : path_(path), temporary_(path + ".part"), file_(std::fopen(temporary_.c_str(), "wb")) {
        if (file_ == nullptr) fail("be written");
    }
    ~WholeFile() {
        if (file_ != nullptr) std::fclose(file_);
        if (!kept_) ::unlink(temporary_.c_str());
    }
    WholeFile(const WholeFile &) = delete;
    WholeFile &operator=(const WholeFile &) = delete;

    void write(const std::string &text) {
        if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("be written");
    }
    void keep() {
        std::FILE *const file = std::exchange(file_, nullptr);
        if (std::fclose(file) != 0) fail("be written");
        if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("be put in place");
        kept_ = true;
    }

  private:
    [[noreturn]] void fail(const char *what) {
        const std::string why = std::strerror(errno);
        if (file_ != nullptr) std::fclose(std::exchange(file_, nullptr));
        ::unlink(temporary_.c_str());
        throw FileError(path_, 0, 0, std::string("cannot ") + what + ": " + why, "check that the folder exists, may be written to and has room");
    }
    std::string path_, temporary_;
    std::FILE *file_;
    bool kept_ = false;
};

void append_number(std::string &text, double value) {
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
                "header line '" + key + ": " + value + "' cannot be written", "keep keys and values to one line without blanks at the ends, keys without ':', not 'format'");
    }
    std::set<std::string> names{"t_s"};
    for (const Signal &signal : log.signals) {
        double number = 0;
        const auto parsed = std::from_chars(signal.name.data(), signal.name.data() + signal.name.size(), number);
        require(!signal.name.empty() && signal.name.find_first_of("\r\n\t") == std::string::npos && signal.name.find('\0') == std::string::npos &&
                    parsed.ptr != signal.name.data() + signal.name.size(),
                path, "signal name '" + signal.name + "' cannot be written", "use '<object>.<quantity>_<unit>'");
        require(names.insert(signal.name).second, path, "signal '" + signal.name + "' stands twice", "give every signal its own name");
        require(signal.t_s.size() == signal.value.size(), path, "signal '" + signal.name + "' has " + std::to_string(signal.t_s.size()) + " times and " + std::to_string(signal.value.size()) + " values",
                "give every sample a time");
        double previous = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < signal.t_s.size(); ++i) {
            require(std::isfinite(signal.t_s[i]) && signal.t_s[i] > previous, path, "times of '" + signal.name + "' do not increase at sample " + std::to_string(i), "sort them and drop duplicates");
            require(std::isfinite(signal.value[i]), path, "'" + signal.name + "' is not finite at sample " + std::to_string(i), "leave the sample out");
            previous = signal.t_s[i];
        }
    }
}

} // namespace

void write_csv(const Log &log, const std::string &path) {
    check(log, path);
    WholeFile file(path);
    std::string text = "# format: traction-log 1\n";
    for (const auto &[key, value] : log.header) text.append("# ").append(key).append(": ").append(value).append(1, '\n');
    text += "t_s";
    for (const Signal &signal : log.signals) text.append(1, ',').append(name_cell(signal.name));
    text += '\n';
    std::vector<std::size_t> next(log.signals.size(), 0);
    constexpr double never = std::numeric_limits<double>::infinity();
    for (;;) {
        double t_s = never;
        for (std::size_t i = 0; i < next.size(); ++i) {
            if (next[i] < log.signals[i].t_s.size()) t_s = std::min(t_s, log.signals[i].t_s[next[i]]);
        }
        if (t_s == never) break;
        append_number(text, t_s);
        for (std::size_t i = 0; i < next.size(); ++i) {
            text += ',';
            const Signal &signal = log.signals[i];
            if (next[i] < signal.t_s.size() && signal.t_s[next[i]] == t_s) append_number(text, signal.value[next[i]++]);
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
