#include "hinge.h"

#include <cstddef>

namespace traction::sim {

namespace {

using Vector = std::array<double, 3>;
constexpr std::size_t row_count = 5;
using Rows = std::array<Vector, row_count>;

double dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector cross(const Vector &a, const Vector &b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }

Vector turned(const double *turn, const Vector &v) {
    return {turn[0] * v[0] + turn[1] * v[1] + turn[2] * v[2], turn[4] * v[0] + turn[5] * v[1] + turn[6] * v[2],
            turn[8] * v[0] + turn[9] * v[1] + turn[10] * v[2]};
}

// (4), in world axes.
Vector gyroscopic_Nm(const Vector &I, const double *turn, const double *spin, double h) {
    Vector L{};
    for (std::size_t k = 0; k < 3; ++k) L[k] = I[k] * (turn[k] * spin[0] + turn[4 + k] * spin[1] + turn[8 + k] * spin[2]);
    const Vector IL{I[0] * L[0], I[1] * L[1], I[2] * L[2]}, adjoint{I[1] * I[2] * L[0], I[0] * I[2] * L[1], I[0] * I[1] * L[2]};
    const Vector side = cross(IL, L);
    const double share = 1 / (I[0] * I[1] * I[2] + h * h * dot(L, IL));
    Vector y{};
    for (std::size_t k = 0; k < 3; ++k) y[k] = share * (adjoint[k] + h * side[k]); // what lies along L turns nothing
    return turned(turn, cross(L, y));
}

// The inverse inertia in world axes, symmetric.
std::array<Vector, 3> inverse_inertia(const Vector &I, const double *turn) {
    const Vector inverse{1 / I[0], 1 / I[1], 1 / I[2]};
    std::array<Vector, 3> W{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector row{turn[4 * i] * inverse[0], turn[4 * i + 1] * inverse[1], turn[4 * i + 2] * inverse[2]};
        for (std::size_t j = 0; j <= i; ++j) W[i][j] = W[j][i] = row[0] * turn[4 * j] + row[1] * turn[4 * j + 1] + row[2] * turn[4 * j + 2];
    }
    return W;
}

// A x = b by A = L D L^T; the lower half of A is read, and b becomes x.
void solve(std::array<std::array<double, row_count>, row_count> &A, std::array<double, row_count> &b) {
    std::array<double, row_count> inverse{};
    for (std::size_t j = 0; j < row_count; ++j) {
        std::array<double, row_count> scaled{};
        double pivot = A[j][j];
        for (std::size_t k = 0; k < j; ++k) scaled[k] = A[j][k], A[j][k] *= inverse[k], pivot -= scaled[k] * A[j][k];
        inverse[j] = 1 / pivot;
        for (std::size_t i = j + 1; i < row_count; ++i)
            for (std::size_t k = 0; k < j; ++k) A[i][j] -= A[i][k] * A[j][k];
    }
    for (std::size_t i = 0; i < row_count; ++i)
        for (std::size_t k = 0; k < i; ++k) b[i] -= A[i][k] * b[k];
    for (std::size_t i = row_count; i-- > 0;) {
        b[i] *= inverse[i];
        for (std::size_t k = i + 1; k < row_count; ++k) b[i] -= A[k][i] * b[k];
    }
}

} // namespace

std::array<HingeLoad, 2> Hinge::loads(const std::array<HingeMotion, 2> &now, double dt_s) const {
    const double rate = 1 / dt_s;
    std::array<HingeLoad, 2> out{};
    std::array<Rows, 2> J{}; // of the spins; those of the velocities are 1 and -1
    std::array<Vector, 2> arm{}, axis_now{};
    std::array<std::array<double, row_count>, row_count> A{};
    std::array<double, row_count> lambda{};
    const Vector u1 = turned(now[0].turn, body[0].normal_1), u2 = turned(now[0].turn, body[0].normal_2);
    for (std::size_t n = 0; n < 2; ++n) {
        const HingeBody &b = body[n];
        const HingeMotion &m = now[n];
        const double sign = n == 0 ? 1 : -1;
        const Vector r = arm[n] = turned(m.turn, b.anchor_m);
        axis_now[n] = turned(m.turn, b.axis);
        Rows &own = J[n];
        own[0] = {0, sign * r[2], -sign * r[1]}, own[1] = {-sign * r[2], 0, sign * r[0]}, own[2] = {sign * r[1], -sign * r[0], 0};
        for (std::size_t k = 0; k < 3; ++k) own[3][k] = sign * u1[k], own[4][k] = sign * u2[k];

        out[n].torque_Nm = gyroscopic_Nm(b.inertia_kg_m2, m.turn, m.spin, dt_s);
        const std::array<Vector, 3> W = inverse_inertia(b.inertia_kg_m2, m.turn);
        const double light = 1 / b.mass_kg;
        Vector torque = m.torque_Nm, spin{};
        for (std::size_t k = 0; k < 3; ++k) torque[k] += out[n].torque_Nm[k];
        for (std::size_t k = 0; k < 3; ++k) spin[k] = m.spin[k] * rate + dot(W[k], torque);
        for (std::size_t i = 0; i < row_count; ++i) {
            const Vector moved{dot(own[i], W[0]), dot(own[i], W[1]), dot(own[i], W[2])};
            for (std::size_t j = 0; j <= i; ++j) A[i][j] += dot(moved, own[j]);
            lambda[i] -= dot(own[i], spin);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            A[k][k] += light;
            lambda[k] -= sign * (m.velocity[k] * rate + m.force_N[k] * light);
        }
    }
    const double back = erp * rate * rate;
    const Vector turn_back = cross(axis_now[0], axis_now[1]);
    for (std::size_t k = 0; k < 3; ++k) lambda[k] -= back * (now[0].at[k] + arm[0][k] - now[1].at[k] - arm[1][k]);
    lambda[3] += back * dot(turn_back, u1), lambda[4] += back * dot(turn_back, u2);
    for (std::size_t i = 0; i < row_count; ++i) A[i][i] += cfm * rate;
    solve(A, lambda);
    for (std::size_t n = 0; n < 2; ++n)
        for (std::size_t k = 0; k < 3; ++k) {
            out[n].force_N[k] = n == 0 ? lambda[k] : -lambda[k];
            for (std::size_t i = 0; i < row_count; ++i) out[n].torque_Nm[k] += J[n][i][k] * lambda[i];
        }
    return out;
}

} // namespace traction::sim
