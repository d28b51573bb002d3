#include "host/scene/scene.h"

namespace pointgi {

std::string SourcePlace::text() const {
  if (line == 0) return file.empty() ? "(default)" : file;
  return file + ":" + std::to_string(line) + ":" + std::to_string(column);
}

const char* name_of(UpAxis up) {
  constexpr const char* names[] = {"y", "z", "x", "-y", "-z", "-x"};
  return names[static_cast<std::size_t>(up)];
}

const std::vector<UpAxis>& up_axes() {
  static const std::vector<UpAxis> all{UpAxis::y,       UpAxis::z,       UpAxis::x,
                                       UpAxis::minus_y, UpAxis::minus_z, UpAxis::minus_x};
  return all;
}

Vector3d direction_of(UpAxis up) {
  constexpr int axes[] = {1, 2, 0};
  const auto number = static_cast<int>(up);
  return (number < 3 ? 1.0 : -1.0) * Vector3d::Unit(axes[number % 3]);
}

const char* name_of(Backfaces backfaces) {
  return backfaces == Backfaces::shade ? "shade" : "see_through";
}

const char* name_of(PointOrder order) {
  return order == PointOrder::morton ? "morton" : "hilbert";
}

const char* name_of(TraversalForm form) {
  return form == TraversalForm::step ? "step" : "wide";
}

const char* name_of(PoolStorage storage) {
  return storage == PoolStorage::buffer           ? "buffer"
         : storage == PoolStorage::image1d_buffer ? "image1d_buffer"
                                                  : "image2d";
}

const char* name_of(Stepping stepping) {
  return stepping == Stepping::exact ? "exact" : "absolute_delta";
}

const char* name_of(RayGrouping grouping) {
  return grouping == RayGrouping::ray ? "ray" : "packet";
}

const char* name_of(SurfaceForm surface) {
  return surface == SurfaceForm::discs ? "discs" : "mls";
}

std::string name_of(WorkGroup group) {
  return std::to_string(group.x) + "x" + std::to_string(group.y);
}

const std::vector<PointOrder>& point_orders() {
  static const std::vector<PointOrder> all{PointOrder::morton, PointOrder::hilbert};
  return all;
}

const std::vector<TraversalForm>& traversal_forms() {
  static const std::vector<TraversalForm> all{TraversalForm::step, TraversalForm::wide};
  return all;
}

const std::vector<PoolStorage>& pool_storages() {
  static const std::vector<PoolStorage> all{PoolStorage::buffer, PoolStorage::image1d_buffer, PoolStorage::image2d};
  return all;
}

const std::vector<RayGrouping>& ray_groupings() {
  static const std::vector<RayGrouping> all{RayGrouping::ray, RayGrouping::packet};
  return all;
}

const std::vector<WorkGroup>& work_groups() {
  static const std::vector<WorkGroup> all{{8, 4}, {32, 1}, {16, 4}, {64, 1}};
  return all;
}

} // namespace pointgi
