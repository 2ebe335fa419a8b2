#include "telemetry.h"

#include "host_tools/log/log.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

namespace traction::drive {

namespace {

constexpr double listen_period_s = 0.02, between_rows_s = 0.1, between_silent_rows_s = 0.5, put_by_period_s = 1;
constexpr std::uint32_t backwards = 1u << 31; // a difference of the rover's clock, which wraps

std::string wheel_name(std::size_t wheel, const char *quantity) { return "wheel" + std::to_string(wheel) + quantity; }

std::string cell(double value) {
    char text[32];
    std::snprintf(text, sizeof text, ",%.5g", value);
    return std::isfinite(value) ? text : ",";
}

double rounded(double value) { return std::round(value * 1e6) / 1e6; } // what the link tells in float, as the simulator's log

// `status` null: nothing is heard.
std::string live_row(double t_s, const Status *status, Hearing hearing, double age_s) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", t_s);
    std::string line = text;
    if (status == nullptr) {
        line += std::string(14, ',');
    } else {
        line += cell(status->speed_m_s);
        for (const double slip : status->slip) line += cell(slip);
        for (const double current : status->current_A) line += cell(current);
        line += cell(status->battery_V) + "," + std::to_string(status->mode) + "," + std::to_string(status->faults) + "," +
                std::to_string(status->drive) + cell(status->set_speed_m_s);
    }
    return line + "," + std::to_string(static_cast<int>(hearing)) + cell(age_s);
}

} // namespace

Hearing hearing_of(const Operator &link) {
    if (link.heard()) return link.silence_s() > silent_after_s ? Hearing::silent : Hearing::heard;
    if (link.other_key()) return Hearing::other_key;
    return link.has_key() && link.counted() && !link.counts().keyed ? Hearing::no_key : Hearing::never;
}

Telemetry::Telemetry(const std::string &path) : log_(path) {
    speed_ = log_.add("estimate.speed_m_s");
    speed_std_ = log_.add("estimate.speed_std_m_s");
    standstill_ = log_.add("estimate.standstill");
    for (std::size_t i = 0; i < wheel_.size(); i++)
        wheel_[i] = {log_.add(wheel_name(i, ".slip")), log_.add(wheel_name(i, ".slip_valid")), log_.add(wheel_name(i, ".current_A"))};
    battery_ = log_.add("battery.voltage_V");
    mode_ = log_.add("control.mode");
    faults_ = log_.add("control.faults");
    fault_wheels_ = log_.add("control.fault_wheels");
    asked_ = log_.add("command.speed_m_s");
    drive_ = log_.add("actuator.drive");
}

bool Telemetry::add(const Status &status, double heard_s) {
    if (rows_ == 0) {
        began_s_ = heard_s;
        first_ms_ = status.time_ms;
    } else if (status.session != session_) {
        base_s_ = std::max(heard_s - began_s_, last_s_ + 1e-3);
        first_ms_ = status.time_ms;
    }
    const std::uint32_t since_ms = status.time_ms - first_ms_;
    const double t_s = base_s_ + since_ms / 1000.0;
    if (rows_ > 0 && (since_ms >= backwards || t_s <= last_s_)) return false;
    session_ = status.session;
    last_s_ = t_s;
    rows_++;
    put(speed_, status.speed_m_s);
    put(speed_std_, status.speed_std_m_s);
    put(standstill_, status.standstill ? 1 : 0);
    for (std::size_t i = 0; i < wheel_.size(); i++) {
        const bool valid = std::isfinite(status.slip[i]);
        if (valid) put(wheel_[i].slip, status.slip[i]);
        put(wheel_[i].valid, valid ? 1 : 0);
        put(wheel_[i].current, status.current_A[i]);
    }
    put(battery_, status.battery_V);
    put(mode_, status.mode);
    put(faults_, status.faults);
    put(fault_wheels_, status.fault_wheels);
    put(asked_, status.set_speed_m_s);
    put(drive_, status.drive);
    return true;
}

void Telemetry::put(std::size_t column, double value) { log_.put(column, last_s_, rounded(value)); }

void Telemetry::write(const std::map<std::string, std::string> &header) { log_.write(header); }

Received record(Operator &link, Telemetry &log, double seconds, const std::function<void(const std::string &)> &row,
                const std::function<bool()> &stopped) {
    Received received;
    bool fresh = false;
    double heard_s = 0;
    link.each_status([&](const Status &status) {
        const double silence_s = link.now_s() - heard_s;
        if (received.rows > 0 && silence_s > silent_after_s) {
            received.silences++;
            received.longest_s = std::max(received.longest_s, silence_s);
        }
        heard_s = link.now_s();
        fresh = log.add(status, heard_s) || fresh;
        received.rows = log.rows();
    });
    const double until_s = link.now_s() + seconds;
    double told_s = -1, shown_s = -1, put_by_s = link.now_s();
    while (link.now_s() < until_s && !stopped()) {
        if (link.now_s() - put_by_s >= put_by_period_s) { // whatever ends this program, a second is lost
            log.put_by();
            put_by_s = link.now_s();
        }
        try {
            link.listen(listen_period_s);
        } catch (const log::FileError &) { // the network is gone; it may come back
            std::this_thread::sleep_for(std::chrono::duration<double>(listen_period_s));
        }
        const Hearing hearing = hearing_of(link);
        const bool heard = hearing == Hearing::heard;
        const double since_s = told_s < 0 ? 1e9 : link.now_s() - told_s;
        if (heard ? !fresh || since_s < between_rows_s : since_s < between_silent_rows_s) continue;
        const double age_s = link.silence_s();
        if (log.rows() > 0) shown_s = std::max(heard ? log.last_s() : log.last_s() + age_s, shown_s + 1e-3);
        row(live_row(std::max(shown_s, 0.0), heard ? &link.status() : nullptr, hearing, age_s));
        told_s = link.now_s();
        fresh = false;
    }
    link.each_status(nullptr);
    received.seconds = log.last_s();
    return received;
}

std::string live_names() {
    std::string names = "t_s,estimate.speed_m_s";
    for (const char *quantity : {".slip", ".current_A"})
        for (std::size_t i = 0; i < 4; i++) names += "," + wheel_name(i, quantity);
    return names + ",battery.voltage_V,control.mode,control.faults,actuator.drive,command.speed_m_s,link.hearing,link.age_s";
}

} // namespace traction::drive
