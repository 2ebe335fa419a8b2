// forward.h - what the model says the sensors should have read: semi-inverse output error.
//
// The encoder speeds (and motor voltage, yaw rate) are given; the body's speed is integrated from the model's forces:
//   M dv/dt = sum_i (Ft_i - Rr_i) + F_body, motion.h                                                                      (1)
//   torque balance:  KG*I = Gr(w) + J*dw/dt + R*Ft                                               (17) Lhomme-Desages
//   voltage balance: I = (duty*V - ke*w)/Ra, from clean voltage and speed, never from the noisy current              (2)
//     with dead time Vd of the bridge: I = e - Vd sgn(I) over Ra, e = duty*V - ke*w; hence none for |e| < Vd              (3)
// Stages are cached: a parameter that leaves the motion alone costs only the balances it touches; one that does not costs a linear
// recursion beside the base motion (tangent.cpp), unless a wheel has play (backlash), begins or ceases to lag (a relaxation length from or
// to zero), or the motion is imposed: then a whole integration.
#pragma once

#include "motion.h"
#include "windows.h"

#include <Eigen/Core>

#include <memory>
#include <utility>
#include <vector>

namespace traction::lab {

// What is written before it is read, call by call: a copy begins without it, for it is megabytes.
template <typename T> class Scratch {
  public:
    Scratch() = default;
    Scratch(const Scratch &) {}
    Scratch &operator=(const Scratch &) { return *this; }
    Scratch(Scratch &&) noexcept = default;
    Scratch &operator=(Scratch &&) noexcept = default;
    ~Scratch() = default;
    T &operator*() { return here_; }
    T *operator->() { return &here_; }

  private:
    T here_;
};

// True where no wheel's current remembers or bends: the torque balance follows the tractions, the voltage balance does not.
bool plain_currents(const Physics &physics);

class Forward {
  public:
    explicit Forward(const Dataset &data);

    // Predictions of every row of every balance, in the order of data.balance.
    Eigen::VectorXd predict(const Physics &physics);
    // The same where only the stages in `touched` (see Stage) differ from the base's, by any amount.
    Eigen::VectorXd predict(const Physics &physics, unsigned touched);

    // The same to first order, beside `base`, the prediction of the last set_base().
    Eigen::VectorXd predict_from_base(const Physics &physics, unsigned touched, int wheel); // wheel -1: any
    // True where that is a recursion beside the base (neighbour() of motion.h): then several cost less in one pass, a column each.
    bool is_neighbour(const Physics &physics, unsigned touched) const;
    Eigen::MatrixXd predict_neighbours(const std::vector<Physics> &moved, const std::vector<unsigned> &touched,
                                       const std::vector<int> &wheel);
    // What one unit of each coefficient of a shape f(X) changes in each row, beside the base: of a shape that moves the body, and of one of
    // the torque and voltage balances alone. Holds where nothing but the motion remembers (no heating, no other terms).
    // each_wheel: of the shape on each wheel alone, one after the other (wheels x count columns, at most most_shapes).
    Eigen::MatrixXd shaped(const Physics &base, const UnitResponse &unit, const Term &term, std::size_t count, bool each_wheel = false);
    struct ElectricSeries {
        std::vector<double> reading, lost, per_V,
            shaft; // current by torque; by voltage: per_V times the motor's voltage, less what is lost
    };
    std::vector<ElectricSeries> electric_unit(const Physics &base, TermTarget target) const; // per wheel
    Eigen::MatrixXd shaped_electric(const Physics &base, const std::vector<ElectricSeries> &unit, const Term &term,
                                    std::size_t count) const;
    void set_base(const Physics &physics);
    // Of the same data: its motion is the first guess, and what follows from delays alone need not be found again.
    void start_near(const Forward &other) {
        base_motion_ = other.base_motion_, have_base_ = other.have_base_;
        windows_ = other.windows_, mean_voltage_ = other.mean_voltage_, voltage_integral_ = other.voltage_integral_;
    }
    const Eigen::VectorXd &base() const { return base_prediction_; }
    bool has_linear_base() const { return linear_base_; }
    const Motion &motion() const { return *base_motion_; }
    const std::vector<std::vector<double>> &winding_current_A() const { return base_current_; } // per wheel, torque balance

    std::size_t rows() const { return row_count_; }
    std::size_t first_row(std::size_t balance) const { return first_row_[balance]; }

  private:
    Eigen::VectorXd observe(const Physics &physics, const Motion &motion) const;
    // Rows of the base's prediction that another motion and the stages touched change.
    void observe_beside(const Physics &physics, const Motion &motion, unsigned touched, int wheel, Eigen::VectorXd &out) const;
    void electrical(const Physics &physics, const Motion &motion, std::size_t wheel, unsigned stages, std::vector<double> &current,
                    Eigen::VectorXd &out) const;
    void electric_series(const Physics &physics, const Motion &motion, std::size_t wheel, std::vector<double> &current,
                         ElectricSeries &out) const;
    template <bool cold, bool smooth>
    void electric_steps(const Physics &physics, const Motion &motion, std::size_t wheel, const std::vector<const ExtraTerm *> &terms,
                        std::vector<double> &current, ElectricSeries &out) const;
    // The traction at the motor's own wheel that would brake the motor as its wheels do together, each by its radius; where it turns no
    // other wheel, that wheel's own. `sum`: where it goes when there are several.
    static const std::vector<double> &shaft_traction(const Physics &physics, const Motion &motion, std::size_t wheel,
                                                     std::vector<double> &sum);
    // Currents of all wheels, for those that share a lead; nothing where none does.
    void share_leads(const Physics &physics, const Motion &motion) const;
    double current_of_others(const Physics &physics, std::size_t wheel, std::size_t k) const;
    // Winding currents of all motors, for the terms that ask for those of the others (theirs follow from what such terms leave out, and
    // once more with them: to first order of the terms); nothing where none asks.
    void currents_for_terms(const Physics &physics, const Motion &motion) const;
    // Of the torque and voltage terms, I left out; current: of all motors.
    Signals signals_of(const Physics &physics, const Motion &motion, std::size_t wheel, std::size_t k,
                       const std::vector<std::vector<double>> &current) const;
    void lead(std::size_t balance, const std::vector<double> &series, double share, double delay_s, Eigen::VectorXd &out) const;
    void sensors(const Physics &physics, const Motion &motion, Eigen::VectorXd &out) const;
    void torque_of_traction(const Physics &physics, const Motion &motion, std::size_t wheel, Eigen::VectorXd &out) const;
    // out = (or, adding, +=) the series' mean over each row's window
    void rows_of(std::size_t balance, const std::vector<double> &series, double delay_s, bool adding, Eigen::VectorXd &out) const;
    const Eigen::VectorXd &mean_voltage(std::size_t balance, double delay_s, double lag_s) const;
    std::vector<double> voltage_parts(std::size_t balance, double delay_s, double lag_s) const;
    const std::vector<double> &voltage_integral(std::size_t wheel, double lag_s) const;
    void dead_zone(const Physics &physics, std::size_t wheel, std::size_t balance, Eigen::Ref<Eigen::VectorXd> rows) const;
    std::size_t balance_of(BalanceKind kind, std::size_t wheel) const; // balance.size() when there is none

    const Dataset *data_;
    std::size_t row_count_ = 0;
    std::vector<std::size_t> first_row_;
    Physics base_physics_;
    std::shared_ptr<Motion> base_motion_; // of several copies, until one of them moves on: never written where another has it too
    Scratch<Motion> scratch_;
    mutable Scratch<std::vector<double>> series_, current_, shaft_now_, shaft_before_;
    mutable Scratch<ElectricSeries> electric_;
    mutable std::vector<std::vector<double>> lead_current_; // per wheel, where leads are shared
    mutable std::vector<std::vector<double>> term_current_; // per wheel, where terms ask for the others'
    Scratch<std::vector<Motion>> shaped_, beside_;
    mutable std::vector<Windows> windows_;
    std::vector<std::size_t> windows_of_; // per balance: currents are read in the same windows, at one delay
    struct MeanVoltage {
        double delay_s = 0, lag_s = 0;
        Eigen::VectorXd mean_V;
    };
    struct SumVoltage {
        double lag_s = 0;
        std::vector<double> sum_Vs;
    };
    template <typename T> using LastTwo = std::pair<std::shared_ptr<const T>, std::shared_ptr<const T>>; // the one asked for last first
    mutable std::vector<LastTwo<MeanVoltage>> mean_voltage_;                                             // per wheel
    mutable std::vector<LastTwo<SumVoltage>> voltage_integral_;                                          // per wheel
    std::vector<std::vector<double>> base_current_;
    Eigen::VectorXd base_prediction_;
    bool have_base_ = false, linear_base_ = false; // linear: its neighbours follow from its tangents
};

} // namespace traction::lab
