// series.h - which rows of a balance a result carries: all of them, or, of more than 20000, those at the extremes.
#pragma once

#include "compare.h"

#include <cstddef>
#include <vector>

namespace traction::lab {

// Rounded to seven digits, times to 0.1 ms: a third of the bytes, and less than a pixel of any plot.
struct SeriesRows {
    std::vector<double> t_s, measured, model, after;
};

SeriesRows rows_to_show(const BalanceComparison &balance, std::size_t most = 20000);

// Indices of at most about `most` rows, rising: the first and the last of all, and of each of equal stretches the lowest and highest of
// every column. No extreme of any column is lost. Columns have the same length; NaN is passed over.
std::vector<std::size_t> extremes_of(const std::vector<const std::vector<double> *> &columns, std::size_t most);

} // namespace traction::lab
