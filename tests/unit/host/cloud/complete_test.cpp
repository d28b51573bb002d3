#include "host/cloud/complete.h"
#include "host/cloud/drop_points.h"
#include "host/error.h"
#include "tests/unit/host/cloud/completed_cloud.h"
#include "tests/unit/host/cloud/sampled_surfaces.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <omp.h>

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

CompleteOptions with(NormalSource normals) {
  CompleteOptions options;
  options.normals = normals;
  return options;
}

PointCloud without_normals(PointCloud cloud) {
  cloud.normal.clear();
  return cloud;
}

/// A ball of `rings` x 2 rings quads, cut into triangles that face outwards.
PointCloud ball_mesh(int rings) {
  PointCloud cloud;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      const double latitude = pi * (i + 0.25) / (rings + 0.5), longitude = pi * j / rings;
      cloud.position.emplace_back(std::sin(latitude) * std::cos(longitude), std::sin(latitude) * std::sin(longitude),
                                  std::cos(latitude));
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * 2 * rings + j % (2 * rings)); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      cloud.triangle.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      cloud.triangle.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return cloud;
}

} // namespace

TEST_CASE("bad points are dropped, counted and reported, and the rest is as if they had never been",
          "[cloud][complete]") {
  PointCloud clean = fibonacci_sphere(3000);
  clean.radius.assign(3000, 0.05f);
  clean.colour.assign(3000, Vector3f(0.1f, 0.2f, 0.3f));
  PointCloud dirty;
  std::size_t bad = 0;
  std::vector<std::uint32_t> number;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    if (i % 100 == 7) {
      dirty.position.push_back(clean.position[i]);
      dirty.normal.push_back(clean.normal[i]);
      dirty.colour.push_back(clean.colour[i]);
      dirty.radius.push_back(clean.radius[i]);
      switch (bad++ % 6) {
      case 0:
        dirty.position.back().y() = std::numeric_limits<double>::quiet_NaN();
        break;
      case 1:
        dirty.position.back().z() = -std::numeric_limits<double>::infinity();
        break;
      case 2:
        dirty.radius.back() = 0;
        break;
      case 3:
        dirty.radius.back() = -1;
        break;
      case 4:
        dirty.radius.back() = infinite;
        break;
      default:
        dirty.radius.back() = 1e-42f;
        break;
      }
    }
    number.push_back(static_cast<std::uint32_t>(dirty.size()));
    dirty.position.push_back(clean.position[i]);
    dirty.normal.push_back(clean.normal[i]);
    dirty.colour.push_back(clean.colour[i]);
    dirty.radius.push_back(clean.radius[i]);
  }
  for (std::uint32_t i = 0; i + 2 < 3000; i += 5) {
    clean.triangle.push_back({i, i + 1, i + 2});
    dirty.triangle.push_back({number[i], number[i + 1], number[i + 2]});
  }
  dirty.triangle.push_back({number[7] - 1, 0, 1}); // refers to a point that goes
  dirty.triangle.push_back({0, 1, 4000000000u});   // to none
  const CloudReport dirty_report = complete(dirty), clean_report = complete(clean);
  CHECK(dirty_report.points_in_file == 3030);
  CHECK(dirty_report.points_dropped == 30);
  CHECK(warns_of(dirty_report, "30 of 3030 points were dropped"));
  CHECK(clean_report.points_dropped == 0);
  CHECK(clean_report.warnings.empty());
  CHECK(dirty.position == clean.position);
  CHECK(dirty.normal == clean.normal);
  CHECK(dirty.colour == clean.colour);
  CHECK(dirty.radius == clean.radius);
  CHECK(dirty.area == clean.area);
  CHECK(dirty.triangle == clean.triangle);
}

TEST_CASE("what is not used can not make a point unusable", "[cloud][complete]") {
  PointCloud cloud = fibonacci_sphere(500);
  cloud.radius.assign(500, -1.0f);
  cloud.normal[3].setZero();
  CompleteOptions options = with(NormalSource::estimate);
  options.radii = RadiusSource::estimate;
  CHECK(complete(cloud, options).points_dropped == 0);
  check_promises(cloud);
}

TEST_CASE("clouds of which nothing is left, or that lack what is asked for, are refused", "[cloud][complete]") {
  const auto refused = [](PointCloud cloud, const CompleteOptions& options, const std::string& word) {
    CloudReport report;
    try {
      complete_cloud(cloud, options, report);
      FAIL("not refused: " + word);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::input);
      CHECK(std::string(error.what()).find(word) != std::string::npos);
    }
  };
  refused({}, {}, "no points");
  PointCloud broken;
  broken.position.assign(5, Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  refused(broken, {}, "none of the cloud's 5 points");
  refused(without_normals(fibonacci_sphere(10)), with(NormalSource::file), "\"estimate\"");
  CompleteOptions radii;
  radii.radii = RadiusSource::file;
  refused(fibonacci_sphere(10), radii, "radius");
}

TEST_CASE("the file's normals and radii are used", "[cloud][complete]") {
  PointCloud cloud = fibonacci_sphere(2000);
  const std::vector<Vector3f> truth = cloud.normal;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.normal[i] *= i % 2 == 0 ? 1e-20f : 13.0f;
  cloud.radius.assign(2000, 0.125f);
  const CloudReport report = complete(cloud);
  CHECK(report.normals_from == "file");
  CHECK(report.radii_from == "file");
  CHECK(report.warnings.empty());
  check_promises(cloud);
  CHECK(agreement(cloud, truth) == 1);
  CHECK(cloud.radius == std::vector<float>(2000, 0.125f));
  CHECK(total(cloud.area) == Approx(4 * pi).epsilon(0.01));

  CompleteOptions estimate;
  estimate.radii = RadiusSource::estimate;
  CHECK(complete(cloud = fibonacci_sphere(2000), estimate).radii_from.find("estimated") == 0);
}

TEST_CASE("areas that a sampler gave are kept, and so are its normals", "[cloud][complete]") {
  PointCloud room = fibonacci_sphere(2000);
  for (Vector3f& n : room.normal)
    n = -n;
  room.radius.assign(2000, 0.1f);
  room.area.assign(2000, 0.006f);
  const PointCloud before = room;
  const CloudReport report = complete(room);
  CHECK(report.areas_from == "given");
  CHECK(report.normals_from == "file");
  CHECK(agreement(room, before.normal) == 1); // faces inwards on purpose
  CHECK(room.area == before.area);
  CHECK(room.radius == before.radius);
}

TEST_CASE("a closed surface that faces inwards is turned, unless the file is to be trusted", "[cloud][complete]") {
  PointCloud inward = fibonacci_sphere(3000);
  const std::vector<Vector3f> outward = inward.normal;
  for (Vector3f& n : inward.normal)
    n = -n;
  PointCloud cloud = inward;
  CloudReport report = complete(cloud);
  CHECK(report.normals_from == "file, flipped");
  CHECK(warns_of(report, "normals = \"file\""));
  CHECK(agreement(cloud, outward) == 1);

  report = complete(cloud = inward, with(NormalSource::file));
  CHECK(report.normals_from == "file");
  CHECK(report.warnings.empty());
  CHECK(agreement(cloud, outward) == 0);

  complete(cloud = inward, with(NormalSource::flip)); // what the user says mends it, mends it
  CHECK(agreement(cloud, outward) == 1);
  complete(cloud = inward, with(NormalSource::estimate));
  CHECK(agreement(cloud, outward) == 1);
}

TEST_CASE("faces give normals, and their winding is turned with them", "[cloud][complete]") {
  PointCloud cloud = ball_mesh(20);
  std::vector<Vector3f> outward;
  for (const Vector3d& p : cloud.position)
    outward.push_back(p.cast<float>());
  PointCloud inside_out = cloud;
  for (auto& t : inside_out.triangle)
    std::swap(t[1], t[2]);

  CloudReport report = complete(cloud);
  CHECK(report.normals_from == "faces");
  CHECK(report.triangles == cloud.triangle.size());
  CHECK(agreement(cloud, outward) == 1);

  PointCloud kept = inside_out;
  report = complete(kept, with(NormalSource::file));
  CHECK(report.normals_from == "faces");
  CHECK(agreement(kept, outward) == 0);

  report = complete(inside_out);
  CHECK(report.normals_from == "faces, flipped");
  CHECK(agreement(inside_out, outward) == 1);
  CHECK(mesh_volume(inside_out) == Approx(mesh_volume(cloud))); // the same sum in another order
}

TEST_CASE("open surfaces and mixed signs are left alone", "[cloud][complete]") {
  PointCloud bowl = fibonacci_sphere(4000), mixed = fibonacci_sphere(4000);
  for (Vector3f& n : bowl.normal)
    n = -n;
  bowl.position.resize(2000); // the spiral runs from one pole to the other
  bowl.normal.resize(2000);
  const std::vector<Vector3f> bowl_normals = bowl.normal;
  CHECK(complete(bowl).normals_from == "file");
  CHECK(agreement(bowl, bowl_normals) == 1);

  std::mt19937_64 random(61);
  for (Vector3f& n : mixed.normal)
    if (uniform(random, 0, 1) < 0.6) n = -n;
  const std::vector<Vector3f> mixed_normals = mixed.normal;
  const CloudReport report = complete(mixed);
  CHECK(report.normals_from == "file");
  CHECK(warns_of(report, "48")); // 2 x 0.6 x 0.4 of the pairs are opposed
  CHECK(agreement(mixed, mixed_normals) == 1);
  CHECK(total(mixed.area) == Approx(4 * pi).epsilon(0.02)); // one surface, whatever its signs
}

TEST_CASE("few points, or points in a row or in one place, become something finite", "[cloud][complete]") {
  for (const double scale : {1e-30, 1.0, 1e15}) {
    for (const int n : {1, 2, 3, 4, 5, 20}) {
      PointCloud line, pile, scatter;
      std::mt19937_64 random(62);
      for (int i = 0; i < n; ++i) {
        line.position.push_back(scale * (Vector3d(1, 2, 3) + 0.1 * i * Vector3d(2, 1, 0)));
        pile.position.push_back(scale * Vector3d(1, 2, 3));
        scatter.position.push_back(scale * on_sphere(random).position);
      }
      for (PointCloud* cloud : {&line, &pile, &scatter}) {
        const CloudReport report = complete(*cloud);
        check_promises(*cloud);
        const bool plain = cloud == &scatter && n > 2;
        CHECK(report.warnings.empty() == plain);
        const float largest = *std::max_element(cloud->radius.begin(), cloud->radius.end());
        if (cloud == &pile || n == 1)
          CHECK(largest == Approx(1.0f));
        else // a few spacings at most: they lie within 2 extents
          CHECK(static_cast<double>(largest) < 5 * scale * (cloud == &line ? 0.23 * n : 2));
      }
    }
  }
}

TEST_CASE("a hundred thousand points in one place, and a far outlier", "[cloud][complete]") {
  PointCloud cloud = without_normals(fibonacci_sphere(5000));
  cloud.position.insert(cloud.position.end(), 100000, Vector3d(0, 0, 1));
  cloud.position.emplace_back(1e6, 0, 0);
  complete(cloud);
  check_promises(cloud);
  CHECK(*std::max_element(cloud.radius.begin(), cloud.radius.end()) < 0.5f); // spacing 0.05; no giant disc
  CHECK(total(cloud.area) == Approx(4 * pi).epsilon(0.01));
}

TEST_CASE("the same bits on any number of threads, the same splats at any place and size", "[cloud][complete]") {
  const PointCloud bare = without_normals(random_sampling(on_torus, 8000, 63));
  PointCloud first = bare;
  complete(first);
  const int threads = omp_get_max_threads();
  for (const int count : {1, 2, 4}) {
    omp_set_num_threads(count);
    PointCloud again = bare;
    complete(again);
    CHECK(again.normal == first.normal);
    CHECK(again.radius == first.radius);
    CHECK(again.area == first.area);
  }
  omp_set_num_threads(threads);
  for (const double scale : {1e-6, 1e6}) {
    PointCloud cloud = bare;
    for (Vector3d& p : cloud.position)
      p = scale * (p + 1e6 * Vector3d(2, -1, 3));
    complete(cloud);
    CHECK(agreement(cloud, first.normal) == 1);
    double worst = 0; // doubles at 4e6 sizes from the origin: 1e-9 of the size, 1e-7 of the spacing
    for (std::size_t i = 0; i < cloud.size(); ++i)
      worst = std::max(
          worst, std::abs(static_cast<double>(cloud.radius[i]) / static_cast<double>(first.radius[i]) / scale - 1));
    CHECK(worst < 1e-4);
  }
}

TEST_CASE("a far outlier is dropped, a far second object is not", "[cloud][complete]") {
  PointCloud cloud = fibonacci_sphere(3000);
  cloud.position.emplace_back(1e6, 0.0, 0.0);
  cloud.normal.emplace_back(0.0f, 0.0f, 1.0f);
  CloudReport report = complete(cloud);
  CHECK(cloud.size() == 3000);
  CHECK(report.points_dropped == 1);
  CHECK(warns_of(report, "thousand times"));
  PointCloud two = fibonacci_sphere(3000);
  for (std::size_t i = 0; i < 300; ++i) {
    two.position.push_back(two.position[i] + Vector3d(1e6, 0.0, 0.0));
    two.normal.push_back(two.normal[i]);
  }
  complete(two);
  CHECK(two.size() == 3300);
}
