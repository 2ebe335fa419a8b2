// distribution.h - tail probability of the F distribution, quantile of Student's t, signed-rank test.
#pragma once

#include <vector>

namespace traction::lab {

// P(F > f) with d1, d2 degrees of freedom (d2 may be fractional); 1 when f <= 0. Derived from the regularised incomplete beta
// function, continued fraction by Lentz's method; relative error < 1e-10 for d1 <= 20, d2 in 1..1000.
double f_tail(double f, double d1, double d2);

// t with P(|T| > t) = p for a Student t of `freedom` degrees, at most 1000. By bisection on f_tail; p in (0, 1).
double t_quantile(double p, double freedom);

// One-sided p of Wilcoxon's signed-rank test (Biometrics Bulletin 1 (1945) 80): that values symmetric about 0, or lying below it, rank
// as far up as these. Exact up to 60 values other than 0, beyond by the normal approximation; 1 without any. Ties are ranked as they come.
double signed_rank_tail(std::vector<double> values);

} // namespace traction::lab
