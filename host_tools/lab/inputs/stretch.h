// stretch.h - a part of a data set, from one time to another: its grid and the rows that lie wholly within.
#pragma once

#include "dataset.h"

namespace traction::lab {

// Rows that reach over either end are left out, and with them a balance that keeps none; times stay those of the whole. The stretch of a
// table of trials (independent_rows) is the table.
Dataset stretch(const Dataset &data, double from_s, double to_s);

} // namespace traction::lab
