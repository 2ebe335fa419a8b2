#include "uneven_grip.h"

#include <array>
#include <cmath>
#include <map>

namespace traction::lab {

namespace {

constexpr double mean_over_s = 1;
// (1): logs without such a law took up to 0.25 of the wheels', on gravel 0.22, 0.22, 0.29 and 0.45 of that in common, elsewhere more; those
// with one took 0.49 and 0.56 and all of it in common, or 0.7 and more.
constexpr double least_of_wheels = 0.3, in_common = 0.5, most_of_wheels = 0.5;

// Sums of rows before and with, and how many.
using Sums = std::map<long, std::array<double, 3>>;

void add(Sums &sums, long at, double before, double with) {
    std::array<double, 3> &s = sums[at];
    s[0] += before, s[1] += with, s[2] += 1;
}

struct Squares {
    double before = 0, with = 0;
    void take(const Sums &sums) {
        for (const auto &[at, s] : sums) before += s[0] * s[0] / s[2], with += s[1] * s[1] / s[2];
    }
    double share() const { return before > 0 ? 1 - with / before : 0; }
};

} // namespace

SharesTaken shares_taken(const Problem &before, const HeldOut &left_before, const HeldOut &left_with) {
    Squares of_wheels, of_all;
    Sums together;
    Eigen::Index row = 0;
    int wheels = 0;
    for (const Balance &b : before.data().balance) {
        if (b.kind != BalanceKind::current_torque) {
            row += static_cast<Eigen::Index>(b.measured.size());
            continue;
        }
        Sums own;
        for (const double t : b.t0_s) {
            const auto at = static_cast<long>(std::floor(t / mean_over_s));
            const double scale = before.row_scale[row], was = scale * left_before.residual[row], is = scale * left_with.residual[row];
            add(own, at, was, is);
            add(together, at, was, is);
            ++row;
        }
        of_wheels.take(own);
        wheels += own.empty() ? 0 : 1;
    }
    of_all.take(together);
    return {wheels, of_wheels.share(), of_all.share()};
}

bool holds_in_common(const Candidate &law, const Problem &before, const HeldOut &left_before, const HeldOut &left_with) {
    if ((law.effect != "shear_peak" && law.effect != "sliding_speed_loss") || law.wheel >= 0) return true;
    const SharesTaken taken = shares_taken(before, left_before, left_with);
    return taken.wheels < 2 || taken.of_wheels > most_of_wheels ||
           (taken.of_wheels > least_of_wheels && taken.of_all_together > in_common * taken.of_wheels);
}

} // namespace traction::lab
