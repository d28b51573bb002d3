/// A reader of clouds, POINTGI_FUZZ_TARGET of cloud_targets: a cloud that the file can account for, or an error that
/// says where; and no more memory than the file accounts for.
#include "host/cloud/readers/readers.h"
#include "tests/fuzz/targets/cloud_targets.h"
#include "tests/fuzz/targets/target.h"
#include "tests/support/promises.h"
#include <cstdlib>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// The reader, and what the seeds of all formats that it reads say of them.
struct Target {
  const CloudReader* reader = nullptr;
  std::string name;
  std::size_t expansion = 1;
  std::function<std::string(const std::string&)> pack = nullptr;
};

const CloudReader& reader_of(std::string_view format) {
  for (const CloudReader& reader : cloud_readers())
    if (format == reader.format) return reader;
  std::abort(); // a row of cloud_targets names no format
}

Target target_of(const std::string& name) {
  Target target;
  for (const CloudTarget& row : cloud_targets) {
    if (name != row.name) continue;
    target.reader = &reader_of(row.format);
    for (const CloudSeed& seed : cloud_seeds()) {
      if (reader_of(seed.format).read != target.reader->read) continue;
      if (target.name.empty()) target.name = "input" + seed.extension;
      target.expansion = std::max(target.expansion, seed.expansion);
      if (row.inside) target.pack = seed.pack;
    }
  }
  return target;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Target target = target_of(POINTGI_FUZZ_TARGET);
  std::string bytes(view_of(data, size));
  if (target.pack) bytes = target.pack(bytes);
  const std::string path = write_input(target.name, bytes);
  const std::size_t before = allocated_bytes();
  reset_peak();
  CloudReport report;
  try {
    const PointCloud cloud = target.reader->read(path, {0.0, {}, true}, report);
    // A point takes three bytes at least: a digit a coordinate.
    require_kept(broken_promise(cloud, report, bytes.size(), 3.0 / static_cast<double>(target.expansion)));
  } catch (const Error& error) {
    require_kept(broken_promise_of_cloud(error, path));
  }
  // The bound of tests/fuzz/readers_fuzz_test.cpp.
  const std::size_t most = (std::size_t{8} << 20) + 512 * bytes.size() * target.expansion;
  if (peak_bytes() - before > most)
    require_kept(std::to_string(peak_bytes() - before) + " bytes of memory for a file of " +
                 std::to_string(bytes.size()) + " bytes");
  return 0;
}
