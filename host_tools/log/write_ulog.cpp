#include "ulog.h"

#include "csv_text.h"
#include "ulog_format.h"
#include "write_file.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>

namespace traction::log {

namespace {

constexpr double no_time_s = std::numeric_limits<double>::infinity();
constexpr std::size_t fields_of_a_topic = 400; // a message has at most 65535 bytes, and so has its definition
constexpr std::size_t name_letters = 100, text_letters = 60000, topics_most = 65535;

void put_field(std::string &out, std::uint64_t value, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i, value >>= 8u) out += static_cast<char>(value & 0xffu);
}

std::string message(char kind, std::string_view payload) {
    std::string out;
    put_field(out, payload.size(), 2);
    out += kind;
    out += payload;
    return out;
}

std::string information(const std::string &key, const std::string &value, const std::string &path, bool several) {
    if (value.size() > text_letters)
        throw LogError(path, 0, 0, "'" + value.substr(0, 60) + "...' is too long for a ULog",
                       "keep header lines and names below 60000 letters");
    const std::string typed = "char[" + std::to_string(value.size()) + "] " + key;
    std::string payload;
    if (several) payload += '\0'; // not the rest of the one before
    payload += static_cast<char>(typed.size());
    return message(several ? 'M' : 'I', payload + typed + value);
}

// A time beyond what a stamp holds stands in t_s alone.
std::uint64_t stamp_us(double t_s, double begin_s) {
    constexpr double most = 9e18;
    return static_cast<std::uint64_t>(std::llround(std::min((t_s - begin_s) * 1e6, most)));
}

// What a first reading of a column tells.
struct Facts {
    std::uint64_t count = 0, times = 14695981039346656037u; // FNV-1a over the bits of its times
    double first_s = 0, last_s = 0;
    bool stamps_hold = true; // whole microseconds give every time back
    std::vector<double> step_s;

    bool whole = true, single = true;
    double least = 0, most = 0;

    void time(double t_s) {
        if (count++ == 0) first_s = t_s;
        if (count > 1 && step_s.size() < 1000) step_s.push_back(t_s - last_s);
        last_s = t_s;
        times = (times ^ std::bit_cast<std::uint64_t>(t_s)) * 1099511628211u;
        times ^= times >> 29u; // the product alone carries nothing down
        stamps_hold = stamps_hold && t_s >= 0 && static_cast<double>(stamp_us(t_s, 0)) / 1e6 == t_s;
    }
    // -0 is no whole number: its sign would be lost.
    void value(double value) {
        whole = whole && value == std::trunc(value) && !(value == 0 && std::signbit(value));
        single = single && std::fabs(value) <= static_cast<double>(std::numeric_limits<float>::max()) &&
                 static_cast<double>(static_cast<float>(value)) == value;
        least = std::min(least, value);
        most = std::max(most, value);
    }
    // The smallest type that holds every value exactly.
    const char *type() const {
        const auto fits = [this](double below, double above) { return whole && least >= below && most <= above; };
        if (fits(INT8_MIN, INT8_MAX)) return "int8_t";
        if (fits(INT16_MIN, INT16_MAX)) return "int16_t";
        if (single) return "float";
        return fits(INT32_MIN, INT32_MAX) ? "int32_t" : "double";
    }
    bool same_clock(const Facts &other) const {
        return count == other.count && times == other.times && first_s == other.first_s && last_s == other.last_s;
    }
};

void put_value(std::string &out, double value, char type) {
    switch (type) {
    case '1':
        put_field(out, static_cast<std::uint8_t>(static_cast<std::int8_t>(value)), 1);
        break;
    case '2':
        put_field(out, static_cast<std::uint16_t>(static_cast<std::int16_t>(value)), 2);
        break;
    case '4':
        put_field(out, static_cast<std::uint32_t>(static_cast<std::int32_t>(value)), 4);
        break;
    case 'f':
        put_field(out, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
        break;
    default:
        put_field(out, std::bit_cast<std::uint64_t>(value), 8);
    }
}

// Letters, digits and '_', a letter first.
std::string field_name(const std::string &name, std::set<std::string> &taken) {
    std::string field;
    for (const char c : name.substr(0, name_letters)) {
        const auto byte = static_cast<unsigned char>(c);
        field += byte < 128 && std::isalnum(byte) != 0 ? c : '_';
    }
    if (std::isalpha(static_cast<unsigned char>(field[0])) == 0) field.insert(0, "x");
    const std::string begin = field;
    for (int i = 2; !taken.insert(field).second; ++i) field = begin + "_" + std::to_string(i);
    return field;
}

struct Topic {
    std::string name, definition, types; // types: a letter a field, as put_value takes them
    std::vector<UlogColumn *> columns;   // of one clock
    std::set<std::string> taken{"timestamp", "t_s"};
    Facts clock; // of its first column
    bool with_t_s = false;

    double due_s() const { return columns.front()->t_s(); }
};

// A log that is written: its columns, what is known of each, and their topics.
struct Plan {
    std::vector<Facts> facts;
    std::vector<Topic> topics;
    std::vector<std::size_t> topic_of; // of a column
    double begin_s = 0;
};
constexpr std::size_t no_topic = static_cast<std::size_t>(-1);

Facts facts_of(UlogColumn &column, const std::string &path) {
    Facts facts;
    double previous_s = -no_time_s;
    for (column.rewind(); column.t_s() != no_time_s; column.next()) {
        check_sample(column.name(), facts.count, previous_s, column.t_s(), column.value(), path);
        previous_s = column.t_s();
        facts.time(previous_s);
        facts.value(column.value());
    }
    column.rewind();
    return facts;
}

// Columns of one clock, in the order of the log; an empty one has no topic.
Plan plan_of(const std::vector<std::unique_ptr<UlogColumn>> &columns, const std::string &path) {
    Plan plan;
    for (const auto &column : columns) {
        const Facts facts = plan.facts.emplace_back(facts_of(*column, path));
        plan.topic_of.push_back(no_topic);
        if (facts.count == 0) continue;
        plan.begin_s = std::min(plan.begin_s, facts.first_s);
        auto found = std::find_if(plan.topics.begin(), plan.topics.end(),
                                  [&facts](const Topic &t) { return t.columns.size() < fields_of_a_topic && t.clock.same_clock(facts); });
        if (found == plan.topics.end()) {
            found = plan.topics.insert(plan.topics.end(), Topic{});
            found->clock = facts;
        }
        found->columns.push_back(column.get());
        plan.topic_of.back() = static_cast<std::size_t>(found - plan.topics.begin());
    }
    return plan;
}

// at_100_Hz, by the median of the first intervals.
std::string topic_name(std::vector<double> step_s) {
    if (step_s.empty()) return "at_once";
    const auto middle = step_s.begin() + static_cast<std::ptrdiff_t>(step_s.size() / 2);
    std::nth_element(step_s.begin(), middle, step_s.end());
    char text[40];
    std::snprintf(text, sizeof text, "at_%.3g_Hz", 1 / *middle);
    return text;
}

void define(Topic &topic, bool moved, std::set<std::string> &taken) {
    topic.name = field_name(topic_name(topic.clock.step_s), taken);
    topic.with_t_s = moved || !topic.clock.stamps_hold;
    topic.definition = topic.name + ":uint64_t timestamp;" + (topic.with_t_s ? "double t_s;" : "");
}

// The column's field in its topic, with its type.
std::string add_field(Topic &topic, const UlogColumn &column, const Facts &facts) {
    static const std::map<std::string, char> letters{{"int8_t", '1'}, {"int16_t", '2'}, {"int32_t", '4'}, {"float", 'f'}, {"double", 'd'}};
    const std::string type = facts.type(), field = field_name(column.name(), topic.taken);
    topic.types += letters.at(type);
    topic.definition.append(type).append(1, ' ').append(field).append(1, ';');
    return topic.name + ' ' + field + ' ';
}

std::string head_of(const std::map<std::string, std::string> &header, const std::vector<std::unique_ptr<UlogColumn>> &columns, Plan &plan,
                    const std::string &path) {
    std::string text(ulog_magic);
    text += '\1';
    put_field(text, 0, 8);
    text += message('B', std::string(40, '\0')) + information("sys_name", "traction-log", path, false);
    if (plan.begin_s < 0) text += information("traction_moved_s", std::to_string(-plan.begin_s), path, false);
    for (const auto &[key, value] : header) text += information("traction_header", key + ": " + value, path, true);
    std::set<std::string> taken;
    for (Topic &topic : plan.topics) define(topic, plan.begin_s < 0, taken);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::size_t topic = plan.topic_of[i];
        const std::string place = topic != no_topic ? add_field(plan.topics[topic], *columns[i], plan.facts[i]) : "- - ";
        text += information("traction_signal", place + columns[i]->name(), path, true);
    }
    for (const Topic &topic : plan.topics) text += message('F', topic.definition);
    for (std::size_t i = 0; i < plan.topics.size(); ++i) {
        std::string payload(1, '\0');
        put_field(payload, i, 2);
        text += message('A', payload + plan.topics[i].name);
    }
    return text;
}

class SignalColumn : public UlogColumn {
  public:
    explicit SignalColumn(const Signal &signal) : signal_(signal) {}
    const std::string &name() const override { return signal_.name; }
    void rewind() override { next_ = 0; }
    double t_s() const override { return next_ < signal_.t_s.size() ? signal_.t_s[next_] : no_time_s; }
    double value() const override { return signal_.value[next_]; }
    void next() override { ++next_; }

  private:
    const Signal &signal_;
    std::size_t next_ = 0;
};

} // namespace

void write_ulog(const std::map<std::string, std::string> &header, const std::vector<std::unique_ptr<UlogColumn>> &columns,
                const std::string &path) {
    std::vector<std::string> names;
    for (const auto &column : columns) names.push_back(column->name());
    (void)csv_head(header, names, path); // what a CSV cannot hold, this does not hold either
    Plan plan = plan_of(columns, path);
    if (plan.topics.size() > topics_most) throw LogError(path, 0, 0, "more than 65535 topics cannot be written", "leave columns out");
    WholeFile file(path);
    std::string text = head_of(header, columns, plan, path), payload;
    for (;;) {
        const auto due =
            std::min_element(plan.topics.begin(), plan.topics.end(), [](const Topic &a, const Topic &b) { return a.due_s() < b.due_s(); });
        if (due == plan.topics.end() || due->due_s() == no_time_s) break;
        const double t_s = due->due_s();
        payload.clear();
        put_field(payload, static_cast<std::uint64_t>(due - plan.topics.begin()), 2);
        put_field(payload, stamp_us(t_s, plan.begin_s), 8);
        if (due->with_t_s) put_field(payload, std::bit_cast<std::uint64_t>(t_s), 8);
        for (std::size_t i = 0; i < due->columns.size(); ++i) {
            UlogColumn &column = *due->columns[i];
            put_value(payload, column.value(), due->types[i]);
            column.next();
        }
        text += message('D', payload);
        if (text.size() > std::size_t{1} << 20) {
            file.write(text);
            text.clear();
        }
    }
    file.write(text);
    file.keep();
}

void write_ulog(const Log &log, const std::string &path) {
    std::vector<std::unique_ptr<UlogColumn>> columns;
    for (const Signal &signal : log.signals) {
        if (signal.t_s.size() != signal.value.size())
            throw LogError(path, 0, 0,
                           "signal '" + signal.name + "' has " + std::to_string(signal.t_s.size()) + " times and " +
                               std::to_string(signal.value.size()) + " values",
                           "give every sample a time");
        columns.push_back(std::make_unique<SignalColumn>(signal));
    }
    write_ulog(log.header, columns, path);
}

bool names_a_ulog(const std::string &path) { return path.size() > 4 && path.ends_with(".ulg"); }

} // namespace traction::log
