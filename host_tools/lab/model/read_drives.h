// read_drives.h - which wheel's motor turns which other wheels: rover.drives of a model file (docs/model_format.md).
//
//   drives = [0, 1]              wheels 0 and 1 have a motor, the other wheels of a side turn with the motor there
//   drives = [[0, 2], [1, 3]]    the same, each motor's wheels by name, its own first; as many as a motor turns
// Left out, every wheel has a motor of its own. The wheels of a motor turn one to one: by a chain or a belt on equal sprockets.
#pragma once

#include "model.h"

#include <toml++/toml.h>

#include <string>

namespace traction::lab {

// Fills WheelSpec::drive, and gives the wheels that a motor turns its [motor]. The wheels are read already. Throws ModelError.
void read_drives(const toml::table &root, Model &model);

// Throws ModelError where what is on a motor is put on a wheel that turns with another wheel's.
void check_effect_wheel(const toml::table &effect, const std::string &where, const Model &model, const EffectUse &use);

} // namespace traction::lab
