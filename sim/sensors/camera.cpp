#include "camera.h"

#include <utility>

namespace traction::sim {

// Pose at t_s by linear interpolation; the oldest one before the record begins.
Pose Camera::past(double t_s) const {
    if (t_s <= kept(0).t_s) return kept(0);
    std::size_t i = count_ - 1;
    while (i > 0 && kept(i - 1).t_s > t_s) i--;
    if (i == 0) return kept(0);
    const Pose &a = kept(i - 1), &b = kept(i);
    const double u = b.t_s > a.t_s ? (t_s - a.t_s) / (b.t_s - a.t_s) : 1;
    return {t_s, a.x_m + u * (b.x_m - a.x_m), a.y_m + u * (b.y_m - a.y_m), a.yaw_rad + u * (b.yaw_rad - a.yaw_rad)};
}

void Camera::keep(const Pose &pose) {
    if (count_ == ring_.size()) {
        std::vector<Pose> larger(count_ == 0 ? 16 : 2 * count_);
        for (std::size_t i = 0; i < count_; i++) larger[i] = kept(i);
        ring_ = std::move(larger);
        oldest_ = 0;
    }
    ring_[(oldest_ + count_++) & (ring_.size() - 1)] = pose;
}

std::optional<Pose> Camera::step(const Pose &truth) {
    keep(truth);
    while (count_ > 2 && kept(1).t_s < truth.t_s - config_.delay_s - 0.01) {
        oldest_ = (oldest_ + 1) & (ring_.size() - 1);
        count_--;
    }
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
