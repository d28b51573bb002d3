#include "host/measure/stored_trade.h"
#include "host/atomic_file.h"
#include "host/cache/binary_cache.h"
#include <filesystem>
#include <fmt/format.h>

namespace pointgi {

namespace {

namespace fs = std::filesystem;

std::string file_of(const std::string& scene, const std::string& device) {
  const std::string folder = cache_folder();
  if (folder.empty()) return {};
  std::error_code ignored;
  const std::string place = fs::weakly_canonical(scene, ignored).string();
  return (fs::path(folder) / "trades" / fmt::format("{:016x}.json", fnv1a(place + "\n" + device))).string();
}

} // namespace

void store_trade(const Trade& trade) {
  const std::string path = file_of(trade.scene, trade.device);
  if (path.empty()) return;
  const std::optional<Trade> earlier = stored_trade(trade.scene, trade.device);
  if (earlier && earlier->state == trade.state && earlier->runs.size() > trade.runs.size()) return;
  std::error_code ignored;
  fs::create_directories(fs::path(path).parent_path(), ignored);
  try {
    const std::string text = json_of(trade);
    AtomicFile file(path);
    file.write(text.data(), text.size());
    file.commit();
  } catch (const Error&) { // the folder of the measurement has it
  }
}

std::optional<Trade> stored_trade(const std::string& scene, const std::string& device) {
  const std::string path = file_of(scene, device);
  std::error_code ignored;
  if (path.empty() || !fs::exists(path, ignored)) return std::nullopt;
  try {
    Trade trade = read_trade(path);
    if (trade.version != POINTGI_VERSION || trade.runs.empty()) return std::nullopt;
    return trade;
  } catch (const Error&) {
    return std::nullopt;
  }
}

} // namespace pointgi
