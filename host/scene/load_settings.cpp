/// The sections that stand once in a scene: [render], [camera], [radiosity], [caustics], [octree], [traversal].
#include "host/scene/load_sections.h"
#include "host/scene/radiosity_words.h"
#include <Eigen/Geometry>
#include <algorithm>

namespace pointgi {
namespace {

void load_size(const TableReader& table, RenderSettings& render) {
  const toml::node* node = table.find("size");
  if (node == nullptr) return;
  const std::string expected = "expected [width, height], two integers from " + std::to_string(limits::image_side.low) +
                               " to " + std::to_string(limits::image_side.high);
  const auto side = [&](std::size_t index) {
    const toml::array* array = node->as_array();
    const auto* value = array != nullptr && array->size() == 2 ? (*array)[index].as_integer() : nullptr;
    if (value == nullptr || value->get() < limits::image_side.low || value->get() > limits::image_side.high)
      table.fail("size", expected + ", found " + found_text(*node));
    return value->get();
  };
  const long long width = side(0);
  const long long height = side(1);
  if (width * height > limits::image_pixels)
    table.fail("size", "expected at most " + std::to_string(limits::image_pixels) + " pixels in all, found " +
                           std::to_string(width * height) + "; make a side smaller");
  render.width = static_cast<int>(width);
  render.height = static_cast<int>(height);
}

/// A number or a word.
void load_exposure(const TableReader& table, RenderSettings& render) {
  const toml::node* node = table.find("exposure");
  if (node == nullptr) return;
  render.auto_exposure = node->is_string() && node->as_string()->get() == "auto";
  if (render.auto_exposure) return;
  if (!node->is_number())
    table.fail("exposure",
               std::string("expected \"auto\" or a number ") + limits::exposure.words + ", found " + found_text(*node));
  render.exposure = *table.number("exposure", limits::exposure);
}

} // namespace

void load_render(const TableReader& root, RenderSettings& render) {
  const std::optional<TableReader> table = root.table("render");
  if (!table) return;
  table->allow_only({"size", "spp", "seed", "exposure", "max_depth", "jitter", "adaptive"});
  load_size(*table, render);
  if (const auto spp = table->integer("spp", limits::spp)) render.spp = static_cast<int>(*spp);
  if (const auto seed = table->integer("seed", limits::seed)) render.seed = static_cast<unsigned>(*seed);
  load_exposure(*table, render);
  if (const auto depth = table->integer("max_depth", limits::max_depth)) render.max_depth = static_cast<int>(*depth);
  if (const auto jitter = table->boolean("jitter")) render.jitter = *jitter;
  if (const auto adaptive = table->boolean("adaptive")) render.adaptive = *adaptive;
}

void load_camera(const TableReader& root, UpAxis up, CameraSettings& camera) {
  const std::optional<TableReader> table = root.table("camera");
  if (!table) return;
  table->allow_only({"position", "look_at", "fov_deg", "up", "backfaces"});
  camera.place = table->place();
  if (const auto fov = table->number("fov_deg", limits::fov)) camera.fov_deg = *fov;
  if (const auto word = table->choice("backfaces", {name_of(Backfaces::shade), name_of(Backfaces::see_through)}))
    camera.backfaces = *word == name_of(Backfaces::shade) ? Backfaces::shade : Backfaces::see_through;
  if (!table->has("position") && !table->has("look_at")) {
    if (table->has("up"))
      table->fail("up", "goes with a position and look_at, and there are none; give them, or the scene's own up");
    return; // a view is found
  }
  camera.chosen = true;
  camera.position = table->need_vector3("position", limits::coordinate);
  camera.look_at = table->need_vector3("look_at", limits::coordinate);

  const Vector3d view = camera.look_at - camera.position;
  if (view.norm() <= limits::same_point * std::max(camera.look_at.norm(), camera.position.norm()))
    table->fail("look_at", "expected a point other than camera.position, found the same; the camera has no direction");
  if (table->has("up")) {
    camera.up = table->need_vector3("up", limits::coordinate);
    if (camera.up->norm() == 0.0) table->fail("up", "expected a direction, found [0, 0, 0]");
    camera.up->normalize();
    if (view.normalized().cross(*camera.up).norm() < limits::parallel_sine)
      table->fail("up",
                  "the camera looks along its up direction, so that no side of the picture is up; choose another");
    return;
  }
  if (view.normalized().cross(direction_of(up)).norm() < limits::parallel_sine)
    table->fail("look_at", std::string("the camera looks along up = \"") + name_of(up) +
                               "\", so that no side of the picture is up; move it a little aside or set up = \"" +
                               (up == UpAxis::y || up == UpAxis::minus_y ? "z" : "y") + "\"");
}

namespace {

/// An integer among few.
template <std::size_t count>
void load_one_of(const TableReader& table, const char* key, const int (&values)[count], int& into) {
  const auto value = table.integer(key, {values[0], values[count - 1]});
  if (!value) return;
  std::string words;
  for (std::size_t k = 0; k < count; ++k) {
    if (values[k] == *value) {
      into = values[k];
      return;
    }
    words += (k == 0 ? "" : k + 1 < count ? ", " : " or ") + std::to_string(values[k]);
  }
  table.fail(key, "expected " + words + ", found " + std::to_string(*value));
}

void load_gather(const TableReader& table, RadiositySettings& radiosity) {
  const auto sampling = table.choice("sampling", {"all", "static", "monte_carlo", "mipmap", "adaptive"});
  if (const auto window = table.integer("window", limits::window)) {
    radiosity.window = static_cast<int>(*window);
    radiosity.sampling = "mipmap"; // "all", the default, has no windows
    if (sampling == std::string("all"))
      radiosity.notes.push_back("radiosity.window is not read with radiosity.sampling = \"all\"");
  }
  if (sampling) radiosity.sampling = *sampling;
  radiosity.reciprocity = table.boolean("reciprocity");
  radiosity.visibility_cache = table.boolean("visibility_cache");
  if (const auto visibility = table.choice("visibility", {"rays", "voxels"})) radiosity.visibility = *visibility;
  load_one_of(table, "voxels", limits::voxel_sides, radiosity.voxels);
  if (radiosity.visibility == "voxels" && radiosity.voxels != 32 && radiosity.voxels != 64 && radiosity.voxels != 128)
    table.fail("voxels", "visibility = \"voxels\" marches through 32, 64 or 128 voxels a side");
  if (const auto passes = table.integer("passes", limits::passes)) radiosity.passes = static_cast<int>(*passes);
  if (radiosity.reciprocity.value_or(false) && radiosity.sampling != "all")
    table.fail("reciprocity",
               "reciprocity goes with sampling = \"all\": other samplings ask of a pair in one direction");
  if (radiosity.visibility_cache.value_or(false) &&
      (radiosity.sampling == "monte_carlo" || radiosity.sampling == "adaptive"))
    table.fail("visibility_cache", "sampling = \"" + radiosity.sampling +
                                       "\" asks for other pairs in each pass; leave visibility_cache out, or choose "
                                       "\"all\", \"static\" or \"mipmap\"");
}

/// What the log should say where keys are given that the method does not read; "auto" reads those of the two methods
/// that it chooses between.
void note_keys_not_read(const TableReader& table, RadiositySettings& radiosity) {
  const std::string& method = radiosity.method;
  for (const std::string& key : radiosity_method_keys()) {
    if (!table.has(key.c_str())) continue;
    bool is_read = false;
    std::string readers;
    for (const RadiosityWords& row : radiosity_words()) {
      if (std::find(row.keys.begin(), row.keys.end(), key) == row.keys.end()) continue;
      const std::string reader = row.method;
      is_read = is_read || reader == method || (method == "auto" && (reader == "fmm" || reader == "directions"));
      readers += (readers.empty() ? "\"" : ", \"") + reader + "\"";
    }
    if (!is_read)
      radiosity.notes.push_back("radiosity." + key + " is not read by method \"" + method + "\"; it is of " + readers);
  }
}

/// The method that alone reads some of the section's keys; empty: none does.
std::string method_of_keys(const TableReader& table) {
  std::string method, by;
  for (const RadiosityWords& row : radiosity_words())
    for (const char* key : row.keys) {
      if (!table.has(key) || !is_of_one_method(key)) continue;
      if (!method.empty() && method != row.method)
        table.fail(key, std::string("method \"") + row.method + "\" reads this key, and \"" + method + "\" reads " +
                            by + "; say which one with method = \"" + row.method + "\" or \"" + method + "\"");
      method = row.method;
      by = key;
    }
  return method;
}

} // namespace

void load_radiosity(const TableReader& root, RadiositySettings& radiosity) {
  const std::optional<TableReader> table = root.table("radiosity");
  if (!table) return;
  std::vector<std::string> keys = radiosity_method_keys();
  keys.insert(keys.begin(), "method");
  keys.insert(keys.end(), {"direct_light", "least_share", "light_samples"});
  table->allow_only(keys);
  radiosity.place = table->place();
  if (const auto method = table->choice("method", radiosity_method_words()))
    radiosity.method = *method;
  else if (const std::string implied = method_of_keys(*table); !implied.empty()) {
    radiosity.method = implied;
    radiosity.notes.push_back("radiosity.method is \"" + implied + "\", which alone reads some of the given keys");
  }
  note_keys_not_read(*table, radiosity);
  if (const auto order = table->integer("order", limits::order)) radiosity.order = static_cast<int>(*order);
  if (const auto samples = table->integer("vmap_samples", limits::vmap_samples))
    radiosity.vmap_samples = static_cast<int>(*samples);
  if (const auto samples = table->integer("point_samples", limits::point_samples))
    radiosity.point_samples = static_cast<int>(*samples);
  if (const auto rays = table->integer("vmap_rays", limits::vmap_rays)) radiosity.vmap_rays = *rays;
  if (const auto epsilon = table->number("epsilon", limits::epsilon)) radiosity.epsilon = *epsilon;
  if (const auto tolerance = table->number("tolerance", limits::tolerance)) radiosity.tolerance = *tolerance;
  if (const auto directions = table->integer("directions", limits::directions))
    radiosity.directions = static_cast<int>(*directions);
  if (const auto share = table->boolean("share")) radiosity.share = *share;
  if (const auto set = table->choice("direction_set", {"stratified", "hemicube"})) radiosity.direction_set = *set;
  load_gather(*table, radiosity);
  if (const auto vmap = table->choice("vmap", {"fractions", "thesis"})) radiosity.vmap = *vmap;
  load_one_of(*table, "cones", limits::cone_counts, radiosity.cones);
  if (const auto sides = table->boolean("anisotropic")) radiosity.anisotropic = *sides;
  if (const auto at = table->choice("at", {"points", "pixels"})) radiosity.at = *at;
  if (const auto direct = table->choice("direct_light", {"auto", "shadow_rays", "radiosity"}))
    radiosity.direct_light = *direct;
  if (const auto share = table->number("least_share", limits::least_share)) radiosity.least_share = *share;
  if (const auto samples = table->integer("light_samples", limits::light_samples))
    radiosity.light_samples = static_cast<int>(*samples);
}

void load_caustics(const TableReader& root, CausticSettings& caustics) {
  const std::optional<TableReader> table = root.table("caustics");
  if (!table) return;
  table->allow_only({"photons", "gather_k", "power", "max_radius", "feedback", "indirect"});
  caustics.place = table->place();
  if (const auto photons = table->integer("photons", limits::photons)) caustics.photons = *photons;
  if (const auto gather = table->integer("gather_k", limits::gather_k)) caustics.gather_k = static_cast<int>(*gather);
  if (const auto power = table->choice("power", {"unbiased", "equal"})) caustics.power = *power;
  if (const auto radius = table->number("max_radius", limits::length)) caustics.max_radius = *radius;
  if (const auto feedback = table->boolean("feedback")) caustics.feedback = *feedback;
  if (const auto indirect = table->boolean("indirect")) caustics.indirect = *indirect;
}

namespace {

/// A choice among `values` by their names, or "auto": left open.
template <typename T>
void load_choice(const TableReader& table, const char* key, const std::vector<T>& values, std::optional<T>& into) {
  std::vector<std::string> words{"auto"};
  for (const T value : values)
    words.push_back(name_of(value));
  const auto word = table.choice(key, words);
  if (!word) return;
  const auto at = std::find(words.begin() + 1, words.end(), *word);
  if (at == words.end())
    into.reset();
  else
    into = values[static_cast<std::size_t>(at - words.begin() - 1)];
}

} // namespace

void load_octree(const TableReader& root, OctreeSettings& octree) {
  const std::optional<TableReader> table = root.table("octree");
  if (!table) return;
  table->allow_only({"branching", "order", "leaf_capacity", "max_depth"});
  if (const auto branching = table->integer("branching", {2, 4})) {
    if (*branching == 3) table->fail("branching", "expected 2 or 4, found 3");
    octree.branching = static_cast<unsigned>(*branching);
  }
  load_choice(*table, "order", point_orders(), octree.order);
  if (const auto capacity = table->integer("leaf_capacity", limits::leaf_capacity))
    octree.leaf_capacity = static_cast<unsigned>(*capacity);
  if (const auto depth = table->integer("max_depth", limits::octree_depth))
    octree.max_depth = static_cast<unsigned>(*depth);
}

void load_traversal(const TableReader& root, TraversalSettings& traversal) {
  const std::optional<TableReader> table = root.table("traversal");
  if (!table) return;
  table->allow_only({"form", "grouping", "group", "lanes", "storage", "stepping", "step_delta", "fast_math", "surface",
                     "mls_neighbours"});
  load_choice(*table, "form", traversal_forms(), traversal.form);
  load_choice(*table, "grouping", ray_groupings(), traversal.grouping);
  load_choice(*table, "group", work_groups(), traversal.group);
  if (const auto lanes = table->integer("lanes", {8, 16})) {
    if (*lanes != 8 && *lanes != 16) table->fail("lanes", "expected 8 or 16, found " + std::to_string(*lanes));
    traversal.lanes = static_cast<unsigned>(*lanes);
  }
  load_choice(*table, "storage", pool_storages(), traversal.storage);
  if (const auto stepping = table->choice("stepping", {name_of(Stepping::exact), name_of(Stepping::absolute_delta)}))
    traversal.stepping = *stepping == name_of(Stepping::exact) ? Stepping::exact : Stepping::absolute_delta;
  if (const auto delta = table->number("step_delta", limits::length)) traversal.step_delta = *delta;
  if (const auto fast = table->boolean("fast_math")) traversal.fast_math = *fast;
  if (const auto word = table->choice("surface", {name_of(SurfaceForm::discs), name_of(SurfaceForm::mls)}))
    traversal.surface = *word == name_of(SurfaceForm::discs) ? SurfaceForm::discs : SurfaceForm::mls;
  if (const auto neighbours = table->integer("mls_neighbours", limits::mls_neighbours)) {
    if (traversal.surface != SurfaceForm::mls)
      table->fail("mls_neighbours",
                  "goes with surface = \"mls\", and the surface is discs; set surface, or leave it out");
    traversal.mls_neighbours = static_cast<unsigned>(*neighbours);
  }
}

} // namespace pointgi
