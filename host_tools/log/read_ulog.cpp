#include "ulog.h"

#include "ulog_format.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <map>
#include <utility>

namespace traction::log {

namespace {

double number(std::string_view bytes, const std::string &type) {
    const std::uint64_t bits = little_endian(bytes);
    if (type == "double") return std::bit_cast<double>(bits);
    if (type == "float") return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    if (type[0] == 'i') { // signed: its top bit is carried up
        const unsigned above = 64 - 8 * static_cast<unsigned>(bytes.size());
        return static_cast<double>(static_cast<std::int64_t>(bits << above) >> above);
    }
    return static_cast<double>(bits);
}

struct Slot {
    UlogField field;
    std::size_t signal = 0;
};

struct ReadTopic {
    std::vector<UlogField> fields;
    std::vector<Slot> slots; // those that are signals
    std::size_t bytes = 0, stamp_at = 0, t_s_at = 0;
    bool stamped = false, has_t_s = false;
};

class Reader {
  public:
    Reader(const std::string &file, const ReadLimits &limits) : file_(file), limits_(limits) {}

    void take(char kind, std::string_view payload) {
        if (kind == 'I' || kind == 'M') information(kind == 'M' ? payload.substr(std::min<std::size_t>(1, payload.size())) : payload);
        if (kind == 'F') {
            const std::size_t colon = payload.find(':');
            const auto fields = colon != std::string_view::npos ? ulog_fields(payload.substr(colon + 1)) : std::nullopt;
            if (fields) define(std::string(payload.substr(0, colon)), *fields);
        }
        if (kind == 'A' && payload.size() > 3) ids_[little_endian(payload.substr(1, 2))] = std::string(payload.substr(3));
        if (kind == 'D' && payload.size() > 2) data(little_endian(payload.substr(0, 2)), payload.substr(2));
    }

    bool ours = false;
    std::size_t broken = 0; // messages
    std::map<std::string, std::string> header;
    std::vector<Signal> signals;

  private:
    void information(std::string_view payload) {
        const std::size_t key_bytes = payload.empty() ? 0 : static_cast<std::uint8_t>(payload[0]);
        if (payload.size() < 1 + key_bytes) return;
        const std::string_view key = payload.substr(1, key_bytes), value = payload.substr(1 + key_bytes);
        if (key.ends_with(" sys_name")) ours = value == "traction-log";
        if (key.ends_with(" traction_header")) {
            const std::size_t colon = value.find(": ");
            if (colon != std::string_view::npos) header[std::string(value.substr(0, colon))] = value.substr(colon + 2);
        }
        if (key.ends_with(" traction_signal")) {
            const std::size_t first = value.find(' '), second = first != std::string_view::npos ? value.find(' ', first + 1) : first;
            if (second == std::string_view::npos) return;
            place_[std::string(value.substr(0, second))] = signals.size();
            signals.push_back({std::string(value.substr(second + 1)), {}, {}});
        }
    }

    void define(const std::string &name, const std::vector<UlogField> &fields) {
        ReadTopic topic;
        for (const UlogField &field : fields) {
            if (field.name == "timestamp" && field.type == "uint64_t") {
                topic.stamped = true;
                topic.stamp_at = field.at;
            } else if (field.name == "t_s" && field.type == "double") {
                topic.has_t_s = true;
                topic.t_s_at = field.at;
            } else if (const auto found = place_.find(name + ' ' + field.name); found != place_.end() && field.count == 1) {
                topic.slots.push_back({field, found->second});
            }
            topic.bytes = field.at + field.size * field.count;
        }
        if (topic.stamped) topics_[name] = std::move(topic);
    }

    void data(std::uint64_t id, std::string_view payload) {
        const auto name = ids_.find(id);
        const auto found = name != ids_.end() ? topics_.find(name->second) : topics_.end();
        if (found == topics_.end() || payload.size() < found->second.bytes) {
            ++broken;
            return;
        }
        const ReadTopic &topic = found->second;
        const double t_s = topic.has_t_s ? std::bit_cast<double>(little_endian(payload.substr(topic.t_s_at, 8)))
                                         : static_cast<double>(little_endian(payload.substr(topic.stamp_at, 8))) / 1e6;
        samples_ += topic.slots.size();
        if (samples_ > limits_.samples)
            throw LogError(file_, 0, 0, "the log holds more than " + std::to_string(limits_.samples) + " samples",
                           "cut it into parts, or leave out the fastest columns");
        for (const Slot &slot : topic.slots) {
            signals[slot.signal].t_s.push_back(t_s);
            signals[slot.signal].value.push_back(number(payload.substr(slot.field.at, slot.field.size), slot.field.type));
        }
    }

    const std::string &file_;
    const ReadLimits &limits_;
    std::size_t samples_ = 0;
    std::map<std::string, ReadTopic> topics_;
    std::map<std::uint64_t, std::string> ids_;
    std::map<std::string, std::size_t> place_; // "topic field"
};

} // namespace

bool begins_as_ulog(std::string_view bytes) { return bytes.starts_with(ulog_magic); }

bool is_own_ulog(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 256> begin{}; // who wrote it stands first
    file.read(begin.data(), begin.size());
    const std::string_view bytes(begin.data(), static_cast<std::size_t>(file.gcount()));
    return begins_as_ulog(bytes) && bytes.find("sys_nametraction-log") != std::string_view::npos;
}

Log read_ulog(std::string_view bytes, const std::string &path, const ReadLimits &limits, std::vector<Repair> &repairs) {
    Reader reader(path, limits);
    const UlogStop stop = for_each_ulog_message(bytes, [&reader](char kind, std::string_view payload) { reader.take(kind, payload); });
    if (!reader.ours)
        throw LogError(path, 0, 0, "is a ULog, and not a log of ours",
                       "one that tractiond wrote on its rover is read by `traction convert FILE --out LOG.csv`");
    if (stop.how != UlogEnd::whole)
        repairs.push_back({"cut_file", "", 1, 0,
                           stop.how == UlogEnd::within_a_message
                               ? "cut within a message, at byte " + std::to_string(stop.at) + "; read up to there"
                               : "from byte " + std::to_string(stop.at) + " on there are no messages; left out"});
    if (reader.broken > 0)
        repairs.push_back({"broken_message", "", reader.broken, 0,
                           std::to_string(reader.broken) + " messages are of no topic that the file defines, or too short; left out"});
    return log_of_columns(std::move(reader.signals), reader.header, path, repairs);
}

} // namespace traction::log
