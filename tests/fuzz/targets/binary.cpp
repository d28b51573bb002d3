/// A kept program, as it is and with the right hash: the bytes behind the key, or none.
#include "host/cache/binary_cache.h"
#include "tests/fuzz/targets/cache_case.h"
#include "tests/fuzz/targets/target.h"
#include "tests/support/promises.h"
#include <filesystem>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr std::size_t header_bytes = 32, hash_place = 24;

/// Of the one file that is kept there.
std::string kept_file() {
  store_binary(cache_key, {1});
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch_folder()))
    if (entry.path().extension() == ".bin") return std::filesystem::relative(entry.path(), scratch_folder()).string();
  require_kept("nothing is kept");
  return {};
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string name = kept_file();
  const std::string file(view_of(data, size));
  const std::size_t begin = header_bytes + cache_key.size();
  for (const std::string& bytes : {file, with_hash(file, hash_place, begin)}) {
    write_input(name, bytes);
    const auto binary = load_binary(cache_key);
    if (!binary) continue;
    require_kept(bytes.size() > begin && std::string(binary->begin(), binary->end()) == bytes.substr(begin)
                     ? ""
                     : "the program is not what the file holds");
  }
  return 0;
}
