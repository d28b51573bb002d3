#pragma once
/// Recognises how a cloud was made: what is recognised decides sides, up, view and light where nobody says.
#include "host/cloud/free_space.h"
#include "host/cloud/point_cloud.h"

namespace pointgi {

struct RecognisedKind {
  CloudKind kind = CloudKind::model;
  std::string reason;                    ///< a clause: "one depth in every direction from the origin"
  std::optional<Eigen::Vector3d> sensor; ///< a place, world units, that all points were seen from, found and not given
  std::optional<Eigen::Vector3d> up;     ///< unit, where the kind shows it
};

/// What a file says besides its points.
struct KindHints {
  bool has_stations = false;         ///< positions of scanners are given, and the points lie around them
  std::optional<Eigen::Vector3d> up; ///< unit; as the format or the user has it
  const char* level_by = nullptr;    ///< a clause: what shows that `up` is against gravity; null: nothing does
  std::optional<CloudKind> usual;    ///< CloudReport::usual_kind
  bool signs_given = false;          ///< normals have sides
};

/// `spacing`, `normals`, `structure`: a value a site; normals unit, of any sign.
RecognisedKind recognise_kind(const Sites& sites, const std::vector<float>& spacing,
                              const std::vector<Eigen::Vector3f>& normals, const std::vector<Structure>& structure,
                              const FreeSpace& space, const KindHints& hints);

} // namespace pointgi
