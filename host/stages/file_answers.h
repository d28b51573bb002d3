#pragma once
/// Which points of the pool answer for the points of a cloud's file.
#include "host/stages/prepared_scene.h"

namespace pointgi {

/// By the number of a point in the file: its place in the pool.
class FileAnswers {
public:
  static constexpr std::uint32_t none = 0xffffffff;

  /// `scene` has a file_order.
  explicit FileAnswers(const PreparedScene& scene);

  /// Of the splat that the point has become, or that it was merged with; `none`: it was left out or dropped.
  std::uint32_t front(std::size_t record) const { return record < front_.size() ? front_[record] : none; }
  /// Of its other side; `none`: it has no light of its own.
  std::uint32_t back(std::size_t record) const { return record < back_.size() ? back_[record] : none; }
  bool has_backs() const { return !back_.empty(); }

private:
  std::vector<std::uint32_t> front_, back_; ///< back_: empty where nothing is two-sided
};

} // namespace pointgi
