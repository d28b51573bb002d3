#pragma once
/// The report of a measurement: one page to read in a browser.
#include "host/measure/trade.h"
#include <string>

namespace pointgi {

inline constexpr char report_name[] = "report.html";

/// Writes `folder`/report.html: one file that shows the measurement without a network, with the pictures that `trade`
/// names and that lie in `folder`. `trade_json` is json_of(trade); the page shows what stands there. A picture that is
/// missing or is no PNG is left out, and the page says so. Throws Error(output) where the file cannot be written.
void write_report(const Trade& trade, const std::string& trade_json, const std::string& folder);

} // namespace pointgi
