/// A scene file: a scene, or an error that says where. A printable line that begins with "#set " is an override as
/// --set takes it; who types other characters sees them in the error. Clouds may lie in cloud.ply and environment maps
/// in sky.hdr beside the scene.
#include "host/scene/load_scene.h"
#include "tests/fuzz/targets/target.h"
#include "tests/support/hdr_bytes.h"
#include "tests/support/promises.h"

using namespace pointgi;
using namespace pointgi::test;

namespace {

std::vector<std::string> overrides_in(std::string_view text) {
  constexpr std::string_view mark = "#set ";
  std::vector<std::string> overrides;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string line(text.substr(0, end));
    if (line.rfind(mark, 0) == 0 && is_printable(line)) overrides.push_back(line.substr(mark.size()));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return overrides;
}

std::string broken_promise(const Error& error) {
  // An override that cannot be put into the scene is a fault of the command line.
  if (error.kind() != ErrorKind::input && error.kind() != ErrorKind::usage)
    return std::string("the error is neither of the input nor of an override: ") + error.what();
  return is_harmless(error.what()) ? "" : std::string("the error has control characters: ") + error.what();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool neighbours_lie_there = [] {
    write_input("cloud.ply", ""); // never read
    write_input("sky.hdr", hdr_file(2, 1, {rgbe(1.0f, 1.0f, 1.0f), rgbe(2.0f, 1.0f, 0.5f)}, HdrCode::flat));
    return true;
  }();
  (void)neighbours_lie_there;
  const std::string_view text = view_of(data, size);
  const std::string path = write_input("scene.toml", text);
  try {
    const Scene scene = load_scene(path, overrides_in(text));
    require_kept(scene.clouds.empty() && scene.shapes.empty() ? "the scene is empty" : "");
    for (const std::string& warning : scene.warnings)
      require_kept(is_harmless(warning) ? "" : "a warning has control characters: " + warning);
  } catch (const Error& error) {
    require_kept(broken_promise(error));
  }
  return 0;
}
