#include "host/scene/field_albedo.h"
#include "host/cloud/input_file.h"
#include "host/cloud/readers/field_plan.h"
#include "octree/parallel.h"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace pointgi {

namespace {

constexpr double low_share = 0.01, high_share = 0.99; // a few extremes don't take the contrast from the others
constexpr std::size_t most_samples = 1000000;
constexpr double middle = 0.5;
constexpr double least_range = 0.1; // of the quantiles' range
// Black lies so many ranges below the least value, which becomes 0.23 in sRGB: the albedo 0.04 of asphalt.
constexpr double darkest = 0.3;

using Fields = std::vector<const Field*>;

struct Range {
  double low, high;
};

/// Of the values that are finite, of every so many: the quantiles, and the value in the middle.
Range quantiles(const Fields& fields, double* middle_value = nullptr) {
  std::vector<double> values;
  for (const Field* field : fields) {
    const std::size_t step = field->values.size() * fields.size() / most_samples + 1;
    for (std::size_t i = 0; i < field->values.size(); i += step)
      if (std::isfinite(field->values[i])) values.push_back(field->values[i]);
  }
  if (values.empty()) return {0.0, 0.0};
  const auto quantile = [&](double share) {
    const auto at = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  if (middle_value != nullptr) *middle_value = quantile(0.5);
  const double low = quantile(low_share);
  return {low, quantile(high_share)};
}

/// Grey by one field, or red, green and blue by three.
void fill_colours(const Fields& fields, Range range, PointCloud& cloud) {
  cloud.colour.resize(cloud.size());
  const bool flat = !(range.high > range.low);
  parallel_ranges(cloud.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double value = fields[fields.size() == 3 ? k : 0]->values[i];
        const double share = flat || std::isnan(value) ? middle : (value - range.low) / (range.high - range.low);
        cloud.colour[i][static_cast<int>(k)] = static_cast<float>(std::clamp(share, 0.0, 1.0));
      }
  });
}

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 40;
  std::string list;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
    list += (list.empty() ? "" : ", ") + printable(names[i]);
  if (names.size() > most) list += " and " + std::to_string(names.size() - most) + " more";
  return list;
}

std::string describe(const Fields& fields, Range range) {
  std::string names;
  for (const Field* field : fields)
    names += (names.empty() ? "" : ", ") + printable(field->info.name);
  char numbers[100];
  std::snprintf(numbers, sizeof numbers, "%.6g is black, %.6g is white", range.low, range.high);
  return names + " (" + numbers + ")";
}

} // namespace

void colours_from_fields(const MaterialSettings& material, const std::string& file, PointCloud& cloud,
                         CloudReport& report) {
  Fields fields;
  for (const std::string& name : material.albedo_field->fields) {
    fields.push_back(find_field(cloud.fields, name));
    if (fields.back() == nullptr)
      throw Error(ErrorKind::input,
                  file + ": has no field \"" + printable(name) + "\", from which material \"" +
                      printable(material.name) + "\" (" + material.place.text() + ") takes its albedo; " +
                      (report.fields.empty() ? "it has no fields: only scans have them, meshes and arrays don't"
                                             : "its fields are " + list_of(report.fields)));
  }
  Range range = quantiles(fields);
  range.low = material.albedo_field->low.value_or(range.low);
  range.high = material.albedo_field->high.value_or(range.high);
  fill_colours(fields, range, cloud);
  report.notes.push_back("the colours are " + describe(fields, range));
}

bool colours_from_intensity(PointCloud& cloud, CloudReport& report) {
  for (const char* name : intensity_names())
    if (const Field* field = find_field(cloud.fields, name)) {
      double usual = 0.0;
      Range range = quantiles({field}, &usual);
      if (!(range.high > range.low)) continue; // all alike: it tells nothing
      // Lasers measure a few bright signs and much that is dark: half of the points are at least middle grey.
      range.high = std::clamp(range.low + (usual - range.low) / middle,
                              range.low + least_range * (range.high - range.low), range.high);
      range.low -= darkest * (range.high - range.low); // no surface takes all light
      fill_colours({field}, range, cloud);
      report.notes.push_back("the file has no colours: they are grey by its field " + describe({field}, range) +
                             "; a material chooses by albedo = { field = \"" + printable(field->info.name) +
                             "\", low = ..., high = ... }");
      return true;
    }
  return false;
}

} // namespace pointgi
