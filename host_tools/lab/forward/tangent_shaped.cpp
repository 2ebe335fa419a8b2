// Neighbours of a known motion by shapes f(X), (3) of motion.h for several right sides at once.
#include "motion.h"

#include "wheel_step.h"

#include "sim/physics/terramechanics.h"

#include <Eigen/Dense>

#include <array>

namespace traction::lab {

namespace {

// Four numbers side by side for each of `groups` groups of shapes.
template <std::size_t groups> struct Groups {
    std::array<Lane, groups> of;

    Groups() = default;
    TRACTION_LANE_INLINE explicit Groups(double all) { of.fill(Lane(all)); }
    template <typename Each> TRACTION_LANE_INLINE static Groups each(Each &&one) {
        Groups out;
        for (std::size_t g = 0; g < groups; ++g) out.of[g] = one(g);
        return out;
    }
    TRACTION_LANE_INLINE double operator[](std::size_t i) const { return of[i / 4][i % 4]; }
    TRACTION_LANE_INLINE void set(std::size_t i, double x) { of[i / 4].set(i % 4, x); }
    TRACTION_LANE_INLINE Groups &operator+=(const Groups &b) { return *this = *this + b; }
    TRACTION_LANE_INLINE Groups &operator*=(double b) { return *this = b * *this; }
    TRACTION_LANE_INLINE friend Groups operator+(const Groups &a, const Groups &b) {
        return each([&](std::size_t g) { return a.of[g] + b.of[g]; });
    }
    TRACTION_LANE_INLINE friend Groups operator-(const Groups &a, const Groups &b) {
        return each([&](std::size_t g) { return a.of[g] - b.of[g]; });
    }
    TRACTION_LANE_INLINE friend Groups operator*(const Groups &a, const Groups &b) {
        return each([&](std::size_t g) { return a.of[g] * b.of[g]; });
    }
    TRACTION_LANE_INLINE friend Groups operator+(double a, const Groups &b) {
        return each([&](std::size_t g) { return a + b.of[g]; });
    }
    TRACTION_LANE_INLINE friend Groups operator-(const Groups &a, double b) {
        return each([&](std::size_t g) { return a.of[g] - b; });
    }
    TRACTION_LANE_INLINE friend Groups operator*(double a, const Groups &b) {
        return each([&](std::size_t g) { return a * b.of[g]; });
    }
    TRACTION_LANE_INLINE friend Groups operator/(const Groups &a, double b) {
        return each([&](std::size_t g) { return a.of[g] / Lane(b); });
    }
    TRACTION_LANE_INLINE friend Groups root(const Groups &a) {
        return each([&](std::size_t g) { return sqrt(a.of[g]); });
    }
};

// The recursion for four shapes side by side, or twice as many.
template <std::size_t groups> class Shapes {
  public:
    using Lanes = Groups<groups>;
    using Lane3 = std::array<Lanes, 3>;

    Shapes(const Dataset &data, const Physics &physics, const Motion &known, const UnitResponse &unit)
        : data_(data), known_(known), unit_(unit),
          freedom_(detail::freedom_of(data, physics)), per_N_{1 / physics.body.mass, freedom_.vy ? 1 / physics.body.mass : 0,
                                                              freedom_.yaw ? 1 / physics.body.yaw_inertia : 0} {
        const WheelStep step(data, physics);
        for (std::size_t i = 0; i < physics.wheel.size(); ++i) lags_[i] = step.lags(i), order_[i] = step.order(i);
        for (Lane3 *x : {&q_, &before_}) x->fill(Lanes(0.0));
        slip_.fill(Lanes(0.0));
        side_.fill(Lanes(0.0));
        slip_before_.fill(Lanes(0.0));
        side_before_.fill(Lanes(0.0));
    }

    // share: of this step, wheel by wheel.
    [[gnu::always_inline]] inline void step(std::size_t k, const double *share, std::vector<Motion> &motions) {
        const StepTangent &t = known_.tangent[k];
        const double implicit_step = (k < 2 ? 1.0 : 2.0 / 3) * data_.step_s;
        const std::size_t wheels = unit_.force.size(), lanes = motions.size();
        std::array<Lanes, most_wheels> f;
        Lane3 force{Lanes(0.0), Lanes(0.0), Lanes(0.0)}, right, known_part;
        for (std::size_t i = 0; i < wheels; ++i) {
            f[i] = Lanes(0.0);
            for (std::size_t j = 0; j < lanes; ++j) f[i].set(j, share[i * lanes + j]);
            for (std::size_t c = 0; c < 3; ++c) {
                const auto at = static_cast<Eigen::Index>(c);
                force[c] += unit_.force[i][k][at] * f[i];
                if (lags_[i])
                    force[c] += known_.wheel[i].force_by_slip[k][at] * remembered(k, order_[i], slip_[i], slip_before_[i]) +
                                known_.wheel[i].force_by_side[k][at] * remembered(k, order_[i], side_[i], side_before_[i]);
            }
        }
        if (freedom_.observed && k >= data_.yaw_late) { // the gyro, on the change
            Lanes pull(0.0);
            for (std::size_t j = 0, past = k - data_.yaw_late; j < lanes; ++j)
                pull.set(j, detail::observer_1_s * (known_.yaw_rate_rad_s[past] - motions[j].yaw_rate_rad_s[past]));
            force[2] += pull / per_N_[2];
        }
        for (std::size_t c = 0; c < 3; ++c) {
            const auto at = static_cast<Eigen::Index>(c);
            right[c] = k < 2 ? q_[c] : (4 * q_[c] - before_[c]) / 3;
            if (c == 2 && !freedom_.yaw) right[c] = Lanes(0.0);
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
    void wheel(std::size_t i, std::size_t k, const Lanes &f, std::vector<Motion> &motions) {
        const Motion::Wheel &w = known_.wheel[i];
        Lanes traction = w.traction_N[k] + unit_.traction[i][k] * f + w.traction_by_accel[k] * accel_ + w.traction_by_path[k] * path_;
        for (std::size_t c = 0; c < 3; ++c) traction += w.traction_by_speed[k][static_cast<Eigen::Index>(c)] * q_[c];
        if (lags_[i]) {
            const Lanes slip = remembered(k, order_[i], slip_[i], slip_before_[i]),
                        side = remembered(k, order_[i], side_[i], side_before_[i]);
            traction += w.traction_by_slip[k] * slip + w.traction_by_side[k] * side;
            slip_before_[i] = slip_[i], side_before_[i] = side_[i];
            slip_[i] = w.slip_by_slip[k] * slip;
            side_[i] = w.side_by_side[k] * side;
            for (std::size_t c = 0; c < 3; ++c) {
                slip_[i] += w.slip_by_speed[k][static_cast<Eigen::Index>(c)] * q_[c];
                side_[i] += w.side_by_speed[k][static_cast<Eigen::Index>(c)] * q_[c];
            }
        }
        for (std::size_t j = 0; j < motions.size(); ++j) motions[j].wheel[i].traction_N[k] = traction[j];
    }

    void body(std::size_t k, std::vector<Motion> &motions) {
        const double v = known_.v_m_s[k], vy = known_.vy_m_s[k], turn = known_.yaw_rate_rad_s[k];
        Lanes along = q_[0];
        if (freedom_.omni) along = root((v + q_[0]) * (v + q_[0]) + (vy + q_[1]) * (vy + q_[1])) - std::hypot(v, vy);
        path_ += data_.step_s * along;
        Lanes body_accel = known_.accel_m_s2[k] + accel_;
        if (freedom_.vy) body_accel += Lanes(turn * vy) - (turn + q_[2]) * (vy + q_[1]);
        for (std::size_t j = 0; j < motions.size(); ++j) {
            Motion &m = motions[j];
            m.v_m_s[k] = v + q_[0][j];
            m.vy_m_s[k] = vy + q_[1][j];
            m.yaw_rate_rad_s[k] = turn + q_[2][j];
            m.path_m[k] = known_.path_m[k] + path_[j];
            m.accel_m_s2[k] = body_accel[j];
        }
    }

    const Dataset &data_;
    const Motion &known_;
    const UnitResponse &unit_;
    detail::Freedom freedom_;
    std::array<double, 3> per_N_;
    std::array<bool, most_wheels> lags_{};
    std::array<double, most_wheels> order_{};
    Lane3 q_, before_; // changes, as are the next
    Lanes accel_ = Lanes(0.0), path_ = Lanes(0.0);
    std::array<Lanes, most_wheels> slip_, side_, slip_before_, side_before_;
};

template <std::size_t groups> struct Pass {
    const Dataset &data;
    const Physics &base;
    const Motion &known;
    const UnitResponse &unit;
    const std::vector<double> &share;
    std::vector<Motion> &motions;

    // The same operations, none contracted: the same bits.
    [[gnu::flatten]] void narrow() const { follow(); }
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    [[gnu::target("avx2"), gnu::flatten]] void wide() const { follow(); }
#else
    void wide() const { narrow(); }
#endif

    void run() const {
        static const bool has_wide = sim::has(sim::Vectors::avx2);
        has_wide ? wide() : narrow();
    }

  private:
    [[gnu::always_inline]] inline void follow() const {
        Shapes<groups> shapes(data, base, known, unit);
        for (std::size_t k = 0; k < data.count; ++k) shapes.step(k, &share[k * base.wheel.size() * motions.size()], motions);
    }
};

} // namespace

void neighbours_shaped(const Dataset &data, const Physics &base, const Motion &known, const UnitResponse &unit,
                       const std::vector<double> &share, std::vector<Motion> &motions) {
    for (Motion &m : motions) detail::resize(m, data.count, base.wheel.size(), false, false);
    if (motions.size() <= 4)
        Pass<1>{data, base, known, unit, share, motions}.run();
    else if (motions.size() <= most_shapes)
        Pass<2>{data, base, known, unit, share, motions}.run();
}

} // namespace traction::lab
