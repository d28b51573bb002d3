/// A scan that is baked comes back: its order, all that it had, and an answer for every point.
#include "host/api/prepared.h"
#include "host/app/commands.h"
#include "host/cloud/readers/las_read.h"
#include "host/cloud/readers/ply.h"
#include "host/image/srgb.h"
#include "tests/support/las_bytes.h"
#include "tests/support/scans.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr std::size_t ball = 800, not_a_number = 3, twin = 10;

/// Bytes of a vertex of scan(): 3 doubles, a ushort, a char, 3 uchars, a list of one int.
constexpr std::size_t vertex_bytes = 24 + 2 + 1 + 3 + 5;

void append(std::string& text, const void* data, std::size_t size) {
  text.append(static_cast<const char*>(data), size);
}

/// Vertex i of a ball of radius 1 about a place in map coordinates; one is no number, the last lies where another does.
std::string vertex(std::size_t i) {
  const std::size_t k = i == ball ? twin : i;
  const double z = 1.0 - (2.0 * static_cast<double>(k) + 1.0) / static_cast<double>(ball);
  const double r = std::sqrt(1.0 - z * z), a = 2.399963229728653 * static_cast<double>(k);
  double place[3] = {654321.125 + r * std::cos(a), 4.2e6 + r * std::sin(a), 123.0 + z};
  if (i == not_a_number) place[1] = std::nan("");
  std::string bytes;
  append(bytes, place, sizeof place);
  const auto quality = static_cast<std::uint16_t>(60000 + i);
  append(bytes, &quality, sizeof quality);
  bytes += static_cast<char>(-static_cast<int>(i % 100)); // a signed byte
  bytes += "\xc0\x80\x40";
  bytes += '\x01';
  const auto neighbour = static_cast<std::int32_t>(i);
  append(bytes, &neighbour, sizeof neighbour);
  return bytes;
}

std::string scan() {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment scanned by a test\nelement vertex " +
                     std::to_string(ball + 1) +
                     "\nproperty double x\nproperty double y\nproperty double z\nproperty ushort quality\n"
                     "property char odd\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                     "property list uchar int neighbours\nelement epoch 1\nproperty double seconds\nend_header\n";
  for (std::size_t i = 0; i <= ball; ++i)
    text += vertex(i);
  const double seconds = 1e9 + 0.25;
  append(text, &seconds, sizeof seconds);
  return text;
}

/// The scan under an even sky of radiance 1: each point of a ball has an irradiance of pi and gets no light from
/// others.
std::string under_sky(const std::string& of_cloud, const std::string& of_material = "") {
  return "version = 1\n[environment]\nradiance = [1, 1, 1]\n[[material]]\nname = \"own\"\ntype = \"diffuse\"\n" +
         of_material + "\n[[cloud]]\nfile = \"scan.ply\"\nmaterial = \"own\"\n" + of_cloud + "\n";
}

struct Baked {
  std::string header, body;
  PointCloud cloud;
  const std::vector<double>& field(const std::string& name) const {
    for (const Field& field : cloud.fields)
      if (field.info.name == name) return field.values;
    FAIL("no field " << name);
    throw 0;
  }
};

Baked baked(const std::string& scene, const std::string& source, bool sky = false) {
  const TemporaryFolder folder;
  folder.write("scan.ply", source);
  BakeOptions options;
  options.input = folder.write("scene.toml", scene);
  options.output = folder.file("lit.ply");
  options.quiet = true;
  options.sky = sky;
  if (run_bake(options) != ExitCode::done) throw std::runtime_error("the cloud was not finished");
  Baked result;
  const std::string text = contents(options.output);
  const std::size_t body = text.find("end_header\n") + 11;
  result.header = text.substr(0, body);
  result.body = text.substr(body);
  CloudReport report;
  result.cloud = read_ply(options.output, {0.0, {}, true}, report);
  return result;
}

} // namespace

TEST_CASE("bake gives a scan back: order, bits, odd properties, other elements, and light for every point") {
  // Placed in the scene, which the file's coordinates do not show.
  const Baked back = baked(under_sky("scale = 3\nrotate_deg = [0, 0, 90]\ntranslate = [-1e6, 5, 7]"), scan());
  CHECK_THAT(back.header, Contains("comment scanned by a test\n") &&
                              Contains("property char odd\nproperty uchar albedo_red\nproperty uchar albedo_green\n"
                                       "property uchar albedo_blue\nproperty list uchar int neighbours\n"
                                       "property float nx\nproperty float ny\nproperty float nz\n"
                                       "property float radius\nproperty uchar lit\nproperty uchar red\n"
                                       "property uchar green\nproperty uchar blue\n"
                                       "property float scalar_radiosity_r\nproperty float scalar_radiosity_g\n"
                                       "property float scalar_radiosity_b\nelement epoch 1\n"));
  constexpr std::size_t added = 4 * 4 + 4 + 3 * 4;
  REQUIRE(back.body.size() == (ball + 1) * (vertex_bytes + added) + sizeof(double));
  for (std::size_t i = 0; i <= ball; ++i)
    REQUIRE(back.body.substr(i * (vertex_bytes + added), vertex_bytes) == vertex(i));
  const std::vector<double>&lit = back.field("lit"), &red = back.field("scalar_radiosity_r"),
        &blue = back.field("scalar_radiosity_b"), &shown = back.field("red"), &radius = back.field("radius"),
        &nx = back.field("nx");
  const double rho_red = srgb_to_linear(static_cast<float>(0xc0) / 255.0f),
               rho_blue = srgb_to_linear(static_cast<float>(0x40) / 255.0f);
  double worst_normal = 0.0;
  for (std::size_t i = 0; i <= ball; ++i) {
    CAPTURE(i);
    if (i == not_a_number) {
      CHECK(lit[i] == 0.0);
      CHECK(red[i] == 0.0);
      CHECK(shown[i] == 0.0);
      continue;
    }
    REQUIRE(lit[i] == 1.0);
    // Discs about the ball stand a little into each other's sky, by about radius / 1: the mean of 64 estimates.
    CHECK(red[i] == Approx(pi * rho_red).epsilon(0.08));
    CHECK(blue[i] == Approx(pi * rho_blue).epsilon(0.08));
    CHECK(shown[i] == Approx(0xc0).epsilon(0.05)); // sRGB of B / pi: about the square root of that error
    CHECK(radius[i] > 0.02);                       // half the spacing of 800 points on a ball is 0.06
    CHECK(radius[i] < 0.2);
    worst_normal = std::max(worst_normal, std::abs(nx[i] - (back.cloud.position[i].x() - 654321.125)));
  }
  CHECK(worst_normal < 0.15); // estimated by planes through neighbours; turned back with the cloud
  CHECK(red[ball] == red[twin]);
}

TEST_CASE("bake marks what was left out by a filter, and keeps it") {
  const Baked back = baked(under_sky("keep = { quality = { min = 60000, max = 60399 } }"), scan());
  const std::vector<double>&lit = back.field("lit"), &red = back.field("scalar_radiosity_r");
  for (std::size_t i = 0; i <= ball; ++i) {
    CAPTURE(i);
    CHECK(lit[i] == (i < 400 && i != not_a_number ? 1.0 : 0.0));
    CHECK((red[i] > 0.0) == (lit[i] == 1.0));
  }
}

TEST_CASE("bake of a two-sided scan: the light of the backs beside that of the fronts, the colour of both") {
  const Baked back = baked(under_sky("normals = \"estimate\"", "two_sided = true\nalbedo = [0.5, 0.5, 0.5]"), scan());
  const std::vector<double>&front = back.field("scalar_radiosity_g"), &behind = back.field("scalar_radiosity_g_back"),
        &shown = back.field("green");
  const double mean = 0.25; // of 0.5 outside and next to nothing inside, where the ball hides the sky
  for (std::size_t i = 0; i < ball; ++i) {
    if (i == not_a_number) continue;
    CAPTURE(i);
    CHECK(front[i] + behind[i] == Approx(0.5 * pi).epsilon(0.1));
    CHECK(std::min(front[i], behind[i]) < 0.05);
    CHECK(shown[i] == Approx(255.0 * linear_to_srgb(static_cast<float>(mean))).epsilon(0.06));
  }
}

TEST_CASE("bake of a scan twice: one of each column, and the first albedo is kept") {
  const TemporaryFolder folder;
  folder.write("scan.ply", scan());
  BakeOptions options;
  options.input = folder.write("scene.toml", under_sky(""));
  options.output = folder.file("once.ply");
  options.quiet = true;
  REQUIRE(run_bake(options) == ExitCode::done);
  const std::string once = contents(options.output);
  folder.write("scan.ply", once);
  options.output = folder.file("twice.ply");
  REQUIRE(run_bake(options) == ExitCode::done);
  const std::string twice = contents(options.output);
  const std::size_t header = once.find("end_header\n");
  // nx, ny, nz and radius of the first run are the file's own by now; all else has its old place.
  CHECK(twice.substr(0, header) == once.substr(0, header));
  CHECK(twice.size() == once.size());
  CHECK(twice.substr(header + 11, vertex_bytes) == vertex(0));
}

TEST_CASE("bake of a LAS file gives LAS back, or PLY, with what it had and the light beside it") {
  LasFile file;
  file.format = 2;
  file.scale = {0.001, 0.001, 0.001};
  file.offset = {654321.0, 4.2e6, 100.0};
  constexpr std::size_t count = 400;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
    const double r = std::sqrt(1.0 - z * z), a = 2.399963229728653 * static_cast<double>(i);
    LasPoint& p = file.points.emplace_back();
    p.position = {static_cast<std::int32_t>(std::lround(1000.0 * r * std::cos(a))),
                  static_cast<std::int32_t>(std::lround(1000.0 * r * std::sin(a))),
                  static_cast<std::int32_t>(std::lround(1000.0 * z))};
    p.classification = i % 4 == 0 ? 7 : 2;
    p.intensity = static_cast<std::uint16_t>(i);
    p.colour = {0xc0c0, 0x8080, 0x4040};
  }
  const TemporaryFolder folder;
  folder.write("scan.las", file.bytes());
  std::string scene = under_sky("keep = { classification = 2 }");
  scene.replace(scene.find("scan.ply"), 8, "scan.las");
  BakeOptions options;
  options.input = folder.write("scene.toml", scene);
  options.quiet = options.sky = true;
  for (const std::string ending : {".las", ".ply"}) {
    options.output = folder.file("lit" + ending);
    REQUIRE(run_bake(options) == ExitCode::done);
    CloudReport report;
    const ReadRequest all{0.0, {}, true};
    const PointCloud back =
        ending == ".las" ? read_las(options.output, all, report) : read_ply(options.output, all, report);
    const auto field = [&](const std::string& name) {
      for (const Field& one : back.fields)
        if (lookup_name(one.info.name) == name) return one.values;
      FAIL("no field " << name);
      throw 0;
    };
    REQUIRE(back.size() == count);
    CAPTURE(ending);
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d place(0.001 * file.points[i].position[0] + file.offset[0],
                                  0.001 * file.points[i].position[1] + file.offset[1],
                                  0.001 * file.points[i].position[2] + file.offset[2]);
      REQUIRE((back.position[i] - place).norm() < 1e-8); // of doubles of 4e6 the last bits
      REQUIRE(field("intensity")[i] == static_cast<double>(i));
      REQUIRE(field("albedo_red")[i] == 0xc0c0);
      REQUIRE(field("lit")[i] == (i % 4 == 0 ? 0.0 : 1.0));
      REQUIRE((field("radiosity_r")[i] > 1.0) == (i % 4 != 0)); // pi times an albedo of 0.53
      REQUIRE((field("sky")[i] > 0.8) == (i % 4 != 0));
      REQUIRE((field("red")[i] > 0.0) == (i % 4 != 0));
    }
  }
}

TEST_CASE("a cloud in memory comes back in its own order") {
  std::vector<double> places;
  std::vector<float> normals, colours;
  for (std::size_t i = 0; i < 300; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / 300.0, r = std::sqrt(1.0 - z * z),
                 a = 2.399963229728653 * static_cast<double>(i);
    for (const double value : {r * std::cos(a), r * std::sin(a), z}) {
      places.push_back(value);
      normals.push_back(static_cast<float>(value));
      colours.push_back(static_cast<float>(0.5 + 0.5 * value));
    }
  }
  api::Scene scene;
  scene.add("material", {{"name", "own"}, {"type", "diffuse"}});
  scene.set("environment", {{"radiance", {1.0, 1.0, 1.0}}});
  scene.add(api::Points{300, places.data(), normals.data(), colours.data(), nullptr},
            {{"material", "own"}, {"crop", "none"}});
  CHECK_THROWS_WITH(scene.check(), Contains("cloud.0.crop: expected a table"));
  scene.set("cloud.0.crop={ min = [-2, -2, 0] }");
  const api::Context context;
  const api::Prepared prepared(context, scene);
  const api::Light light(prepared);
  const TemporaryFolder folder;
  light.write_ply(folder.file("lit.ply"), {0.0, true});
  CloudReport report;
  const PointCloud cloud =
      read_ply(folder.file("lit.ply"), {0.0, {"lit", "albedo_green", "scalar_sky"}, false}, report);
  REQUIRE(cloud.size() == 300);
  for (std::size_t i = 0; i < 300; ++i) {
    CHECK(cloud.position[i] == Eigen::Vector3d(places[3 * i], places[3 * i + 1], places[3 * i + 2]));
    CHECK(cloud.fields[0].values[i] == static_cast<double>(colours[3 * i + 1]));
    CHECK(cloud.fields[1].values[i] == (places[3 * i + 2] >= 0.0 ? 1.0 : 0.0));
  }
}

TEST_CASE("bake of a real file in map coordinates gives its bits back") {
  const auto path = scan_path("../cases/utm_double.ply");
  if (!path) {
    WARN("skipped: no shared/cases/utm_double.ply");
    return;
  }
  const TemporaryFolder folder;
  BakeOptions options;
  options.input = *path;
  options.output = folder.file("lit.ply");
  options.quiet = true;
  options.quality = "draft";
  REQUIRE(run_bake(options) == ExitCode::done);
  CloudReport of_source, of_output;
  const PointCloud source = read_ply(*path, {0.0, {}, true}, of_source);
  const PointCloud back = read_ply(options.output, {0.0, {}, true}, of_output);
  REQUIRE(back.size() == source.size());
  for (std::size_t i = 0; i < source.size(); ++i)
    REQUIRE(std::memcmp(&back.position[i], &source.position[i], sizeof source.position[i]) == 0);
  REQUIRE(back.fields.size() > source.fields.size());
  for (std::size_t f = 0; f < source.fields.size(); ++f)
    CHECK(back.fields[f].values == source.fields[f].values);
}
