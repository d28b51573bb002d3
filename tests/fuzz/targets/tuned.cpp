/// A file of tuned settings: settings that can be written and read again, or an error that says where.
#include "host/scene/tuned_file.h"
#include "tests/fuzz/targets/target.h"
#include "tests/support/promises.h"

using namespace pointgi;
using namespace pointgi::test;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file = "tuned.toml", text(view_of(data, size));
  try {
    const TunedFile tuned = parse_tuned(text, file);
    if (tuned.device.empty()) return 0; // of kernels/tuned, which nobody writes
    const std::string again = tuned_text(tuned);
    require_kept(tuned_text(parse_tuned(again, file)) == again ? "" : "settings change when they are written and read");
  } catch (const Error& error) {
    require_kept(error.kind() == ErrorKind::input ? "" : "the error is not one of the input");
    require_kept(is_harmless(error.what()) ? "" : std::string("the error has control characters: ") + error.what());
  }
  return 0;
}
