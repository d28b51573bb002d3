#pragma once
/// Which side of a surface is its front.
#include "host/cloud/kind.h"

namespace pointgi {

/// What is known of who saw a cloud, world units.
struct OrientationEvidence {
  std::optional<Eigen::Vector3d> viewpoint; ///< the user's word: obeyed
  std::vector<Eigen::Vector3d> stations;    ///< positions of scanners ...
  std::vector<std::uint16_t> station;       ///< ... and which of them saw each point; empty: not known
  std::vector<Eigen::Vector3d> eyes;        ///< camera and lamps of the scene: what they see should face them
  RecognisedKind kind;
};

struct Orientation {
  std::string how;  ///< "outwards", "towards the viewpoint", "upwards along z" ...
  double doubt = 0; ///< share of the sites whose side was nearly a tie
};

/// Turns the signs of unit normals, a value a site. By, in this order: the viewpoint; the stations, each point to the
/// one that saw it; the sensor or the up direction of the recognised kind; else patches that agree along a spanning
/// forest, each turned by what the eyes see of it, by the volume that it encloses, by the side from which more of the
/// free space is seen, or by its neighbours. `space`: of the same sites.
Orientation orient_normals(const Sites& sites, const OrientationEvidence& evidence, const FreeSpace& space,
                           std::vector<Eigen::Vector3f>& normals);

/// Whether a scanner at `station` can have seen the points at all: nearer than ten times their size. World units.
bool may_have_seen(const Sites& sites, const Eigen::Vector3d& station);

} // namespace pointgi
