#include "host/stages/require_memory.h"
#include "host/error.h"
#include "host/photon/trace_photons.h"
#include "host/radiosity/direct.h"
#include "host/scene/limits.h"
#include "host/scene/objects.h"
#include "host/stages/device_need.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace pointgi {

namespace {

/// "needs 12 MiB of a device, which has 3 MiB left of 8 MiB".
std::string needs(const Session& session, std::uint64_t bytes) {
  return fmt::format("needs {} of {}, which has {} left of {}", megabytes(bytes), session.info().name,
                     megabytes(session.bytes_left()), megabytes(session.info().memory_bytes));
}

[[noreturn]] void refuse(const std::string& what, const std::vector<std::string>& remedies) {
  std::string text;
  for (const std::string& remedy : remedies)
    if (!remedy.empty()) text += (text.empty() ? "; set " : ", or ") + remedy;
  throw Error(ErrorKind::memory, what + text + ", or use another --device");
}

/// The largest number of two digits that is not above `value`.
long long rounded_down(double value) {
  double unit = 1.0;
  while (value / unit >= 100.0)
    unit *= 10.0;
  return static_cast<long long>(std::floor(value / unit) * unit);
}

/// Of two digits, not below `value` > 0.
std::string rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return fmt::format("{:.2g}", std::ceil(value / unit - 1e-9) * unit);
}

/// Points of which the exchange's `bytes_of` are about `left`, as a share of `points`.
template <class Bytes>
double share_that_fits(std::size_t points, std::uint64_t left, const Bytes& bytes_of) {
  double share = 1.0;
  while (share > 1e-6 && bytes_of(static_cast<std::size_t>(share * static_cast<double>(points))) > left)
    share *= 0.8;
  return share;
}

std::string cones_that_fit(const Session& session, RadiositySettings settings, const ExchangedCount& count) {
  const std::uint64_t left = session.bytes_left();
  const auto fits = [&] { return exchange_need("cones", settings, count, left).least <= left; };
  const int wanted = settings.voxels;
  for (auto side = std::rbegin(limits::voxel_sides); side != std::rend(limits::voxel_sides); ++side) {
    settings.voxels = *side;
    if (*side < wanted && fits()) return fmt::format("radiosity.voxels = {}", *side);
  }
  return {};
}

void require_exchange(const Session& session, const IndirectRequest& request, const ScenePoints& points) {
  if (!reason_against_radiosity(request).empty()) return;
  const RadiositySettings& settings = request.scene.radiosity;
  // The planner takes "directions" where nothing else is cheaper, and that method can do with little.
  const std::string method = settings.method == "auto" ? "directions" : settings.method;
  const std::vector<std::uint8_t> exchanging = exchanging_materials(request.scene);
  ExchangedCount count{0, request.points.size};
  for (const Splat& s : request.points)
    count.points += exchanging[material_of(s)];
  const std::uint64_t left = session.bytes_left();
  const auto bytes_of = [&](std::size_t some) {
    const double share = static_cast<double>(some) / static_cast<double>(std::max<std::size_t>(1, count.points));
    return exchange_need(method, settings, {some, static_cast<std::size_t>(share * static_cast<double>(count.pool))},
                         left)
        .least;
  };
  const std::uint64_t wanted = bytes_of(count.points);
  if (wanted <= left) return;
  std::vector<std::string> remedies;
  if (method == "gather" && settings.visibility_cache.value_or(true)) {
    RadiositySettings traced = settings;
    traced.visibility_cache = false;
    if (exchange_need(method, traced, count, left).least <= left)
      remedies.push_back("radiosity.visibility_cache = false");
  }
  if (method == "cones") remedies.push_back(cones_that_fit(session, settings, count));
  if (method != "directions" && exchange_need("directions", settings, count, left).least <= left)
    remedies.push_back("radiosity.method = \"directions\"");
  remedies.push_back(fewer_points(points, share_that_fits(count.points, left, bytes_of)));
  refuse(fmt::format("radiosity.method = \"{}\" of {} points {}", method, count.points, needs(session, wanted)),
         remedies);
}

void require_photons(const Session& session, const IndirectRequest& request) {
  const auto photons = static_cast<std::uint64_t>(request.scene.caustics.photons);
  if (request.by_paths || photons == 0 || !request.lighting.has_specular() || !request.lighting.has_light()) return;
  const std::uint64_t left = session.bytes_left();
  const auto bytes_of = [&](std::uint64_t some) {
    return photon_map_bytes(std::min<std::uint64_t>(some / 2, most_stored_photons), request.points.size);
  };
  if (bytes_of(photons) <= left) return;
  double fits = static_cast<double>(photons);
  while (fits >= 1.0 && bytes_of(static_cast<std::uint64_t>(fits)) > left)
    fits *= 0.9;
  refuse(fmt::format("caustics.photons = {} {}", photons, needs(session, bytes_of(photons))),
         {fmt::format("caustics.photons = {}", rounded_down(fits))});
}

} // namespace

std::string fewer_points(const ScenePoints& all, double share) {
  struct Object {
    std::size_t points = 0;
    double area = 0.0;
  };
  std::vector<Object> objects(all.first.size);
  for (std::size_t k = 0; k < all.points.size && !objects.empty(); ++k) {
    const auto behind = std::upper_bound(all.first.begin(), all.first.end(), all.ids[k]);
    const std::ptrdiff_t object = behind - all.first.begin() - 1;
    if (object < 0) continue;
    Object& of = objects[static_cast<std::size_t>(object)];
    ++of.points;
    of.area += all.points[k].area;
  }
  const auto largest = std::max_element(objects.begin(), objects.end(),
                                        [](const Object& a, const Object& b) { return a.points < b.points; });
  if (largest == objects.end() || largest->points == 0) return {};
  const auto number = static_cast<std::size_t>(largest - objects.begin());
  const auto total = static_cast<double>(all.points.size), its = static_cast<double>(largest->points);
  // What the others keep, this one has to lose, but for a tenth of its points.
  const double kept = std::max(0.1, 1.0 - (1.0 - share) * total / its);
  const double spacing = all.side * std::sqrt(largest->area / its) / std::sqrt(kept);
  const std::size_t clouds = all.scene.clouds.size();
  std::string key;
  if (number >= clouds)
    key = fmt::format("shape.{}.spacing = {}", number - clouds, rounded_up(spacing));
  else if (const CloudSettings& cloud = all.scene.clouds[number]; cloud.spacing > 0.0)
    key = fmt::format("cloud.{}.spacing = {}", number, rounded_up(spacing));
  else
    key = fmt::format("cloud.{}.voxel = {}", number, rounded_up(spacing / cloud.scale));
  return fmt::format("{}, which keeps about {} points", key, rounded_down(total - (1.0 - kept) * its));
}

void require_pool_memory(const Session& session, const ScenePoints& points, const OctreeSummary& octree,
                         const TraversalVariant& variant) {
  const std::uint64_t left = session.bytes_left();
  if (octree.bytes <= left) return;
  std::vector<std::string> remedies;
  if (variant.form == TraversalForm::step) remedies.push_back("traversal.form = \"wide\"");
  remedies.push_back(fewer_points(points, static_cast<double>(left) / static_cast<double>(octree.bytes)));
  refuse(fmt::format("the octree of {} points {}", octree.points, needs(session, octree.bytes)), remedies);
}

void require_light_memory(const Session& session, const IndirectRequest& request, const ScenePoints& points,
                          bool photons) {
  require_exchange(session, request, points);
  if (photons) require_photons(session, request);
}

void require_fmm_memory(const Session& session, const ClusterTree& tree, const RadiositySettings& settings,
                        const LinkEstimate& links) {
  const std::uint64_t wanted = fmm_bytes(tree, static_cast<unsigned>(settings.order), links);
  if (wanted <= session.bytes_left()) return;
  refuse(
      fmt::format("radiosity.method = \"fmm\" of {} points and about {:.1f} million links {}", tree.points.size(),
                  1e-6 * links.links, needs(session, wanted)),
      {"radiosity.method = \"directions\"", fmt::format("radiosity.epsilon = {}", rounded_up(4.0 * settings.epsilon))});
}

} // namespace pointgi
