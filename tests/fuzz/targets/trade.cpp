/// trade.json: a measurement that can be written and read again, and of which all is asked that commands ask; or an
/// input error.
#include "host/measure/trade.h"
#include "tests/fuzz/targets/target.h"
#include "tests/support/promises.h"

using namespace pointgi;
using namespace pointgi::test;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = write_input("trade.json", view_of(data, size));
  try {
    Trade trade = read_trade(path);
    const std::string text = json_of(trade);
    require_kept(json_of(read_trade(write_input("again.json", text))) == text
                     ? ""
                     : "a measurement changes when it is written and read");
    csv_of(trade);
    mark_front(trade);
    fastest_within_error(trade, 1e-3);
    most_accurate_within(trade, 1.0);
    for (const MeasuredRun& run : trade.runs)
      command_of(trade, run);
  } catch (const Error& error) {
    require_kept(broken_promise(error, path));
  }
  return 0;
}
