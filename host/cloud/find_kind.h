#pragma once
/// Recognises the kind of a cloud from its points and from what its file and the user say, and reports it.
#include "host/cloud/complete.h"
#include "host/cloud/kind.h"
#include "host/cloud/site_spacing.h"

namespace pointgi {

/// Cells along the longest side of the FreeSpace that kinds and sides are judged by.
constexpr unsigned free_space_side = 128;

/// `signs_given`: normals have sides.
KindHints hints_for(const Sites& sites, const PointCloud& cloud, const CompleteOptions& options, bool signs_given,
                    const CloudReport& report);

/// Fills kind, kind_reason, up and stations of the report.
void tell_kind(const RecognisedKind& found, const PointCloud& cloud, const KindHints& hints, CloudReport& report);

/// Reports the kind of a cloud whose normals are given, unit and with sides; `spacing`: with these normals.
void find_kind(const PointCloud& cloud, const Sites& sites, const CompleteOptions& options, const SiteSpacing& spacing,
               CloudReport& report);

} // namespace pointgi
