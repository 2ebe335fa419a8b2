#include "hinge.h"

#include "sim/physics/terramechanics.h"

#include <cstddef>

namespace traction::sim {

namespace {

// A number of each body, side by side: one instruction for both, on SSE2 and NEON alike.
using Both = double __attribute__((vector_size(16)));
using Vector = std::array<Both, 3>;

Both both(double first, double second) { return Both{first, second}; }
double sum(Both x) { return x[0] + x[1]; }
Both dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector &a, const Vector &b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
Vector vector_of(const double *first, const double *second) {
    return {both(first[0], second[0]), both(first[1], second[1]), both(first[2], second[2])};
}
Vector vector_of(const std::array<double, 3> &first, const std::array<double, 3> &second) { return vector_of(first.data(), second.data()); }

struct BothTurns {
    Vector x, y, z; // rows
    Vector operator()(const Vector &v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
    Vector back(const Vector &v) const {
        return {x[0] * v[0] + y[0] * v[1] + z[0] * v[2], x[1] * v[0] + y[1] * v[1] + z[1] * v[2], x[2] * v[0] + y[2] * v[1] + z[2] * v[2]};
    }
};

// (4), in world axes.
Vector gyroscopic_Nm(const Vector &I, const BothTurns &turn, const Vector &spin, double h) {
    const Vector own = turn.back(spin), L{I[0] * own[0], I[1] * own[1], I[2] * own[2]}, IL{I[0] * L[0], I[1] * L[1], I[2] * L[2]};
    const Vector side = cross(IL, L);
    const Both yz = I[1] * I[2], share = 1 / (I[0] * yz + h * h * dot(L, IL));
    const Vector y{share * (yz * L[0] + h * side[0]), share * (I[0] * I[2] * L[1] + h * side[1]),
                   share * (I[0] * I[1] * L[2] + h * side[2])}; // what lies along L turns nothing
    return turn(cross(L, y));
}

// A symmetric matrix.
struct Symmetric {
    Both xx, xy, xz, yy, yz, zz;
    Vector operator()(const Vector &v) const {
        return {xx * v[0] + xy * v[1] + xz * v[2], xy * v[0] + yy * v[1] + yz * v[2], xz * v[0] + yz * v[1] + zz * v[2]};
    }
};

// The inverse inertia in world axes.
Symmetric inverse_inertia(const Vector &I, const BothTurns &turn) {
    const Vector inverse{1 / I[0], 1 / I[1], 1 / I[2]};
    const auto scaled = [&](const Vector &row) { return Vector{row[0] * inverse[0], row[1] * inverse[1], row[2] * inverse[2]}; };
    const Vector x = scaled(turn.x), y = scaled(turn.y), z = scaled(turn.z);
    return {dot(x, turn.x), dot(x, turn.y), dot(x, turn.z), dot(y, turn.y), dot(y, turn.z), dot(z, turn.z)};
}

constexpr std::size_t row_count = 5;
using Column = std::array<double, row_count>;

// A x = b by A = L D L^T; the lower half of A is read, and b becomes x.
void solve(std::array<Column, row_count> &A, Column &b) {
    Column inverse{};
#pragma GCC unroll 5
    for (std::size_t j = 0; j < row_count; ++j) {
        double pivot = A[j][j];
#pragma GCC unroll 5
        for (std::size_t k = 0; k < j; ++k) {
            const double whole = A[j][k];
            A[j][k] *= inverse[k], pivot -= whole * A[j][k];
        }
        inverse[j] = 1 / pivot;
#pragma GCC unroll 5
        for (std::size_t i = j + 1; i < row_count; ++i)
#pragma GCC unroll 5
            for (std::size_t k = 0; k < j; ++k) A[i][j] -= A[i][k] * A[j][k];
    }
#pragma GCC unroll 5
    for (std::size_t i = 0; i < row_count; ++i)
#pragma GCC unroll 5
        for (std::size_t k = 0; k < i; ++k) b[i] -= A[i][k] * b[k];
#pragma GCC unroll 5
    for (std::size_t i = row_count; i-- > 0;) {
        b[i] *= inverse[i];
#pragma GCC unroll 5
        for (std::size_t k = i + 1; k < row_count; ++k) b[i] -= A[k][i] * b[k];
    }
}

} // namespace

namespace {

inline void loads_here(const Hinge &hinge, const std::array<HingeMotion, 2> &now, double dt_s, std::array<HingeLoad, 2> &out) {
    const auto &body = hinge.body;
    const double rate = 1 / dt_s;
    const HingeMotion &a = now[0], &b = now[1];
    const BothTurns turn{vector_of(a.turn, b.turn), vector_of(a.turn + 4, b.turn + 4), vector_of(a.turn + 8, b.turn + 8)};
    const Vector I = vector_of(body[0].inertia_kg_m2, body[1].inertia_kg_m2), spin = vector_of(a.spin, b.spin);
    const Both light = 1 / both(body[0].mass_kg, body[1].mass_kg), sign{1, -1};
    const Vector r = turn(vector_of(body[0].anchor_m, body[1].anchor_m)), axis = turn(vector_of(body[0].axis, body[1].axis));
    // the two normals of the first body's axis, as rows of both spins
    const auto normal = [&](const std::array<double, 3> &own) {
        const Vector world = turn(vector_of(own, own));
        return Vector{sign * world[0][0], sign * world[1][0], sign * world[2][0]};
    };
    const Vector u1 = normal(body[0].normal_1), u2 = normal(body[0].normal_2);

    const Vector gyroscopic = gyroscopic_Nm(I, turn, spin, dt_s);
    const Symmetric W = inverse_inertia(I, turn);
    const Vector torque = vector_of(a.torque_Nm, b.torque_Nm), force = vector_of(a.force_N, b.force_N),
                 velocity = vector_of(a.velocity, b.velocity);
    Vector free_spin = W({torque[0] + gyroscopic[0], torque[1] + gyroscopic[1], torque[2] + gyroscopic[2]}), free_way;
    for (std::size_t k = 0; k < 3; ++k) free_spin[k] += rate * spin[k], free_way[k] = rate * velocity[k] + light * force[k];

    // rows of the spins: sign (e_k x r) . w = sign (w x r)_k, and u . w. The signs of the first three cancel among themselves.
    const Vector mx{W.xy * r[2] - W.xz * r[1], W.yy * r[2] - W.yz * r[1], W.yz * r[2] - W.zz * r[1]},
        my{W.xz * r[0] - W.xx * r[2], W.yz * r[0] - W.xy * r[2], W.zz * r[0] - W.xz * r[2]},
        mz{W.xx * r[1] - W.xy * r[0], W.xy * r[1] - W.yy * r[0], W.xz * r[1] - W.yz * r[0]};
    const Vector m1 = W(u1), m2 = W(u2), back_1 = cross(m1, r), back_2 = cross(m2, r), whirl = cross(free_spin, r);
    const double stiff = hinge.cfm * rate, lightness = sum(light) + stiff;
    std::array<Column, row_count> A{};
    A[0][0] = lightness + sum(mx[1] * r[2] - mx[2] * r[1]);
    A[1][0] = sum(my[1] * r[2] - my[2] * r[1]);
    A[1][1] = lightness + sum(my[2] * r[0] - my[0] * r[2]);
    A[2][0] = sum(mz[1] * r[2] - mz[2] * r[1]);
    A[2][1] = sum(mz[2] * r[0] - mz[0] * r[2]);
    A[2][2] = lightness + sum(mz[0] * r[1] - mz[1] * r[0]);
    for (std::size_t k = 0; k < 3; ++k) A[3][k] = sum(sign * back_1[k]), A[4][k] = sum(sign * back_2[k]);
    A[3][3] = stiff + sum(dot(m1, u1));
    A[4][3] = sum(dot(m2, u1));
    A[4][4] = stiff + sum(dot(m2, u2));

    const double back = hinge.erp * rate * rate;
    Column lambda{};
    for (std::size_t k = 0; k < 3; ++k)
        lambda[k] = -sum(sign * (free_way[k] + whirl[k])) - back * sum(sign * (both(a.at[k], b.at[k]) + r[k]));
    const std::array<double, 3> apart{axis[1][0] * axis[2][1] - axis[2][0] * axis[1][1], axis[2][0] * axis[0][1] - axis[0][0] * axis[2][1],
                                      axis[0][0] * axis[1][1] - axis[1][0] * axis[0][1]};
    lambda[3] = back * (apart[0] * u1[0][0] + apart[1] * u1[1][0] + apart[2] * u1[2][0]) - sum(dot(u1, free_spin));
    lambda[4] = back * (apart[0] * u2[0][0] + apart[1] * u2[1][0] + apart[2] * u2[2][0]) - sum(dot(u2, free_spin));
    solve(A, lambda);

    const Vector pull{sign * lambda[0], sign * lambda[1], sign * lambda[2]}, twist = cross(r, pull);
    for (std::size_t k = 0; k < 3; ++k) {
        const Both sum_Nm = gyroscopic[k] + twist[k] + u1[k] * lambda[3] + u2[k] * lambda[4];
        for (std::size_t n = 0; n < 2; ++n) out[n].force_N[k] = pull[k][n], out[n].torque_Nm[k] = sum_Nm[n];
    }
}

// The same for a processor whose instructions leave their operands alone: a quarter fewer of them, the same bits.
using Loads = void (*)(const Hinge &, const std::array<HingeMotion, 2> &, double, std::array<HingeLoad, 2> &);
void loads_narrow(const Hinge &hinge, const std::array<HingeMotion, 2> &now, double dt_s, std::array<HingeLoad, 2> &out) {
    loads_here(hinge, now, dt_s, out);
}
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
__attribute__((target("avx2"), flatten)) void loads_avx2(const Hinge &hinge, const std::array<HingeMotion, 2> &now, double dt_s,
                                                         std::array<HingeLoad, 2> &out) {
    loads_here(hinge, now, dt_s, out);
}
Loads widest_loads() { return has(Vectors::avx2) ? loads_avx2 : loads_narrow; }
#else
Loads widest_loads() { return loads_narrow; }
#endif

} // namespace

std::array<HingeLoad, 2> Hinge::loads(const std::array<HingeMotion, 2> &now, double dt_s) const {
    static const Loads widest = widest_loads();
    std::array<HingeLoad, 2> out;
    widest(*this, now, dt_s, out);
    return out;
}

} // namespace traction::sim
