#pragma once
#include "host/embedded_file.h"
#include <vector>

namespace pointgi {

/// The files of host/measure/page/, of which a report is made. Written at build time.
const std::vector<EmbeddedFile>& report_page();

} // namespace pointgi
