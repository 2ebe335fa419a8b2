// read_runs.h - what belongs to one run: [[run]] of a model file (docs/model_format.md).
//
//   [[run]]
//   log = "gravel.csv"            the run's file, without folder
//   [run.soil]                    its ground, where it is another: for all wheels
//   mu = 0.97
//   [run.sensors.accel]           its offsets, as a fit of several runs writes them
//   bias_m_s2 = 0.02
#pragma once

#include "model.h"
#include "model_reader.h"

#include <toml++/toml.h>

namespace traction::lab {

// Fills Model::runs. Throws ModelError.
void read_runs(const ModelReader &reader, const toml::table &root, Model &model);

} // namespace traction::lab
