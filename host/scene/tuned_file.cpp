#include "host/scene/tuned_file.h"
#include "host/scene/load_sections.h"
#include "host/scene/scene_text.h"
#include <cstdio>
#include <sstream>

namespace pointgi {

namespace {

toml::table parsed(const std::string& text, const std::string& file) {
  check_nesting(text, file);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw Error(ErrorKind::input, harmless(place_of(error.source(), file).text() +
                                           ": not valid TOML: " + std::string(error.description())));
  }
}

/// A file that was cut short lacks something; one with a value that changes answers was not measured.
void require_all(const TableReader& root, const TunedFile& tuned) {
  const OctreeSettings& o = tuned.octree;
  const TraversalSettings& t = tuned.traversal;
  if (!o.branching || !o.order || !o.leaf_capacity)
    root.fail("octree", "expected branching, order and leaf_capacity, each with a value");
  if (!t.form || !t.grouping || !t.group || !t.lanes || !t.storage)
    root.fail("traversal", "expected form, lanes, storage, grouping and group, each with a value");
  if (t.fast_math || t.stepping != Stepping::exact)
    root.fail("traversal", "expected no approximation: fast_math and absolute_delta are for scenes only");
}

/// A basic string of TOML. Control characters have no place in a device's name and become blanks.
std::string quoted_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return out + "\"";
}

} // namespace

TunedFile parse_tuned(const std::string& text, const std::string& file) {
  const toml::table document = parsed(text, file);
  const TableReader root(document, file, "");
  root.allow_only({"profile", "octree", "traversal"});
  TunedFile tuned;
  if (const auto profile = root.table("profile")) {
    profile->allow_only({"device", "driver", "version", "date", "scene", "rays_per_second"});
    const auto text_of = [&](const char* key) { return profile->need_text(key, "a text"); };
    tuned.device = text_of("device");
    tuned.driver = text_of("driver");
    tuned.version = text_of("version");
    tuned.date = text_of("date");
    tuned.scene = text_of("scene");
    tuned.rays_per_second = profile->need_number("rays_per_second", limits::light);
  }
  load_octree(root, tuned.octree);
  load_traversal(root, tuned.traversal);
  require_all(root, tuned);
  return tuned;
}

std::string tuned_text(const TunedFile& tuned) {
  const OctreeSettings& o = tuned.octree;
  const TraversalSettings& t = tuned.traversal;
  std::ostringstream out;
  out.exceptions(std::ios::badbit); // where memory ends: half of the text would be written
  char rays[32];
  std::snprintf(rays, sizeof rays, "%.4e", tuned.rays_per_second);
  out << "# The fastest variant that `pointgi profile` measured on this device; `pointgi render` takes it from here.\n"
      << "# [octree] and [traversal] can be pasted into a scene. Delete the file to return to the defaults.\n"
      << "[profile]\ndevice = " << quoted_text(tuned.device) << "\ndriver = " << quoted_text(tuned.driver)
      << "\nversion = " << quoted_text(tuned.version) << "\ndate = " << quoted_text(tuned.date)
      << "\nscene = " << quoted_text(tuned.scene) << "\nrays_per_second = " << rays
      << "\n\n[octree]\nbranching = " << o.branching.value() << "\norder = \"" << name_of(o.order.value())
      << "\"\nleaf_capacity = " << o.leaf_capacity.value() << "\n\n[traversal]\nform = \"" << name_of(t.form.value())
      << "\"\nlanes = " << t.lanes.value() << "\nstorage = \"" << name_of(t.storage.value()) << "\"\ngrouping = \""
      << name_of(t.grouping.value()) << "\"\ngroup = \"" << name_of(t.group.value()) << "\"\n";
  return out.str();
}

} // namespace pointgi
