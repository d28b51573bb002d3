/// errors.cbor, which lies beside trade.json: errors that fit the measurement, or none, and never an exception.
#include "host/measure/kept_errors.h"
#include "tests/fuzz/targets/target.h"
#include "tests/support/trade.h"

using namespace pointgi;
using namespace pointgi::test;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Trade trade = small_trade();
  for (const auto& [name, errors] : kept_errors(write_input(kept_errors_name, view_of(data, size)), trade)) {
    for (const std::vector<double>& sums : errors.tile_sums())
      require_kept(sums.size() == ErrorOfRepeats::tiles(trade.width, trade.height) ? "" : "the errors do not fit");
    errors.estimate();
    errors.change_from(errors);
  }
  return 0;
}
