/// keep, crop, clip and voxel of a [[cloud]].
#include "host/scene/load_sections.h"

namespace pointgi {

namespace {

/// A number, a list of numbers, or a range.
FieldCondition load_condition(const TableReader& keep, const std::string& name) {
  FieldCondition condition{name, {}};
  const char* key = name.c_str();
  const toml::node& node = *keep.find(key);
  if (node.is_table()) {
    const TableReader range = *keep.inline_table(key, "{ min = 0, max = 1 }");
    range.allow_only({"min", "max"});
    if (!range.has("min") && !range.has("max")) range.fail("expected min, max or both");
    condition.min = range.number("min", limits::field_value).value_or(condition.min);
    condition.max = range.number("max", limits::field_value).value_or(condition.max);
    if (condition.min > condition.max) range.fail("min", "is above max: no value lies between them");
  } else if (node.is_array()) {
    condition.values = *keep.numbers(key, limits::field_value);
  } else if (node.is_number()) {
    condition.values = {*keep.number(key, limits::field_value)};
  } else {
    keep.fail(key, "expected a number, a list of numbers or a range { min = 0, max = 1 }, found " + found_text(node));
  }
  return condition;
}

CropBox load_crop(const TableReader& crop) {
  crop.allow_only({"min", "max"});
  if (!crop.has("min") && !crop.has("max")) crop.fail("expected min, max or both");
  CropBox box;
  box.min = crop.vector3("min", limits::coordinate).value_or(box.min);
  box.max = crop.vector3("max", limits::coordinate).value_or(box.max);
  if ((box.min.array() > box.max.array()).any()) crop.fail("min", "is above max on an axis: the box has no inside");
  return box;
}

std::vector<ClipPlane> load_clip(const TableReader& cloud) {
  const toml::node* node = cloud.find("clip");
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table))
    cloud.fail("clip",
               "expected a list of planes, [{ point = [0, 0, 1], normal = [0, 0, -1] }], found " + found_text(*node));
  std::vector<ClipPlane> planes;
  for (const TableReader& plane : cloud.tables("clip")) {
    plane.allow_only({"point", "normal"});
    ClipPlane& loaded = planes.emplace_back();
    loaded.point = plane.need_vector3("point", limits::coordinate);
    loaded.normal = plane.need_vector3("normal", limits::coordinate);
    if (loaded.normal.isZero(0.0)) plane.fail("normal", "has no length; it shows the side that stays");
  }
  return planes;
}

} // namespace

Selection load_selection(const TableReader& cloud) {
  Selection selection;
  if (const auto keep = cloud.inline_table("keep", "{ classification = [2, 6], intensity = { min = 10 } }"))
    for (const std::string& field : keep->keys())
      selection.keep.push_back(load_condition(*keep, field));
  if (const auto crop = cloud.inline_table("crop", "{ min = [0, 0, 0], max = [1, 1, 1] }"))
    selection.crop = load_crop(*crop);
  selection.clip = load_clip(cloud);
  selection.voxel = cloud.number("voxel", limits::length);
  return selection;
}

} // namespace pointgi
