#include "host/cloud/select.h"
#include "host/cloud/input_file.h"
#include "host/cloud/keep_points.h"
#include "host/cloud/voxel_grid.h"
#include "host/error.h"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace pointgi {

namespace {

using ValueOf = std::function<double(std::size_t point)>;

/// The names that mean the same field, the given one first.
std::vector<std::string> names_of(const std::string& field) {
  const std::string name = lookup_name(field);
  if (name == "classification" || name == "class") return {field, name == "class" ? "classification" : "class"};
  return {field};
}

bool is_coordinate(const std::string& field) {
  const std::string name = lookup_name(field);
  return name == "x" || name == "y" || name == "z";
}

/// A value that the cloud has whether or not it came from a file; empty if it has none of that name.
ValueOf attribute(const PointCloud& cloud, const std::string& name) {
  const auto channel = [&](const auto& vectors, int axis) -> ValueOf {
    if (vectors.empty()) return {};
    return [&vectors, axis](std::size_t i) { return static_cast<double>(vectors[i][axis]); };
  };
  constexpr const char* names[] = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"};
  const auto at = std::find(std::begin(names), std::end(names), name) - std::begin(names);
  const auto axis = static_cast<int>(at % 3);
  if (at < 3) return channel(cloud.position, axis);
  if (at < 6) return channel(cloud.normal, axis);
  if (at < 9) return channel(cloud.colour, axis);
  if (name != "radius" || cloud.radius.empty()) return {};
  return [&cloud](std::size_t i) { return static_cast<double>(cloud.radius[i]); };
}

std::string list_of_fields(const CloudReport& report) {
  constexpr std::size_t most = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(most, report.fields.size()); ++i)
    list += (list.empty() ? "" : ", ") + printable(report.fields[i]);
  if (report.fields.size() > most) list += ", ...";
  return list;
}

ValueOf values_of(const PointCloud& cloud, const FieldCondition& condition, const CloudReport& report) {
  if (is_coordinate(condition.field)) return attribute(cloud, lookup_name(condition.field));
  for (const std::string& name : names_of(condition.field))
    for (const Field& field : cloud.fields)
      if (lookup_name(field.info.name) == lookup_name(name)) return [&field](std::size_t i) { return field.values[i]; };
  if (ValueOf own = attribute(cloud, lookup_name(condition.field))) return own;
  const std::string list = list_of_fields(report);
  throw Error(ErrorKind::input,
              "keep: the cloud has no field " + quoted_bytes(condition.field) +
                  (list.empty() ? "; it has x, y, z and what it was given besides" : "; it has " + list));
}

std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

/// Least and largest value of the points, "from 1 to 2".
std::string range_text(std::size_t count, const ValueOf& value) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < count; ++i) {
    low = std::fmin(low, value(i));
    high = std::fmax(high, value(i));
  }
  return low <= high ? "from " + number_text(low) + " to " + number_text(high) : "no numbers";
}

bool passes(const FieldCondition& condition, double value) {
  if (condition.values.empty()) return value >= condition.min && value <= condition.max;
  return std::find(condition.values.begin(), condition.values.end(), value) != condition.values.end();
}

/// One filter at work: what it took, and an end where nothing is left.
class Filters {
public:
  Filters(PointCloud& cloud, CloudReport& report) : cloud_(cloud), report_(report), all_(cloud.size()) {}

  /// `there_was`: describes the points before the filter, for the error.
  void apply(const std::string& name, const std::function<bool(std::size_t)>& wanted,
             const std::function<std::string()>& there_was) {
    const std::size_t before = cloud_.size();
    const bool any = [&] {
      for (std::size_t i = 0; i < before; ++i)
        if (wanted(i)) return true;
      return false;
    }();
    if (!any && before > 0)
      throw Error(ErrorKind::input, name + " leaves none of " + std::to_string(before) + " points" +
                                        (before < all_ ? " (of " + std::to_string(all_) + ")" : "") + ", which have " +
                                        there_was());
    took(name, keep_points(cloud_, wanted));
  }

  void took(const std::string& name, std::size_t count) {
    report_.points_left_out += count;
    counts_ += (counts_.empty() ? "" : ", ") + name + " took " + std::to_string(count);
  }

  void finish() {
    report_.notes.push_back(std::to_string(cloud_.size()) + " of " + std::to_string(all_) +
                            " points are kept: " + counts_);
  }

private:
  PointCloud& cloud_;
  CloudReport& report_;
  std::size_t all_;
  std::string counts_;
};

std::string bounds_text(const PointCloud& cloud) {
  const auto axis = [&](int k) {
    return range_text(cloud.size(), [&](std::size_t i) { return cloud.position[i][k]; });
  };
  return "x " + axis(0) + ", y " + axis(1) + ", z " + axis(2);
}

} // namespace

std::vector<std::string> fields_of(const Selection& selection) {
  std::vector<std::string> fields;
  for (const FieldCondition& condition : selection.keep)
    if (!is_coordinate(condition.field))
      for (const std::string& name : names_of(condition.field))
        fields.push_back(name);
  return fields;
}

void select_points(PointCloud& cloud, const Selection& selection, CloudReport& report) {
  if (selection.empty()) return;
  Filters filters(cloud, report);
  const auto bounds = [&] { return bounds_text(cloud); };
  for (const FieldCondition& condition : selection.keep) {
    const ValueOf value = values_of(cloud, condition, report);
    filters.apply(
        "keep." + condition.field, [&](std::size_t i) { return passes(condition, value(i)); },
        [&] { return condition.field + " " + range_text(cloud.size(), value); });
  }
  if (selection.crop)
    filters.apply(
        "crop",
        [&](std::size_t i) {
          const auto p = cloud.position[i].array();
          return (p >= selection.crop->min.array()).all() && (p <= selection.crop->max.array()).all();
        },
        bounds);
  for (std::size_t k = 0; k < selection.clip.size(); ++k)
    filters.apply(
        "clip." + std::to_string(k),
        [&](std::size_t i) {
          // In [0, inf) as it is, not its negation: NaN lies on no side.
          return selection.clip[k].normal.dot(cloud.position[i] - selection.clip[k].point) >= 0.0;
        },
        bounds);
  if (selection.voxel) {
    const std::vector<bool> chosen = one_point_a_voxel(cloud.position, *selection.voxel);
    filters.apply(
        "voxel", [&](std::size_t i) { return chosen[i]; }, bounds);
  }
  filters.finish();
}

} // namespace pointgi
