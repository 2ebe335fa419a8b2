// gyro_by_camera.h - a gyro's scale as the camera's heading sees it, without the model.
//
// Over windows of 2 s, by least squares of k, of how late the camera is and of the gyro's offset:
//
//   turn of the camera = turn of the gyro / (1 + k) - late * change of its rate - offset * 2 s                                      (1)
//
// What a model lacks of how a machine turns (a skid steer scrubs) may look like a scale of the gyro's; (1) has no part in that.
#pragma once

#include "host_tools/lab/inputs/dataset.h"

#include <optional>

namespace traction::lab {

struct ScaleByPeer {
    double scale = 0, error = 0; // k and, at most, its standard error [1]
    // Whether no scale at all is nearer than the named one, by nine in chi squared: three standard errors (assumed).
    bool denies(double named) const { return (named - scale) * (named - scale) - scale * scale > 9 * error * error; }
};

// (1); nothing where one of the two is not in the log, or fewer than ten windows are, or nothing turns.
std::optional<ScaleByPeer> gyro_by_camera(const Dataset &data);

} // namespace traction::lab
