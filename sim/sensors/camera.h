// camera.h - overhead camera that tracks a target on the rover: x, y to 1 mm and heading, 7 times a second (docs/sources.md section 4).
//
// Heading noise 4 mrad: two marks 0.25 m apart, each to 1 mm (assumed). A delayed camera shows where the rover was.
#pragma once

#include "random.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace traction::sim {

inline constexpr double camera_rate_Hz = 7;
inline constexpr double camera_noise_m = 0.001;
inline constexpr double camera_noise_rad = 0.004;

struct CameraConfig {
    double delay_s = 0;
    double scale = 1; // distances times this
    double noise_m = camera_noise_m;
    double noise_rad = camera_noise_rad;
};

struct Pose {
    double t_s = 0, x_m = 0, y_m = 0, yaw_rad = 0;
};

class Camera {
  public:
    Camera(const CameraConfig &config, std::uint64_t seed) : config_(config), random_(seed, "camera") {}

    // Called once per plant step with the true pose; returns a measured pose, stamped with its nominal time, when one is due.
    std::optional<Pose> step(const Pose &truth);

  private:
    Pose past(double t_s) const;
    CameraConfig config_;
    Random random_;
    std::vector<Pose> ring_; // the poses not yet too old, the oldest at oldest_: a power of two of places
    std::size_t oldest_ = 0, count_ = 0;
    const Pose &kept(std::size_t i) const { return ring_[(oldest_ + i) & (ring_.size() - 1)]; }
    void keep(const Pose &pose);
    std::int64_t next_ = 0;
};

} // namespace traction::sim
