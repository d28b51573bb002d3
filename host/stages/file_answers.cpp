#include "host/stages/file_answers.h"
#include <algorithm>

namespace pointgi {

namespace {

/// Places in the pool by id, of the fronts or of the backs.
std::vector<std::uint32_t> places_by_id(const PreparedScene& scene, bool backs) {
  std::uint32_t ids = 0;
  for (const std::uint32_t id : scene.ids)
    ids = std::max(ids, id + 1);
  for (const MergedSplat& merged : scene.file_order->merged)
    ids = std::max(ids, merged.id + 1);
  std::vector<std::uint32_t> place(std::max(ids, scene.file_order->points), FileAnswers::none);
  const View<Splat> points = scene.points;
  for (std::uint32_t p = 0; p < points.size; ++p)
    if (is_back_of_sheet(points[p]) == backs) place[scene.ids[p]] = p;
  for (const MergedSplat& merged : scene.file_order->merged)
    place[merged.id] = place[merged.into];
  return place;
}

/// The same by the points' numbers in the file.
std::vector<std::uint32_t> places_by_record(const PreparedScene& scene, bool backs) {
  const FileOrder& order = *scene.file_order;
  std::vector<std::uint32_t> by_id = places_by_id(scene, backs);
  by_id.resize(order.points); // what follows are other objects
  if (order.record.empty()) return by_id;
  const std::uint32_t last = *std::max_element(order.record.begin(), order.record.end());
  std::vector<std::uint32_t> by_record(std::size_t{last} + 1, FileAnswers::none);
  // Of the points that a vertex at an edge of a mesh became, the first.
  for (std::size_t id = order.record.size(); id-- > 0;)
    by_record[order.record[id]] = by_id[id];
  return by_record;
}

} // namespace

FileAnswers::FileAnswers(const PreparedScene& scene) : front_(places_by_record(scene, false)) {
  const View<Splat> points = scene.points;
  if (std::any_of(points.begin(), points.end(), is_back_of_sheet)) back_ = places_by_record(scene, true);
}

} // namespace pointgi
