#include "host/cloud/kind.h"
#include "host/cloud/percent.h"
#include "host/cloud/quantile.h"
#include "host/cloud/sensor_view.h"
#include "octree/parallel.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

namespace pointgi {

namespace {

constexpr std::uint32_t looked_at = 4000;          // sites of a sample; shares are then right to 1 %
constexpr std::size_t most_in_columns = 1'000'000; // some 60,000 columns: their share is right to 0.5 %
constexpr double terrain_thickness = 0.35;
constexpr double terrain_facing = 0.5; // mean of |n.up|
constexpr double single_valued = 0.7;  // share of columns that hold one height
constexpr double two_sheets = 1.9;     // kurtosis below which the columns hold two
constexpr double enclosed = 0.15;      // openness below which a side is inside something
constexpr double many_enclosed = 0.3;  // share of sites with both sides enclosed, of rooms
constexpr double on_the_walls = 0.8;   // share of sites, of an empty box
constexpr double mostly_volume = 0.5;
constexpr double edge_on = 0.1;
// Structure from motion has 4.4 to 10, dense clouds and models 1 to 4; of scans from one station that are as uneven the
// sensor is known.
constexpr double uneven = 4.3;

struct Extent {
  Eigen::Vector3d low, high;
  Eigen::Vector3d size() const { return high - low; }
};

constexpr std::size_t grain = 1 << 16; // sites of a range

/// Of the sites on surfaces, or of all where these are few, without the outermost hundredth on each side.
Extent extent_of(const Sites& sites, const std::vector<Structure>& structure) {
  std::vector<std::uint32_t> on_surface;
  for (std::uint32_t s = 0; s < structure.size(); ++s)
    if (structure[s] == Structure::surface) on_surface.push_back(s);
  const bool all = structure.empty() || 4 * on_surface.size() < sites.size();
  const std::size_t count = all ? sites.size() : on_surface.size(), cut = count / 100;
  const auto bounds = bounds_at_ranks(count, cut, count - 1 - cut, [&](std::size_t i) {
    return sites.position(all ? static_cast<std::uint32_t>(i) : on_surface[i]);
  });
  return {Eigen::Vector3d::Map(bounds[0].data()), Eigen::Vector3d::Map(bounds[1].data())};
}

/// How much normals face along an axis: the means of |n.axis| and of n.axis.
struct AxisMeans {
  double either_way = 0, along = 0;

  AxisMeans& operator+=(const AxisMeans& other) {
    either_way += other.either_way;
    along += other.along;
    return *this;
  }
};

AxisMeans mean_facing(const std::vector<Eigen::Vector3f>& normals, int axis) {
  AxisMeans mean =
      parallel_sum(normals.size(), grain, AxisMeans(), [&](AxisMeans& sum, std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
          const auto along = static_cast<double>(normals[s][axis]);
          sum += {std::abs(along), along};
        }
      });
  mean.either_way /= static_cast<double>(normals.size());
  mean.along /= static_cast<double>(normals.size());
  return mean;
}

/// How the sites of a column lie about a plane of their own.
struct Layering {
  double one_layer = 0; ///< share of the columns in which they do so no farther than 1.8 of their distances
  double kurtosis = 3;  ///< of those distances from the plane: 3 for noise, near 1 for two sheets
};

/// The distances of a column's sites from the plane that fits them best, in cells.
std::vector<double> residuals_of(const Sites& sites, const std::vector<std::uint32_t>& column, int axis, double cell) {
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  const Eigen::Vector3d& origin = sites.position(column[0]);
  const auto row_of = [&](std::uint32_t s) {
    const Eigen::Vector3d e = (sites.position(s) - origin) / cell;
    return Eigen::Vector3d(1.0, e[a], e[b]);
  };
  Eigen::Matrix3d moments = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const std::uint32_t s : column) {
    moments += row_of(s) * row_of(s).transpose();
    right += row_of(s) * (sites.position(s)[axis] - origin[axis]) / cell;
  }
  const Eigen::Vector3d plane = moments.inverse() * right;
  std::vector<double> residuals;
  for (const std::uint32_t s : column)
    residuals.push_back((sites.position(s)[axis] - origin[axis]) / cell - plane.dot(row_of(s)));
  return residuals;
}

/// Over a grid across `axis` whose cells are four distances of neighbours wide. Points of no surface do not count. Of
/// more than a million sites in a regular sample of the columns.
Layering layering_of(const Sites& sites, const std::vector<Structure>& structure, const Extent& extent, int axis) {
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  const double longer = std::max(extent.size()[a], extent.size()[b]);
  if (std::min(extent.size()[a], extent.size()[b]) <= 1e-6 * longer) return {}; // no grid has cells across a line
  const double area = extent.size()[a] * extent.size()[b];
  const double cell = std::sqrt(16.0 * area / sites.size());
  const auto columns = static_cast<std::size_t>(extent.size()[a] / cell) + 1;
  const auto rows = static_cast<std::size_t>(extent.size()[b] / cell) + 1;
  const std::size_t step = (sites.size() + most_in_columns - 1) / most_in_columns;
  std::vector<std::vector<std::uint32_t>> grid((columns * rows + step - 1) / step);
  for (std::uint32_t s = 0; s < sites.size(); ++s) {
    if (!structure.empty() && structure[s] == Structure::line) continue;
    const Eigen::Vector3d p = (sites.position(s) - extent.low) / cell;
    if (p[a] < 0 || p[b] < 0) continue;
    const auto x = static_cast<std::size_t>(p[a]), y = static_cast<std::size_t>(p[b]);
    if (const std::size_t column = y * columns + x; x < columns && y < rows && column % step == 0)
      grid[column / step].push_back(s);
  }
  constexpr double thick = 0.45; // of a cell
  std::size_t full = 0, single = 0;
  double second = 0, fourth = 0, count = 0;
  for (const auto& column : grid) {
    if (column.size() < 8) continue;
    ++full;
    double sum = 0;
    const std::vector<double> residuals = residuals_of(sites, column, axis, cell);
    for (const double r : residuals)
      sum += r * r;
    const bool one = std::sqrt(sum / static_cast<double>(residuals.size())) < thick;
    single += one;
    for (const double r : residuals) {
      if (!one) break;
      second += r * r;
      fourth += r * r * r * r;
      count += 1;
    }
  }
  Layering result;
  if (full > 0) result.one_layer = static_cast<double>(single) / static_cast<double>(full);
  if (second > 1e-3 * count) result.kurtosis = fourth * count / (second * second); // thinner than that is one layer
  return result;
}

/// What a cloud that is a height field is one over.
struct HeightField {
  Eigen::Vector3d up;
  double one_layer; ///< share of its places that have one height
};

std::optional<HeightField> height_field(const Sites& sites, const Extent& extent,
                                        const std::vector<Eigen::Vector3f>& normals,
                                        const std::vector<Structure>& structure, const KindHints& hints) {
  const Eigen::Vector3d size = extent.size();
  int thin = 0;
  size.minCoeff(&thin);
  if (hints.up) hints.up->cwiseAbs().maxCoeff(&thin);
  const double middle = size.sum() - size.minCoeff() - size.maxCoeff();
  if (size[thin] > terrain_thickness * middle) return {};
  const AxisMeans facing = mean_facing(normals, thin);
  if (facing.either_way < terrain_facing) return {};
  if (hints.signs_given && std::abs(facing.along) < terrain_facing) return {}; // a wall scanned on both sides is none
  const Layering layers = layering_of(sites, structure, extent, thin);
  if (layers.one_layer <= single_valued || layers.kurtosis <= two_sheets) return {};
  // Given normals face down the axis in coordinates that count downwards.
  const double side = hints.signs_given && facing.along < 0 ? -1.0 : 1.0;
  return HeightField{hints.up ? *hints.up : Eigen::Vector3d(Eigen::Vector3d::Unit(thin) * side), layers.one_layer};
}

/// Whether normals that have signs point to the middle of the sites.
bool points_inwards(const Sites& sites, const std::vector<Eigen::Vector3f>& normals, const Extent& extent) {
  const Eigen::Vector3d middle = 0.5 * (extent.low + extent.high);
  const double sum = parallel_sum(sites.size(), grain, 0.0, [&](double& part, std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      part += normals[s].cast<double>().dot((middle - sites.position(static_cast<std::uint32_t>(s))).normalized());
  });
  return sum > 0.5 * sites.size();
}

/// The spacing that nine tenths of the sites stay below, over that of one tenth.
double unevenness(const std::vector<float>& spacing) {
  const std::size_t n = spacing.size();
  const auto found = values_at_ranks(n, std::array<std::size_t, 2>{rank_of_share(n, 0.1), rank_of_share(n, 0.9)},
                                     [&](std::size_t s, std::size_t) { return spacing[s]; });
  return found[1] / found[0];
}

/// Median of the cosine under which the sensor sees the surface: near 0, and it cannot have scanned it.
double median_cosine(const Sites& sites, const std::vector<Eigen::Vector3f>& normals, const Eigen::Vector3d& sensor) {
  const std::uint32_t step = std::max(1u, sites.size() / looked_at);
  std::vector<double> cosines;
  for (std::uint32_t s = 0; s < sites.size(); s += step) {
    const Eigen::Vector3d way = sites.position(s) - sensor;
    cosines.push_back(std::abs(normals[s].cast<double>().dot(way)) / std::max(way.norm(), 1e-30));
  }
  return median(std::move(cosines));
}

/// How many sites are on each of the six sides of a box, on any, and in or on it.
struct BoxCounts {
  std::array<std::size_t, 6> on{};
  std::size_t any = 0, inside = 0;

  void add(const Eigen::Vector3d& p, const Extent& extent, double near) {
    if ((p.array() < extent.low.array() - near).any() || (p.array() > extent.high.array() + near).any()) return;
    ++inside;
    bool wall = false;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side)
        if (std::abs(p[axis] - (side == 0 ? extent.low : extent.high)[axis]) < near) {
          ++on[static_cast<std::size_t>(2 * axis + side)];
          wall = true;
        }
    any += wall;
  }
  BoxCounts& operator+=(const BoxCounts& other) {
    for (std::size_t side = 0; side < on.size(); ++side)
      on[side] += other.on[side];
    any += other.any;
    inside += other.inside;
    return *this;
  }
};

/// Share of the sites near the six sides of the bounds, if every side has some; else 0.
double box_share(const Sites& sites, const Extent& extent) {
  const double near = 0.03 * extent.size().maxCoeff();
  const BoxCounts counts =
      parallel_sum(sites.size(), grain, BoxCounts(), [&](BoxCounts& sum, std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s)
          sum.add(sites.position(static_cast<std::uint32_t>(s)), extent, near);
      });
  if (*std::min_element(counts.on.begin(), counts.on.end()) * 50 < counts.inside) return 0.0;
  return static_cast<double>(counts.any) / static_cast<double>(std::max<std::size_t>(counts.inside, 1));
}

/// Metres, as nearly all scans of rooms have them.
bool has_size_of_a_room(const Eigen::Vector3d& size) {
  return size.minCoeff() > 1.8 && size.minCoeff() < 8.0 && size.maxCoeff() < 100.0;
}

/// Share of a sample of the sites that have something in front of both their sides.
double enclosed_share(const Sites& sites, const std::vector<Eigen::Vector3f>& normals, const FreeSpace& space) {
  const std::uint32_t step = std::max(1u, sites.size() / looked_at);
  std::size_t both = 0, all = 0;
  for (std::uint32_t s = 0; s < sites.size(); s += step, ++all) {
    const Eigen::Vector3d n = normals[s].cast<double>();
    both += space.openness(sites.position(s), n) < enclosed && space.openness(sites.position(s), -n) < enclosed;
  }
  return static_cast<double>(both) / static_cast<double>(all);
}

} // namespace

RecognisedKind recognise_kind(const Sites& sites, const std::vector<float>& spacing,
                              const std::vector<Eigen::Vector3f>& normals, const std::vector<Structure>& structure,
                              const FreeSpace& space, const KindHints& hints) {
  if (hints.has_stations)
    return {CloudKind::station, "positions of scanners are known", {}, hints.up.value_or(Eigen::Vector3d::UnitZ())};
  if (hints.usual) return {*hints.usual, "files of this format hold such", {}, hints.up};
  if (sites.size() < 100) return {CloudKind::model, "few points", {}, hints.up};
  const Eigen::Vector3d origin = sites.to_local(Eigen::Vector3d::Zero());
  if (const SensorView view = sensor_view(sites, origin);
      view.convincing() && median_cosine(sites, normals, origin) > edge_on) {
    char text[160];
    std::snprintf(text, sizeof text, "%.1f %% of the points have one depth a direction from the origin, %s",
                  100.0 * view.one_depth,
                  view.lattice ? "in rows and columns as pixels have" : "evenly spread over the directions");
    // A scanner that turns looks along the ground, a depth camera along its own z.
    const Extent extent = extent_of(sites, structure);
    const Eigen::Vector3d ahead = (extent.low + extent.high) / 2 - origin;
    const bool frame = view.lattice || (!view.all_around && std::abs(ahead.z()) > 0.8 * ahead.norm() && !hints.up);
    return {frame ? CloudKind::depth_frame : CloudKind::station, text, Eigen::Vector3d(Eigen::Vector3d::Zero()),
            frame ? hints.up : hints.up.value_or(Eigen::Vector3d::UnitZ())};
  }
  const Extent extent = extent_of(sites, structure);
  if (const auto field = height_field(sites, extent, normals, structure, hints))
    return {CloudKind::terrain, "one height at " + percent(field->one_layer, 0) + " of the places", {}, field->up};
  if (const double step = unevenness(spacing); step > uneven && hints.level_by == nullptr && !hints.signs_given) {
    char text[80];
    std::snprintf(text, sizeof text, "the spacing of its points differs by a factor of %.1f", step);
    return {CloudKind::sparse, text, {}, hints.up};
  }
  const auto volume = std::count(structure.begin(), structure.end(), Structure::volume);
  if (static_cast<double>(volume) > mostly_volume * sites.size())
    return {CloudKind::foliage,
            percent(static_cast<double>(volume) / sites.size(), 0) + " of the points have no surface around them",
            {},
            hints.up};
  const Eigen::Vector3d size = extent.size() * sites.unit();
  if (has_size_of_a_room(size) && (!hints.signs_given || points_inwards(sites, normals, extent)))
    if (const double walls = box_share(sites, extent); walls > on_the_walls)
      return {CloudKind::room,
              percent(walls, 0) + " of the points lie on the six sides of a box as large as a room",
              {},
              hints.up};
  if (const double inside = enclosed_share(sites, normals, space); inside > many_enclosed)
    return {CloudKind::room,
            percent(inside, 0) + " of the points have something in front of both their sides",
            {},
            hints.up};
  if (hints.level_by != nullptr) return {CloudKind::map, hints.level_by, {}, hints.up};
  return {CloudKind::model, "nothing speaks for another kind", {}, hints.up};
}

} // namespace pointgi
