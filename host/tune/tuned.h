#pragma once
/// Which variant a device gets where the scene leaves it open: what a profile of this device and driver found, else
/// what kernels/tuned says for its class.
#include "host/scene/tuned_file.h"
#include "host/tune/variant_list.h"

namespace pointgi {

/// What `pointgi profile` stored for this device and driver.
struct StoredWinner {
  std::optional<TunedFile> file;
  std::string warning; ///< why a file that is there is not used; it is never trusted half
};

/// "2025-01-31", here and now.
std::string today();

/// Where the winner of this device and driver is kept: below the cache folder; empty when there is none.
std::string winner_path(const DeviceInfo& device);

/// Reads it. A file that is damaged, of another device, driver or version of this program gives a warning only.
StoredWinner stored_winner(const DeviceInfo& device);

/// Keeps the variant for this device and driver, atomically; returns the file's path. Throws Error(output) when there
/// is no cache folder or it cannot be written.
std::string store_winner(const DeviceInfo& device, const TraversalVariant& variant, const std::string& scene,
                         double rays_per_second);

/// The defaults of the device's class: kernels/tuned/cpu.toml for CPUs, gpu.toml for all others.
/// Throws Error(input) when POINTGI_KERNEL_DIR holds a wrong one.
TunedFile class_defaults(const DeviceInfo& device);

/// Whether a scene narrows the choice of the variant.
bool says_something(const TraversalSettings& traversal, const OctreeSettings& octree);

struct VariantChoice {
  TraversalVariant variant;
  std::string source; ///< "profile of 2025-01-31", "default of CPU devices", "the scene and default of CPU devices"
};

/// Settings of the scene win; what they leave open comes from the stored winner, or else from the defaults of the
/// device's class, or else from the plain form: from the first of these that goes with the scene's settings on this
/// device, whole. Throws Error(usage) when none does.
VariantChoice choose_variant(const TraversalSettings& traversal, const OctreeSettings& octree, const DeviceInfo& device,
                             const std::optional<TunedFile>& stored = std::nullopt);

} // namespace pointgi
