#include "write_mcap.h"

#include "csv_text.h"
#include "write_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace traction::log {

namespace {

// Opcodes of the specification.
enum Op : std::uint8_t {
    op_header = 1,
    op_footer,
    op_schema,
    op_channel,
    op_message,
    op_chunk,
    op_message_index,
    op_chunk_index,
    op_statistics = 11,
    op_metadata,
    op_metadata_index,
    op_summary_offset,
    op_data_end
};

constexpr std::string_view magic{"\x89MCAP0\r\n", 8};
constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

void put(std::string &out, std::uint64_t value, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i, value >>= 8u) out += static_cast<char>(value & 0xffu);
}
void put_text(std::string &out, std::string_view text) {
    put(out, text.size(), 4);
    out += text;
}
void put_map(std::string &out, const std::map<std::string, std::string> &map) {
    std::string pairs;
    for (const auto &[key, value] : map) {
        put_text(pairs, key);
        put_text(pairs, value);
    }
    put_text(out, pairs); // its length in bytes, then the pairs
}
std::string record(Op op, std::string_view content) {
    std::string out(1, static_cast<char>(op));
    put(out, content.size(), 8);
    out += content;
    return out;
}

// CRC-32 of IEEE 802.3, reflected, 0xedb88320.
std::uint32_t crc_of(std::string_view bytes) {
    static const auto table = [] {
        std::array<std::uint32_t, 256> made{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            std::uint32_t value = i;
            for (int bit = 0; bit < 8; ++bit) value = (value & 1u) != 0 ? value >> 1u ^ 0xedb88320u : value >> 1u;
            made[i] = value;
        }
        return made;
    }();
    std::uint32_t crc = 0xffffffffu;
    for (const char byte : bytes) crc = crc >> 8u ^ table[(crc ^ static_cast<std::uint8_t>(byte)) & 0xffu];
    return crc ^ 0xffffffffu;
}

// What ROS takes for a name: small letters, digits and single underscores, a letter first, no underscore last.
std::string ros_name(std::string_view text) {
    std::string name;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const char next = byte < 128 && std::isalnum(byte) != 0 ? static_cast<char>(std::tolower(byte)) : '_';
        if (next != '_' || (!name.empty() && name.back() != '_')) name += next;
    }
    while (!name.empty() && name.back() == '_') name.pop_back();
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0) name.insert(0, "x_");
    while (name.back() == '_') name.pop_back();
    return name;
}

std::string unlike(std::string name, std::set<std::string> &taken) {
    const std::string begin = name;
    for (int i = 2; !taken.insert(name).second; ++i) name = begin + "_" + std::to_string(i);
    return name;
}

// "wheel0_state" as a message's type, Wheel0State.
std::string type_name(const std::string &topic) {
    std::string name;
    bool large = true;
    for (const char c : topic) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) {
            large = true;
            continue;
        }
        name += large ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        large = false;
    }
    return "traction_msgs/msg/" + name;
}

struct Channel {
    std::string name, object;
    std::vector<const Signal *> signals; // of one clock
    std::size_t next = 0;                // sample
};

std::vector<Channel> topics_of(const Log &log) {
    std::vector<Channel> topics;
    std::map<std::string, int> clocks; // of an object
    for (const Signal &signal : log.signals) {
        if (signal.t_s.empty()) continue;
        const std::size_t dot = signal.name.find('.');
        const std::string object = dot == std::string::npos ? "log" : signal.name.substr(0, dot);
        auto found = std::find_if(topics.begin(), topics.end(),
                                  [&](const Channel &t) { return t.object == object && t.signals.front()->t_s == signal.t_s; });
        if (found == topics.end()) {
            found = topics.insert(topics.end(), Channel{.name = {}, .object = object, .signals = {}, .next = 0});
            ++clocks[object];
        }
        found->signals.push_back(&signal);
    }
    std::set<std::string> taken;
    for (Channel &topic : topics) {
        const std::string &first = topic.signals.front()->name;
        topic.name = "/" + ros_name(topic.object);
        if (clocks[topic.object] > 1) topic.name += "/" + ros_name(first.substr(first.find('.') + 1));
        topic.name = unlike(topic.name, taken);
    }
    return topics;
}

std::string schema_text(const Channel &topic) {
    std::string text;
    std::set<std::string> taken;
    for (const Signal *signal : topic.signals) {
        const std::size_t dot = signal->name.find('.');
        std::string was = signal->name;
        std::replace_if(
            was.begin(), was.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
        text += "float64 " + unlike(ros_name(dot == std::string::npos ? was : was.substr(dot + 1)), taken) + " # " + was + "\n";
    }
    return text;
}

struct Chunk {
    std::string records;
    std::map<std::uint16_t, std::string> index; // of a channel: pairs of time and offset
    std::uint64_t first_ns = 0, last_ns = 0;
};

class Writer {
  public:
    explicit Writer(const std::string &path) : file_(path) {}

    void put_bytes(std::string_view bytes) {
        file_.write(bytes);
        at_ += bytes.size();
    }

    void message(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns, std::string_view data) {
        if (chunk_.records.empty()) chunk_.first_ns = time_ns;
        chunk_.last_ns = time_ns;
        put(chunk_.index[channel], time_ns, 8);
        put(chunk_.index[channel], chunk_.records.size(), 8);
        std::string content;
        put(content, channel, 2);
        put(content, sequence, 4);
        put(content, time_ns, 8);
        put(content, time_ns, 8);
        content += data;
        chunk_.records += record(op_message, content);
        first_ns_ = messages_ == 0 ? time_ns : first_ns_;
        last_ns_ = time_ns;
        ++messages_;
        ++counts_[channel];
        if (chunk_.records.size() >= chunk_bytes) end_chunk();
    }

    // Chunk, its message indexes, and the chunk's line in the summary.
    void end_chunk() {
        if (chunk_.records.empty()) return;
        std::string content;
        put(content, chunk_.first_ns, 8);
        put(content, chunk_.last_ns, 8);
        put(content, chunk_.records.size(), 8);
        put(content, crc_of(chunk_.records), 4);
        put_text(content, ""); // no compression
        put(content, chunk_.records.size(), 8);
        content += chunk_.records;
        const std::uint64_t begin = at_;
        put_bytes(record(op_chunk, content));
        const std::uint64_t end = at_;
        std::string offsets;
        for (const auto &[channel, pairs] : chunk_.index) {
            put(offsets, channel, 2);
            put(offsets, at_, 8);
            std::string index;
            put(index, channel, 2);
            put_text(index, pairs);
            put_bytes(record(op_message_index, index));
        }
        std::string line;
        put(line, chunk_.first_ns, 8);
        put(line, chunk_.last_ns, 8);
        put(line, begin, 8);
        put(line, end - begin, 8);
        put_text(line, offsets);
        put(line, at_ - end, 8);
        put_text(line, "");
        put(line, chunk_.records.size(), 8);
        put(line, chunk_.records.size(), 8);
        chunk_index_ += record(op_chunk_index, line);
        ++chunks_;
        chunk_ = {};
    }

    void metadata(const std::string &name, const std::map<std::string, std::string> &map) {
        std::string content;
        put_text(content, name);
        put_map(content, map);
        const std::string bytes = record(op_metadata, content);
        std::string line;
        put(line, at_, 8);
        put(line, bytes.size(), 8);
        put_text(line, name);
        metadata_index_ += record(op_metadata_index, line);
        put_bytes(bytes);
    }

    void finish(const std::string &schemas, const std::string &channels, std::size_t topics) {
        end_chunk();
        std::string content;
        put(content, 0, 4); // no CRC over the data: each chunk has one
        put_bytes(record(op_data_end, content));
        const std::uint64_t start = at_;
        std::string counts, statistics;
        for (const auto &[channel, count] : counts_) {
            put(counts, channel, 2);
            put(counts, count, 8);
        }
        put(statistics, messages_, 8);
        put(statistics, topics, 2);
        put(statistics, topics, 4);
        put(statistics, 0, 4);
        put(statistics, 1, 4);
        put(statistics, chunks_, 4);
        put(statistics, first_ns_, 8);
        put(statistics, last_ns_, 8);
        put_text(statistics, counts);
        const std::vector<std::pair<Op, std::string>> groups{{op_schema, schemas},
                                                             {op_channel, channels},
                                                             {op_statistics, record(op_statistics, statistics)},
                                                             {op_chunk_index, chunk_index_},
                                                             {op_metadata_index, metadata_index_}};
        std::string summary, offsets;
        for (const auto &[op, bytes] : groups) {
            if (bytes.empty()) continue;
            std::string line;
            put(line, op, 1);
            put(line, start + summary.size(), 8);
            put(line, bytes.size(), 8);
            offsets += record(op_summary_offset, line);
            summary += bytes;
        }
        const std::uint64_t offset_start = start + summary.size();
        summary += offsets;
        std::string footer;
        put(footer, start, 8);
        put(footer, offset_start, 8);
        std::string head(1, static_cast<char>(op_footer)); // the CRC reaches to the footer's own field
        put(head, footer.size() + 4, 8);
        put(footer, crc_of(summary + head + footer), 4);
        put_bytes(summary);
        put_bytes(record(op_footer, footer));
        put_bytes(magic);
        file_.keep();
    }

  private:
    WholeFile file_;
    std::uint64_t at_ = 0, messages_ = 0, first_ns_ = 0, last_ns_ = 0;
    std::uint32_t chunks_ = 0;
    Chunk chunk_;
    std::string chunk_index_, metadata_index_;
    std::map<std::uint16_t, std::uint64_t> counts_;
};

} // namespace

void write_mcap(const Log &log, const std::string &path) {
    std::vector<Channel> topics = topics_of(log);
    if (topics.size() > std::numeric_limits<std::uint16_t>::max())
        throw LogError(path, 0, 0, "more than 65535 topics cannot be written", "leave objects out");
    double begin_s = 0;
    for (const Channel &topic : topics) {
        for (const Signal *signal : topic.signals)
            for (std::size_t i = 0; i < signal->t_s.size(); ++i)
                check_sample(signal->name, i, i == 0 ? -std::numeric_limits<double>::infinity() : signal->t_s[i - 1], signal->t_s[i],
                             signal->value[i], path);
        begin_s = std::min(begin_s, topic.signals.front()->t_s.front());
        if (topic.signals.front()->t_s.back() - begin_s > 1.8e10) // 2^64 ns
            throw LogError(path, 0, 0, "times beyond 570 years cannot be written", "give seconds");
    }
    std::string schemas, channels, content;
    std::set<std::string> types; // /a/b and /a_b would be one
    for (std::size_t i = 0; i < topics.size(); ++i) {
        std::string schema, channel;
        put(schema, i + 1, 2);
        put_text(schema, unlike(type_name(topics[i].name), types));
        put_text(schema, "ros2msg");
        put_text(schema, schema_text(topics[i]));
        schemas += record(op_schema, schema);
        put(channel, i + 1, 2);
        put(channel, i + 1, 2);
        put_text(channel, topics[i].name);
        put_text(channel, "cdr");
        put_map(channel, {});
        channels += record(op_channel, channel);
    }
    Writer writer(path);
    put_text(content, "ros2");
    put_text(content, "traction");
    writer.put_bytes(std::string(magic) + record(op_header, content));
    std::map<std::string, std::string> header = log.header;
    if (begin_s < 0) header["moved_s"] = std::to_string(-begin_s);
    writer.metadata("traction-log", header);
    writer.put_bytes(schemas + channels);
    const auto next_s = [](const Channel &topic) {
        const std::vector<double> &t_s = topic.signals.front()->t_s;
        return topic.next < t_s.size() ? t_s[topic.next] : std::numeric_limits<double>::infinity();
    };
    for (;;) {
        const auto due =
            std::min_element(topics.begin(), topics.end(), [&](const Channel &a, const Channel &b) { return next_s(a) < next_s(b); });
        if (due == topics.end() || std::isinf(next_s(*due))) break;
        std::string data{0, 1, 0, 0}; // CDR, little endian
        for (const Signal *signal : due->signals) put(data, std::bit_cast<std::uint64_t>(signal->value[due->next]), 8);
        const auto channel = static_cast<std::uint16_t>(due - topics.begin() + 1);
        writer.message(channel, static_cast<std::uint32_t>(due->next),
                       static_cast<std::uint64_t>(std::llround((next_s(*due) - begin_s) * 1e9)), data);
        ++due->next;
    }
    writer.finish(schemas, channels, topics.size());
}

} // namespace traction::log
