#pragma once
#include "host/embedded_file.h"
#include <vector>

namespace pointgi {

/// The files of kernels/, by their names below it. Written at build time.
const std::vector<EmbeddedFile>& embedded_kernels();

} // namespace pointgi
