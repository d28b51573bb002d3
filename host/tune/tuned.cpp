#include "host/tune/tuned.h"
#include "host/atomic_file.h"
#include "host/cache/binary_cache.h"
#include "host/cl/kernel_source.h"
#include "host/error.h"
#include <cctype>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace pointgi {

namespace {

/// As [profile] names them; the platform belongs to the device: one CPU may stand in several.
std::string device_text(const DeviceInfo& device) {
  return device.name + " (" + device.platform + ")";
}
std::string driver_text(const DeviceInfo& device) {
  return device.driver + ", " + device.opencl;
}

/// Letters and digits of a name, the rest made dashes: a file's name that people can read.
std::string slug(const std::string& text) {
  std::string result;
  for (const unsigned char c : text.substr(0, 80))
    if (std::isalnum(c))
      result += static_cast<char>(std::tolower(c));
    else if (!result.empty() && result.back() != '-')
      result += '-';
  return result;
}

/// What the scene says over what a layer says.
TraversalVariant merged(const TraversalSettings& t, const OctreeSettings& o, const TraversalVariant& layer) {
  TraversalVariant v = layer;
  if (o.branching) v.axis_bits = *o.branching == 4 ? 2 : 1;
  v.order = o.order.value_or(layer.order);
  v.leaf_capacity = o.leaf_capacity.value_or(layer.leaf_capacity);
  v.max_depth = o.max_depth;
  v.lanes = t.lanes.value_or(layer.lanes);
  v.storage = t.storage.value_or(layer.storage);
  v.stepping = t.stepping;
  v.step_delta = t.step_delta;
  v.grouping = t.grouping.value_or(layer.grouping);
  v.group = t.group.value_or(layer.group);
  v.fast_math = t.fast_math;
  v.patches = t.surface == SurfaceForm::mls;
  return v;
}

TraversalVariant variant_of(const TunedFile& tuned) {
  TraversalSettings settings = tuned.traversal;
  return merged(settings, tuned.octree, plain_variant(settings.form.value()));
}

} // namespace

bool says_something(const TraversalSettings& t, const OctreeSettings& o) {
  return o.branching || o.order || o.leaf_capacity || t.form || t.grouping || t.group || t.lanes || t.storage ||
         t.stepping != Stepping::exact || t.fast_math;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &local);
  return text;
}

std::string winner_path(const DeviceInfo& device) {
  const std::string folder = cache_folder();
  if (folder.empty()) return {};
  const std::string who = device_text(device) + "\n" + driver_text(device);
  char hash[24];
  std::snprintf(hash, sizeof hash, "%08llx", static_cast<unsigned long long>(fnv1a(who) & 0xffffffffull));
  return folder + "/tuned/" + slug(device.name + " " + device.driver) + "-" + hash + ".toml";
}

StoredWinner stored_winner(const DeviceInfo& device) {
  const std::string path = winner_path(device);
  std::error_code failed;
  if (path.empty() || !std::filesystem::is_regular_file(path, failed)) return {};
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  const auto ignored = [&](const std::string& why) {
    return StoredWinner{std::nullopt, why + "; it is not used: run `pointgi profile` again, or delete the file"};
  };
  if (!text) return ignored(path + ": is empty, or cannot be read"); // half of it may be good TOML
  try {
    const TunedFile tuned = parse_tuned(text.str(), path);
    if (tuned.device != device_text(device) || tuned.driver != driver_text(device))
      return ignored(path + ": was measured on another device or driver");
    if (tuned.version != POINTGI_VERSION) return ignored(path + ": was measured by pointgi " + tuned.version);
    if (const std::string why = why_not(variant_of(tuned), device); !why.empty())
      return ignored(path + ": holds what this device does not take: " + why);
    return {tuned, {}};
  } catch (const Error& error) {
    return ignored(error.what());
  }
}

std::string store_winner(const DeviceInfo& device, const TraversalVariant& variant, const std::string& scene,
                         double rays_per_second) {
  TunedFile tuned;
  tuned.octree.branching = 1u << variant.axis_bits;
  tuned.octree.order = variant.order;
  tuned.octree.leaf_capacity = variant.leaf_capacity;
  tuned.traversal.form = variant.form;
  tuned.traversal.lanes = variant.lanes;
  tuned.traversal.storage = variant.storage;
  tuned.traversal.grouping = variant.grouping;
  tuned.traversal.group = variant.group;
  tuned.device = device_text(device);
  tuned.driver = driver_text(device);
  tuned.version = POINTGI_VERSION;
  tuned.date = today();
  tuned.scene = scene;
  tuned.rays_per_second = rays_per_second;
  const std::string path = winner_path(device), text = tuned_text(tuned);
  if (path.empty())
    throw Error(ErrorKind::output, "there is no folder to store the best variant in; set POINTGI_CACHE_DIR");
  std::error_code ignored; // the file says it better
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
  return path;
}

TunedFile class_defaults(const DeviceInfo& device) {
  const std::string name = device.is_cpu ? "tuned/cpu.toml" : "tuned/gpu.toml", path = "kernels/" + name;
  return parse_tuned(kernel_file(name), path);
}

VariantChoice choose_variant(const TraversalSettings& traversal, const OctreeSettings& octree, const DeviceInfo& device,
                             const std::optional<TunedFile>& stored) {
  std::vector<VariantChoice> layers;
  if (stored) layers.push_back({variant_of(*stored), "profile of " + stored->date});
  layers.push_back({variant_of(class_defaults(device)), device.is_cpu ? "default of CPU devices" : "default of GPUs"});
  for (const TraversalForm form : traversal_forms())
    layers.push_back({plain_variant(form), std::string("plain ") + name_of(form) + " form"});
  const bool scene_speaks = says_something(traversal, octree);
  std::string reasons; // of one form what the device lacks, of another what the form cannot do
  for (const VariantChoice& layer : layers) {
    if (traversal.form && *traversal.form != layer.variant.form) continue;
    const TraversalVariant variant = merged(traversal, octree, layer.variant);
    const std::string why = why_not(variant, device);
    if (why.empty()) return {variant, scene_speaks ? "the scene and " + layer.source : layer.source};
    if (reasons.find(why) == std::string::npos) reasons += (reasons.empty() ? "" : ", ") + why;
  }
  throw Error(scene_speaks ? ErrorKind::usage : ErrorKind::device,
              "the settings of [octree] and [traversal] do not go together on " + device.name + ": " + reasons +
                  "; change one of them, or leave them out");
}

} // namespace pointgi
