#include "host/cloud/readers/point_sink.h"
#include "host/cloud/precision.h"
#include "host/cloud/readers/colour_range.h"
#include "host/error.h"
#include "octree/parallel.h"
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

namespace pointgi {

namespace {

constexpr std::size_t grain = 1 << 16;

/// Red, green and blue, 0..255, of 0x00RRGGBB. The bits of a float that way are a tiny number, far below 1, or with
/// something in the upper byte a huge or negative one; a float from 1 to 2^24 holds the integer itself.
Eigen::Vector3f unpack(double value, FieldType type) {
  std::uint32_t bits = 0;
  if (is_float(type) && !(value >= 1.0 && value < 16777216.0)) {
    const auto narrow = static_cast<float>(value);
    std::memcpy(&bits, &narrow, sizeof bits);
  } else if (std::abs(value) < 4294967296.0) {
    bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(value)); // writers make the same bits int and uint
  }
  return {static_cast<float>(bits >> 16 & 255), static_cast<float>(bits >> 8 & 255), static_cast<float>(bits & 255)};
}

/// The index of a scanner position; what can be none becomes the last that there could be.
std::uint16_t station_of(double value) {
  return value >= 0.0 && value < 65535.0 ? static_cast<std::uint16_t>(value) : std::uint16_t{65535};
}

} // namespace

PointSink::PointSink(FieldPlan plan, std::size_t count, const std::string& file)
    : plan_(std::move(plan)), file_(file), has_packed_(plan_.has(slot_packed_colour)),
      is_flat_(!plan_.has(slot_scale + 2)) {
  for (std::size_t f = 0; f < plan_.slot.size(); ++f)
    if (plan_.slot[f] != slot_none) field_of_[static_cast<std::size_t>(plan_.slot[f])] = f;
  try {
    take_memory(count);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::memory,
                file + ": " + std::to_string(count) + " points do not fit into memory; thin the cloud out or split it");
  }
}

void PointSink::take_memory(std::size_t count) {
  cloud_.position.resize(count);
  if (plan_.has(slot_normal)) cloud_.normal.resize(count);
  if (plan_.has(slot_colour) || has_packed_) cloud_.colour.resize(count);
  if (plan_.has(slot_radius)) cloud_.radius.resize(count);
  if (plan_.has(slot_station)) cloud_.station.resize(count);
  if (plan_.has(slot_harmonic)) gaussians_.harmonic.resize(count);
  if (plan_.has(slot_opacity)) gaussians_.opacity.resize(count);
  if (plan_.has(slot_scale)) gaussians_.log_scale.resize(count);
  if (plan_.has(slot_rotation)) gaussians_.rotation.resize(count);
  for (const std::size_t field : plan_.kept)
    cloud_.fields.push_back({plan_.fields[field], std::vector<double>(count)});
}

void PointSink::put(std::size_t point, const double* values) {
  cloud_.position[point] = triple(values, slot_position);
  if (!cloud_.normal.empty()) cloud_.normal[point] = triple(values, slot_normal).cast<float>();
  if (has_packed_)
    cloud_.colour[point] = unpack(value(values, slot_packed_colour), plan_.fields[field_of_[slot_packed_colour]].type);
  else if (!cloud_.colour.empty())
    cloud_.colour[point] = triple(values, slot_colour).cast<float>();
  if (!cloud_.radius.empty()) cloud_.radius[point] = static_cast<float>(value(values, slot_radius));
  if (!cloud_.station.empty()) cloud_.station[point] = station_of(value(values, slot_station));
  for (std::size_t k = 0; k < plan_.kept.size(); ++k)
    cloud_.fields[k].values[point] = values[plan_.kept[k]];
  if (!gaussians_.harmonic.empty()) put_gaussian(point, values);
}

void PointSink::put_gaussian(std::size_t point, const double* values) {
  gaussians_.harmonic[point] = triple(values, slot_harmonic).cast<float>();
  if (!gaussians_.opacity.empty()) gaussians_.opacity[point] = static_cast<float>(value(values, slot_opacity));
  if (!gaussians_.log_scale.empty()) {
    const double third = is_flat_ ? -std::numeric_limits<double>::infinity() : value(values, slot_scale + 2);
    gaussians_.log_scale[point] =
        Eigen::Vector3d(value(values, slot_scale), value(values, slot_scale + 1), third).cast<float>();
  }
  if (!gaussians_.rotation.empty())
    for (int k = 0; k < 4; ++k)
      gaussians_.rotation[point][k] = static_cast<float>(value(values, slot_rotation + k));
}

void PointSink::finish_normals(CloudReport& report) {
  std::atomic<std::size_t> given{0};
  parallel_ranges(cloud_.normal.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::size_t here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      Eigen::Vector3f& normal = cloud_.normal[i];
      const float square = normal.squaredNorm(); // NaN, or out of these bounds: of lengths that need care
      const bool usable =
          (square > 1e-30f && square < 1e30f) || (normal.allFinite() && std::isnormal(normal.stableNorm()));
      if (!usable) normal.setZero();
      here += usable ? 1u : 0u;
    }
    given += here;
  });
  if (cloud_.normal.empty() || given > 0) return;
  cloud_.normal = {};
  if (plan_.has(slot_harmonic)) return; // zeros stand there by custom
  report.notes.push_back("the file's normals are all zero or not finite: it is taken as one without normals");
}

PointCloud PointSink::finish(CloudReport& report) {
  report.points_in_file = cloud_.size();
  finish_normals(report);
  if (has_packed_)
    scale_colours({FieldType::u8, FieldType::u8, FieldType::u8}, cloud_.colour, report);
  else if (!cloud_.colour.empty())
    scale_colours({plan_.fields[field_of_[slot_colour]].type, plan_.fields[field_of_[slot_colour + 1]].type,
                   plan_.fields[field_of_[slot_colour + 2]].type},
                  cloud_.colour, report);
  if (plan_.has(slot_harmonic)) discs_from_gaussians(gaussians_, cloud_, report);
  std::array<bool, 3> is_float32{};
  for (std::size_t k = 0; k < 3; ++k)
    is_float32[k] = plan_.fields[field_of_[slot_position + k]].type == FieldType::f32;
  if (const auto warning = float_precision_warning(cloud_.position, is_float32)) report.warnings.push_back(*warning);
  return std::move(cloud_);
}

} // namespace pointgi
