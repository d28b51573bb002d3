/// What fields mean, by their names.
#include "host/cloud/readers/field_plan.h"
#include "host/error.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using Catch::Contains;

namespace {

FieldPlan plan_of(const std::vector<std::string>& names, const ReadRequest& request = {},
                  CloudReport* report = nullptr) {
  std::vector<FieldInfo> fields;
  for (const std::string& name : names)
    fields.push_back({name, FieldType::f32, 1.0, 0.0});
  CloudReport own;
  return plan_fields(std::move(fields), request, "cloud.pcd", "line 3: FIELDS", report != nullptr ? *report : own);
}

std::vector<int> slots(const std::vector<std::string>& names) {
  return plan_of(names).slot;
}

} // namespace

TEST_CASE("fields: names of normals, colours and the rest", "[fields]") {
  const int p = slot_position, n = slot_normal, c = slot_colour;
  const std::vector<int> normals{n, n + 1, n + 2, p, p + 1, p + 2}, colours{p, p + 1, p + 2, c, c + 1, c + 2};
  CHECK(slots({"nx", "ny", "nz", "x", "y", "z"}) == normals);
  CHECK(slots({"normal_x", "normal_y", "normal_z", "X", "Y", "Z"}) == normals);
  CHECK(slots({"NormalX", "NormalY", "NormalZ", "x", "y", "z"}) == normals);
  CHECK(slots({"x", "y", "z", "red", "green", "blue"}) == colours);
  CHECK(slots({"x", "y", "z", "r", "g", "b"}) == colours);
  CHECK(slots({"x", "y", "z", "scalar_R", "scalar_G", "scalar_B"}) == colours);
  CHECK(slots({"x", "y", "z", "diffuse_red", "diffuse_green", "diffuse_blue"}) == colours);
  CHECK(slots({"z", "y", "x", "rgb", "radius", "scalar_Intensity", "station"}) ==
        std::vector<int>{p + 2, p + 1, p, slot_packed_colour, slot_radius, slot_intensity, slot_station});
  CHECK(slots({"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "rot_0", "rot_1", "rot_2",
               "rot_3"}) == std::vector<int>{p, p + 1, p + 2, slot_harmonic, slot_harmonic + 1, slot_harmonic + 2,
                                             slot_opacity, slot_scale, slot_scale + 1, slot_rotation, slot_rotation + 1,
                                             slot_rotation + 2, slot_rotation + 3});
  // Without the harmonics it is no Gaussian, and two of three are no triple.
  CHECK(slots({"x", "y", "z", "opacity", "nx", "ny"}) == std::vector<int>{p, p + 1, p + 2, -1, -1, -1});
}

TEST_CASE("fields: of several names for one thing the first of the list wins", "[fields]") {
  const FieldPlan plan = plan_of({"x", "y", "z", "rgb", "r", "g", "b", "scalar_red", "red", "green", "blue"});
  CHECK(plan.slot == std::vector<int>{0, 1, 2, -1, -1, -1, -1, -1, 6, 7, 8});
  CHECK(plan_of({"scalar_x", "x", "y", "z"}).slot == std::vector<int>{-1, 0, 1, 2});
}

TEST_CASE("fields: what is kept is what was asked for, and intensity where there are no colours", "[fields]") {
  const std::vector<std::string> names{"x", "y", "z", "Classification", "scalar_Intensity"};
  CHECK(plan_of(names).kept == std::vector<std::size_t>{4});
  CHECK(plan_of(names, {0.0, {"classification", "absent"}, false}).kept == std::vector<std::size_t>{3, 4});
  CHECK(plan_of(names, {0.0, {}, true}).kept == std::vector<std::size_t>{0, 1, 2, 3, 4});
  CHECK(plan_of({"x", "y", "z", "intensity", "rgb"}).kept.empty());
  CHECK(plan_of({"x", "y", "z", "intensity", "rgb"}, {0.0, {"intensity"}, false}).kept == std::vector<std::size_t>{3});
}

TEST_CASE("fields: the report says what each is used for, and once what is not used", "[fields]") {
  CloudReport report;
  plan_of({"x", "y", "z", "intensity", "curvature", "\x1b[31m"}, {}, &report);
  REQUIRE(report.properties.size() == 6);
  CHECK(report.properties[0].property == "x (float)");
  CHECK(report.properties[0].use == "position");
  CHECK(report.properties[3].use == "colour (grey)");
  CHECK(report.properties[4].use == "not used");
  CHECK(report.fields.size() == 6);
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Contains("not used: curvature, \\x1b[31m;"));

  CloudReport all_used;
  plan_of({"x", "y", "z", "red", "green", "blue", "alpha"}, {}, &all_used);
  CHECK(all_used.notes.empty());

  std::vector<std::string> many{"x", "y", "z"};
  for (int i = 0; i < 100; ++i)
    many.push_back("f" + std::to_string(i));
  CloudReport short_report;
  plan_of(many, {}, &short_report);
  CHECK_THAT(short_report.notes.at(0), Contains("f7 and 92 more"));
}

TEST_CASE("fields: a cloud without one of x, y and z is refused", "[fields]") {
  CHECK_THROWS_WITH(plan_of({"x", "y", "nz"}), Contains("cloud.pcd: line 3: FIELDS has no property \"z\""));
}
