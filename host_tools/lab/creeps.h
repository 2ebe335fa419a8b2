// creeps.h - whether a drive is so slow that the speed over which rolling resistance reverses tells more than how large it is.
//
// At centimetres a second a resistance that reverses over millimetres a second is never whole: x / (x^4 + e^4)^(1/4) of it acts at x,
// within 2 % of the whole from 2 e on. How friction at rest turns is known of no machine (assumed e = 6 +- 4 mm/s), so that a slow drive is
// asked. A drive of one velocity has no rows that tell it, and a quick one has few: asked where a tenth of the rims that move go below 5
// cm/s.
#pragma once

#include "host_tools/lab/inputs/dataset.h"
#include "host_tools/lab/model/model.h"

#include <string>

namespace traction::lab {

// `data`: of `model`, whose body's motion follows from its forces and which does not state the speed itself.
bool creeps(const Model &model, const Dataset &data);

// Sets soil.reversal_speed_m_s free. Data made of the model then leaves rows out up to a tenth of the top speed (inputs/inputs.h).
void ask_for_reversal(Model &model);

inline const std::string reversal_is_asked =
    "the drive is slow: the speed over which rolling resistance reverses is fitted too (soil.reversal_speed_m_s)";

} // namespace traction::lab
