// The rover's end of the supervision link against an operator that this test makes of the same packets: what is told, what is obeyed, what
// is refused and counted. An independent operator (pymavlink) speaks to it in supervision.sh.
#include "firmware/core/control.h"
#include "firmware/core/rover_config.h"
#include "firmware/link/key.h"
#include "firmware/link/supervisor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

namespace {

using Bytes = std::vector<uint8_t>;
constexpr std::array<uint8_t, 32> our_key{1, 2, 3, 4}, another_key{9};
constexpr uint64_t begin_10us = 37'000'000'000'000; // 2026 in 10 us since 2015
constexpr uint32_t session = 0xfeedf00d;

// An operator: makes packets, reads the rover's.
struct Operator {
    explicit Operator(const uint8_t *key, uint8_t number = 254) : system(number) {
        channel_begin(&channel, number, 190, key);
        channel_clock(&channel, begin_10us + 100);
    }
    template <typename Message, typename Encode> Bytes packet(Encode encode, const Message &message) {
        mavlink_message_t made;
        encode(system, 190, &channel.status, &made, &message);
        Bytes bytes(CHANNEL_PACKET);
        bytes.resize(channel_bytes(&made, bytes.data()));
        return bytes;
    }
    Bytes command(mavlink_traction_command_t asked) { return packet(mavlink_msg_traction_command_encode_status, asked); }
    channel_t channel;
    uint8_t system;
};

// A rover's end, and all that it has sent.
struct Rover {
    explicit Rover(const uint8_t *key, const uint8_t *listener_key = nullptr) : listener(listener_key != nullptr ? listener_key : key, 7) {
        rover_parameters_reference(&parameters);
        const supervisor_config_t config{.rover = &parameters,
                                         .key = key,
                                         .speed_max_m_s = 1,
                                         .yaw_max_rad_s = 4,
                                         .patience_ms = 80,
                                         .session = session,
                                         .started_10us = begin_10us,
                                         .version = {0, 2, 0},
                                         .system = 1};
        const supervisor_world_t world{.context = this,
                                       .send = [](void *self, int peer, const uint8_t *bytes,
                                                  size_t length) { static_cast<Rover *>(self)->take(peer, bytes, length); },
                                       .list =
                                           [](void *self, supervisor_log_t *list, size_t room) {
                                               const auto &all = static_cast<Rover *>(self)->logs;
                                               size_t count = 0;
                                               for (const auto &[number, bytes] : all)
                                                   if (count < room)
                                                       list[count++] = {number, static_cast<uint32_t>(bytes.size()), 1'770'000'000};
                                               return count;
                                           },
                                       .read =
                                           [](void *self, uint32_t number, uint32_t offset, uint8_t *bytes, size_t count) {
                                               const auto &all = static_cast<Rover *>(self)->logs;
                                               const auto found = all.find(number);
                                               if (found == all.end() || offset >= found->second.size()) return size_t{0};
                                               const size_t got = std::min(count, found->second.size() - offset);
                                               std::memcpy(bytes, found->second.data() + offset, got);
                                               return got;
                                           }};
        supervisor_begin(&link, &config, &world);
    }
    void take(int peer, const uint8_t *bytes, size_t length) {
        sent_bytes += length;
        peers.insert(peer);
        mavlink_message_t packet;
        for (size_t i = 0; i < length; i++) {
            const channel_verdict_t verdict = channel_take(&listener.channel, bytes[i], &packet);
            if (verdict == CHANNEL_NOTHING) continue;
            verdicts[verdict]++;
            heard.push_back(packet);
        }
    }
    supervisor_heard_t receive(const Bytes &bytes, int peer = 0) {
        return supervisor_receive(&link, peer, bytes.data(), bytes.size(), now_ms, begin_10us + now_ms * 100u);
    }
    void run(uint32_t ms) { // the thread's steps
        for (const uint32_t end = now_ms + ms; now_ms < end; now_ms += SUPERVISOR_STEP_MS)
            supervisor_step(&link, now_ms, begin_10us + now_ms * 100u);
    }
    int count(uint32_t message) const {
        return static_cast<int>(std::count_if(heard.begin(), heard.end(), [=](const auto &packet) { return packet.msgid == message; }));
    }
    const mavlink_message_t *last(uint32_t message) const {
        for (size_t i = heard.size(); i-- > 0;)
            if (heard[i].msgid == message) return &heard[i];
        return nullptr;
    }
    mavlink_traction_command_t fresh(int mode = MODE_PLATFORM_SPEED, float speed = 0.3f) const {
        mavlink_traction_command_t asked{};
        asked.session = session;
        asked.rover_time_ms = now_ms;
        asked.platform_speed_m_s = speed;
        asked.target_system = 1;
        asked.target_component = 1;
        asked.mode = static_cast<uint8_t>(mode);
        return asked;
    }
    uint32_t refused() const {
        const supervisor_counts_t &c = link.counts;
        return c.refused_unsigned + c.refused_signature + c.refused_replay + c.refused_stale + c.refused_other;
    }
    rover_parameters_t parameters;
    supervisor_t link;
    Operator listener;
    std::map<uint32_t, Bytes> logs;
    std::vector<mavlink_message_t> heard;
    std::map<int, int> verdicts;
    std::set<int> peers;
    size_t sent_bytes = 0;
    uint32_t now_ms = 1000;
};

int many(const char *variable, int otherwise) {
    const char *text = std::getenv(variable);
    return text != nullptr ? std::atoi(text) : otherwise;
}

} // namespace

TEST(Supervisor, obeys_a_signed_command) {
    Rover rover(our_key.data());
    Operator who(our_key.data());
    EXPECT_EQ(rover.receive(who.command(rover.fresh())), SUPERVISOR_HEARD_KEY);
    EXPECT_EQ(rover.link.counts.accepted, 1u);
    EXPECT_EQ(rover.link.order.number, 1u);
    EXPECT_EQ(rover.link.order.command.mode, MODE_PLATFORM_SPEED);
    EXPECT_EQ(rover.link.order.command.platform_speed_m_s, 0.3f);
    auto slip = rover.fresh(MODE_SLIP);
    slip.slip_ref = 0.2f;
    slip.slip_wheels = 5;
    rover.receive(who.command(slip));
    EXPECT_EQ(rover.link.order.command.mode, MODE_SLIP);
    EXPECT_EQ(rover.link.order.command.slip_ref, 0.2f);
    EXPECT_EQ(rover.link.order.command.slip_wheels, 5);
    EXPECT_EQ(rover.refused(), 0u);
}

TEST(Supervisor, refuses_and_counts_each_kind_of_wrong_command) {
    struct Case {
        const char *name;
        uint32_t supervisor_counts_t::*counter;
        std::function<void(Rover &)> give;
    };
    const auto with = [](auto change) {
        return [change](Rover &rover) {
            Operator who(our_key.data());
            auto asked = rover.fresh();
            change(asked, rover);
            rover.receive(who.command(asked));
        };
    };
    using C = mavlink_traction_command_t;
    using K = supervisor_counts_t;
    const std::vector<Case> cases{
        {"unsigned", &K::refused_unsigned, [](Rover &r) { r.receive(Operator(nullptr).command(r.fresh())); }},
        {"another key", &K::refused_signature, [](Rover &r) { r.receive(Operator(another_key.data()).command(r.fresh())); }},
        {"an unsigned stop", &K::refused_unsigned, [](Rover &r) { r.receive(Operator(nullptr).command(r.fresh(MODE_STOP))); }},
        {"of another session", &K::refused_stale, with([](C &c, Rover &) { c.session++; })},
        {"answers what is too old", &K::refused_stale, with([](C &c, Rover &) { c.rover_time_ms -= SUPERVISOR_STALE_MS + 1; })},
        {"answers what is to come", &K::refused_stale, with([](C &c, Rover &) { c.rover_time_ms += 1; })},
        {"too fast", &K::refused_other, with([](C &c, Rover &) { c.platform_speed_m_s = 1.01f; })},
        {"too fast backward", &K::refused_other, with([](C &c, Rover &) { c.platform_speed_m_s = -1.01f; })},
        {"no number", &K::refused_other, with([](C &c, Rover &) { c.platform_speed_m_s = NAN; })},
        {"turns too fast", &K::refused_other, with([](C &c, Rover &) { c.yaw_rate_rad_s = INFINITY; })},
        {"more than all slip", &K::refused_other, with([](C &c, Rover &) { c.slip_ref = 1.5f; })},
        {"a fifth wheel", &K::refused_other, with([](C &c, Rover &) { c.slip_wheels = 16; })},
        {"open loop", &K::refused_other, with([](C &c, Rover &) { c.mode = MODE_OPEN_LOOP; })},
        {"no mode", &K::refused_other, with([](C &c, Rover &) { c.mode = 200; })},
        {"a mission", &K::refused_other,
         [](Rover &r) {
             mavlink_mission_count_t mission{};
             mission.target_system = 1;
             mission.count = 3;
             r.receive(Operator(our_key.data()).packet(mavlink_msg_mission_count_encode_status, mission));
         }},
        {"a key over the air", &K::refused_other,
         [](Rover &r) {
             mavlink_setup_signing_t key{};
             key.target_system = 1;
             r.receive(Operator(our_key.data()).packet(mavlink_msg_setup_signing_encode_status, key));
         }},
        {"arming", &K::refused_other,
         [](Rover &r) {
             mavlink_command_long_t arm{};
             arm.target_system = 1;
             arm.command = MAV_CMD_COMPONENT_ARM_DISARM;
             arm.param1 = 1;
             r.receive(Operator(our_key.data()).packet(mavlink_msg_command_long_encode_status, arm));
         }},
        {"an unsigned parameter", &K::refused_unsigned,
         [](Rover &r) {
             mavlink_param_set_t set{};
             set.target_system = 1;
             set.param_value = 0.1f;
             std::memcpy(set.param_id, "LINK_SPEED_MAX", 14);
             r.receive(Operator(nullptr).packet(mavlink_msg_param_set_encode_status, set));
         }},
        {"a parameter from before the start", &K::refused_replay,
         [](Rover &r) {
             Operator who(our_key.data());
             who.channel.signing.timestamp = begin_10us - 1000;
             mavlink_param_set_t set{};
             set.target_system = 1;
             set.param_value = 0.1f;
             std::memcpy(set.param_id, "LINK_SPEED_MAX", 14);
             r.receive(who.packet(mavlink_msg_param_set_encode_status, set));
         }},
    };
    for (const Case &one : cases) {
        SCOPED_TRACE(one.name);
        Rover rover(our_key.data());
        one.give(rover);
        EXPECT_EQ(rover.link.counts.accepted, 0u);
        EXPECT_EQ(rover.link.order.number, 0u);
        EXPECT_EQ(rover.link.counts.*one.counter, 1u);
        EXPECT_EQ(rover.refused(), 1u);
        EXPECT_EQ(rover.link.setting[2], 1.0f); // LINK_SPEED_MAX
    }
}

TEST(Supervisor, a_packet_that_comes_again_or_late_is_a_replay) {
    Rover rover(our_key.data());
    Operator who(our_key.data());
    const Bytes first = who.command(rover.fresh()), second = who.command(rover.fresh());
    rover.receive(second);
    rover.receive(second);
    rover.receive(first);
    EXPECT_EQ(rover.link.counts.accepted, 1u);
    EXPECT_EQ(rover.link.counts.refused_replay, 2u);
    Operator late(our_key.data(), 99); // never heard of, and its clock a minute and a bit behind
    late.channel.signing.timestamp = begin_10us - 61 * 100'000;
    rover.receive(late.command(rover.fresh()));
    EXPECT_EQ(rover.link.counts.refused_replay, 3u);
    EXPECT_EQ(rover.receive(Operator(another_key.data()).command(rover.fresh())), SUPERVISOR_HEARD_SOMEBODY); // is told, not obeyed
}

// A board without a clock of its own begins in 1970, an operator's may be wrong by hours: after the first words of either they agree,
// because each signs with the latest time that it has believed.
TEST(Supervisor, clocks_that_differ_meet) {
    for (const int64_t ahead_s : {-86'400 * 4000ll, -3600ll, -61ll, 61ll, 3600ll}) {
        SCOPED_TRACE(ahead_s);
        Rover rover(our_key.data());
        Operator &who = rover.listener;
        const auto rover_10us = [&] {
            return static_cast<uint64_t>(static_cast<int64_t>(begin_10us) + ahead_s * 100'000) + rover.now_ms * 100u;
        };
        rover.link.config.started_10us = rover_10us();
        uint32_t began_ms = rover.now_ms;
        while (rover.link.counts.accepted == 0 && rover.now_ms - began_ms < 3000) {
            channel_clock(&who.channel, begin_10us + rover.now_ms * 100u);
            if ((rover.now_ms - began_ms) % 1000 == 0) { // its heartbeat
                const mavlink_heartbeat_t told{};
                const Bytes bytes = who.packet(mavlink_msg_heartbeat_encode_status, told);
                (void)supervisor_receive(&rover.link, 0, bytes.data(), bytes.size(), rover.now_ms, rover_10us());
            }
            supervisor_step(&rover.link, rover.now_ms, rover_10us());
            rover.now_ms += 10;
            if (rover.verdicts[CHANNEL_SIGNED] == 0) continue; // drives once it believes the rover
            const Bytes bytes = who.command(rover.fresh());
            (void)supervisor_receive(&rover.link, 0, bytes.data(), bytes.size(), rover.now_ms, rover_10us());
        }
        EXPECT_EQ(rover.link.counts.accepted, 1u);
        EXPECT_LE(rover.now_ms - began_ms, 1100u); // the second heartbeat at the latest
    }
}

TEST(Supervisor, a_command_recorded_before_a_restart_moves_nothing_after_it) {
    Rover before(our_key.data());
    Operator who(our_key.data());
    const Bytes recorded = who.command(before.fresh());
    Rover after(our_key.data());
    after.link.config.session = session + 1;
    after.receive(recorded);
    EXPECT_EQ(after.link.order.number, 0u);
    EXPECT_EQ(after.link.counts.refused_stale, 1u);
}

TEST(Supervisor, without_a_key_it_tells_and_obeys_nobody) {
    Rover rover(nullptr);
    rover.receive(Operator(our_key.data()).command(rover.fresh()));
    rover.receive(Operator(nullptr).command(rover.fresh()));
    rover.receive(Operator(nullptr).command(rover.fresh(MODE_STOP)));
    EXPECT_EQ(rover.link.order.number, 0u);
    EXPECT_EQ(rover.link.counts.refused_unsigned, 3u);
    const trace_t trace{};
    const command_t command{};
    supervisor_tick(&rover.link, &trace, &command);
    rover.run(1000);
    EXPECT_GE(rover.count(MAVLINK_MSG_ID_TRACTION_STATUS), 19);
    EXPECT_EQ(rover.verdicts[CHANNEL_SIGNED], 0);
    EXPECT_EQ(mavlink_msg_traction_link_get_keyed(rover.last(MAVLINK_MSG_ID_TRACTION_LINK)), 0);
}

TEST(Supervisor, one_operator_drives_and_anybody_with_the_key_stops) {
    Rover rover(our_key.data());
    Operator first(our_key.data(), 254), second(our_key.data(), 253);
    rover.receive(first.command(rover.fresh()));
    rover.receive(second.command(rover.fresh()));
    EXPECT_EQ(rover.link.counts.refused_other, 1u);
    EXPECT_EQ(rover.link.order.number, 1u);
    auto old = rover.fresh(MODE_STOP);
    old.session = 0; // a stop needs no status
    rover.receive(second.command(old));
    EXPECT_EQ(rover.link.order.command.mode, MODE_STOP);
    rover.receive(second.command(rover.fresh())); // stopped: whoever comes first
    EXPECT_EQ(rover.link.order.command.mode, MODE_PLATFORM_SPEED);
    rover.receive(second.command(rover.fresh()), 3); // the same number, from elsewhere
    EXPECT_EQ(rover.link.counts.refused_other, 2u);
    supervisor_moved(&rover.link, 0, 3); // it was the same one, and has a place now
    rover.receive(second.command(rover.fresh()), 3);
    EXPECT_EQ(rover.link.counts.refused_other, 2u);
    rover.run(SUPERVISOR_OPERATOR_MS + 20);
    rover.receive(first.command(rover.fresh())); // the second fell silent
    EXPECT_EQ(rover.link.counts.refused_other, 2u);
    EXPECT_EQ(rover.link.counts.losses, 1u);
}

// (1): more than 80 ms and at most 90 ms after the last command received a tick sees it as too old, whatever the ticks' phase; and the
// firmware's own controller then lets the wheels go no further.
TEST(Supervisor, a_silent_operator_stops_the_rover_within_90_ms) {
    const control_config_t config = rover_config_default();
    command_t order{};
    order.mode = MODE_PLATFORM_SPEED;
    order.platform_speed_m_s = 0.3f;
    for (uint64_t phase_us = 0; phase_us < 10'000; phase_us += 100) {
        control_state_t state;
        control_reset(&config, &state);
        sensor_frame_t frame{};
        frame.present = FRAME_ALL;
        for (auto &count : frame.current_count) count = 2048;
        frame.battery_count = 1800;
        const uint64_t last_ns = 50'000'000 + phase_us * 1000; // the last command comes then, those before every 20 ms
        uint64_t stopped_ns = 0;
        for (uint32_t tick = 0; tick < 20; tick++) {
            const uint64_t now_ns = tick * 10'000'000ull;
            uint64_t received_ns = last_ns;
            while (received_ns > now_ns) received_ns = received_ns > 20'000'000 ? received_ns - 20'000'000 : 0;
            command_t command = order;
            command.age_ticks = supervisor_age_ticks(&order, received_ns, now_ns);
            frame.tick = tick;
            frame.elapsed_ticks = 1;
            frame.time_us += 10'000;
            const trace_t trace = control_step(&config, &state, &command, &frame);
            const bool timed_out = (trace.faults & FAULT_COMMAND_TIMEOUT) != 0;
            if (timed_out && stopped_ns == 0) stopped_ns = now_ns;
            EXPECT_TRUE(!timed_out || trace.actuator.drive != DRIVE_ON);
        }
        EXPECT_GT(stopped_ns, last_ns + 80'000'000) << phase_us; // two commands of 20 ms lost, and 40 ms of jitter, stop nothing
        EXPECT_LE(stopped_ns, last_ns + 90'000'000) << phase_us;
    }
    const command_t stop{};                                    // MODE_STOP
    EXPECT_EQ(supervisor_age_ticks(&stop, 0, UINT64_MAX), 0u); // a stop does not age
    EXPECT_EQ(supervisor_age_ticks(&order, 5, 4), 0u);
    EXPECT_EQ(supervisor_age_ticks(&order, 0, UINT64_MAX), UINT32_MAX);
}

TEST(Supervisor, answers_a_ground_stations_first_questions) {
    Rover rover(our_key.data());
    Operator who(nullptr, 255); // without a key: these are questions
    mavlink_param_request_list_t list{};
    list.target_system = 1;
    list.target_component = 1;
    EXPECT_EQ(rover.receive(who.packet(mavlink_msg_param_request_list_encode_status, list)), SUPERVISOR_HEARD_SOMEBODY);
    rover.run(2000);
    std::map<int, std::string> names;
    for (const mavlink_message_t &packet : rover.heard)
        if (packet.msgid == MAVLINK_MSG_ID_PARAM_VALUE) {
            mavlink_param_value_t value;
            mavlink_msg_param_value_decode(&packet, &value);
            EXPECT_EQ(value.param_count, supervisor_parameter_count(&rover.link));
            names[value.param_index] = std::string(value.param_id, strnlen(value.param_id, 16));
        }
    EXPECT_EQ(names.size(), supervisor_parameter_count(&rover.link));
    std::set<std::string> different;
    for (const auto &[index, name] : names) different.insert(name);
    EXPECT_EQ(different.size(), names.size()) << "two parameters have one name on the wire";

    mavlink_command_long_t ask{};
    ask.target_system = 1;
    ask.command = MAV_CMD_REQUEST_MESSAGE;
    ask.param1 = MAVLINK_MSG_ID_AUTOPILOT_VERSION;
    rover.receive(who.packet(mavlink_msg_command_long_encode_status, ask));
    ASSERT_EQ(rover.count(MAVLINK_MSG_ID_AUTOPILOT_VERSION), 1);
    EXPECT_EQ(mavlink_msg_autopilot_version_get_flight_sw_version(rover.last(MAVLINK_MSG_ID_AUTOPILOT_VERSION)) >> 16u, 2u);
    EXPECT_EQ(mavlink_msg_command_ack_get_result(rover.last(MAVLINK_MSG_ID_COMMAND_ACK)), MAV_RESULT_ACCEPTED);
    ask.command = MAV_CMD_NAV_TAKEOFF;
    rover.receive(who.packet(mavlink_msg_command_long_encode_status, ask));
    EXPECT_EQ(mavlink_msg_command_ack_get_result(rover.last(MAVLINK_MSG_ID_COMMAND_ACK)), MAV_RESULT_DENIED);
    EXPECT_EQ(mavlink_msg_command_ack_get_command(rover.last(MAVLINK_MSG_ID_COMMAND_ACK)), MAV_CMD_NAV_TAKEOFF);
    mavlink_mission_request_list_t mission{};
    mission.target_system = 1;
    rover.receive(who.packet(mavlink_msg_mission_request_list_encode_status, mission));
    ASSERT_EQ(rover.count(MAVLINK_MSG_ID_MISSION_COUNT), 1);
    EXPECT_EQ(mavlink_msg_mission_count_get_count(rover.last(MAVLINK_MSG_ID_MISSION_COUNT)), 0);
    EXPECT_GE(rover.count(MAVLINK_MSG_ID_HEARTBEAT), 2);
    const mavlink_message_t *heartbeat = rover.last(MAVLINK_MSG_ID_HEARTBEAT);
    EXPECT_EQ(mavlink_msg_heartbeat_get_type(heartbeat), MAV_TYPE_GROUND_ROVER);
}

// What a ground station sends when somebody presses its buttons, each refused in the words of its own protocol, with a key and without.
TEST(Supervisor, refuses_in_words_what_a_ground_station_would_do) {
    for (const bool keyed : {false, true}) {
        Rover rover(our_key.data());
        Operator who(keyed ? our_key.data() : nullptr, 255);
        mavlink_command_int_t reposition{};
        reposition.target_system = 1;
        reposition.command = MAV_CMD_DO_REPOSITION;
        rover.receive(who.packet(mavlink_msg_command_int_encode_status, reposition));
        ASSERT_EQ(rover.count(MAVLINK_MSG_ID_COMMAND_ACK), 1);
        EXPECT_EQ(mavlink_msg_command_ack_get_command(rover.last(MAVLINK_MSG_ID_COMMAND_ACK)), MAV_CMD_DO_REPOSITION);
        EXPECT_EQ(mavlink_msg_command_ack_get_result(rover.last(MAVLINK_MSG_ID_COMMAND_ACK)), MAV_RESULT_DENIED);
        mavlink_mission_count_t upload{};
        upload.target_system = 1;
        upload.count = 5;
        upload.mission_type = MAV_MISSION_TYPE_FENCE;
        rover.receive(who.packet(mavlink_msg_mission_count_encode_status, upload));
        ASSERT_EQ(rover.count(MAVLINK_MSG_ID_MISSION_ACK), 1);
        EXPECT_EQ(mavlink_msg_mission_ack_get_type(rover.last(MAVLINK_MSG_ID_MISSION_ACK)), MAV_MISSION_DENIED);
        EXPECT_EQ(mavlink_msg_mission_ack_get_mission_type(rover.last(MAVLINK_MSG_ID_MISSION_ACK)), MAV_MISSION_TYPE_FENCE);
        mavlink_mission_clear_all_t clear{};
        clear.target_system = 1;
        clear.mission_type = MAV_MISSION_TYPE_RALLY;
        rover.receive(who.packet(mavlink_msg_mission_clear_all_encode_status, clear));
        ASSERT_EQ(rover.count(MAVLINK_MSG_ID_MISSION_ACK), 2);
        EXPECT_EQ(mavlink_msg_mission_ack_get_mission_type(rover.last(MAVLINK_MSG_ID_MISSION_ACK)), MAV_MISSION_TYPE_RALLY);
        mavlink_param_set_t set{}; // the rover's own number: nobody's to set over the link
        set.target_system = 1;
        set.param_value = 99;
        std::memcpy(set.param_id, "wheel_radius_m", 14);
        rover.receive(who.packet(mavlink_msg_param_set_encode_status, set));
        ASSERT_EQ(rover.count(MAVLINK_MSG_ID_PARAM_VALUE), 1);
        EXPECT_EQ(mavlink_msg_param_value_get_param_value(rover.last(MAVLINK_MSG_ID_PARAM_VALUE)),
                  rover.parameters.value[ROVER_wheel_radius_m]);
        std::memcpy(set.param_id, "LINK_SPEED_MAX", 14); // the link's: with the key, within its range
        set.param_value = 0.5f;
        rover.receive(who.packet(mavlink_msg_param_set_encode_status, set));
        EXPECT_EQ(mavlink_msg_param_value_get_param_value(rover.last(MAVLINK_MSG_ID_PARAM_VALUE)), keyed ? 0.5f : 1.0f);
        EXPECT_EQ(rover.refused(), keyed ? 4u : 5u);
        EXPECT_EQ(rover.link.order.number, 0u);
        const int said = static_cast<int>(rover.heard.size());
        mavlink_param_set_t none{};
        none.target_system = 1;
        std::memcpy(none.param_id, "NO_SUCH", 7);
        rover.receive(who.packet(mavlink_msg_param_set_encode_status, none));
        mavlink_manual_control_t stick{}; // it has no answer
        stick.target = 1;
        rover.receive(who.packet(mavlink_msg_manual_control_encode_status, stick));
        EXPECT_EQ(static_cast<int>(rover.heard.size()), said);
        EXPECT_EQ(rover.refused(), keyed ? 6u : 7u);
    }
}

TEST(Supervisor, sets_its_own_parameters_within_their_range_and_no_other) {
    Rover rover(our_key.data());
    Operator who(our_key.data());
    const auto set = [&](const char *name, float value) {
        mavlink_param_set_t packet{};
        packet.target_system = 1;
        packet.param_value = value;
        std::memcpy(packet.param_id, name, std::min<size_t>(std::strlen(name), 16));
        rover.receive(who.packet(mavlink_msg_param_set_encode_status, packet));
    };
    set("LINK_SPEED_MAX", 0.2f);
    rover.receive(who.command(rover.fresh(MODE_PLATFORM_SPEED, 0.3f)));
    EXPECT_EQ(rover.link.counts.refused_other, 1u);
    set("LINK_SPEED_MAX", 3.0f); // more than the firmware drives
    set("LINK_STATUS_HZ", NAN);
    set("LINK_STATUS_HZ", 1000.0f);
    set("wheel_radius_m", 0.2f); // the file's
    EXPECT_EQ(rover.link.counts.refused_other, 5u);
    EXPECT_EQ(rover.link.setting[2], 0.2f);
    EXPECT_EQ(rover.link.setting[0], 20.0f);
    EXPECT_EQ(rover.link.counts.accepted, 1u);
}

TEST(Supervisor, tells_at_the_rates_and_within_the_bytes_that_are_written_down) {
    Rover rover(our_key.data());
    trace_t trace{};
    trace.speed_m_s = 0.25f;
    trace.speed_std_m_s = 0.01f;
    trace.faults = FAULT_STALL;
    trace.battery_voltage_V = 7.2f;
    trace.wheel[2].slip = 0.5f;
    trace.wheel[2].slip_valid = true;
    const command_t command{};
    for (int i = 0; i < 1000; i++) {
        trace.tick++;
        supervisor_tick(&rover.link, &trace, &command);
        rover.run(10);
    }
    // 10 s: 20 Hz, 1 Hz, 1 Hz, 2 Hz, each at most one more or less
    EXPECT_NEAR(rover.count(MAVLINK_MSG_ID_TRACTION_STATUS), 200, 1);
    EXPECT_NEAR(rover.count(MAVLINK_MSG_ID_HEARTBEAT), 10, 1);
    EXPECT_NEAR(rover.count(MAVLINK_MSG_ID_TRACTION_LINK), 10, 1);
    EXPECT_NEAR(rover.count(MAVLINK_MSG_ID_SYS_STATUS), 20, 1);
    EXPECT_EQ(rover.count(MAVLINK_MSG_ID_STATUSTEXT), 1); // the fault, once
    EXPECT_EQ(rover.verdicts[CHANNEL_SIGNED], static_cast<int>(rover.heard.size()));
    // with the datagrams' 28 bytes of IP and UDP: 20 (75 + 28) + 34 + 28 + 63 + 28 + 2 (68 + 45 + 56) = 2551 bytes a second, nothing left
    // out
    EXPECT_LE(static_cast<double>(rover.sent_bytes + 28 * rover.heard.size()) / 10, 2600) << rover.sent_bytes;
    mavlink_traction_status_t told;
    mavlink_msg_traction_status_decode(rover.last(MAVLINK_MSG_ID_TRACTION_STATUS), &told);
    EXPECT_EQ(told.speed_m_s, 0.25f);
    EXPECT_EQ(told.faults, static_cast<uint32_t>(FAULT_STALL));
    EXPECT_EQ(told.battery_mV, 7200);
    EXPECT_EQ(told.slip_e4[2], 5000);
    EXPECT_EQ(told.slip_e4[0], INT16_MAX);
    EXPECT_EQ(told.session, session);
}

TEST(Supervisor, no_trace_makes_a_number_that_cannot_be_sent) { // undefined behaviour would end the sanitized build here
    Rover rover(our_key.data());
    command_t command{};
    command.platform_speed_m_s = NAN;
    for (const float value : {NAN, INFINITY, -INFINITY, 1e30f, -1e30f}) {
        trace_t trace{};
        trace.speed_m_s = trace.speed_std_m_s = trace.battery_voltage_V = value;
        for (auto &wheel : trace.wheel) {
            wheel.slip = wheel.current_A = wheel.duty = value;
            wheel.slip_valid = true;
        }
        supervisor_tick(&rover.link, &trace, &command);
        rover.run(1000);
    }
    EXPECT_GE(rover.count(MAVLINK_MSG_ID_TRACTION_STATUS), 95);
}

TEST(Supervisor, lists_and_sends_logs_whole_within_the_budget) {
    Rover rover(our_key.data());
    std::mt19937 random(20261122);
    for (const uint32_t number : {3u, 4u, 7u}) {
        Bytes bytes(30'000 + number);
        for (uint8_t &byte : bytes) byte = static_cast<uint8_t>(random());
        rover.logs[number] = bytes;
    }
    Operator who(nullptr);
    mavlink_log_request_list_t list{};
    list.target_system = 1;
    list.end = 0xffff;
    rover.receive(who.packet(mavlink_msg_log_request_list_encode_status, list), 2);
    rover.run(500);
    EXPECT_EQ(rover.count(MAVLINK_MSG_ID_LOG_ENTRY), 3);
    mavlink_log_entry_t entry;
    mavlink_msg_log_entry_decode(rover.last(MAVLINK_MSG_ID_LOG_ENTRY), &entry);
    EXPECT_EQ(entry.id, 7);
    EXPECT_EQ(entry.size, 30'007u);
    EXPECT_EQ(entry.num_logs, 3);
    EXPECT_EQ(entry.last_log_num, 7);

    mavlink_log_request_data_t data{};
    data.target_system = 1;
    data.id = 7;
    data.count = UINT32_MAX;
    rover.receive(who.packet(mavlink_msg_log_request_data_encode_status, data), 2);
    rover.heard.clear();
    const size_t before = rover.sent_bytes;
    rover.run(100);
    EXPECT_LE(rover.sent_bytes - before, 100'000 / 10 + 2 * CHANNEL_PACKET + 1000u); // 100 kB/s, and the telemetry between
    rover.run(1000);
    Bytes got(30'007);
    for (const mavlink_message_t &packet : rover.heard)
        if (packet.msgid == MAVLINK_MSG_ID_LOG_DATA) {
            mavlink_log_data_t piece;
            mavlink_msg_log_data_decode(&packet, &piece);
            ASSERT_LE(piece.ofs + piece.count, got.size());
            std::memcpy(got.data() + piece.ofs, piece.data, piece.count);
        }
    EXPECT_TRUE(got == rover.logs[7]);

    rover.receive(who.packet(mavlink_msg_log_request_data_encode_status, data), 2);
    supervisor_moved(&rover.link, 2, SUPERVISOR_NOBODY); // its reader is gone
    rover.heard.clear();
    rover.run(500);
    EXPECT_EQ(rover.count(MAVLINK_MSG_ID_LOG_DATA), 0);
}

TEST(Supervisor, there_being_no_log_is_told) {
    Rover rover(our_key.data());
    mavlink_log_request_list_t list{};
    list.end = 0xffff;
    rover.receive(Operator(nullptr).packet(mavlink_msg_log_request_list_encode_status, list));
    rover.run(100);
    ASSERT_EQ(rover.count(MAVLINK_MSG_ID_LOG_ENTRY), 1);
    EXPECT_EQ(mavlink_msg_log_entry_get_num_logs(rover.last(MAVLINK_MSG_ID_LOG_ENTRY)), 0);
}

TEST(Supervisor, random_bytes_move_nothing) {
    Rover rover(our_key.data());
    std::mt19937 random(20261122);
    int left = many("LINK_BYTES", 100'000);
    while (left > 0) {
        Bytes bytes(1 + random() % 300);
        for (uint8_t &byte : bytes) byte = static_cast<uint8_t>(random());
        if (random() % 2 == 0) { // and such as begin as a packet does
            bytes[0] = 0xfd;
            if (bytes.size() > 2) bytes[2] &= 1;
        }
        left -= static_cast<int>(bytes.size());
        rover.receive(bytes);
        rover.now_ms++;
    }
    EXPECT_EQ(rover.link.counts.accepted, 0u);
    EXPECT_EQ(rover.link.order.number, 0u);
}

// Whole packets of every kind the rover knows, with any content and length: unsigned ones move nothing, signed ones nothing beyond the
// limits.
TEST(Supervisor, any_content_of_a_whole_packet_is_borne) {
    static const mavlink_msg_entry_t known[] = MAVLINK_MESSAGE_CRCS;
    std::mt19937 random(20261124);
    Rover open(our_key.data()), driven(our_key.data());
    for (Rover *rover : {&open, &driven})
        for (uint32_t number = 1; number < 4; number++) rover->logs[number] = Bytes(1000);
    Operator nobody(nullptr), who(our_key.data());
    for (int i = many("LINK_PACKETS", 5'000); i > 0; i--) {
        // every second one is of a kind that is answered or obeyed
        const uint32_t asked[] = {20, 21, 23, 43, 76, 117, 119, 122, MAVLINK_MSG_ID_TRACTION_COMMAND};
        const mavlink_msg_entry_t *about =
            random() % 2 == 0 ? mavlink_get_msg_entry(asked[random() % std::size(asked)]) : &known[random() % std::size(known)];
        mavlink_message_t packet{};
        packet.msgid = about->msgid & 0xffffffu;
        char *payload = _MAV_PAYLOAD_NON_CONST(&packet);
        for (size_t k = 0; k < about->max_msg_len; k++) payload[k] = static_cast<char>(random() % 3 == 0 ? random() : 0);
        if ((about->flags & MAV_MSG_ENTRY_FLAG_HAVE_TARGET_SYSTEM) != 0) payload[about->target_system_ofs] = 1;
        if ((about->flags & MAV_MSG_ENTRY_FLAG_HAVE_TARGET_COMPONENT) != 0) payload[about->target_component_ofs] = 1;
        if (about->msgid == MAVLINK_MSG_ID_TRACTION_COMMAND && random() % 2 == 0) {
            std::memcpy(payload, &session, 4); // the first two of its fields on the wire
            std::memcpy(payload + 4, &driven.now_ms, 4);
            payload[22] = static_cast<char>(random() % 8);
        }
        const bool key = random() % 2 == 0;
        channel_t &channel = key ? who.channel : nobody.channel;
        (void)mavlink_finalize_message_buffer(&packet, channel.system, 190, &channel.status, about->min_msg_len, about->max_msg_len,
                                              about->crc_extra);
        Bytes bytes(CHANNEL_PACKET);
        bytes.resize(channel_bytes(&packet, bytes.data()));
        if (random() % 20 == 0) bytes.resize(1 + random() % bytes.size()); // cut
        (key ? driven : open).receive(bytes, static_cast<int>(random() % 5));
        if (i % 16 == 0) {
            open.run(10);
            driven.run(10);
            driven.now_ms = open.now_ms = std::max(driven.now_ms, open.now_ms);
        }
        const command_t &order = driven.link.order.command;
        ASSERT_TRUE(order.mode == MODE_STOP || order.mode == MODE_PLATFORM_SPEED || order.mode == MODE_SLIP ||
                    order.mode == MODE_SOIL_SWEEP);
        ASSERT_LE(std::fabs(order.platform_speed_m_s), 1.0f);
        ASSERT_LE(std::fabs(order.yaw_rate_rad_s), 4.0f);
        ASSERT_LE(std::fabs(order.slip_ref), 1.0f);
        ASSERT_LT(order.slip_wheels, 16);
    }
    EXPECT_EQ(open.link.counts.accepted, 0u);
    EXPECT_EQ(open.link.order.number, 0u);
    EXPECT_GT(driven.link.counts.accepted, 0u);
}

// What an attacker has who hears everything and lacks the key: old packets, his own, and any change of them.
TEST(Supervisor, no_forged_command_is_obeyed) {
    Rover rover(our_key.data());
    Operator genuine(our_key.data()), forger(another_key.data()), nobody(nullptr);
    std::mt19937 random(20261123);
    const int forgeries = many("LINK_FORGERIES", 5'000);
    uint32_t sent = 0;
    std::vector<Bytes> overheard; // obeyed once
    for (int i = 0; i < forgeries; i++) {
        if (i % 100 == 0) {
            overheard.push_back(genuine.command(rover.fresh(MODE_PLATFORM_SPEED, 0.1f)));
            rover.receive(overheard.back());
            sent++;
        }
        auto asked = rover.fresh(MODE_PLATFORM_SPEED, 0.9f);
        Bytes bytes;
        switch (random() % 6) {
        case 0:
            bytes = nobody.command(asked);
            break;
        case 1:
            bytes = forger.command(asked);
            break;
        case 2:
            bytes = overheard[random() % overheard.size()];
            break;
        case 3: { // a genuine one that never arrived, changed in one bit
            bytes = genuine.command(asked);
            bytes[random() % bytes.size()] ^= static_cast<uint8_t>(1u << random() % 8);
            break;
        }
        case 4: { // the signature of an overheard one under a command of his own
            bytes = forger.command(asked);
            const Bytes &other = overheard[random() % overheard.size()];
            std::copy(other.end() - 13, other.end(), bytes.end() - 13);
            break;
        }
        default: { // a signature guessed, the flag kept
            bytes = forger.command(asked);
            for (size_t k = bytes.size() - 6; k < bytes.size(); k++) bytes[k] = static_cast<uint8_t>(random());
            break;
        }
        }
        rover.receive(bytes);
        rover.now_ms += 3;
    }
    EXPECT_EQ(rover.link.counts.accepted, sent);
    EXPECT_EQ(rover.link.order.number, sent);
    EXPECT_EQ(rover.link.order.command.platform_speed_m_s, 0.1f);
    EXPECT_GT(rover.refused(), static_cast<uint32_t>(forgeries) / 2);
}

TEST(Key, is_made_for_its_owner_alone_and_read_back) {
    char folder[] = "/tmp/traction_key_XXXXXX";
    ASSERT_NE(mkdtemp(folder), nullptr);
    const std::string path = std::string(folder) + "/key";
    char message[KEY_MESSAGE];
    std::array<uint8_t, 32> first{}, again{};
    ASSERT_TRUE(key_make(path.c_str(), message)) << message;
    struct stat about {};
    ASSERT_EQ(stat(path.c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777, 0600u);
    ASSERT_TRUE(key_read(path.c_str(), first.data(), message)) << message;
    ASSERT_TRUE(key_read(path.c_str(), again.data(), message));
    EXPECT_EQ(first, again);
    EXPECT_NE(first, (std::array<uint8_t, 32>{}));
    EXPECT_FALSE(key_make(path.c_str(), message));
    EXPECT_NE(std::strstr(message, "never overwritten"), nullptr) << message;
    chmod(path.c_str(), 0640);
    EXPECT_FALSE(key_read(path.c_str(), again.data(), message));
    EXPECT_NE(std::strstr(message, "mode 640"), nullptr) << message;
    const auto refused = [&](const std::string &text, const char *why) {
        const std::string wrong = std::string(folder) + "/wrong";
        std::ofstream(wrong) << text;
        chmod(wrong.c_str(), 0600);
        EXPECT_FALSE(key_read(wrong.c_str(), again.data(), message)) << text;
        EXPECT_NE(std::strstr(message, why), nullptr) << message;
        unlink(wrong.c_str());
    };
    refused("", "64 hex digits");
    refused(std::string(63, 'a'), "64 hex digits");
    refused(std::string(65, 'a'), "64 hex digits");
    refused(std::string(63, 'a') + "g", "hex digits");
    EXPECT_FALSE(key_read((std::string(folder) + "/none").c_str(), again.data(), message));
    EXPECT_FALSE(key_read(folder, again.data(), message));
    unlink(path.c_str());
    rmdir(folder);
}
