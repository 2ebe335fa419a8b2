#include "gyro_by_camera.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <vector>

namespace traction::lab {

namespace {

constexpr double span_s = 2;
constexpr Eigen::Index least_windows = 10;

bool ends_within(const Dataset &data, double from_s, double to_s) {
    return std::any_of(data.run_start_s.begin(), data.run_start_s.end(), [&](double t) { return t > from_s && t <= to_s; });
}

} // namespace

std::optional<ScaleByPeer> gyro_by_camera(const Dataset &data) {
    if (!data.gyro || !data.camera_heading || data.yaw_rad.size() != data.count || data.yaw_rate_rad_s.size() != data.count) return {};
    const std::vector<double> &rate = data.yaw_rate_rad_s;
    const auto n = static_cast<std::size_t>(std::round(span_s / data.step_s));
    Eigen::MatrixX3d by(static_cast<Eigen::Index>(data.count / n), 3);
    Eigen::VectorXd turn(by.rows());
    Eigen::Index rows = 0;
    for (std::size_t first = 0; first + n < data.count; first += n) {
        if (ends_within(data, data.time(first), data.time(first + n))) continue;
        double sum = 0.5 * (rate[first] + rate[first + n]);
        for (std::size_t k = first + 1; k < first + n; ++k) sum += rate[k];
        by.row(rows) << sum * data.step_s, rate[first] - rate[first + n], -span_s;
        turn[rows++] = data.yaw_rad[first + n] - data.yaw_rad[first];
    }
    if (rows < least_windows) return {};
    by.conservativeResize(rows, 3), turn.conservativeResize(rows);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> qr(by);
    if (qr.rank() < 3) return {};
    const Eigen::Vector3d solution = qr.solve(turn);
    const double variance = (turn - by * solution).squaredNorm() / static_cast<double>(rows - 3);
    // Neighbours share a reading of the camera, with opposite signs: its noise tells at most twice in what turns to and fro.
    const double error = std::sqrt(2 * variance * (by.transpose() * by).inverse()(0, 0)), gain = solution[0];
    if (!(gain > 3 * error)) return {};
    return ScaleByPeer{1 / gain - 1, error / (gain * gain)};
}

} // namespace traction::lab
