// telemetry.h - what a rover tells over the supervision link, kept as a log and shown as it comes. Nothing here commands.
//
// A log of telemetry has one row a status: 20 a second, LINK_STATUS_HZ 1 to 50. It holds what the firmware believes (estimate.speed_m_s,
// wheel<i>.slip, modes, faults) and measured currents and voltage, and neither wheel speeds nor duty nor counts: good for plots and for a
// look back, not to learn a model from. For that there is the on-board log, which the same link brings.
//
// Times are the rover's, from its first status on. Where its program starts anew they go on by this machine's clock.
#pragma once

#include "operator.h"

#include "host_tools/log/spool.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace traction::drive {

constexpr double silent_after_s = 1.5; // the slowest status rate is 1 Hz; half a second of network, assumed

// How the rover is heard. As a number in a live row.
enum class Hearing { heard = 0, never = 1, silent = 2, other_key = 3, no_key = 4 };
Hearing hearing_of(const Operator &link);

class Telemetry {
  public:
    explicit Telemetry(const std::string &path); // of the log, CSV or ULog; throws log::FileError

    // heard_s: this machine's clock. False: older than what was there, or the same again; it is left out.
    bool add(const Status &status, double heard_s);
    void begin(const std::map<std::string, std::string> &header) { log_.begin(header); } // log::Spool's
    void put_by() { log_.put_by(); }
    std::size_t rows() const { return rows_; }
    double last_s() const { return last_s_; }                     // of the log, 0 before the first
    void write(const std::map<std::string, std::string> &header); // throws log::LogError

  private:
    void put(std::size_t column, double value);
    log::Spool log_;
    struct Wheel {
        std::size_t slip, valid, current;
    };
    std::array<Wheel, 4> wheel_{};
    std::size_t speed_ = 0, speed_std_ = 0, asked_ = 0, battery_ = 0, mode_ = 0, faults_ = 0, fault_wheels_ = 0, standstill_ = 0,
                drive_ = 0;
    std::size_t rows_ = 0;
    std::uint32_t session_ = 0, first_ms_ = 0;
    double last_s_ = 0, base_s_ = 0, began_s_ = 0;
};

struct Received {
    std::size_t rows = 0; // in the log
    double seconds = 0;   // from the first to the last
    int silences = 0;     // longer than silent_after_s, after the first status
    double longest_s = 0; // of them
};

// Takes what comes into `log` until `stopped`, or for `seconds`. A rover that is silent, a network that is gone are waited for. `row` gets
// lines as live_names() says: with every status, ten a second at most, and two a second in silence.
Received record(Operator &link, Telemetry &log, double seconds, const std::function<void(const std::string &line)> &row,
                const std::function<bool()> &stopped);

// "t_s,estimate.speed_m_s,wheel0.slip,...": the first ten columns are those of `simulate --live -`; an empty cell means nothing, t_s is 0
// until the first status.
std::string live_names();

} // namespace traction::drive
