// operator.h - the operator's end of the supervision link (docs/supervision.md): MAVLink 2 over UDP to one rover.
//
// Believes what is signed with the operator's key; without a key, what comes. Times are of the steady clock, in seconds since the start.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace traction::drive {

// What is asked for; mode is one of control_mode_t (firmware/core/signals.h).
struct Order {
    int mode = 0;
    double speed_m_s = 0, yaw_rate_rad_s = 0, slip = 0;
    unsigned slip_wheels = 0; // bit i: wheel i
};

// The rover's latest words about itself.
struct Status {
    std::uint32_t time_ms = 0, session = 0, tick = 0, faults = 0; // fault_t
    double speed_m_s = 0, speed_std_m_s = 0, set_speed_m_s = 0, battery_V = 0;
    std::array<double, 4> slip{}, current_A{}; // slip: NaN where it means nothing
    int mode = 0, drive = 0;                   // control_mode_t, drive_state_t
    unsigned fault_wheels = 0;
    bool standstill = false, in_command = false, too_old = false;
};

// And about the link, since its program began.
struct LinkCounts {
    std::uint32_t accepted = 0, refused_unsigned = 0, refused_signature = 0, refused_replay = 0, refused_stale = 0, refused_other = 0,
                  broken = 0, losses = 0;
    int operator_system = 0;
    bool keyed = false;
};

struct LogEntry {
    unsigned id = 0;
    std::uint32_t bytes = 0, time_s = 0; // last written, seconds since 1970
};

class Operator {
  public:
    // address: "10.0.0.5", "rover.local:14555", "[::1]:14555". key_file "": watches only. system: the rover's MAVLink number.
    // Throws log::LogError (address, key) or log::FileError (no socket).
    Operator(const std::string &address, const std::string &key_file, int system);
    ~Operator();

    void listen(double seconds); // takes what comes, and tells every second that the operator is there
    double now_s() const;

    bool heard() const;       // a status has come
    double silence_s() const; // since the latest one; since the start where none came
    bool has_key() const;
    bool other_key() const;                                           // the rover signs with another key: nothing that it says is believed
    std::size_t statuses() const;                                     // so many have come
    void each_status(std::function<void(const Status &status)> told); // called with every one that comes; replaces the one before
    const Status &status() const;
    const LinkCounts &counts() const; // of the latest second
    bool counted() const;             // they have come

    void send(const Order &order); // answers the latest status, which must have come

    // Each waits for the rover's whole answer and asks again for what was lost; throws log::FileError when it stays out.
    std::vector<LogEntry> logs();
    std::string log(const LogEntry &entry, const std::function<void(std::size_t bytes)> &told); // the bytes
    std::map<std::string, double> parameters();
    double set_parameter(const std::string &name, double value); // what it is then

    std::vector<std::string> take_texts(); // what the rover said since the last call
    const std::string &address() const;

  private:
    struct Socket;
    std::unique_ptr<Socket> self_;
};

// Makes a new key file (mode 0600); throws log::FileError.
void make_key(const std::string &path);

} // namespace traction::drive
