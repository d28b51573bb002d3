// scripts/import on files that its own libraries write here.
#include "host/cloud/readers/readers.h"
#include "tests/support/imported.h"
#include "tests/support/scans.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// False, and said, where the script would have to ask the network.
bool installed() {
  if (import_is_installed()) return true;
  WARN("skipped: scripts/import has not been run before");
  something_skipped = true;
  return false;
}

/// Runs a Python program in the environment of scripts/import; `scan` is the path that it writes.
void write_by_python(const std::string& program, const std::string& scan, const TemporaryFolder& folder) {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const std::string place = cache != nullptr && *cache != '\0' ? cache : std::string(std::getenv("HOME")) + "/.cache";
  const std::string file = folder.write("make.py", program);
  REQUIRE(std::system(("'" + place + "/pointgi/import/bin/python' '" + file + "' '" + scan + "'").c_str()) == 0);
}

/// Two stations: one at 10 20 30, turned by a quarter about z, spherical, with one invalid record and 8-bit colours;
/// one without a pose, cartesian, with 16-bit colours and no colorLimits. No images2D.
const char* const two_stations = R"(
import sys, numpy as np
from pye57 import libe57
file = libe57.ImageFile(sys.argv[1], "w")
file.extensionsAdd("", libe57.E57_V1_0_URI)
root = file.root()
for name, text in (("formatName", "ASTM E57 3D Imaging Data File"), ("guid", "{1}")):
    root.set(name, libe57.StringNode(file, text))
root.set("versionMajor", libe57.IntegerNode(file, 1))
root.set("versionMinor", libe57.IntegerNode(file, 0))
scans = libe57.VectorNode(file, True)
root.set("data3D", scans)

def structure(values):
    node = libe57.StructureNode(file)
    for name, value in values.items():
        node.set(name, structure(value) if isinstance(value, dict) else libe57.FloatNode(file, value))
    return node

def add(columns, colour_maximum, pose):
    node = libe57.StructureNode(file)
    node.set("guid", libe57.StringNode(file, "{%d}" % len(scans)))
    if pose:
        node.set("pose", structure(pose))
    prototype = libe57.StructureNode(file)
    for name in columns:
        whole = name.startswith("color") or name.endswith("State") or name == "returnIndex"
        most = colour_maximum if name.startswith("color") else 3
        prototype.set(name, libe57.IntegerNode(file, 0, 0, most) if whole else libe57.FloatNode(file, 0.0))
    points = libe57.CompressedVectorNode(file, prototype, libe57.VectorNode(file, True))
    node.set("points", points)
    scans.append(node)
    buffers, arrays = libe57.VectorSourceDestBuffer(), []
    for name, values in columns.items():
        arrays.append(np.array(values, "d"))
        buffers.append(libe57.SourceDestBuffer(file, name, arrays[-1], len(values), True, True))
    writer = points.writer(buffers)
    writer.write(len(values))
    writer.close()

half = np.sqrt(0.5)
add({"sphericalRange": [1, 9, 2], "sphericalAzimuth": [0, 0, np.pi / 2], "sphericalElevation": [0, 0, np.pi / 6],
     "sphericalInvalidState": [0, 2, 0], "intensity": [0.25, 0, 0.75],
     "colorRed": [255, 0, 0], "colorGreen": [0, 0, 51], "colorBlue": [0, 0, 0], "returnIndex": [0, 0, 1]}, 255,
    {"rotation": {"w": half, "x": 0.0, "y": 0.0, "z": half}, "translation": {"x": 10.0, "y": 20.0, "z": 30.0}})
add({"cartesianX": [4e6 + 0.125], "cartesianY": [5], "cartesianZ": [6],
     "colorRed": [65535], "colorGreen": [32768], "colorBlue": [0]}, 65535, None)
file.close()
)";

/// LAZ, point format 3, offset 4e6, of which the colours are zero: none.
const char* const packed_las = R"(
import sys, laspy, numpy as np
header = laspy.LasHeader(point_format=3, version="1.2")
header.offsets, header.scales = [4e6, 0, 0], [0.001, 0.001, 0.001]
header.add_extra_dim(laspy.ExtraBytesParams(name="tree id", type="int32"))
las = laspy.LasData(header)
las.x, las.y, las.z = np.array([4000000.125, 4000001]), np.array([2, 3]), np.array([-1, 1])
las.intensity, las.classification, las.return_number = [7, 65535], [2, 6], [1, 2]
las["tree id"] = [-5, 5]
las.write(sys.argv[1])
)";

/// The values of a field, or none.
std::vector<double> values_of(const PointCloud& cloud, const std::string& name) {
  for (const Field& field : cloud.fields)
    if (field.info.name == name) return field.values;
  return {};
}

} // namespace

TEST_CASE("scripts/import: wrong arguments are told apart from wrong files", "[scripts]") {
  const TemporaryFolder folder;
  const auto code_of = [&](const std::string& arguments) {
    const std::string command = POINTGI_SOURCE_DIR "/scripts/import " + arguments + " 2>" + folder.file("err");
    return WEXITSTATUS(std::system(command.c_str()));
  };
  CHECK(code_of("scan.laz") == 2);
  CHECK(code_of("'" + folder.write("a.laz", "LASF") + "' a.txt") == 2);
  CHECK_THAT(contents(folder.file("err")), Contains("let its name end in .ply"));
  CHECK(code_of("'" + folder.file("none.laz") + "' a.ply") == 3);
  CHECK_THAT(contents(folder.file("err")), Contains("no such file"));
}

TEST_CASE("scripts/import: without Python's packages it says what is missing, and leaves no file", "[scripts]") {
  const TemporaryFolder folder;
  const std::string scan = folder.write("a.laz", "LASF");
  // Nothing listens at port 9 of this machine, and no wheels lie in the empty folder.
  const std::string no_network = "XDG_CACHE_HOME='" + folder.file("cache") + "' PIP_INDEX_URL=http://127.0.0.1:9/ " +
                                 "PIP_FIND_LINKS='" + folder.file("") + "' PIP_RETRIES=0 ";
  const std::string command = no_network + POINTGI_SOURCE_DIR "/scripts/import '" + scan + "' '" +
                              folder.file("a.ply") + "' 2>'" + folder.file("err") + "'";
  CHECK(WEXITSTATUS(std::system(command.c_str())) == 3);
  const std::string text = contents(folder.file("err"));
  CHECK((text.find("check the network") != std::string::npos || text.find("install it") != std::string::npos));
  CHECK(!std::filesystem::exists(folder.file("a.ply")));
}

TEST_CASE("scripts/import: an E57 file keeps its stations, its valid points and all of its colours", "[scripts]") {
  if (!installed()) return;
  const TemporaryFolder folder;
  write_by_python(two_stations, folder.file("two.e57"), folder);
  const ImportRun run = run_import(folder.file("two.e57"), folder);
  INFO(run.err);
  REQUIRE(run.code == 0);
  CHECK_THAT(run.err, Contains("1 of 4 records are marked invalid"));
  CloudReport report;
  const PointCloud cloud = read_cloud(run.ply, {0.0, {"intensity", "return_number"}, false}, report);
  REQUIRE(cloud.size() == 3);
  // Roundings of two rotations at coordinates of 30.
  CHECK((cloud.position[0] - Eigen::Vector3d(10, 21, 30)).norm() < 1e-13);
  CHECK((cloud.position[1] - Eigen::Vector3d(10 - std::sqrt(3.0), 20, 31)).norm() < 1e-13);
  CHECK(cloud.position[2] == Eigen::Vector3d(4e6 + 0.125, 5, 6));
  REQUIRE(cloud.stations.size() == 2);
  CHECK(cloud.stations[0] == Eigen::Vector3d(10, 20, 30));
  CHECK(cloud.stations[1] == Eigen::Vector3d(0, 0, 0));
  CHECK(cloud.station == std::vector<std::uint16_t>{0, 0, 1});
  CHECK(report.up == Eigen::Vector3d(0, 0, 1));
  REQUIRE(cloud.colour.size() == 3);
  const float step = 1.0f / 65535.0f; // of 16-bit colours
  CHECK((cloud.colour[0] - Eigen::Vector3f(1, 0, 0)).norm() < step);
  CHECK((cloud.colour[1] - Eigen::Vector3f(0, 0.2f, 0)).norm() < step);
  CHECK((cloud.colour[2] - Eigen::Vector3f(1, 0.5f, 0)).norm() < step);
  CHECK(values_of(cloud, "intensity") == std::vector<double>{0.25, 0.75, 0.0});
  CHECK(values_of(cloud, "return_number") == std::vector<double>{1, 2, 0});
}

TEST_CASE("scripts/import: a LAZ file keeps doubles and fields, and zeros are no colours", "[scripts]") {
  if (!installed()) return;
  const TemporaryFolder folder;
  write_by_python(packed_las, folder.file("two.laz"), folder);
  const ImportRun run = run_import(folder.file("two.laz"), folder);
  INFO(run.err);
  REQUIRE(run.code == 0);
  CloudReport report;
  const PointCloud cloud = read_cloud(run.ply, {0.0, {"intensity", "classification", "tree_id"}, false}, report);
  REQUIRE(cloud.size() == 2);
  CHECK(cloud.position[0] == Eigen::Vector3d(125 * 0.001 + 4e6, 2, -1));
  CHECK(cloud.colour.empty());
  CHECK(cloud.stations.empty());
  CHECK(report.up == Eigen::Vector3d(0, 0, 1));
  CHECK(values_of(cloud, "intensity") == std::vector<double>{7, 65535});
  CHECK(values_of(cloud, "classification") == std::vector<double>{2, 6});
  CHECK(values_of(cloud, "tree_id") == std::vector<double>{-5, 5});
}

TEST_CASE("scripts/import: a damaged file leaves the old output and says so", "[scripts]") {
  if (!installed()) return;
  const TemporaryFolder folder;
  write_by_python(packed_las, folder.file("two.laz"), folder);
  const std::string whole = contents(folder.file("two.laz"));
  const std::string old_output = folder.write("imported.ply", "old");
  for (const std::string& bytes : {whole.substr(0, 100), whole.substr(0, whole.size() - 60), std::string("none")}) {
    const ImportRun run = run_import(folder.write("cut.laz", bytes), folder);
    INFO(run.err);
    CHECK(run.code == 3);
    CHECK_THAT(run.err, Contains("error: " + folder.file("cut.laz")));
    CHECK(contents(old_output) == "old");
  }
}
