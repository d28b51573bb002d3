#pragma once
/// LAS files, versions 1.0 to 1.4, all point formats, and LAZ and COPC, which are LAS with compressed points; waveforms
/// are left aside.
#include "host/cloud/readers/readers.h"

namespace pointgi {

/// Positions are integer times scale plus offset, in double. Every dimension is a field by its name, see las_columns().
/// Points that are marked as withheld, or classified as noise, are kept and told. `report.up` is z; where x and y are
/// degrees `report.placement` makes them metres.
/// Throws Error(input) naming the byte; for a kind of compression that is not known with what converts it.
PointCloud read_las(const std::string& path, const ReadRequest& request, CloudReport& report);

} // namespace pointgi
