#include "terms.h"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace traction::lab {

namespace {

constexpr std::array<std::string_view, static_cast<std::size_t>(TermTarget::count)> target_names = {
    "wheel_torque", "wheel_friction", "wheel_force", "rolling_resistance", "body_force",   "voltage",       "soil_strength",
    "shear_slip",   "motor_constant", "resistance",  "sensor.accel",       "sensor.radar", "sensor.camera", "sensor.current"};

constexpr std::array<std::string_view, static_cast<std::size_t>(Axis::count)> axis_names = {"time",
                                                                                            "wheel speed",
                                                                                            "ground speed",
                                                                                            "slip",
                                                                                            "wheel load",
                                                                                            "wheel angle",
                                                                                            "path travelled",
                                                                                            "acceleration",
                                                                                            "winding current (model)",
                                                                                            "direction",
                                                                                            "absolute speed",
                                                                                            "yaw rate",
                                                                                            "place on the path",
                                                                                            "wheel angle since reversal",
                                                                                            "current of the other motors (model)",
                                                                                            "current of the motors of its axle (model)",
                                                                                            "current of the motors of its side (model)",
                                                                                            "absolute wheel speed",
                                                                                            "motor voltage (duty times battery)",
                                                                                            "wheel angle within a turn"};
constexpr std::array<std::string_view, static_cast<std::size_t>(Axis::count)> axis_units = {
    "s", "rad/s", "m/s", "1", "N", "rad", "m", "m/s^2", "A", "1", "m/s", "rad/s", "m", "rad", "A", "A", "A", "rad/s", "V", "rad"};

class Piecewise : public Term {
  public:
    Piecewise(Axis axis, std::vector<double> knots) : axis_(axis), knots_(std::move(knots)) {}
    double value(const Signals &signals, const double *c) const override {
        const double x = axis_value(axis_, signals);
        if (knots_.size() == 1 || !(x > knots_.front())) return c[0];
        if (x >= knots_.back()) return c[knots_.size() - 1];
        const auto upper = std::upper_bound(knots_.begin(), knots_.end(), x);
        const auto i = static_cast<std::size_t>(upper - knots_.begin());
        const double f = (x - knots_[i - 1]) / (knots_[i] - knots_[i - 1]);
        return c[i - 1] + f * (c[i] - c[i - 1]);
    }
    void weights(const Signals &signals, std::size_t count, double *weight) const override {
        const double x = axis_value(axis_, signals);
        std::fill(weight, weight + count, 0.0);
        std::size_t i = 1;
        while (i < knots_.size() && x >= knots_[i]) ++i;
        if (i == knots_.size()) --i;
        const double f = knots_.size() == 1 ? 1 : std::clamp((x - knots_[i - 1]) / (knots_[i] - knots_[i - 1]), 0.0, 1.0);
        if (knots_.size() > 1) weight[i - 1] = 1 - f;
        weight[i] = f;
    }
    bool of_other_motors() const override { return is_of_other_motors(axis_); }

  private:
    Axis axis_;
    std::vector<double> knots_;
};

class Cells : public Term {
  public:
    Cells(Axis axis, double start, double length) : axis_(axis), start_(start), length_(length) {}
    double value(const Signals &signals, const double *c) const override {
        const double x = (axis_value(axis_, signals) - start_) / length_;
        return x >= 0 ? c[static_cast<std::size_t>(x)] : 0;
    }
    void weights(const Signals &signals, std::size_t count, double *weight) const override {
        const double x = (axis_value(axis_, signals) - start_) / length_;
        for (std::size_t j = 0; j < count; ++j) weight[j] = x >= static_cast<double>(j) && x < static_cast<double>(j + 1) ? 1 : 0;
    }

  private:
    Axis axis_;
    double start_, length_;
};

class Periodic : public Term {
  public:
    Periodic(Axis axis, double order) : axis_(axis), order_(order) {}
    double value(const Signals &signals, const double *c) const override {
        const double x = order_ * axis_value(axis_, signals);
        return c[0] * std::cos(x) + c[1] * std::sin(x);
    }
    void weights(const Signals &signals, std::size_t, double *weight) const override {
        const double x = order_ * axis_value(axis_, signals);
        weight[0] = std::cos(x), weight[1] = std::sin(x);
    }

  private:
    Axis axis_;
    double order_;
};

class Expression : public Term {
  public:
    Expression(const std::string &text, const std::vector<std::string> &parameters) : coefficients_(parameters.size()) {
        try {
            const std::array<std::pair<const char *, double *>, 18> names = {{{"t", &s_.t},
                                                                              {"w", &s_.w},
                                                                              {"v", &s_.v},
                                                                              {"s", &s_.s},
                                                                              {"Fn", &s_.Fn},
                                                                              {"theta", &s_.theta},
                                                                              {"x", &s_.x},
                                                                              {"a", &s_.a},
                                                                              {"I", &s_.I},
                                                                              {"u", &s_.u},
                                                                              {"Ft", &s_.Ft},
                                                                              {"V", &s_.V},
                                                                              {"r", &s_.r},
                                                                              {"X", &s_.X},
                                                                              {"d", &s_.d},
                                                                              {"Io", &s_.Io},
                                                                              {"Ia", &s_.Ia},
                                                                              {"Is", &s_.Is}}};
            for (const auto &[name, place] : names) parser_.DefineVar(name, place);
            for (std::size_t i = 0; i < parameters.size(); ++i) parser_.DefineVar(parameters[i], &coefficients_[i]);
            parser_.DefineConst("pi", M_PI);
            parser_.SetExpr(text);
            parser_.Eval(); // finds syntax errors and unknown names now
            const auto &used = parser_.GetUsedVar();
            of_others_ = used.count("Io") + used.count("Ia") + used.count("Is") > 0;
        } catch (const mu::Parser::exception_type &error) {
            throw std::runtime_error(error.GetMsg());
        }
    }
    double value(const Signals &signals, const double *c) const override {
        s_ = signals;
        std::copy(c, c + coefficients_.size(), coefficients_.begin());
        const double result = parser_.Eval();
        return std::isfinite(result) ? result : 0.0; // 1/0 at standstill is no force
    }
    bool of_other_motors() const override { return of_others_; }

  private:
    bool of_others_ = false;
    mutable Signals s_;
    mutable std::vector<double> coefficients_;
    mu::Parser parser_;
};

} // namespace

void Term::weights(const Signals &signals, std::size_t count, double *weight) const {
    std::vector<double> one(count, 0);
    for (std::size_t j = 0; j < count; ++j) {
        one[j] = 1;
        weight[j] = value(signals, one.data());
        one[j] = 0;
    }
}

std::string_view target_name(TermTarget target) { return target_names[static_cast<std::size_t>(target)]; }

bool parse_target(std::string_view name, TermTarget &target) {
    const auto found = std::find(target_names.begin(), target_names.end(), name);
    if (found == target_names.end()) return false;
    target = static_cast<TermTarget>(found - target_names.begin());
    return true;
}

bool acts_on_motor(TermTarget target) { return (target_stages(target) & (stage_torque | stage_voltage)) != 0; }

unsigned target_stages(TermTarget target) {
    switch (target) {
    case TermTarget::wheel_torque:
    case TermTarget::wheel_friction:
        return stage_torque;
    case TermTarget::wheel_force:
    case TermTarget::rolling:
    case TermTarget::body_force:
    case TermTarget::soil_strength:
    case TermTarget::shear_slip:
        return stage_motion;
    case TermTarget::voltage:
    case TermTarget::resistance:
        return stage_voltage;
    case TermTarget::motor_constant:
    case TermTarget::current:
        return stage_torque | stage_voltage;
    case TermTarget::accel:
    case TermTarget::radar:
    case TermTarget::camera:
        return stage_sensors;
    case TermTarget::count:
        break;
    }
    return stage_motion;
}

std::string_view axis_name(Axis axis) { return axis_names[static_cast<std::size_t>(axis)]; }
std::string_view axis_unit(Axis axis) { return axis_units[static_cast<std::size_t>(axis)]; }

double axis_value(Axis axis, const Signals &s) {
    switch (axis) {
    case Axis::time:
        return s.t;
    case Axis::wheel_speed:
        return s.w;
    case Axis::speed:
        return s.v;
    case Axis::slip:
        return s.s;
    case Axis::load:
        return s.Fn;
    case Axis::angle:
        return s.theta;
    case Axis::path:
        return s.x;
    case Axis::accel:
        return s.a;
    case Axis::current:
        return s.I;
    case Axis::direction:
        return s.v / std::sqrt(s.v * s.v + 1e-4);
    case Axis::abs_speed:
        return std::fabs(s.v);
    case Axis::yaw_rate:
        return s.r;
    case Axis::place:
        return s.X;
    case Axis::reversal:
        return s.d;
    case Axis::other_current:
        return s.Io;
    case Axis::axle_current:
        return s.Ia;
    case Axis::side_current:
        return s.Is;
    case Axis::abs_wheel_speed:
        return std::fabs(s.w);
    case Axis::voltage:
        return s.u;
    case Axis::turn:
        return std::remainder(s.theta, 2 * std::numbers::pi);
    case Axis::count:
        break;
    }
    return 0;
}

bool is_of_other_motors(Axis axis) { return axis == Axis::other_current || axis == Axis::axle_current || axis == Axis::side_current; }

std::shared_ptr<Term> make_piecewise(Axis axis, std::vector<double> knots) { return std::make_shared<Piecewise>(axis, std::move(knots)); }
std::shared_ptr<Term> make_cells(Axis axis, double start, double length) { return std::make_shared<Cells>(axis, start, length); }
std::shared_ptr<Term> make_periodic(Axis axis, double order) { return std::make_shared<Periodic>(axis, order); }
std::shared_ptr<Term> make_expression(const std::string &expression, const std::vector<std::string> &parameters) {
    return std::make_shared<Expression>(expression, parameters);
}

} // namespace traction::lab
