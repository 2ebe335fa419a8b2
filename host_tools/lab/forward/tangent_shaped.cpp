// Neighbours of a known motion by shapes f(X), (3) of motion.h for several right sides at once.
#include "motion.h"

#include "wheel_step.h"

#include <Eigen/Dense>

#include <array>

namespace traction::lab {

namespace {

// The recursion for `Lanes` shapes side by side.
template <int Lanes> class Shapes {
  public:
    using Lane = Eigen::Array<double, Lanes, 1>;
    using Lane3 = std::array<Lane, 3>;

    Shapes(const Dataset &data, const Physics &physics, const Motion &known, const UnitResponse &unit)
        : data_(data), known_(known), unit_(unit),
          freedom_(detail::freedom_of(data, physics)), per_N_{1 / physics.body.mass, freedom_.vy ? 1 / physics.body.mass : 0,
                                                              freedom_.yaw ? 1 / physics.body.yaw_inertia : 0} {
        const WheelStep step(data, physics);
        for (std::size_t i = 0; i < physics.wheel.size(); ++i) lags_[i] = step.lags(i);
        for (Lane3 *x : {&q_, &before_}) x->fill(Lane::Zero());
        slip_.fill(Lane::Zero());
        side_.fill(Lane::Zero());
    }

    // share: of this step, wheel by wheel.
    void step(std::size_t k, const double *share, std::vector<Motion> &motions) {
        const StepTangent &t = known_.tangent[k];
        const double implicit_step = (k < 2 ? 1.0 : 2.0 / 3) * data_.step_s;
        const std::size_t wheels = unit_.force.size(), lanes = motions.size();
        std::array<Lane, most_wheels> f;
        Lane3 force{Lane::Zero(), Lane::Zero(), Lane::Zero()}, right, known_part;
        for (std::size_t i = 0; i < wheels; ++i) {
            f[i].setZero();
            for (std::size_t j = 0; j < lanes; ++j) f[i][static_cast<Eigen::Index>(j)] = share[i * lanes + j];
            for (std::size_t c = 0; c < 3; ++c) {
                const auto at = static_cast<Eigen::Index>(c);
                force[c] += unit_.force[i][k][at] * f[i];
                if (lags_[i]) force[c] += known_.wheel[i].force_by_slip[k][at] * slip_[i] + known_.wheel[i].force_by_side[k][at] * side_[i];
            }
        }
        for (std::size_t c = 0; c < 3; ++c) {
            const auto at = static_cast<Eigen::Index>(c);
            right[c] = k < 2 ? q_[c] : Lane((4 * q_[c] - before_[c]) / 3);
            if (c == 2 && !freedom_.yaw) right[c].setZero();
            known_part[c] = right[c] + implicit_step * (per_N_[c] * force[c] + t.rate_by_accel[at] * accel_ + t.rate_by_path[at] * path_);
        }
        before_ = q_;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto at = static_cast<Eigen::Index>(c);
            q_[c] = t.inverse(at, 0) * known_part[0] + t.inverse(at, 1) * known_part[1] + t.inverse(at, 2) * known_part[2];
        }
        for (std::size_t i = 0; i < wheels; ++i) wheel(i, k, f[i], motions);
        accel_ = (q_[0] - right[0]) / implicit_step;
        body(k, motions);
    }

  private:
    void wheel(std::size_t i, std::size_t k, const Lane &f, std::vector<Motion> &motions) {
        const Motion::Wheel &w = known_.wheel[i];
        Lane traction = w.traction_N[k] + unit_.traction[i][k] * f + w.traction_by_accel[k] * accel_ + w.traction_by_path[k] * path_;
        for (std::size_t c = 0; c < 3; ++c) traction += w.traction_by_speed[k][static_cast<Eigen::Index>(c)] * q_[c];
        if (lags_[i]) {
            traction += w.traction_by_slip[k] * slip_[i] + w.traction_by_side[k] * side_[i];
            slip_[i] *= w.slip_by_slip[k];
            side_[i] *= w.side_by_side[k];
            for (std::size_t c = 0; c < 3; ++c) {
                slip_[i] += w.slip_by_speed[k][static_cast<Eigen::Index>(c)] * q_[c];
                side_[i] += w.side_by_speed[k][static_cast<Eigen::Index>(c)] * q_[c];
            }
        }
        for (std::size_t j = 0; j < motions.size(); ++j) motions[j].wheel[i].traction_N[k] = traction[static_cast<Eigen::Index>(j)];
    }

    void body(std::size_t k, std::vector<Motion> &motions) {
        const double v = known_.v_m_s[k], vy = known_.vy_m_s[k], turn = known_.yaw_rate_rad_s[k];
        Lane along = q_[0];
        if (freedom_.omni) along = ((v + q_[0]).square() + (vy + q_[1]).square()).sqrt() - std::hypot(v, vy);
        path_ += data_.step_s * along;
        Lane body_accel = known_.accel_m_s2[k] + accel_;
        if (freedom_.vy) body_accel += turn * vy - (turn + q_[2]) * (vy + q_[1]);
        for (std::size_t j = 0; j < motions.size(); ++j) {
            const auto at = static_cast<Eigen::Index>(j);
            Motion &m = motions[j];
            m.v_m_s[k] = v + q_[0][at];
            m.vy_m_s[k] = vy + q_[1][at];
            m.yaw_rate_rad_s[k] = turn + q_[2][at];
            m.path_m[k] = known_.path_m[k] + path_[at];
            m.accel_m_s2[k] = body_accel[at];
        }
    }

    const Dataset &data_;
    const Motion &known_;
    const UnitResponse &unit_;
    detail::Freedom freedom_;
    std::array<double, 3> per_N_;
    std::array<bool, most_wheels> lags_{};
    Lane3 q_, before_; // changes, as are the next
    Lane accel_ = Lane::Zero(), path_ = Lane::Zero();
    std::array<Lane, most_wheels> slip_, side_;
};

template <int Lanes>
void follow(const Dataset &data, const Physics &base, const Motion &known, const UnitResponse &unit, const std::vector<double> &share,
            std::vector<Motion> &motions) {
    Shapes<Lanes> shapes(data, base, known, unit);
    for (std::size_t k = 0; k < data.count; ++k) shapes.step(k, &share[k * base.wheel.size() * motions.size()], motions);
}

} // namespace

void neighbours_shaped(const Dataset &data, const Physics &base, const Motion &known, const UnitResponse &unit,
                       const std::vector<double> &share, std::vector<Motion> &motions) {
    for (Motion &m : motions) detail::resize(m, data.count, base.wheel.size(), false, false);
    if (motions.size() <= 2)
        follow<2>(data, base, known, unit, share, motions);
    else if (motions.size() <= 4)
        follow<4>(data, base, known, unit, share, motions);
    else if (motions.size() <= 6)
        follow<6>(data, base, known, unit, share, motions);
    else if (motions.size() <= most_shapes)
        follow<most_shapes>(data, base, known, unit, share, motions);
}

} // namespace traction::lab
