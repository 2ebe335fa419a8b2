// The on-board log: what a reader of ULog finds in it is what the ticks were, bit for bit; cut anywhere, up to the cut; within its budget.
#include "firmware/app/log_ring.h"
#include "firmware/app/ulog.h"

#include "hal/replay/frames.h"

#include <gtest/gtest.h>
#include <stdexcept>

#include <cstdint>
#include <cstring>
#include <dirent.h>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace {

// A second formulation: reads by the format's own definitions, not by the writer's structs.
struct Message {
    char kind;
    std::string payload;
};

std::vector<Message> messages_of(const std::string &bytes) {
    std::vector<Message> all;
    EXPECT_EQ(bytes.substr(0, 8), std::string("ULog\x01\x12\x35\x01"));
    for (std::size_t at = 16; at + 3 <= bytes.size();) {
        const std::size_t size = static_cast<std::uint8_t>(bytes[at]) | static_cast<std::size_t>(static_cast<std::uint8_t>(bytes[at + 1]))
                                                                            << 8;
        if (at + 3 + size > bytes.size()) break; // cut
        all.push_back({bytes[at + 2], bytes.substr(at + 3, size)});
        at += 3 + size;
    }
    return all;
}

struct Field {
    std::size_t at, size, count;
    std::string type;
};

struct Topic {
    std::string name;
    std::map<std::string, Field> field;
    std::size_t size = 0;
};

Topic topic_of(const std::string &format) {
    const std::map<std::string, std::size_t> sizes{{"uint64_t", 8}, {"uint32_t", 4}, {"int32_t", 4}, {"float", 4},
                                                   {"uint16_t", 2}, {"int16_t", 2},  {"uint8_t", 1}, {"bool", 1}};
    Topic topic;
    const std::size_t colon = format.find(':');
    topic.name = format.substr(0, colon);
    for (std::size_t at = colon + 1; at < format.size();) {
        const std::size_t end = format.find(';', at), blank = format.find(' ', at);
        std::string type = format.substr(at, blank - at);
        std::size_t count = 1;
        if (const std::size_t bracket = type.find('['); bracket != std::string::npos) {
            count = std::stoul(type.substr(bracket + 1));
            type.resize(bracket);
        }
        topic.field[format.substr(blank + 1, end - blank - 1)] = {topic.size, sizes.at(type), count, type};
        topic.size += sizes.at(type) * count;
        at = end + 1;
    }
    return topic;
}

struct Log {
    std::vector<Topic> topic;
    std::vector<std::string> text;
    std::map<std::string, std::vector<std::string>> data; // by topic
    int dropouts = 0;
    std::size_t whole = 0; // messages
};

Log read_log(const std::string &bytes) {
    Log log;
    std::map<unsigned, std::string> subscribed;
    for (const Message &m : messages_of(bytes)) {
        log.whole++;
        if (m.kind == 'F') log.topic.push_back(topic_of(m.payload));
        if (m.kind == 'A') subscribed[static_cast<unsigned char>(m.payload[1])] = m.payload.substr(3);
        if (m.kind == 'L') log.text.push_back(m.payload.substr(9));
        if (m.kind == 'O') log.dropouts++;
        if (m.kind == 'D') {
            const std::string name = subscribed.at(static_cast<unsigned char>(m.payload[0]));
            for (const Topic &topic : log.topic)
                if (topic.name == name) {
                    EXPECT_EQ(m.payload.size() - 2, topic.size) << name;
                }
            log.data[name].push_back(m.payload.substr(2));
        }
    }
    return log;
}

template <typename T> T value(const Log &log, const std::string &topic, std::size_t row, const std::string &field, std::size_t i = 0) {
    for (const Topic &t : log.topic) {
        if (t.name != topic) continue;
        const Field &f = t.field.at(field);
        EXPECT_EQ(f.size, sizeof(T)) << field;
        T out;
        std::memcpy(&out, log.data.at(topic).at(row).data() + f.at + i * f.size, sizeof out); // little endian, as both machines
        return out;
    }
    throw std::out_of_range(topic);
}

struct Tick {
    sensor_frame_t frame{};
    command_t command{};
    trace_t trace{};
};

Tick random_tick(std::uint32_t tick, std::mt19937 &random) {
    Tick out;
    const auto bits = [&random] { return static_cast<std::uint32_t>(random()); };
    const auto real = [&bits] { // any bits, NaN and infinities too
        const std::uint32_t b = bits();
        float f;
        std::memcpy(&f, &b, sizeof f);
        return f;
    };
    sensor_frame_t &f = out.frame;
    f.tick = out.trace.tick = tick;
    f.elapsed_ticks = 1;
    f.time_us = bits();
    f.present = bits() & FRAME_ALL;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        f.encoder_count[i] = static_cast<std::int32_t>(bits());
        f.current_count[i] = static_cast<std::uint16_t>(bits());
        f.bridge_status[i] = static_cast<std::uint8_t>(bits() & 31u);
        out.command.wheel_speed_rad_s[i] = real();
        out.command.duty[i] = real();
        out.trace.wheel[i] = {real(),
                              real(),
                              real(),
                              real(),
                              real(),
                              real(),
                              real(),
                              real(),
                              real(),
                              (bits() & 1u) != 0,
                              (bits() & 1u) != 0,
                              (bits() & 1u) != 0};
        out.trace.actuator.duty_q15[i] = static_cast<std::int16_t>(bits());
    }
    f.battery_count = static_cast<std::uint16_t>(bits());
    f.accel_x_count = static_cast<std::int16_t>(bits());
    f.gyro_z_count = static_cast<std::int16_t>(bits());
    f.radar_samples = static_cast<std::uint8_t>(bits() % 65);
    f.radar_sequence = bits();
    for (int i = 0; i < f.radar_samples; i++) f.radar_count[i] = static_cast<std::uint16_t>(bits() & 1023u);
    f.emergency_stop = (bits() & 1u) != 0;
    out.command.mode = static_cast<control_mode_t>(bits() % MODE_COUNT);
    out.command.platform_speed_m_s = real();
    out.command.slip_ref = real();
    out.command.slip_wheels = static_cast<std::uint8_t>(bits() & 15u);
    out.command.age_ticks = bits();
    out.trace.speed_m_s = real();
    return out;
}

std::string bytes_of(std::uint32_t ticks, std::vector<Tick> *kept, std::vector<std::size_t> *ends = nullptr) {
    std::mt19937 random(5);
    std::uint8_t head[ULOG_HEAD], block[ULOG_TICK];
    std::string bytes(reinterpret_cast<const char *>(head), ulog_head(0, "0.2.0", head));
    EXPECT_LE(bytes.size(), static_cast<std::size_t>(ULOG_HEAD));
    for (std::uint32_t i = 0; i < ticks; i++) {
        const Tick tick = random_tick(i, random);
        const std::size_t length = ulog_tick(&tick.frame, &tick.command, &tick.trace, block);
        EXPECT_LE(length, static_cast<std::size_t>(ULOG_TICK));
        bytes.append(reinterpret_cast<const char *>(block), length);
        if (kept != nullptr) kept->push_back(tick);
        if (ends != nullptr) ends->push_back(bytes.size());
    }
    return bytes;
}

class Folder {
  public:
    Folder() {
        char name[] = "/tmp/traction_ulog_XXXXXX"; // POSIX has this folder everywhere
        path = mkdtemp(name);
    }
    ~Folder() {
        for (const std::string &file : files()) unlink((path + "/" + file).c_str());
        rmdir(path.c_str());
    }
    Folder(const Folder &) = delete;
    Folder &operator=(const Folder &) = delete;
    std::vector<std::string> files() const {
        std::map<std::string, int> sorted;
        DIR *folder = opendir(path.c_str());
        for (const dirent *entry = readdir(folder); entry != nullptr; entry = readdir(folder))
            if (entry->d_name[0] != '.') sorted[entry->d_name] = 1;
        closedir(folder);
        std::vector<std::string> names;
        for (const auto &[name, one] : sorted) names.push_back(name);
        return names;
    }
    std::string read(const std::string &name) const {
        std::ifstream file(path + "/" + name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::string path;
};

} // namespace

TEST(ulog, holds_every_tick_bit_for_bit) {
    std::vector<Tick> ticks;
    const Log log = read_log(bytes_of(200, &ticks));
    ASSERT_EQ(log.data.at("frame").size(), 200u);
    ASSERT_EQ(log.data.at("trace").size(), 200u);
    std::size_t radar = 0;
    const auto same = [](float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; };
    for (std::uint32_t n = 0; n < 200; n++) {
        const Tick &tick = ticks[n];
        EXPECT_EQ(value<std::uint64_t>(log, "frame", n, "timestamp"), (n + 1) * 10000u);
        EXPECT_EQ(value<std::uint32_t>(log, "frame", n, "time_us"), tick.frame.time_us);
        EXPECT_EQ(value<std::uint32_t>(log, "frame", n, "present"), tick.frame.present);
        EXPECT_EQ(value<std::uint16_t>(log, "frame", n, "battery"), tick.frame.battery_count);
        EXPECT_EQ(value<std::int16_t>(log, "frame", n, "accel", 0), tick.frame.accel_x_count);
        EXPECT_EQ(value<std::int16_t>(log, "frame", n, "gyro", 2), tick.frame.gyro_z_count);
        EXPECT_EQ(value<std::uint8_t>(log, "frame", n, "emergency_stop"), tick.frame.emergency_stop ? 1 : 0);
        EXPECT_EQ(value<std::uint8_t>(log, "command", n, "mode"), tick.command.mode);
        EXPECT_EQ(value<std::uint32_t>(log, "command", n, "age_ticks"), tick.command.age_ticks);
        EXPECT_TRUE(same(value<float>(log, "command", n, "slip_ref"), tick.command.slip_ref));
        EXPECT_TRUE(same(value<float>(log, "trace", n, "speed_m_s"), tick.trace.speed_m_s));
        for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
            EXPECT_EQ(value<std::int32_t>(log, "frame", n, "encoder", i), tick.frame.encoder_count[i]);
            EXPECT_EQ(value<std::uint16_t>(log, "frame", n, "current", i), tick.frame.current_count[i]);
            EXPECT_EQ(value<std::uint8_t>(log, "frame", n, "bridge", i), tick.frame.bridge_status[i]);
            EXPECT_TRUE(same(value<float>(log, "command", n, "duty", i), tick.command.duty[i]));
            EXPECT_TRUE(same(value<float>(log, "trace", n, "slip", i), tick.trace.wheel[i].slip));
            EXPECT_TRUE(same(value<float>(log, "trace", n, "slip_std", i), tick.trace.wheel[i].slip_std));
            EXPECT_TRUE(same(value<float>(log, "trace", n, "accel_rad_s2", i), tick.trace.wheel[i].accel_rad_s2));
            EXPECT_EQ(value<std::int16_t>(log, "trace", n, "duty_q15", i), tick.trace.actuator.duty_q15[i]);
            EXPECT_EQ((value<std::uint8_t>(log, "trace", n, "saturated") >> i & 1) != 0, tick.trace.wheel[i].saturated);
        }
        for (std::uint32_t at = 0; at < tick.frame.radar_samples;) {
            EXPECT_EQ(value<std::uint32_t>(log, "radar", radar, "sequence"), tick.frame.radar_sequence + at);
            const std::size_t samples = value<std::uint8_t>(log, "radar", radar, "samples");
            for (std::size_t i = 0; i < samples; i++)
                EXPECT_EQ(value<std::uint16_t>(log, "radar", radar, "count", i), tick.frame.radar_count[at++]);
            radar++;
        }
    }
    EXPECT_EQ(radar, log.data.at("radar").size());
}

TEST(ulog, cut_at_two_hundred_places_holds_every_message_before_the_cut) {
    std::vector<Tick> ticks;
    std::vector<std::size_t> ends;
    const std::string bytes = bytes_of(300, &ticks, &ends);
    std::mt19937 random(6);
    for (int n = 0; n < 200; n++) {
        const std::size_t cut = 16 + random() % (bytes.size() - 16);
        const Log log = read_log(bytes.substr(0, cut));
        std::size_t whole = 0;
        while (whole < ends.size() && ends[whole] <= cut) whole++;
        if (log.data.count("trace") == 0) { // cut within the head or the first tick
            EXPECT_EQ(whole, 0u);
            continue;
        }
        const std::size_t traces = log.data.at("trace").size();
        EXPECT_EQ(traces, whole); // the trace is a tick's last message
        EXPECT_GE(log.data.at("frame").size(), whole);
        if (traces > 0) {
            EXPECT_EQ(value<std::uint32_t>(log, "frame", traces - 1, "time_us"), ticks[traces - 1].frame.time_us);
        }
    }
}

TEST(log_ring, keeps_its_budget_drops_the_oldest_and_begins_a_new_file_at_each_start) {
    const Folder folder;
    std::mt19937 random(7);
    std::uint32_t last_time = 0;
    for (int start = 0; start < 2; start++) {
        const auto ring = std::make_unique<log_ring_t>();
        char message[LOG_RING_MESSAGE];
        ring->patient = true;
        ASSERT_TRUE(log_ring_start(ring.get(), folder.path.c_str(), 1000000, message)) << message;
        for (std::uint32_t i = 0; i < 5000; i++) { // 2.6 MB
            Tick tick = random_tick(i, random);
            log_ring_put(ring.get(), &tick.frame, &tick.command, &tick.trace);
            last_time = tick.frame.time_us;
        }
        EXPECT_EQ(log_ring_finish(ring.get()), 0u);
        EXPECT_STREQ(ring->failed, "");
        std::size_t bytes = 0;
        for (const std::string &name : folder.files()) bytes += folder.read(name).size();
        EXPECT_LE(bytes, 1000000u);
        EXPECT_GT(bytes, 500000u);
        const Log newest = read_log(folder.read(folder.files().back()));
        const std::size_t rows = newest.data.at("frame").size();
        EXPECT_EQ(value<std::uint32_t>(newest, "frame", rows - 1, "time_us"), last_time);
        const Log oldest = read_log(folder.read(folder.files().front())); // each stands for itself
        EXPECT_EQ(oldest.topic.size(), 4u);
    }
    EXPECT_GT(folder.files().front(), "log_000010.ulg");
    EXPECT_LT(folder.files().back(), "log_000060.ulg");
}

TEST(log_ring, tells_a_fault_in_words_and_dumps_the_ticks_around_it) {
    const Folder folder;
    const auto ring = std::make_unique<log_ring_t>();
    char message[LOG_RING_MESSAGE];
    ring->patient = true;
    ASSERT_TRUE(log_ring_start(ring.get(), folder.path.c_str(), 1000000, message));
    std::mt19937 random(8);
    for (std::uint32_t i = 0; i < 600; i++) {
        Tick tick = random_tick(i, random);
        tick.trace.faults = i >= 400 ? FAULT_BRIDGE : 0;
        tick.trace.fault_wheels = i >= 400 ? 4 : 0;
        log_ring_put(ring.get(), &tick.frame, &tick.command, &tick.trace);
    }
    log_ring_finish(ring.get());
    ASSERT_EQ(folder.files().size(), 4u); // three logs of an eighth of the budget, and the dump
    std::size_t told = 0;
    for (const std::string &name : folder.files())
        if (name.substr(0, 3) == "log")
            for (const std::string &text : read_log(folder.read(name)).text) {
                EXPECT_EQ(text.substr(0, 24), "fault 00008000, wheels 4");
                told++;
            }
    EXPECT_EQ(told, 1u);
    const std::string dump = folder.read(folder.files().front());
    EXPECT_EQ(folder.files().front().substr(0, 6), "fault_");
    std::vector<std::uint32_t> ticks;
    for (std::size_t at = 0; at < dump.size(); at = dump.find('\n', at) + 1) {
        sensor_frame_t frame;
        command_t command;
        char why[FRAMES_WHY];
        ASSERT_TRUE(frames_parse(dump.substr(at, dump.find('\n', at) - at + 1).c_str(), &frame, &command, why)) << why;
        ticks.push_back(frame.tick);
    }
    ASSERT_EQ(ticks.size(), static_cast<std::size_t>(LOG_RING_PAST));
    EXPECT_LE(ticks.front(), 400u - 194);
    EXPECT_GE(ticks.back(), 449u);
    for (std::size_t i = 1; i < ticks.size(); i++) EXPECT_EQ(ticks[i], ticks[i - 1] + 1);
}

TEST(log_ring, refuses_what_is_no_folder_and_tells_a_disk_that_is_full) {
    const auto ring = std::make_unique<log_ring_t>();
    char message[LOG_RING_MESSAGE];
    EXPECT_FALSE(log_ring_start(ring.get(), "/dev/null", 1000000, message));
    EXPECT_NE(std::string(message).find("/dev/null: is no folder to write in"), std::string::npos) << message;
    EXPECT_FALSE(log_ring_start(ring.get(), "/nowhere/at/all", 1000000, message));
    const Folder folder;
    EXPECT_FALSE(log_ring_start(ring.get(), folder.path.c_str(), 999999, message));
    const auto full = std::make_unique<log_ring_t>();
    ASSERT_EQ(symlink("/dev/full", (folder.path + "/log_000001.ulg").c_str()), 0);
    full->patient = true;
    full->number = 0;
    ASSERT_TRUE(log_ring_start(full.get(), folder.path.c_str(), 1000000, message)) << message; // takes the next number
    log_ring_finish(full.get());
    EXPECT_EQ(folder.files().back(), "log_000002.ulg");
}
