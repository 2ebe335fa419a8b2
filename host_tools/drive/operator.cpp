#include "operator.h"

#include "firmware/link/channel.h"
#include "firmware/link/key.h"
#include "host_tools/log/log.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

namespace traction::drive {

namespace {

// Ground stations call themselves 255; another number keeps the two's signatures apart.
constexpr std::uint8_t our_system = 254, our_component = MAV_COMP_ID_MISSIONPLANNER;
constexpr double patience_s = 3, again_s = 0.3; // assumed: the rover is gone; a datagram was lost

std::uint64_t signing_time() {
    using namespace std::chrono;
    const auto since_1970 = duration_cast<microseconds>(system_clock::now().time_since_epoch()).count() / 10;
    constexpr std::int64_t begin = 142007040000000; // 2015-01-01 in 10 us
    return since_1970 > begin ? static_cast<std::uint64_t>(since_1970 - begin) : 0;
}

struct Place {
    std::string host, port = "14555";
};

// "host", "host:port", "[v6]:port", "v6".
Place place_of(const std::string &text) {
    Place place;
    const std::size_t close = text.find(']'), colon = text.find(':');
    if (!text.empty() && text[0] == '[' && close != std::string::npos) {
        place.host = text.substr(1, close - 1);
        if (close + 1 < text.size()) place.port = text[close + 1] == ':' ? text.substr(close + 2) : "";
    } else if (colon != std::string::npos && text.find(':', colon + 1) == std::string::npos) {
        place.host = text.substr(0, colon);
        place.port = text.substr(colon + 1);
    } else {
        place.host = text;
    }
    const bool number = !place.port.empty() && place.port.size() <= 5 && place.port.find_first_not_of("0123456789") == std::string::npos;
    if (place.host.empty() || !number || std::stoi(place.port) < 1 || std::stoi(place.port) > 65535)
        throw log::LogError("--host " + text, 0, 0, "is no address", "give 10.0.0.5, rover.local:14555 or [::1]:14555");
    return place;
}

std::string text_of(const char *text, std::size_t room) { return {text, strnlen(text, room)}; }

Status status_of(const mavlink_traction_status_t &told) {
    Status status{.time_ms = told.time_boot_ms,
                  .session = told.session,
                  .tick = told.tick,
                  .faults = told.faults,
                  .speed_m_s = static_cast<double>(told.speed_m_s),
                  .speed_std_m_s = static_cast<double>(told.speed_std_m_s),
                  .set_speed_m_s = static_cast<double>(told.set_speed_m_s),
                  .battery_V = told.battery_mV * 1e-3,
                  .mode = told.mode,
                  .drive = told.drive,
                  .fault_wheels = told.fault_wheels,
                  .standstill = (told.flags & 1u) != 0,
                  .in_command = (told.flags & 2u) != 0,
                  .too_old = (told.flags & 4u) != 0};
    for (std::size_t i = 0; i < status.slip.size(); i++) {
        status.slip[i] = told.slip_e4[i] == INT16_MAX ? std::numeric_limits<double>::quiet_NaN() : told.slip_e4[i] * 1e-4;
        status.current_A[i] = told.current_cA[i] * 0.01;
    }
    return status;
}

} // namespace

struct Operator::Socket {
    std::string address;
    int fd = -1;
    std::uint8_t system = 1;
    bool keyed = false;
    channel_t channel{};
    std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
    double last_status_s = 0, last_heartbeat_s = -10;
    std::size_t statuses = 0, believed = 0, foreign = 0;
    Status status;
    LinkCounts counts;
    bool counted = false;
    std::vector<std::string> texts;
    std::function<void(const mavlink_message_t &)> waiting; // who waits for an answer
    std::function<void(const Status &)> each_status;

    ~Socket() {
        if (fd >= 0) close(fd);
    }

    double now_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); }

    void connect_to(const std::string &text) {
        const Place place = place_of(text);
        addrinfo hints{};
        hints.ai_socktype = SOCK_DGRAM;
        addrinfo *found = nullptr;
        if (const int error = getaddrinfo(place.host.c_str(), place.port.c_str(), &hints, &found); error != 0)
            throw log::FileError("--host " + text, 0, 0, std::string("is not found: ") + gai_strerror(error),
                                 "give the rover's address, or a name that this machine knows");
        const std::unique_ptr<addrinfo, void (*)(addrinfo *)> all(found, freeaddrinfo);
        fd = socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        if (fd < 0 || connect(fd, found->ai_addr, found->ai_addrlen) != 0)
            throw log::FileError("--host " + text, 0, 0, std::string("cannot be reached: ") + std::strerror(errno), "look at the network");
    }

    void send(const mavlink_message_t &packet) {
        std::array<std::uint8_t, CHANNEL_PACKET> bytes{};
        const std::size_t length = channel_bytes(&packet, bytes.data());
        if (::send(fd, bytes.data(), length, MSG_NOSIGNAL) < 0 && errno != EAGAIN && errno != ECONNREFUSED && errno != ENOBUFS)
            throw log::FileError("--host " + address, 0, 0, std::string("cannot be reached: ") + std::strerror(errno),
                                 "look at the network");
    }

    void take(const mavlink_message_t &packet) {
        if (packet.sysid != system) return;
        believed++;
        switch (packet.msgid) {
        case MAVLINK_MSG_ID_TRACTION_STATUS: {
            mavlink_traction_status_t told;
            mavlink_msg_traction_status_decode(&packet, &told);
            status = status_of(told);
            statuses++;
            last_status_s = now_s();
            if (each_status) each_status(status);
            break;
        }
        case MAVLINK_MSG_ID_TRACTION_LINK: {
            mavlink_traction_link_t told;
            mavlink_msg_traction_link_decode(&packet, &told);
            counts = {
                told.accepted, told.refused_unsigned, told.refused_signature, told.refused_replay, told.refused_stale, told.refused_other,
                told.broken,   told.losses,           told.operator_system,   told.keyed != 0};
            counted = true;
            break;
        }
        case MAVLINK_MSG_ID_STATUSTEXT: {
            mavlink_statustext_t told;
            mavlink_msg_statustext_decode(&packet, &told);
            texts.push_back(text_of(told.text, sizeof told.text));
            break;
        }
        default:
            break;
        }
        if (waiting) waiting(packet);
    }

    void receive() {
        std::array<std::uint8_t, 2048> bytes{};
        const ssize_t got = recv(fd, bytes.data(), bytes.size(), 0);
        channel_next_datagram(&channel);
        mavlink_message_t packet;
        for (ssize_t i = 0; i < got; i++) {
            const channel_verdict_t verdict = channel_take(&channel, bytes[static_cast<std::size_t>(i)], &packet);
            if (verdict == CHANNEL_SIGNED || (verdict == CHANNEL_UNSIGNED && !keyed)) take(packet);
            // an unsigned status from a rover that has no key still says so: nothing of it is obeyed, a person reads it
            else if (verdict == CHANNEL_UNSIGNED && packet.msgid == MAVLINK_MSG_ID_TRACTION_LINK)
                take_unsigned(packet);
            else if (verdict == CHANNEL_BAD_SIGNATURE)
                foreign++;
        }
    }

    void take_unsigned(const mavlink_message_t &packet) {
        counted = true;
        counts.keyed = mavlink_msg_traction_link_get_keyed(&packet) != 0;
    }

    void heartbeat() {
        mavlink_message_t packet;
        const mavlink_heartbeat_t told{.custom_mode = 0,
                                       .type = MAV_TYPE_GCS,
                                       .autopilot = MAV_AUTOPILOT_INVALID,
                                       .base_mode = 0,
                                       .system_status = MAV_STATE_ACTIVE,
                                       .mavlink_version = 3};
        mavlink_msg_heartbeat_encode_status(our_system, our_component, &channel.status, &packet, &told);
        send(packet);
        last_heartbeat_s = now_s();
    }

    void listen(double seconds) {
        const double until_s = now_s() + seconds;
        do {
            channel_clock(&channel, signing_time());
            if (now_s() - last_heartbeat_s >= 1) heartbeat();
            pollfd ready{.fd = fd, .events = POLLIN, .revents = 0};
            const double left_s = std::min(until_s - now_s(), 1.0);
            if (poll(&ready, 1, std::max(0, static_cast<int>(std::ceil(left_s * 1e3)))) > 0) receive();
        } while (now_s() < until_s);
    }

    // Asks, and asks again, until done; the rover's silence is an error.
    void until(const std::function<bool()> &done, const std::function<void()> &ask, const char *what) {
        double asked_s = -10, last_s = now_s();
        std::size_t last = believed;
        while (!done()) {
            if (now_s() - asked_s >= again_s) {
                ask();
                asked_s = now_s();
            }
            listen(0.02);
            if (believed != last) last_s = now_s();
            last = believed;
            if (now_s() - last_s > patience_s)
                throw log::FileError("--host " + address, 0, 0, std::string("did not send ") + what, "look at the network, then ask again");
        }
    }
};

Operator::Operator(const std::string &address, const std::string &key_file, int system) : self_(std::make_unique<Socket>()) {
    self_->address = address;
    self_->system = static_cast<std::uint8_t>(system);
    self_->keyed = !key_file.empty();
    std::array<std::uint8_t, KEY_BYTES> key{};
    std::array<char, KEY_MESSAGE> message{};
    if (self_->keyed && !key_read(key_file.c_str(), key.data(), message.data()))
        throw std::runtime_error("--key " + std::string(message.data())); // it is complete
    channel_begin(&self_->channel, our_system, our_component, self_->keyed ? key.data() : nullptr);
    explicit_bzero(key.data(), key.size());
    // two programs of one number would call each other's packets replays; the rover remembers 16 of number and link
    self_->channel.signing.link_id = static_cast<std::uint8_t>(getpid() % 8);
    channel_clock(&self_->channel, signing_time());
    self_->connect_to(address);
}

Operator::~Operator() = default;

void Operator::listen(double seconds) { self_->listen(seconds); }
double Operator::now_s() const { return self_->now_s(); }
bool Operator::heard() const { return self_->statuses > 0; }
double Operator::silence_s() const { return self_->now_s() - self_->last_status_s; }
bool Operator::has_key() const { return self_->keyed; }
bool Operator::other_key() const { return self_->foreign > 0 && self_->believed == 0; }
std::size_t Operator::statuses() const { return self_->statuses; }
void Operator::each_status(std::function<void(const Status &)> told) { self_->each_status = std::move(told); }
const Status &Operator::status() const { return self_->status; }
const LinkCounts &Operator::counts() const { return self_->counts; }
bool Operator::counted() const { return self_->counted; }
const std::string &Operator::address() const { return self_->address; }
std::vector<std::string> Operator::take_texts() { return std::exchange(self_->texts, {}); }

void Operator::send(const Order &order) {
    mavlink_message_t packet;
    const mavlink_traction_command_t asked{.session = self_->status.session,
                                           .rover_time_ms = self_->status.time_ms,
                                           .platform_speed_m_s = static_cast<float>(order.speed_m_s),
                                           .yaw_rate_rad_s = static_cast<float>(order.yaw_rate_rad_s),
                                           .slip_ref = static_cast<float>(order.slip),
                                           .target_system = self_->system,
                                           .target_component = MAV_COMP_ID_AUTOPILOT1,
                                           .mode = static_cast<std::uint8_t>(order.mode),
                                           .slip_wheels = static_cast<std::uint8_t>(order.slip_wheels)};
    channel_clock(&self_->channel, signing_time());
    mavlink_msg_traction_command_encode_status(our_system, our_component, &self_->channel.status, &packet, &asked);
    self_->send(packet);
}

std::vector<LogEntry> Operator::logs() {
    std::map<unsigned, LogEntry> found;
    std::size_t all = 1;
    bool none = false;
    self_->waiting = [&](const mavlink_message_t &packet) {
        if (packet.msgid != MAVLINK_MSG_ID_LOG_ENTRY) return;
        mavlink_log_entry_t entry;
        mavlink_msg_log_entry_decode(&packet, &entry);
        all = entry.num_logs;
        none = all == 0;
        if (!none) found[entry.id] = {entry.id, entry.size, entry.time_utc};
    };
    self_->until([&] { return none || found.size() >= all; },
                 [&] {
                     mavlink_message_t packet;
                     const mavlink_log_request_list_t ask{
                         .start = 0, .end = UINT16_MAX, .target_system = self_->system, .target_component = MAV_COMP_ID_AUTOPILOT1};
                     mavlink_msg_log_request_list_encode_status(our_system, our_component, &self_->channel.status, &packet, &ask);
                     self_->send(packet);
                 },
                 "its list of logs");
    self_->waiting = nullptr;
    std::vector<LogEntry> list;
    for (const auto &[id, entry] : found) list.push_back(entry);
    return list;
}

std::string Operator::log(const LogEntry &entry, const std::function<void(std::size_t)> &told) {
    constexpr std::size_t piece = MAVLINK_MSG_LOG_DATA_FIELD_DATA_LEN;
    std::string bytes(entry.bytes, '\0');
    std::vector<bool> have((bytes.size() + piece - 1) / piece);
    std::size_t missing = have.size(), first = 0;
    double last_s = self_->now_s();
    self_->waiting = [&](const mavlink_message_t &packet) {
        if (packet.msgid != MAVLINK_MSG_ID_LOG_DATA) return;
        mavlink_log_data_t data;
        mavlink_msg_log_data_decode(&packet, &data);
        if (data.id != entry.id || data.ofs % piece != 0 || data.ofs >= bytes.size()) return;
        const std::size_t wanted = std::min(piece, bytes.size() - data.ofs);
        if (data.count < wanted || have[data.ofs / piece]) return;
        std::memcpy(bytes.data() + data.ofs, data.data, wanted);
        have[data.ofs / piece] = true;
        missing--;
        last_s = self_->now_s();
    };
    const auto ask = [&] { // from the first that is missing to the end of that gap
        while (first < have.size() && have[first]) first++;
        std::size_t end = first;
        while (end < have.size() && !have[end]) end++;
        mavlink_message_t packet;
        const mavlink_log_request_data_t request{.ofs = static_cast<std::uint32_t>(first * piece),
                                                 .count = static_cast<std::uint32_t>((end - first) * piece),
                                                 .id = static_cast<std::uint16_t>(entry.id),
                                                 .target_system = self_->system,
                                                 .target_component = MAV_COMP_ID_AUTOPILOT1};
        mavlink_msg_log_request_data_encode_status(our_system, our_component, &self_->channel.status, &packet, &request);
        self_->send(packet);
    };
    double asked_s = -10;
    const double began_s = self_->now_s();
    while (missing > 0) { // waiting() counts down
        const double now_s = self_->now_s();
        if (now_s - std::max(last_s, began_s) > patience_s) {
            self_->waiting = nullptr;
            throw log::FileError("--host " + address(), 0, 0, "did not send log " + std::to_string(entry.id) + " whole",
                                 "it may have been taken away to make room; list them again");
        }
        if (asked_s < 0 || now_s - std::max(last_s, asked_s) > again_s) {
            ask();
            asked_s = now_s;
        }
        self_->listen(0.02);
        told(bytes.size() - std::min(bytes.size(), missing * piece));
    }
    self_->waiting = nullptr;
    mavlink_message_t packet;
    const mavlink_log_request_end_t end{.target_system = self_->system, .target_component = MAV_COMP_ID_AUTOPILOT1};
    mavlink_msg_log_request_end_encode_status(our_system, our_component, &self_->channel.status, &packet, &end);
    self_->send(packet);
    return bytes;
}

std::map<std::string, double> Operator::parameters() {
    std::map<unsigned, std::pair<std::string, double>> found;
    std::size_t all = 1, before = 0;
    bool asked = false;
    self_->waiting = [&](const mavlink_message_t &packet) {
        if (packet.msgid != MAVLINK_MSG_ID_PARAM_VALUE) return;
        mavlink_param_value_t value;
        mavlink_msg_param_value_decode(&packet, &value);
        all = value.param_count;
        if (value.param_index < all) found[value.param_index] = {text_of(value.param_id, sizeof value.param_id), value.param_value};
    };
    self_->until([&] { return found.size() >= all; },
                 [&] {
                     mavlink_message_t packet;
                     const bool whole = !asked || found.empty();
                     if (!whole && found.size() != before) { // still coming
                         before = found.size();
                         return;
                     }
                     if (whole) {
                         const mavlink_param_request_list_t ask{.target_system = self_->system, .target_component = MAV_COMP_ID_AUTOPILOT1};
                         mavlink_msg_param_request_list_encode_status(our_system, our_component, &self_->channel.status, &packet, &ask);
                         self_->send(packet);
                     }
                     for (unsigned i = 0; !whole && i < all; i++) {
                         if (found.contains(i)) continue;
                         mavlink_param_request_read_t ask{};
                         ask.param_index = static_cast<std::int16_t>(i);
                         ask.target_system = self_->system;
                         ask.target_component = MAV_COMP_ID_AUTOPILOT1;
                         mavlink_msg_param_request_read_encode_status(our_system, our_component, &self_->channel.status, &packet, &ask);
                         self_->send(packet);
                     }
                     asked = true;
                 },
                 "all its parameters");
    self_->waiting = nullptr;
    std::map<std::string, double> list;
    for (const auto &[index, one] : found) list.insert(one);
    return list;
}

double Operator::set_parameter(const std::string &name, double value) {
    bool answered = false;
    double is = 0;
    self_->waiting = [&](const mavlink_message_t &packet) {
        if (packet.msgid != MAVLINK_MSG_ID_PARAM_VALUE) return;
        mavlink_param_value_t told;
        mavlink_msg_param_value_decode(&packet, &told);
        if (text_of(told.param_id, sizeof told.param_id) != name) return;
        is = static_cast<double>(told.param_value);
        answered = true;
    };
    self_->until([&] { return answered; },
                 [&] {
                     mavlink_message_t packet;
                     mavlink_param_set_t ask{};
                     ask.param_value = static_cast<float>(value);
                     ask.target_system = self_->system;
                     ask.target_component = MAV_COMP_ID_AUTOPILOT1;
                     std::memcpy(ask.param_id, name.data(), std::min(name.size(), sizeof ask.param_id));
                     ask.param_type = MAV_PARAM_TYPE_REAL32;
                     channel_clock(&self_->channel, signing_time());
                     mavlink_msg_param_set_encode_status(our_system, our_component, &self_->channel.status, &packet, &ask);
                     self_->send(packet);
                 },
                 ("parameter " + name + ": it has none of that name, or does not believe the key; --parameters lists them").c_str());
    self_->waiting = nullptr;
    return is;
}

void make_key(const std::string &path) {
    std::array<char, KEY_MESSAGE> message{};
    if (!key_make(path.c_str(), message.data()))
        throw log::FileError("--new-key", 0, 0, message.data(), "give another name, in a folder that you may write to");
}

} // namespace traction::drive
