#include "host/scene/sample_shape.h"
#include "host/error.h"
#include "host/scene/limits.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace pointgi {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Every cell is covered by its own splat with this much to spare, so that neighbours overlap where they meet and the
/// rounding of positions and radii to float cannot open a pinhole.
constexpr double overlap = 1.1;

/// Largest angle between a point of the sphere and the nearest of n Fibonacci points, times sqrt(n): 2.7336 at worst
/// (measured for n = 12 ... 50000; the worst place is beside the poles and hardly depends on n).
constexpr double fibonacci_covering = 2.734;

// Coarser than this, flat splats say nothing of a round shape: their tangents stand off by 13 % (sphere), 2 % (tube).
constexpr double fewest_on_sphere = 32;
constexpr double fewest_around_tube = 16;

/// Cells of at most `spacing` that divide `length` evenly, as a double: it may exceed any integer.
double cells(double length, double spacing) {
  constexpr double rounding = 1e-9; // 2.0 / 0.02 must be 100 cells, not 101
  return std::max(1.0, std::ceil(length / spacing * (1.0 - rounding)));
}

/// Where splats go.
class Splats {
public:
  explicit Splats(std::size_t count) {
    cloud_.position.reserve(count);
    cloud_.normal.reserve(count);
    cloud_.radius.reserve(count);
    cloud_.area.reserve(count);
  }

  void add(const Vector3d& position, const Vector3d& unit_normal, double radius, double area) {
    cloud_.position.push_back(position);
    cloud_.normal.push_back(unit_normal.cast<float>());
    cloud_.radius.push_back(static_cast<float>(radius));
    cloud_.area.push_back(static_cast<float>(area));
  }

  /// The splat that was added last ends at these borders, if its disc reaches one of them.
  void clip_last(const ClipStrips& clip) {
    const double radius = cloud_.radius.back();
    ClipStrips reached;
    bool any = false;
    for (std::size_t k = 0; k < clip.strip.size(); ++k) {
      if (-clip.strip[k].low >= radius && clip.strip[k].high >= radius) continue;
      reached.strip[k] = clip.strip[k];
      any = true;
    }
    if (any) cloud_.clipped.push_back({static_cast<std::uint32_t>(cloud_.position.size() - 1), reached});
  }

  PointCloud take() { return std::move(cloud_); }

private:
  PointCloud cloud_;
};

// For each shape two functions: how many splats there will be, as a double (it may exceed any integer), and the splats.

double cells_u(const QuadShape& quad, double spacing) {
  return cells(quad.edge_u.norm(), spacing);
}
double cells_v(const QuadShape& quad, double spacing) {
  return cells(quad.edge_v.norm(), spacing);
}

double count_of(const QuadShape& quad, double spacing) {
  return cells_u(quad, spacing) * cells_v(quad, spacing);
}

/// Equal parallelograms, a splat in the middle of each. The smallest disc around a cell's centre that covers the cell
/// reaches to the ends of its longer diagonal, however skewed it is.
void sample(const QuadShape& quad, double spacing, Splats& splats) {
  const double count_u = cells_u(quad, spacing);
  const double count_v = cells_v(quad, spacing);
  const Vector3d step_u = quad.edge_u / count_u;
  const Vector3d step_v = quad.edge_v / count_v;
  const Vector3d span = quad.edge_u.cross(quad.edge_v);
  const double radius = overlap * 0.5 * std::max((step_u + step_v).norm(), (step_u - step_v).norm());
  const double area = span.norm() / (count_u * count_v);
  const Vector3d normal = span.normalized();
  // Across the edges, inwards; how far a step along the other edge goes that way.
  const Vector3d across_u = quad.edge_v.cross(normal).normalized(), across_v = normal.cross(quad.edge_u).normalized();
  const double width_u = step_u.dot(across_u), width_v = step_v.dot(across_v);
  for (double j = 0.5; j < count_v; ++j)
    for (double i = 0.5; i < count_u; ++i) {
      splats.add(quad.corner + i * step_u + j * step_v, normal, radius, area);
      splats.clip_last(
          {{{{across_u, -i * width_u, (count_u - i) * width_u}, {across_v, -j * width_v, (count_v - j) * width_v}}}});
    }
}

std::vector<QuadShape> faces_of(const BoxShape& box) {
  const Vector3d size = box.max - box.min;
  std::vector<QuadShape> faces;
  for (int axis = 0; axis < 3; ++axis) {
    // u x v points along +axis for (axis+1, axis+2), along -axis for the two swapped.
    Vector3d u = Vector3d::Zero(), v = Vector3d::Zero();
    u[(axis + 1) % 3] = size[(axis + 1) % 3];
    v[(axis + 2) % 3] = size[(axis + 2) % 3];
    Vector3d upper = box.min;
    upper[axis] = box.max[axis];
    faces.push_back(box.inward ? QuadShape{box.min, u, v} : QuadShape{box.min, v, u});
    faces.push_back(box.inward ? QuadShape{upper, v, u} : QuadShape{upper, u, v});
  }
  return faces;
}

double count_of(const BoxShape& box, double spacing) {
  double count = 0;
  for (const QuadShape& face : faces_of(box))
    count += count_of(face, spacing);
  return count;
}

void sample(const BoxShape& box, double spacing, Splats& splats) {
  for (const QuadShape& face : faces_of(box))
    sample(face, spacing, splats);
}

double count_of(const SphereShape& sphere, double spacing) {
  const double ratio = sphere.radius / spacing;
  return std::max(fewest_on_sphere, std::ceil(4.0 * pi * ratio * ratio));
}

/// A Fibonacci spiral: equal slices of height (so equal areas), turned by the golden angle. Flat splats that touch the
/// sphere from outside close it where each reaches the neighbouring tangent planes: R tan(covering angle).
void sample(const SphereShape& sphere, double spacing, Splats& splats) {
  const double count = count_of(sphere, spacing);
  const double golden_angle = pi * (3.0 - std::sqrt(5.0));
  const double radius = overlap * sphere.radius * std::tan(fibonacci_covering / std::sqrt(count));
  const double area = 4.0 * pi * sphere.radius * sphere.radius / count;
  for (double i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double across = std::sqrt(1.0 - z * z);
    const double turn = golden_angle * i;
    const Vector3d outward(across * std::cos(turn), across * std::sin(turn), z);
    splats.add(sphere.centre + sphere.radius * outward, sphere.inward ? Vector3d(-outward) : outward, radius, area);
  }
}

/// Two unit vectors that make a right-handed frame with `axis`.
std::pair<Vector3d, Vector3d> frame_of(const Vector3d& axis) {
  const Vector3d u = axis.unitOrthogonal();
  return {u, axis.cross(u)};
}

/// The j-th ring of width w around a disc of diameter w, its splats on the middle radius j w. As it is 2 pi j w long,
/// as many splats as its length holds widths leave cells that are nearly square.
double on_ring(double j) {
  return std::round(2.0 * pi * j);
}

double rings_of(const DiscShape& disc, double spacing) {
  constexpr double rounding = 1e-9; // as in cells()
  return std::max(0.0, std::ceil((disc.radius / spacing - 0.5) * (1.0 - rounding)));
}

double count_of(const DiscShape& disc, double spacing) {
  const double rings = rings_of(disc, spacing);
  // So many rings that the sum would take long: without its rounding it is close enough to be refused.
  if (rings > 1e5) return 1.0 + pi * rings * (rings + 1.0);
  double count = 1.0;
  for (double j = 1; j <= rings; ++j)
    count += on_ring(j);
  return count;
}

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// One splat in the middle, then concentric rings. The outermost end at a regular polygon of the disc's area, a side
/// each. Inside a ring's cell the outer corners are the farthest points; inner corners are nearer, as the cell widens
/// outwards.
void sample(const DiscShape& disc, double spacing, Splats& splats) {
  const double rings = rings_of(disc, spacing);
  const double width = disc.radius / (rings + 0.5);
  const Vector3d normal = disc.normal.normalized();
  const auto [u, v] = frame_of(normal);
  // A disc of one splat is that splat: nothing is left over that an overlap could be needed for.
  splats.add(disc.centre, normal, (rings > 0 ? overlap : 1.0) * width / 2, pi * width * width / 4);
  const double half_side = rings > 0 ? pi / on_ring(rings) : 0.0;
  const double side = rings > 0 ? disc.radius * std::sqrt(half_side / std::tan(half_side)) : 0.0; // from the middle
  for (double j = 1; j <= rings; ++j) {
    const double in_ring = on_ring(j);
    const double half_cell = pi / in_ring;
    const double outer = (j + 0.5) * width;
    const double reach = std::hypot(outer * std::cos(half_cell) - j * width, outer * std::sin(half_cell));
    const double area = 2.0 * pi * j * width * width / in_ring;
    for (double i = 0; i < in_ring; ++i) {
      const double turn = (2.0 * i + j) * half_cell; // every other ring starts half a cell on
      const Vector3d outward = std::cos(turn) * u + std::sin(turn) * v;
      splats.add(disc.centre + j * width * outward, normal, overlap * reach, area);
      if (j == rings) splats.clip_last({{{{outward, -unbounded, side - j * width}, {}}}});
    }
  }
}

double cells_around(const CylinderShape& tube, double spacing) {
  return std::max(fewest_around_tube, cells(2.0 * pi * tube.radius, spacing));
}
double cells_along(const CylinderShape& tube, double spacing) {
  return cells((tube.top - tube.base).norm(), spacing);
}

double count_of(const CylinderShape& tube, double spacing) {
  return cells_around(tube, spacing) * cells_along(tube, spacing);
}

/// The unrolled grid, its rows not staggered: the cells are then the planks of one prism around the tube, without the
/// slivers that open between rows turned against each other.
void sample(const CylinderShape& tube, double spacing, Splats& splats) {
  const Vector3d axis = tube.top - tube.base;
  const double height = axis.norm();
  const double around = cells_around(tube, spacing);
  const double rows = cells_along(tube, spacing);
  const Vector3d along = axis / height;
  const auto [u, v] = frame_of(along);
  const double half_cell = pi / around;
  const double radius = overlap * std::hypot(tube.radius * std::tan(half_cell), 0.5 * height / rows);
  const double area = 2.0 * pi * tube.radius * height / (around * rows);
  for (double row = 0.5; row < rows; ++row) {
    const Vector3d centre = tube.base + row / rows * axis;
    for (double i = 0; i < around; ++i) {
      const double turn = 2.0 * half_cell * i;
      const Vector3d outward = std::cos(turn) * u + std::sin(turn) * v;
      splats.add(centre + tube.radius * outward, tube.inward ? Vector3d(-outward) : outward, radius, area);
      splats.clip_last({{{{along, -row / rows * height, (1.0 - row / rows) * height}, {}}}});
    }
  }
}

std::string text(double number) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.4g", number);
  return digits;
}

[[noreturn]] void refuse_count(const ShapeSettings& shape, double count, double max_points) {
  const auto count_at = [&](double spacing) {
    return std::visit([&](const auto& geometry) { return count_of(geometry, spacing); }, shape.geometry);
  };
  // Counts grow with 1 / spacing², but in whole cells: from that estimate on, a little coarser until it fits. A round
  // shape's least count may be too many at any spacing, hence the bound.
  double enough = shape.spacing * std::sqrt(count / max_points);
  for (int step = 0; step < 1000 && count_at(enough) > max_points; ++step)
    enough *= 1.01;
  constexpr double written_digits = 1.001; // the text must not round it down
  throw Error(ErrorKind::input, shape.place.text() + ": the shape's spacing " + text(shape.spacing) + " would give " +
                                    text(count) + " splats, expected at most " + text(max_points) +
                                    "; set its spacing to " + text(enough * written_digits) + " or more");
}

} // namespace

bool has_flat_faces(const ShapeSettings& shape) {
  return std::holds_alternative<QuadShape>(shape.geometry) || std::holds_alternative<BoxShape>(shape.geometry) ||
         std::holds_alternative<DiscShape>(shape.geometry);
}

PointCloud sample_shape(const ShapeSettings& shape, std::size_t max_points) {
  if (!(shape.spacing >= limits::length.low && shape.spacing <= limits::length.high))
    throw Error(ErrorKind::input, shape.place.text() + ": the shape's spacing is " + text(shape.spacing) +
                                      ", expected a number " + limits::length.words);
  return std::visit(
      [&](const auto& geometry) {
        const double count = count_of(geometry, shape.spacing);
        if (!(count <= static_cast<double>(max_points))) refuse_count(shape, count, static_cast<double>(max_points));
        Splats splats(static_cast<std::size_t>(count));
        sample(geometry, shape.spacing, splats);
        return splats.take();
      },
      shape.geometry);
}

} // namespace pointgi
