// turned_by_wheels.h - whether a machine turns because its wheels turn it.
//
//   r_k = -sum(y_i R w_i) / sum(y_i^2),   y_i from the middle of the wheels          yaw rate of wheels that do not slip            (1)
//
// Where a yaw rate is none of (1)'s, uneven ground makes it: the model follows it only as far as the gyro draws it, so always too little,
// and a gyro that reads too much seems to tell why (fleet 1043018, stop and go straight on: `gyro_scale` 0.16 that was not there).
#pragma once

#include "host_tools/lab/forward/physics.h"
#include "host_tools/lab/inputs/dataset.h"

namespace traction::lab {

// Whether (1), regressed on the measured yaw rate, has at least 0.8 of it: wheels that turn a machine slip, so (1) has all of it and more,
// and a gyro may read a quarter too much (assumed); wheels that are turned by the ground have less (0.7 there).
// True where (1) says nothing: wheels with rollers or at an angle, or all on one line.
bool turned_by_wheels(const Dataset &data, const Physics &physics);

} // namespace traction::lab
