#include "candump.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace traction::board {

namespace {

struct Frame {
    std::int64_t time_us = 0; // whole microseconds: seconds since 1970 as a double would lose some
    std::uint32_t id = 0;
    std::string data;
    bool carries = true; // no remote or error frame
};

std::string_view word_of(std::string_view &line) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

template <typename Number> bool whole(std::string_view text, Number &value, int base) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    return !text.empty() && error == std::errc() && end == text.data() + text.size();
}

bool add_bytes(std::string_view hex, std::string &data) {
    for (std::size_t i = 0; i < hex.size(); i += 2) {
        std::uint8_t byte = 0;
        if (i + 2 > hex.size() || !whole(hex.substr(i, 2), byte, 16)) return false;
        data += static_cast<char>(byte);
    }
    return data.size() <= 64;
}

bool take_time(std::string_view word, std::int64_t &time_us) {
    if (word.size() < 3 || word.front() != '(' || word.back() != ')') return false;
    word = word.substr(1, word.size() - 2);
    const std::size_t point = word.find('.');
    std::int64_t seconds = 0, part = 0;
    if (point == std::string_view::npos || !whole(word.substr(0, point), seconds, 10) || seconds < 0 || seconds > 100'000'000'000)
        return false;
    std::string places(word.substr(point + 1));
    places.resize(6, '0');
    if (!whole(std::string_view(places), part, 10) || part < 0) return false;
    time_us = seconds * 1'000'000 + part;
    return true;
}

bool take_id(std::string_view word, std::uint32_t &id, bool &carries) {
    if (word.empty() || word.size() > 8 || !whole(word, id, 16)) return false;
    carries = (id & 0x20000000u) == 0; // CAN_ERR_FLAG as candump prints it
    if (word.size() > 3) id = (id & 0x1fffffffu) | dbc_extended;
    return true;
}

std::optional<Frame> frame_of(std::string_view line) {
    Frame frame;
    if (!take_time(word_of(line), frame.time_us) || word_of(line).empty()) return {};
    const std::string_view word = word_of(line);
    if (const std::size_t mark = word.find('#'); mark != std::string_view::npos) {
        if (!take_id(word.substr(0, mark), frame.id, frame.carries)) return {};
        std::string_view rest = word.substr(mark + 1);
        if (rest.starts_with('R')) {
            frame.carries = false;
            return frame;
        }
        if (rest.starts_with('#')) { // CAN FD: a digit of flags, then the bytes
            if (rest.size() < 2) return {};
            rest.remove_prefix(2);
        } else if (const std::size_t dlc = rest.find('_'); dlc != std::string_view::npos) {
            rest = rest.substr(0, dlc); // the raw length code of a frame of 8 bytes
        }
        if (!add_bytes(rest, frame.data)) return {};
        return frame;
    }
    std::string_view length = word_of(line);
    std::size_t bytes = 0;
    if (!take_id(word, frame.id, frame.carries) || length.size() < 3 || length.front() != '[' || length.back() != ']' ||
        !whole(length.substr(1, length.size() - 2), bytes, 10) || bytes > 64)
        return {};
    while (frame.data.size() < bytes) {
        const std::string_view byte = word_of(line);
        if (byte == "remote" || byte == "ERRORFRAME") {
            frame.carries = false;
            return frame;
        }
        if (byte.size() != 2 || !add_bytes(byte, frame.data)) return {};
    }
    return frame;
}

class CandumpReader {
  public:
    CandumpReader(const std::string &path, const std::string &dbc_path) : path_(path), dbc_(read_dbc(dbc_path)) {}

    log::Log read() {
        std::ifstream file(path_);
        if (!file.is_open()) throw log::FileError(path_, 0, 0, "cannot be read", "give a file that is there");
        std::size_t line_number = 0;
        for (std::string line; std::getline(file, line);) {
            ++line_number;
            while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
            if (line.empty()) continue;
            const std::optional<Frame> frame = frame_of(line);
            if (frame) {
                take(*frame);
            } else if (wrong_++ == 0) {
                first_wrong_ = line_number;
            }
        }
        return finish();
    }

  private:
    void take(const Frame &frame) {
        first_us_ = frames_++ == 0 ? frame.time_us : std::min(first_us_, frame.time_us);
        if (!frame.carries) return;
        const auto found = dbc_.find(frame.id);
        if (found == dbc_.end()) {
            ++unknown_[frame.id];
            return;
        }
        const DbcMessage &message = found->second;
        std::optional<std::uint64_t> chosen;
        for (const DbcSignal &signal : message.signals)
            if (signal.multiplexor && dbc_fits(signal, frame.data)) chosen = dbc_raw(signal, frame.data);
        bool cut = false;
        for (const DbcSignal &signal : message.signals) {
            if (signal.multiplex >= 0 && chosen != static_cast<std::uint64_t>(signal.multiplex)) continue;
            if (!dbc_fits(signal, frame.data)) {
                cut = true;
                continue;
            }
            const double value = dbc_value(signal, frame.data);
            if (std::isfinite(value))
                samples_[message.name + "." + signal.name].emplace_back(frame.time_us, value);
            else
                ++infinite_;
        }
        if (cut) ++short_[message.name];
    }

    void told(std::size_t count, const std::string &what) {
        if (count > 0) log_.repairs.push_back(path_ + ": " + std::to_string(count) + " " + what);
    }

    log::Log finish() {
        log_.source = path_;
        told(wrong_, "lines are no frame of candump with its time, the first is line " + std::to_string(first_wrong_) + "; left out");
        for (const auto &[id, count] : unknown_) {
            std::array<char, 16> text{};
            std::snprintf(text.data(), text.size(), "%X", static_cast<unsigned>(id & ~dbc_extended));
            told(count, std::string("frames of id ") + text.data() + ", which the DBC does not know; left out");
        }
        for (const auto &[name, count] : short_)
            told(count, "frames " + name + " are shorter than the DBC says; what they lack is left out");
        told(infinite_, "numbers are not finite; left out");
        std::size_t again = 0;
        for (const auto &[id, message] : dbc_)
            for (const DbcSignal &signal : message.signals) {
                const auto found = samples_.find(message.name + "." + signal.name);
                if (found == samples_.end()) continue;
                auto &samples = found->second;
                std::stable_sort(samples.begin(), samples.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
                log::Signal made{.name = found->first, .t_s = {}, .value = {}};
                std::int64_t last_us = -1;
                for (const auto &[time_us, value] : samples) {
                    again += time_us == last_us ? 1 : 0;
                    if (time_us == last_us) continue;
                    last_us = time_us;
                    made.t_s.push_back(static_cast<double>(time_us - first_us_) * 1e-6);
                    made.value.push_back(value);
                }
                log_.signals.push_back(std::move(made));
            }
        told(again, "samples at a time that their signal has already; the first is kept");
        if (log_.signals.empty())
            throw log::LogError(path_, 0, 0, "holds no frame that the DBC knows (" + std::to_string(frames_) + " frames)",
                                "give the log of candump -L, and the DBC of that bus");
        if (first_us_ > 1'000'000'000ll * 1'000'000) { // since 1970, no clock that began with the run
            std::array<char, 40> when{};
            const std::time_t seconds = static_cast<std::time_t>(first_us_ / 1'000'000);
            std::tm utc{};
            if (gmtime_r(&seconds, &utc) != nullptr && std::strftime(when.data(), when.size(), "%Y-%m-%dT%H:%M:%SZ", &utc) > 0)
                log_.header["date"] = when.data();
        }
        return std::move(log_);
    }

    std::string path_;
    Dbc dbc_;
    log::Log log_;
    std::map<std::string, std::vector<std::pair<std::int64_t, double>>> samples_;
    std::map<std::uint32_t, std::size_t> unknown_;
    std::map<std::string, std::size_t> short_;
    std::size_t wrong_ = 0, first_wrong_ = 0, infinite_ = 0, frames_ = 0;
    std::int64_t first_us_ = 0;
};

} // namespace

bool is_candump(const std::string &path) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line) && line.size() < 1000;)
        if (line.find_first_not_of(" \t\r") != std::string::npos) return frame_of(line).has_value();
    return false;
}

log::Log read_candump(const std::string &path, const std::string &dbc_path) { return CandumpReader(path, dbc_path).read(); }

} // namespace traction::board
