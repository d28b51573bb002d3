#pragma once
/// Intervals that hold a figure in 95 of 100 measurements.
#include "host/measure/trade.h"

namespace pointgi {

/// 97.5 % quantile of Student's distribution with `freedom` >= 2 degrees of freedom (less counts as 2), by Fisher's
/// expansion (Abramowitz and Stegun 26.7.5): within 2 % from three degrees of freedom on.
double student_quantile(double freedom);

/// Standard deviation of the logarithms of repeated times, which is taken to be the same for all runs: found from all
/// repetitions about their runs' means. 0: there are none.
double time_deviation(const Trade& trade);

/// Sets the intervals of the seconds of all runs: a run has too few repetitions to tell by itself how much its times
/// vary, so that of all counts. The interval is that of the median, and holds the run's own least and greatest time.
/// With fewer than three second or third repetitions in all, not enough is known: it is from the least to the greatest.
void set_time_intervals(Trade& trade);

} // namespace pointgi
