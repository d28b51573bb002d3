#include "host/error.h"
#include "host/scene/sample_shape.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

using namespace pointgi;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int draws = 2000; // random points on each shape

using Random = std::mt19937;

double uniform(Random& random) {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random);
}

Vector3d direction(Random& random) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(random), normal(random), normal(random)).normalized();
}

/// A shape, its area, the way out at a point of it, and how to draw points of it.
struct Known {
  std::string name;
  ShapeGeometry geometry;
  double size; ///< the spacings of a test are fractions of this
  double area;
  std::function<Vector3d(Random&)> draw;
  std::function<Vector3d(const Vector3d&)> front;
  bool round; ///< rays that look at it run along the front direction of the point, not along a splat's own normal
};

Known quad(const std::string& name, const QuadShape& shape) {
  const Vector3d span = shape.edge_u.cross(shape.edge_v);
  return {name,
          shape,
          std::max(shape.edge_u.norm(), shape.edge_v.norm()),
          span.norm(),
          [=](Random& r) -> Vector3d {
            // Corners and edges belong to the shape: draw them more often than they come by chance.
            const auto side = [&] { return std::clamp(1.2 * uniform(r) - 0.1, 0.0, 1.0); };
            const double u = side(), v = side();
            return shape.corner + u * shape.edge_u + v * shape.edge_v;
          },
          [=](const Vector3d&) -> Vector3d { return span.normalized(); },
          false};
}

Known sphere(bool inward) {
  const SphereShape shape{{1, -2, 3}, 0.7, inward};
  return {inward ? "sphere inward" : "sphere",
          shape,
          shape.radius,
          4 * pi * shape.radius * shape.radius,
          [=](Random& r) -> Vector3d { return shape.centre + shape.radius * direction(r); },
          [=](const Vector3d& p) -> Vector3d { return (inward ? -1.0 : 1.0) * (p - shape.centre).normalized(); },
          true};
}

Known box(bool inward) {
  const BoxShape shape{{-1, 0, 2}, {1, 0.5, 5}, inward};
  const Vector3d size = shape.max - shape.min;
  const Vector3d middle = (shape.max + shape.min) / 2;
  return {inward ? "box inward" : "box",
          shape,
          0.5,
          2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x()),
          [=](Random& r) -> Vector3d {
            Vector3d p = shape.min + Vector3d(uniform(r), uniform(r), uniform(r)).cwiseProduct(size);
            const int axis = static_cast<int>(3 * uniform(r));
            p[axis] = uniform(r) < 0.5 ? shape.min[axis] : shape.max[axis];
            return p;
          },
          [=](const Vector3d& p) -> Vector3d {
            const Vector3d relative = (p - middle).cwiseQuotient(size);
            Eigen::Index axis = 0;
            relative.cwiseAbs().maxCoeff(&axis);
            const double sign = (relative[axis] > 0) == inward ? -1.0 : 1.0;
            return sign * Vector3d::Unit(axis);
          },
          false};
}

Known disc() {
  const DiscShape shape{{0, 1, 0}, {1, 2, -2}, 1.5};
  const Vector3d normal = shape.normal.normalized();
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  return {"disc",
          shape,
          shape.radius,
          pi * shape.radius * shape.radius,
          [=](Random& r) -> Vector3d {
            const double turn = 2 * pi * uniform(r);
            // The rim belongs to the disc: a tenth of the points lies on it.
            const double out = shape.radius * std::sqrt(std::min(1.0, 1.1 * uniform(r)));
            return shape.centre + out * (std::cos(turn) * u + std::sin(turn) * v);
          },
          [=](const Vector3d&) { return normal; },
          false};
}

Known cylinder(bool inward) {
  const CylinderShape shape{{1, 1, 1}, {2, 3, -1}, 0.8, inward};
  const Vector3d axis = shape.top - shape.base;
  const Vector3d along = axis.normalized();
  const Vector3d u = along.unitOrthogonal(), v = along.cross(u);
  return {inward ? "cylinder inward" : "cylinder",
          shape,
          shape.radius,
          2 * pi * shape.radius * axis.norm(),
          [=](Random& r) -> Vector3d {
            const double turn = 2 * pi * uniform(r);
            const double height = std::clamp(1.1 * uniform(r) - 0.05, 0.0, 1.0);
            return shape.base + height * axis + shape.radius * (std::cos(turn) * u + std::sin(turn) * v);
          },
          [=](const Vector3d& p) -> Vector3d {
            const Vector3d from = p - shape.base;
            return (inward ? -1.0 : 1.0) * (from - along * along.dot(from)).normalized();
          },
          true};
}

std::vector<Known> shapes() {
  return {quad("square", {{0, 0, 0}, {0, 0, 2}, {2, 0, 0}}),
          quad("strip", {{5, 5, 5}, {0.3, 0, 0}, {0, 7, 0}}),
          quad("skewed", {{0, 0, 0}, {1, 0, 0}, {0.9, 0.4, 0.1}}),
          quad("far away", {{4.2e5, 5.4e6, 100}, {3, 1, 0}, {0, 2, 1}}),
          sphere(false),
          sphere(true),
          box(false),
          box(true),
          disc(),
          cylinder(false),
          cylinder(true)};
}

PointCloud sampled(const Known& shape, double spacing) {
  ShapeSettings settings;
  settings.geometry = shape.geometry;
  settings.spacing = spacing;
  settings.place = {"scene.toml", 7, 1};
  return sample_shape(settings);
}

/// A disc shape ends at a polygon, whose sides lie up to this much inside its rim and its corners as much outside, in
/// units of its splats' radii.
constexpr double polygon_slack = 0.05;

/// Whether a place on splat i, `off` from its centre, is inside its borders.
bool is_inside(const PointCloud& cloud, std::size_t i, const Vector3d& off) {
  const auto at = std::lower_bound(cloud.clipped.begin(), cloud.clipped.end(), i,
                                   [](const ClippedPoint& c, std::size_t point) { return c.point < point; });
  if (at == cloud.clipped.end() || at->point != i) return true;
  const double slack = polygon_slack * cloud.radius[i];
  return std::all_of(at->clip.strip.begin(), at->clip.strip.end(), [&](const ClipStrips::Strip& strip) {
    const double along = strip.axis.dot(off);
    return along >= strip.low - slack && along <= strip.high + slack;
  });
}

/// Whether a ray through `point` along `ray` meets splat i within its radius and borders, near the point.
bool covers(const PointCloud& cloud, std::size_t i, const Vector3d& point, const Vector3d& ray) {
  const Vector3d normal = cloud.normal[i].cast<double>();
  const Vector3d to_centre = cloud.position[i] - point;
  const double radius = cloud.radius[i];
  const double cosine = normal.dot(ray);
  if (cosine < 0.5 || to_centre.norm() > 2 * radius) return false; // the far side, or another face
  const Vector3d hit = point + normal.dot(to_centre) / cosine * ray;
  return (hit - cloud.position[i]).norm() <= radius && is_inside(cloud, i, hit - cloud.position[i]);
}

const double fractions[] = {0.5, 0.21, 0.06};

} // namespace

TEST_CASE("the areas of a shape's splats sum to its area", "[scene]") {
  for (const Known& shape : shapes())
    for (const double fraction : fractions) {
      INFO(shape.name << ", spacing " << fraction << " of its size");
      const PointCloud cloud = sampled(shape, fraction * shape.size);
      double sum = 0;
      for (const float area : cloud.area)
        sum += area;
      // Each area is rounded to float once, 6e-8 relative; all may be rounded the same way.
      CHECK(sum == Approx(shape.area).epsilon(1e-7));
    }
}

TEST_CASE("a shape's splats lie on it and face the right way", "[scene]") {
  for (const Known& shape : shapes())
    for (const double fraction : fractions) {
      INFO(shape.name << ", spacing " << fraction << " of its size");
      const PointCloud cloud = sampled(shape, fraction * shape.size);
      REQUIRE(cloud.normal.size() == cloud.size());
      REQUIRE(cloud.radius.size() == cloud.size());
      REQUIRE(cloud.area.size() == cloud.size());
      CHECK(cloud.colour.empty());
      double worst_normal = 0, least_radius = 1e30;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vector3d error = cloud.normal[i].cast<double>() - shape.front(cloud.position[i]);
        worst_normal = std::max(worst_normal, error.norm());
        least_radius = std::min(least_radius, static_cast<double>(cloud.radius[i]));
      }
      CHECK(worst_normal < 2e-7); // three components rounded to float
      CHECK(least_radius > 0);
    }
}

TEST_CASE("no point of a shape is left uncovered", "[scene]") {
  for (const Known& shape : shapes())
    for (const double fraction : fractions) {
      INFO(shape.name << ", spacing " << fraction << " of its size");
      const PointCloud cloud = sampled(shape, fraction * shape.size);
      Random random(20240611);
      int holes = 0;
      for (int draw = 0; draw < draws; ++draw) {
        const Vector3d point = shape.draw(random);
        const Vector3d ray = shape.front(point);
        bool covered = false;
        for (std::size_t i = 0; i < cloud.size() && !covered; ++i)
          covered = covers(cloud, i, point, ray);
        holes += !covered;
      }
      CHECK(holes == 0);
    }
}

TEST_CASE("no splat of a shape reaches past its borders, and every one that would is clipped", "[scene]") {
  const QuadShape skewed{{1, 2, 3}, {2, 0, 0}, {0.9, 1.4, 0.1}}, strip{{0, 0, 0}, {5, 0, 0}, {0, 0.02, 0}};
  const DiscShape disc{{0, 0, 0}, {0, 0, 1}, 1.0};
  const CylinderShape tube{{0, 0, 0}, {0, 0, 2}, 0.5, false};
  const auto quad_excess = [](const QuadShape& quad) {
    return [quad](const Vector3d& p) { // how far outside, world units
      const Vector3d n = quad.edge_u.cross(quad.edge_v).normalized();
      const Vector3d across_u = quad.edge_v.cross(n).normalized(), across_v = n.cross(quad.edge_u).normalized();
      const double u = across_u.dot(p - quad.corner), v = across_v.dot(p - quad.corner);
      return std::max({-u, u - across_u.dot(quad.edge_u), -v, v - across_v.dot(quad.edge_v)});
    };
  };
  struct Case {
    ShapeGeometry geometry;
    std::function<double(const Vector3d&)> excess;
  };
  const std::vector<Case> cases = {{skewed, quad_excess(skewed)},
                                   {strip, quad_excess(strip)},
                                   {disc, [](const Vector3d& p) { return p.norm() - 1.0; }},
                                   {tube, [](const Vector3d& p) { return std::max(-p.z(), p.z() - 2.0); }}};
  Random random(20261129);
  for (const Case& c : cases)
    for (const double spacing : {0.5, 0.1, 0.03}) {
      const PointCloud cloud = sample_shape({c.geometry, spacing, "m", {}});
      double farthest = 0;
      std::size_t cut = 0;
      for (std::size_t i = 0; i < cloud.size(); ++i)
        for (int draw = 0; draw < 20; ++draw) {
          const Vector3d across = cloud.normal[i].cast<double>().cross(direction(random)).normalized();
          const Vector3d off = std::sqrt(uniform(random)) * cloud.radius[i] * across;
          const double excess = c.excess(cloud.position[i] + off) / cloud.radius[i];
          if (is_inside(cloud, i, off))
            farthest = std::max(farthest, excess);
          else
            ++cut;
        }
      INFO("shape " << &c - cases.data() << ", spacing " << spacing);
      CHECK(farthest < 3 * polygon_slack); // at the corners of the polygon that a coarse disc is
      CHECK(cut > 0);
    }
}

TEST_CASE("splats are about as dense as the spacing asks, and no larger than they must be", "[scene]") {
  for (const Known& shape : shapes())
    for (const double fraction : {0.1, 0.03}) {
      INFO(shape.name << ", spacing " << fraction << " of its size");
      const double spacing = fraction * shape.size;
      const PointCloud cloud = sampled(shape, spacing);
      // Cells are at most the spacing wide; whole cells, half-filled edges and skew make up to twice as many.
      const double ideal = shape.area / (spacing * spacing);
      CHECK(static_cast<double>(cloud.size()) > 0.85 * ideal);
      CHECK(static_cast<double>(cloud.size()) < 2.5 * ideal + 32);
      // Half a square's diagonal is 0.71 of its side, a skewed cell's up to 1; with the overlap of 1.1 and bent cells.
      CHECK(*std::max_element(cloud.radius.begin(), cloud.radius.end()) < 1.11 * spacing);
    }
}

TEST_CASE("splats overhang a disc's rim by less than half of their radius", "[scene]") {
  const DiscShape shape{{0, 0, 0}, {0, 0, 1}, 1.0};
  for (const double spacing : {3.0, 2.0, 1.0, 0.5, 0.2, 0.05, 0.013}) {
    INFO("spacing " << spacing);
    const PointCloud cloud = sample_shape({shape, spacing, "m", {}});
    double worst = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      worst = std::max(worst, (cloud.position[i].norm() + cloud.radius[i] - 1.0) / cloud.radius[i]);
    CHECK(worst < 0.5);
  }
  // Coarser than the disc: one splat that is the disc.
  const PointCloud one = sample_shape({shape, 2.0, "m", {}});
  REQUIRE(one.size() == 1);
  CHECK(one.radius[0] == 1.0f);
}

TEST_CASE("sampling gives the same splats every time", "[scene]") {
  const Known shape = sphere(false);
  const PointCloud first = sampled(shape, 0.05), second = sampled(shape, 0.05);
  CHECK(first.position == second.position);
  CHECK(first.radius == second.radius);
}

TEST_CASE("a scene may be large or small", "[scene]") {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const PointCloud cloud = sample_shape({SphereShape{{0, 0, 0}, scale, false}, 0.1 * scale, "m", {}});
    CHECK(cloud.size() == 1257); // 4 pi / 0.1², whatever the unit is
    CHECK(cloud.radius[0] / scale == Approx(0.0849).epsilon(0.01));
  }
}

TEST_CASE("too many splats are refused before memory is taken", "[scene]") {
  for (const Known& shape : shapes())
    for (const double spacing : {1e-9, 1e-18}) {
      INFO(shape.name);
      try {
        sampled(shape, spacing);
        FAIL("sampled");
      } catch (const Error& error) {
        CHECK(error.kind() == ErrorKind::input);
        CHECK_THAT(error.what(), Catch::StartsWith("scene.toml:7:1: the shape's spacing 1e-"));
        CHECK_THAT(error.what(), Catch::Contains("splats, expected at most 1e+08; set its spacing to "));
      }
    }
}

TEST_CASE("the spacing that the refusal names is enough", "[scene]") {
  for (const Known& shape : shapes()) {
    INFO(shape.name);
    ShapeSettings settings{shape.geometry, 0.001 * shape.size, "m", {}};
    try {
      sample_shape(settings, 1000);
      FAIL("sampled");
    } catch (const Error& error) {
      const std::string text = error.what();
      const std::string before = "set its spacing to ";
      settings.spacing = std::stod(text.substr(text.find(before) + before.size()));
    }
    const std::size_t count = sample_shape(settings, 1000).size();
    CHECK(count <= 1000);
    CHECK(count > 800); // and it is not much coarser than it must be
  }
}

TEST_CASE("a spacing that is no length is refused", "[scene]") {
  for (const double spacing :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    CHECK_THROWS_AS(sampled(sphere(false), spacing), Error);
}
