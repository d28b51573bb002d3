#pragma once
/// The errors of a measurement's repeated pictures, tile by tile, in a file beside trade.json: an interval comes from
/// how tiles vary between repetitions, so a measurement that goes on needs those of the pictures that were made before.
#include "host/measure/reference.h"
#include <map>
#include <string>

namespace pointgi {

/// By the names of the runs.
using ErrorsOfRuns = std::map<std::string, ErrorOfRepeats>;

inline constexpr char kept_errors_name[] = "errors.cbor";

/// Writes the file, whole or not at all. `trade`: whose runs they are, by its state and size. Throws Error(output).
void keep_errors(const ErrorsOfRuns& errors, const Trade& trade, const std::string& path);

/// Those of the runs of `trade`, each with as many repetitions as the run has. A run is missing where the file, which
/// may be of another measurement, damaged or not there, does not hold so many of it.
ErrorsOfRuns kept_errors(const std::string& path, const Trade& trade);

} // namespace pointgi
