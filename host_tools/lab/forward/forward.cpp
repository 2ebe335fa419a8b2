#include "forward.h"

#include "wheel_step.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace traction::lab {

namespace {

constexpr double friction_share =
    1.0 / 12;                             // of the standstill speed: friction reverses over it; assumed, rows near standstill are left out
constexpr double bridge_current_A = 0.01; // the bridge's dead time reverses over this current at least: assumed
constexpr double voltage_part_s =
    0.01; // dead time bends the voltage balance: it is taken over parts of a row as long as this, a control tick

bool has_electric_terms(const Physics &physics) {
    return std::any_of(physics.terms.begin(), physics.terms.end(),
                       [](const ExtraTerm &term) { return (target_stages(term.target) & (stage_torque | stage_voltage)) != 0; });
}

// A wheel's current then drops the voltage of others.
bool shares_leads(const Physics &physics) {
    return std::any_of(physics.wheel.begin(), physics.wheel.end(), [](const WheelPhysics &w) { return w.shared_ohm != 0; });
}

bool follows_others(const ExtraTerm &term) {
    return (target_stages(term.target) & (stage_torque | stage_voltage)) != 0 && term.term->of_other_motors();
}

// A wheel's current is then part of what others read.
bool asks_for_others(const Physics &physics) { return std::any_of(physics.terms.begin(), physics.terms.end(), follows_others); }

// Of a piecewise constant voltage up to a time; times asked for one after the other are found at once.
class VoltageIntegral {
  public:
    VoltageIntegral(const std::vector<double> &t_s, const std::vector<double> &sum_Vs) : t_(t_s), sum_(sum_Vs) {}
    double operator()(double at) {
        while (j_ + 2 < t_.size() && t_[j_ + 1] <= at) ++j_;
        while (j_ > 0 && t_[j_] > at) --j_;
        return sum_[j_] + (sum_[j_ + 1] - sum_[j_]) / (t_[j_ + 1] - t_[j_]) * (at - t_[j_]);
    }

  private:
    const std::vector<double> &t_, &sum_;
    std::size_t j_ = 0;
};

// A first-order low pass of a series that is linear between its samples, lag in steps: y' = (x - y)/lag, exact. lag < 0: its inverse,
// x + |lag| x', for what is smoothed more on its way here than in the sensor; both are x - lag x' to first order.
void low_pass(std::vector<double> &x, double lag) {
    if (lag == 0 || x.size() < 2) return;
    if (lag < 0) {
        for (std::size_t k = x.size(); --k > 0;) x[k] -= lag * (x[k] - x[k - 1]);
        return;
    }
    const double kept = std::exp(-1 / lag);
    double before = x[0], y = x[0];
    for (std::size_t k = 1; k < x.size(); ++k) {
        const double slope = x[k] - before, now = x[k];
        y = now - lag * slope + (y - before + lag * slope) * kept;
        before = now, x[k] = y;
    }
}

// None of the motor's and the gear's laws that bend or turn about.
bool is_smooth(const WheelPhysics &p) {
    return p.stribeck_Nm == 0 && p.wear_in_Nm == 0 && p.reverse_Nm == 0 && p.churning_Nms2 == 0 && p.ripple_cos_Nm == 0 &&
           p.ripple_sin_Nm == 0 && p.speed_loss_s == 0;
}

std::size_t parts_of(double row_s) { return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(row_s / voltage_part_s))); }

} // namespace

Forward::Forward(const Dataset &data) : data_(&data), base_motion_(std::make_shared<Motion>()) {
    const auto of_current = [](const Balance &b) {
        return b.kind == BalanceKind::current_torque || b.kind == BalanceKind::current_voltage;
    };
    for (std::size_t i = 0; i < data.balance.size(); ++i) {
        const Balance &balance = data.balance[i];
        first_row_.push_back(row_count_);
        std::size_t same = 0;
        while (same < i && !(of_current(balance) && of_current(data.balance[same]) && balance.t0_s == data.balance[same].t0_s &&
                             balance.t1_s == data.balance[same].t1_s))
            ++same;
        windows_of_.push_back(same < i ? windows_of_[same] : windows_.size());
        if (same == i) windows_.emplace_back(data, balance);
        row_count_ += balance.measured.size();
    }
    base_current_.resize(data.wheel.size());
    mean_voltage_.resize(data.wheel.size());
    voltage_integral_.resize(data.wheel.size());
}

void Forward::rows_of(std::size_t balance, const std::vector<double> &series, double delay_s, bool adding, Eigen::VectorXd &out) const {
    windows_[windows_of_[balance]].mean(
        series, delay_s, adding,
        out.segment(static_cast<Eigen::Index>(first_row_[balance]), static_cast<Eigen::Index>(data_->balance[balance].measured.size())));
}

// Mean motor voltage over each row's window, delay_s earlier; lag_s: what the command lags behind the log, the supply does not.
const Eigen::VectorXd &Forward::mean_voltage(std::size_t balance, double delay_s, double lag_s) const {
    const Balance &b = data_->balance[balance];
    const WheelInput &in = data_->wheel[static_cast<std::size_t>(b.wheel)];
    auto &[known, other] = mean_voltage_[static_cast<std::size_t>(b.wheel)];
    const auto is_it = [&](const auto &m) { return m && m->delay_s == delay_s && m->lag_s == lag_s; };
    if (is_it(known)) return known->mean_V;
    std::swap(known, other);
    if (is_it(known)) return known->mean_V;
    MeanVoltage made{delay_s, lag_s, Eigen::VectorXd(static_cast<Eigen::Index>(b.measured.size()))};
    VoltageIntegral integral_to(in.voltage_t_s, voltage_integral(static_cast<std::size_t>(b.wheel), lag_s));
    for (std::size_t r = 0; r < b.measured.size(); ++r) {
        const double t0 = b.t0_s[r] - delay_s - lag_s, t1 = std::max(b.t1_s[r] - delay_s - lag_s, t0 + 1e-6), from = integral_to(t0);
        made.mean_V[static_cast<Eigen::Index>(r)] = (integral_to(t1) - from) / (t1 - t0);
    }
    known = std::make_shared<const MeanVoltage>(std::move(made));
    return known->mean_V;
}

// Of a wheel's motor, at the log's own times.
const std::vector<double> &Forward::voltage_integral(std::size_t wheel, double lag_s) const {
    const WheelInput &in = data_->wheel[wheel];
    if (in.duty.empty() || (lag_s == 0 && !in.voltage_integral_Vs.empty())) return in.voltage_integral_Vs;
    auto &[known, other] = voltage_integral_[wheel];
    if (!known || known->lag_s != lag_s) std::swap(known, other);
    if (!known || known->lag_s != lag_s) known = std::make_shared<const SumVoltage>(SumVoltage{lag_s, data_->voltage_integral(in, lag_s)});
    return known->sum_Vs;
}

// The same over parts of each row.
std::vector<double> Forward::voltage_parts(std::size_t balance, double delay_s, double lag_s) const {
    const Balance &b = data_->balance[balance];
    const WheelInput &in = data_->wheel[static_cast<std::size_t>(b.wheel)];
    VoltageIntegral integral_to(in.voltage_t_s, voltage_integral(static_cast<std::size_t>(b.wheel), lag_s));
    std::vector<double> out;
    for (std::size_t r = 0; r < b.measured.size(); ++r) {
        const std::size_t parts = parts_of(b.t1_s[r] - b.t0_s[r]);
        const double t0 = b.t0_s[r] - delay_s - lag_s, part = std::max((b.t1_s[r] - b.t0_s[r]) / static_cast<double>(parts), 1e-6);
        for (std::size_t n = 0; n < parts; ++n) {
            const double from = integral_to(t0 + static_cast<double>(n) * part);
            out.push_back((integral_to(t0 + static_cast<double>(n + 1) * part) - from) / part);
        }
    }
    return out;
}

// (3) of forward.h: takes from the rows what dead time takes from the current. What flows follows from voltage and speed alone.
void Forward::dead_zone(const Physics &physics, std::size_t wheel, std::size_t balance, Eigen::Ref<Eigen::VectorXd> rows) const {
    const Dataset &d = *data_;
    const Balance &b = d.balance[balance];
    const WheelPhysics &p = physics.wheel[wheel];
    const std::vector<double> voltage = voltage_parts(balance, current_delay_s(physics.body), command_delay_s(physics.body));
    const double offset = sim::law::current_offset(p.current_offset0, p.current_offset_A), last = static_cast<double>(d.count - 2);
    std::size_t at = 0;
    for (std::size_t r = 0; r < b.measured.size(); ++r) {
        const std::size_t parts = parts_of(b.t1_s[r] - b.t0_s[r]);
        double taken = 0;
        for (std::size_t n = 0; n < parts; ++n, ++at) {
            const double t = b.t0_s[r] + (static_cast<double>(n) + 0.5) / static_cast<double>(parts) * (b.t1_s[r] - b.t0_s[r]) -
                             current_delay_s(physics.body);
            const double x = std::clamp((t - d.start_s) / d.step_s, 0.0, last);
            const auto k = static_cast<std::size_t>(x);
            const double f = x - static_cast<double>(k);
            const double per_V = electric_->per_V[k] + f * (electric_->per_V[k + 1] - electric_->per_V[k]),
                         lost = electric_->lost[k] + f * (electric_->lost[k + 1] - electric_->lost[k]);
            const double free = per_V * voltage[at] - lost - offset,
                         most = per_V * sim::law::voltage_gain(1, physics.body.voltage_gain) * p.dead_voltage_V;
            taken += sim::law::bridge_dead_time_V(most, free, bridge_current_A);
        }
        rows[static_cast<Eigen::Index>(r)] -= taken / static_cast<double>(parts);
    }
}

std::size_t Forward::balance_of(BalanceKind kind, std::size_t wheel) const {
    std::size_t b = 0;
    while (b < data_->balance.size() && (data_->balance[b].kind != kind || data_->balance[b].wheel != static_cast<int>(wheel))) ++b;
    return b;
}

const std::vector<double> &Forward::shaft_traction(const Physics &physics, const Motion &motion, std::size_t wheel,
                                                   std::vector<double> &sum) {
    std::size_t turned = 0;
    each_wheel_of(physics, wheel, [&](std::size_t) { ++turned; });
    if (turned == 1) return motion.wheel[wheel].traction_N;
    sum.assign(motion.wheel[wheel].traction_N.size(), 0);
    const double own = rolling_radius(physics.wheel[wheel]);
    each_wheel_of(physics, wheel, [&](std::size_t i) {
        const double arm = rolling_radius(physics.wheel[i]) / own;
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += arm * motion.wheel[i].traction_N[k];
    });
    return sum;
}

// The torque balance's change where only the traction differs from the base motion's: (17) is linear in it.
void Forward::torque_of_traction(const Physics &physics, const Motion &motion, std::size_t wheel, Eigen::VectorXd &out) const {
    const std::size_t balance = balance_of(BalanceKind::current_torque, wheel);
    if (balance == data_->balance.size()) return;
    const WheelPhysics &p = physics.wheel[wheel];
    const double radius = rolling_radius(p), KG = sim::motor_constant(p.KG, p, 0), factor = sim::law::current_gain(1, p.current_gain);
    if (!(KG > 0)) return;
    const double per_N = factor * radius / KG, gain = count_gain(p);
    const bool by_load = sim::load_friction_Nm(p, 1, 1) != 0;
    const std::vector<double> &now = shaft_traction(physics, motion, wheel, *shaft_now_),
                              &before = shaft_traction(physics, *base_motion_, wheel, *shaft_before_);
    series_->resize(data_->count);
    for (std::size_t k = 0; k < data_->count; ++k) {
        (*series_)[k] = per_N * (now[k] - before[k]);
        if (by_load) { // in proportion to the load: its slope
            const double speed = data_->wheel[wheel].speed_rad_s[k];
            (*series_)[k] += per_N * sim::load_friction_Nm(p, 1, gain * speed) * (std::fabs(now[k]) - std::fabs(before[k])) *
                             soft_sign(speed, friction_share * data_->standstill_rad_s);
        }
        if (physics.unsigned_current && base_current_[wheel][k] < 0) (*series_)[k] = -(*series_)[k];
    }
    rows_of(balance, *series_, current_delay_s(physics.body), true, out);
}

Signals Forward::signals_of(const Physics &physics, const Motion &motion, std::size_t wheel, std::size_t k,
                            const std::vector<std::vector<double>> &current) const {
    const Dataset &d = *data_;
    const WheelInput &in = d.wheel[wheel];
    const double gain = count_gain(physics.wheel[wheel]);
    Signals s;
    s.t = d.time(k), s.w = gain * in.speed_rad_s[k], s.theta = gain * in.angle_rad[k];
    double turned = 0; // loads and tractions add up, speeds, slips and places are means
    each_wheel_of(physics, wheel, [&](std::size_t i) {
        const Motion::Wheel &m = motion.wheel[i];
        s.v += m.ground_speed_m_s[k], s.s += m.slip[k], s.Fn += m.load_N[k], s.Ft += m.traction_N[k], s.x += physics.wheel[i].x, ++turned;
    });
    s.v /= turned, s.s /= turned, s.x = motion.path_m[k] + s.x / turned;
    s.a = motion.accel_m_s2[k], s.V = motion.v_m_s[k], s.r = motion.yaw_rate_rad_s[k];
    s.u = in.voltage_V.empty() ? 0 : in.voltage_V[k] / sim::law::voltage_gain(1, physics.body.voltage_gain);
    s.X = motion.path_m[k], s.d = in.travel_rad.empty() ? 0 : gain * in.travel_rad[k], s.Io = s.Ia = s.Is = 0;
    for (std::size_t j = 0; j < current.size(); ++j) {
        if (j == wheel || current[j].size() != d.count) continue;
        s.Io += current[j][k];
        if (same_axle(physics.wheel[wheel], physics.wheel[j])) s.Ia += current[j][k];
        if (same_side(physics.wheel[wheel], physics.wheel[j])) s.Is += current[j][k];
    }
    return s;
}

void Forward::currents_for_terms(const Physics &physics, const Motion &motion) const {
    term_current_.clear();
    if (!asks_for_others(physics)) return;
    lead_current_.clear(); // a lead takes nothing from a winding's current, which follows from the torque
    Physics without = physics;
    std::erase_if(without.terms, follows_others);
    std::vector<std::vector<double>> current(physics.wheel.size());
    for (const Physics *at : std::initializer_list<const Physics *>{&without, &physics}) {
        for (std::size_t i = 0; i < physics.wheel.size(); ++i)
            if (is_motor(physics, i)) electric_series(*at, motion, i, current[i], *electric_);
        term_current_ = current;
    }
}

void Forward::share_leads(const Physics &physics, const Motion &motion) const {
    currents_for_terms(physics, motion);
    lead_current_.clear();
    if (!shares_leads(physics)) return;
    std::vector<std::vector<double>> current(physics.wheel.size());
    for (std::size_t i = 0; i < physics.wheel.size(); ++i)
        if (is_motor(physics, i)) electric_series(physics, motion, i, current[i], *electric_);
    lead_current_ = std::move(current);
}

double Forward::current_of_others(const Physics &physics, std::size_t wheel, std::size_t k) const {
    double sum = 0;
    for (std::size_t j = 0; j < lead_current_.size(); ++j)
        if (j != wheel && !lead_current_[j].empty() &&
            sim::law::shares_lead(physics.wheel[wheel].shared_with, same_axle(physics.wheel[wheel], physics.wheel[j]),
                                  same_side(physics.wheel[wheel], physics.wheel[j])))
            sum += lead_current_[j][k];
    return sum;
}

void Forward::electric_series(const Physics &physics, const Motion &motion, std::size_t wheel, std::vector<double> &current,
                              ElectricSeries &out) const {
    const Dataset &d = *data_;
    std::vector<const ExtraTerm *> terms;
    for (const ExtraTerm &term : physics.terms)
        if ((target_stages(term.target) & (stage_torque | stage_voltage)) != 0 && (term.wheel < 0 || term.wheel == static_cast<int>(wheel)))
            terms.push_back(&term);
    current.resize(d.count);
    for (auto *series : {&out.reading, &out.lost, &out.per_V, &out.shaft}) series->resize(d.count);
    const WheelPhysics &p = physics.wheel[wheel];
    const bool drives = sim::motor_constant(p.KG, p, 0) > 0 && sim::circuit_ohm(p.Ra, p) > 0;
    if (p.heating_K_W != 0 || !terms.empty() || !lead_current_.empty())
        electric_steps<false, false>(physics, motion, wheel, terms, current, out);
    else if (drives && !physics.unsigned_current && is_smooth(p))
        electric_steps<true, true>(physics, motion, wheel, terms, current, out);
    else
        electric_steps<true, false>(physics, motion, wheel, terms, current, out);
}

// cold: nothing heats, no lead is shared, and there are no terms: then most of it is the same at every step. smooth: cold, and no law of
// the motor that has a branch or a library's function in it: then several steps go at once.
template <bool cold, bool smooth>
void Forward::electric_steps(const Physics &physics, const Motion &motion, std::size_t wheel, const std::vector<const ExtraTerm *> &terms,
                             std::vector<double> &current, ElectricSeries &out) const {
    const Dataset &d = *data_;
    WheelPhysics p = physics.wheel[wheel]; // a copy: what is written below cannot change it
    if (smooth)                            // as they are already: so that the compiler knows
        p.stribeck_Nm = p.wear_in_Nm = p.reverse_Nm = p.churning_Nms2 = p.ripple_cos_Nm = p.ripple_sin_Nm = p.speed_loss_s = 0;
    const WheelInput &in = d.wheel[wheel];
    const double *const traction = shaft_traction(physics, motion, wheel, *shaft_now_).data();
    const double *const speed_rad_s = in.speed_rad_s.data(), *const accel_rad_s2 = in.accel_rad_s2.data(),
                        *const angle_rad = in.angle_rad.data();
    double *const __restrict winding_A = current.data(), *const __restrict shaft_Nm = out.shaft.data(),
                             *const __restrict reading_A = out.reading.data(), *const __restrict per_V_A = out.per_V.data(),
                             *const __restrict lost_A = out.lost.data();
    const double gain = count_gain(p), radius = rolling_radius(p), soft_rad_s = friction_share * d.standstill_rad_s;
    const double by_voltage = sim::law::voltage_gain(1, physics.body.voltage_gain);
    const bool unsigned_current = !smooth && physics.unsigned_current;
    double heat_K = 0, start_s = d.start_s;
    std::size_t run = 0; // the next that begins, its windings cold and its gears as at first
    for (std::size_t k = 0, count = d.count; k < count; ++k) {
        const double w = gain * speed_rad_s[k], dw = gain * accel_rad_s2[k];
        if (!smooth)
            for (; run < d.run_start_s.size() && d.run_start_s[run] <= d.time(k); ++run) heat_K = 0, start_s = d.run_start_s[run];
        double KG = sim::motor_constant(p.KG, p, heat_K), ke = sim::motor_constant(p.ke, p, heat_K);
        double Ra = sim::law::hot_resistance_ohm(p.Ra, heat_K), u_lost = 0;
        if (!cold && !lead_current_.empty()) u_lost += sim::law::shared_lead_V(p.shared_ohm, current_of_others(physics, wheel, k));
        const double viscous = sim::viscous_friction_Nm(p.b, p, std::fabs(w)), angle = gain * angle_rad[k];
        const double friction = sim::dry_friction_Nm<law::Library>(viscous + p.t0, p, w, radius * traction[k], d.time(k) - start_s);
        const double side = soft_sign(w, soft_rad_s);
        double gear = friction * side, current_factor = sim::law::current_gain(1, p.current_gain);
        gear += sim::periodic_Nm<law::Library>(p, angle, false) + sim::periodic_Nm<law::Library>(p, angle, true) * side;
        if (!cold && !terms.empty()) {
            Signals s = signals_of(physics, motion, wheel, k, term_current_);
            s.I = KG > 0 ? (gear + p.J * dw + radius * traction[k]) / KG : 0;
            for (const ExtraTerm *term : terms) {
                const double f = term->term->value(s, term->coefficients.data());
                if (term->target == TermTarget::wheel_torque)
                    gear += f;
                else if (term->target == TermTarget::wheel_friction)
                    gear += f * side;
                else if (term->target == TermTarget::voltage)
                    u_lost += f;
                else if (term->target == TermTarget::motor_constant)
                    KG *= 1 + f, ke *= 1 + f;
                else if (term->target == TermTarget::resistance)
                    Ra *= std::max(0.05, 1 + f);
                else if (term->target == TermTarget::current)
                    current_factor *= 1 + f;
            }
        }
        const double I = smooth || KG > 0 ? (gear + p.J * dw + radius * traction[k]) / KG : 0;
        winding_A[k] = I;
        shaft_Nm[k] = radius * traction[k] + gear; // the shaft sensor's: friction of the wheel's own bearing included
        const double I_read = sim::law::current_offset(current_factor * I + p.current_offset0, p.current_offset_A);
        reading_A[k] = unsigned_current ? std::fabs(I_read) : I_read;
        const double ohm = sim::circuit_ohm(Ra, p), per_V = smooth || ohm > 0 ? current_factor / ohm : 0;
        per_V_A[k] = per_V / by_voltage;
        lost_A[k] = sim::law::current_offset(per_V * (u_lost + ke * w) - p.current_offset0, -p.current_offset_A);
        if (!cold) heat_K += d.step_s / p.heating_time_s * sim::heating_gap_K(p, I, p.Ra, heat_K);
    }
}

void Forward::electrical(const Physics &physics, const Motion &motion, std::size_t wheel, unsigned stages, std::vector<double> &current,
                         Eigen::VectorXd &out) const {
    const Dataset &d = *data_;
    const std::size_t torque_balance = balance_of(BalanceKind::current_torque, wheel),
                      voltage_balance = balance_of(BalanceKind::current_voltage, wheel),
                      bench_balance = balance_of(BalanceKind::torque, wheel);
    const bool with_torque = torque_balance < d.balance.size(), with_voltage = voltage_balance < d.balance.size(),
               with_bench = bench_balance < d.balance.size();
    if (!with_torque && !with_voltage && !with_bench) return;
    electric_series(physics, motion, wheel, current, *electric_);
    if (with_torque && (stages & stage_torque) != 0) rows_of(torque_balance, electric_->reading, current_delay_s(physics.body), false, out);
    if (with_voltage && (stages & (stage_voltage | stage_torque)) != 0) {
        const Eigen::VectorXd &voltage = mean_voltage(voltage_balance, current_delay_s(physics.body), command_delay_s(physics.body));
        auto rows = out.segment(static_cast<Eigen::Index>(first_row_[voltage_balance]), voltage.size());
        rows_of(voltage_balance, electric_->per_V, current_delay_s(physics.body), false, out);
        const Eigen::VectorXd through = rows.cwiseProduct(voltage);
        rows_of(voltage_balance, electric_->lost, current_delay_s(physics.body), false, out);
        rows = through - rows;
        if (physics.wheel[wheel].dead_voltage_V != 0) dead_zone(physics, wheel, voltage_balance, rows);
        if (physics.unsigned_current) rows = rows.cwiseAbs();
    }
    if (with_bench) rows_of(bench_balance, electric_->shaft, 0, false, out);
}

// A Doppler radar whose window holds several speeds reads one that leans to the faster: the mean and a share of their range.
void Forward::lead(std::size_t balance, const std::vector<double> &series, double share, double delay_s, Eigen::VectorXd &out) const {
    const Balance &b = data_->balance[balance];
    const auto place = [&](double t) {
        return static_cast<std::ptrdiff_t>(
            std::clamp((t - delay_s - data_->start_s) / data_->step_s, 0.0, static_cast<double>(data_->count - 1)));
    };
    for (std::size_t r = 0; r < b.measured.size(); ++r) {
        const auto [low, high] = std::minmax_element(series.begin() + place(b.t0_s[r]), series.begin() + place(b.t1_s[r]) + 1);
        out[static_cast<Eigen::Index>(first_row_[balance] + r)] += share * (*high - *low);
    }
}

void Forward::sensors(const Physics &physics, const Motion &motion, Eigen::VectorXd &out) const {
    const Dataset &d = *data_;
    const BodyPhysics &b = physics.body;
    std::vector<double> &x = *series_;
    x.resize(d.count);
    Signals s;
    const auto factor = [&](TermTarget target, std::size_t k) {
        double f = 1;
        for (const ExtraTerm &term : physics.terms) {
            if (term.target != target) continue;
            s.t = d.time(k), s.v = s.V = motion.v_m_s[k], s.x = s.X = motion.path_m[k], s.a = motion.accel_m_s2[k],
            s.r = motion.yaw_rate_rad_s[k];
            f += term.term->value(s, term.coefficients.data());
        }
        return f;
    };
    const auto offset = [&](std::size_t k, double RunPhysics::*own, double shared) {
        const RunPhysics *run = run_at(physics, d.time(k));
        return run == nullptr ? shared : own_or(run->*own, shared);
    };
    for (std::size_t i = 0; i < d.balance.size(); ++i) {
        const BalanceKind kind = d.balance[i].kind;
        double delay = 0;
        if (kind == BalanceKind::accel) {
            delay = sim::law::accel_delay_s(b.accel_delay0, b.accel_delay_s);
            const double ahead_m = b.accel_ahead0 + b.accel_ahead_m, left_m = b.accel_left0 + b.accel_left_m;
            const auto thrown = [&](double a, std::size_t k) {
                if (ahead_m == 0 && left_m == 0) return a;
                const std::vector<double> &r = motion.yaw_rate_rad_s;
                const std::size_t from = k > 0 ? k - 1 : k, to = std::min(k + 1, d.count - 1);
                const double rate = (r[to] - r[from]) / (static_cast<double>(to - from) * d.step_s);
                return sim::law::accel_place(a, ahead_m, left_m, r[k], rate);
            };
            double lagged = 0, before = 0;
            const double share = 1 - std::exp(-d.step_s / sim::law::accel_tilt_lag_s);
            for (std::size_t k = 0; k < d.count; ++k) {
                const double a = motion.accel_m_s2[k];
                lagged += share * (0.5 * (a + before) - lagged);
                before = a;
                const double tilted = sim::law::accel_tilt(thrown(a, k), b.gravity, b.accel_tilt_rad_s2_m, lagged);
                const double read = tilted * sim::law::accel_scale(1, b.accel_scale) + offset(k, &RunPhysics::accel_bias, b.accel_bias0);
                x[k] = sim::law::accel_drift(sim::law::accel_bias(read, b.accel_bias_m_s2), b.accel_drift_m_s3, d.time(k)) +
                       factor(TermTarget::accel, k) - 1;
            }
            low_pass(x, sim::law::accel_lag_s(b.accel_lag0, b.accel_lag_s) / d.step_s);
        } else if (kind == BalanceKind::radar) {
            delay = sim::law::radar_delay_s(b.radar_delay, b.radar_delay_s);
            for (std::size_t k = 0; k < d.count; ++k)
                x[k] = std::fabs(motion.v_m_s[k]) * sim::law::radar_scale(1 + b.radar_scale0, b.radar_scale) *
                       sim::law::radar_pitch(b.radar_pitch_s2_m, motion.accel_m_s2[k]) * factor(TermTarget::radar, k);
        } else if (kind == BalanceKind::camera_x || kind == BalanceKind::camera_y || kind == BalanceKind::camera_yaw) {
            delay = sim::law::camera_delay_s(b.camera_delay0, b.camera_delay_s);
            const auto &source = kind == BalanceKind::camera_x   ? motion.v_m_s
                                 : kind == BalanceKind::camera_y ? motion.vy_m_s
                                                                 : motion.yaw_rate_rad_s;
            const double scale = kind == BalanceKind::camera_yaw ? 1 : sim::law::camera_scale(1 + b.camera_scale0, b.camera_scale);
            for (std::size_t k = 0; k < d.count; ++k) x[k] = source[k] * scale * factor(TermTarget::camera, k);
        } else if (kind == BalanceKind::yaw_rate) {
            delay = sim::law::gyro_delay_s(0, b.gyro_delay_s);
            for (std::size_t k = 0; k < d.count; ++k)
                x[k] = motion.yaw_rate_rad_s[k] * sim::law::gyro_scale(1 + b.gyro_scale0, b.gyro_scale) +
                       offset(k, &RunPhysics::gyro_bias, b.gyro_bias);
        } else if (kind == BalanceKind::force) {
            const Motion::Wheel &w = motion.wheel[static_cast<std::size_t>(d.balance[i].wheel)];
            for (std::size_t k = 0; k < d.count; ++k) x[k] = w.traction_N[k] - w.rolling_N[k];
        } else {
            continue;
        }
        rows_of(i, x, delay, false, out);
        if (kind == BalanceKind::radar && b.radar_lead != 0) lead(i, x, b.radar_lead, delay, out);
        if (kind == BalanceKind::camera_x || kind == BalanceKind::camera_y || kind == BalanceKind::camera_yaw)
            for (std::size_t r = 0; r < d.balance[i].measured.size(); ++r)
                out[static_cast<Eigen::Index>(first_row_[i] + r)] *=
                    d.balance[i].t1_s[r] - d.balance[i].t0_s[r]; // a displacement, not a speed
    }
}

Eigen::VectorXd Forward::predict(const Physics &physics) {
    if (data_->count < 3) return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(row_count_));
    integrate(*data_, physics, *scratch_, have_base_ ? base_motion_.get() : nullptr, false);
    return observe(physics, *scratch_);
}

Eigen::VectorXd Forward::predict(const Physics &physics, unsigned touched) {
    if (base_motion_->tangent.empty() || physics.unsigned_current || (touched & stage_motion) == 0) return predict(physics);
    integrate(*data_, physics, *scratch_, base_motion_.get(), false);
    Eigen::VectorXd out = base_prediction_;
    observe_beside(physics, *scratch_, touched, -1, out);
    return out;
}

void Forward::observe_beside(const Physics &physics, const Motion &motion, unsigned touched, int wheel, Eigen::VectorXd &out) const {
    const bool moves = (touched & stage_motion) != 0, electric = (touched & (stage_torque | stage_voltage)) != 0,
               terms = has_electric_terms(physics), shared = shares_leads(physics) || asks_for_others(physics);
    const unsigned stages = moves ? stage_torque | stage_voltage : touched;
    share_leads(physics, motion);
    for (std::size_t i = 0; i < physics.wheel.size(); ++i) {
        const WheelPhysics &p = physics.wheel[i];
        const bool whole = electric && (wheel < 0 || shared || motor_of(physics, static_cast<std::size_t>(wheel)) == i);
        if (whole || (moves && (terms || shared || sim::needs_any(p, sim::needs_heat))))
            electrical(physics, motion, i, stages, *current_, out);
        else if (moves)
            torque_of_traction(physics, motion, i, out);
    }
    if (moves || (touched & stage_sensors) != 0) sensors(physics, motion, out);
}

Eigen::VectorXd Forward::observe(const Physics &physics, const Motion &motion) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(row_count_));
    share_leads(physics, motion);
    for (std::size_t i = 0; i < physics.wheel.size(); ++i) electrical(physics, motion, i, stage_torque | stage_voltage, *current_, out);
    sensors(physics, motion, out);
    return out;
}

void Forward::set_base(const Physics &physics) {
    base_prediction_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(row_count_));
    if (data_->count < 3) return;
    integrate(*data_, physics, *scratch_, have_base_ ? base_motion_.get() : nullptr, true);
    if (base_motion_.use_count() != 1) base_motion_ = std::make_shared<Motion>();
    std::swap(*base_motion_, *scratch_);
    have_base_ = true;
    base_physics_ = physics;
    linear_base_ = !base_motion_->tangent.empty() && has_neighbours(physics, physics);
    share_leads(physics, *base_motion_);
    for (std::size_t i = 0; i < physics.wheel.size(); ++i)
        electrical(physics, *base_motion_, i, stage_torque | stage_voltage, base_current_[i], base_prediction_);
    sensors(physics, *base_motion_, base_prediction_);
}

Eigen::VectorXd Forward::predict_from_base(const Physics &physics, unsigned touched, int wheel) {
    if (data_->count < 3) return base_prediction_;
    const bool moves = (touched & stage_motion) != 0;
    if (moves && !is_neighbour(physics, touched)) return predict(physics);
    if (moves) neighbour(*data_, physics, *base_motion_, wheel, has_electric_terms(physics), *scratch_);
    Eigen::VectorXd out = base_prediction_;
    observe_beside(physics, moves ? *scratch_ : *base_motion_, touched, wheel, out);
    return out;
}

bool Forward::is_neighbour(const Physics &physics, unsigned touched) const {
    return data_->count >= 3 && (touched & stage_motion) != 0 && linear_base_ && has_neighbours(base_physics_, physics);
}

Eigen::MatrixXd Forward::predict_neighbours(const std::vector<Physics> &moved, const std::vector<unsigned> &touched,
                                            const std::vector<int> &wheel) {
    std::vector<Beside> list;
    beside_->resize(std::max(beside_->size(), moved.size()));
    for (std::size_t i = 0; i < moved.size(); ++i) list.push_back({&moved[i], wheel[i], has_electric_terms(moved[i]), &(*beside_)[i]});
    neighbours(*data_, *base_motion_, list);
    Eigen::MatrixXd columns(base_prediction_.size(), static_cast<Eigen::Index>(moved.size()));
    Eigen::VectorXd out;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        out = base_prediction_;
        observe_beside(moved[i], (*beside_)[i], touched[i], wheel[i], out);
        columns.col(static_cast<Eigen::Index>(i)) = out;
    }
    return columns;
}

} // namespace traction::lab
