#pragma once
/// Intervals that hold a figure in 95 of 100 measurements.
#include "host/measure/trade.h"

namespace pointgi {

/// 97.5 % quantile of Student's distribution with `freedom` >= 2 degrees of freedom (less counts as 2), by Fisher's
/// expansion (Abramowitz and Stegun 26.7.5): within 2 % from three degrees of freedom on.
double student_quantile(double freedom);

/// Sets the intervals of the seconds of all runs: a run has too few repetitions to tell by itself how much its times
/// vary, so the logarithms of all runs' times are taken to vary alike, and their variance is found from all repetitions
/// about their runs' means. The interval is that of the median, and holds the run's own least and greatest time. Where
/// no run was repeated it stays as it is.
void set_time_intervals(Trade& trade);

} // namespace pointgi
