#include "camera.h"

namespace traction::sim {

// Pose at t_s by linear interpolation; the oldest one before the record begins.
Pose Camera::past(double t_s) const {
    if (t_s <= history_.front().t_s) return history_.front();
    std::size_t i = history_.size() - 1;
    while (i > 0 && history_[i - 1].t_s > t_s) i--;
    if (i == 0) return history_.front();
    const Pose &a = history_[i - 1], &b = history_[i];
    const double u = b.t_s > a.t_s ? (t_s - a.t_s) / (b.t_s - a.t_s) : 1;
    return {t_s, a.x_m + u * (b.x_m - a.x_m), a.y_m + u * (b.y_m - a.y_m), a.yaw_rad + u * (b.yaw_rad - a.yaw_rad)};
}

std::optional<Pose> Camera::step(const Pose &truth) {
    history_.push_back(truth);
    while (history_.size() > 2 && history_[1].t_s < truth.t_s - config_.delay_s - 0.01) history_.pop_front();
    const double due_s = static_cast<double>(next_) / camera_rate_Hz;
    if (truth.t_s < due_s) return std::nullopt;
    next_++;
    Pose pose = past(due_s - config_.delay_s);
    pose.t_s = due_s;
    pose.x_m = pose.x_m * config_.scale + config_.noise_m * random_.normal();
    pose.y_m = pose.y_m * config_.scale + config_.noise_m * random_.normal();
    pose.yaw_rad += config_.noise_rad * random_.normal();
    return pose;
}

} // namespace traction::sim
