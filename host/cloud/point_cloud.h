#pragma once
/// A point cloud as it came from a file or a sampler: world units, double positions, attributes that may be missing.
#include "host/cloud/field.h"
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pointgi {

/// What the neighbourhood of a point says about it.
enum class Structure : std::uint8_t {
  surface,
  flat,   ///< of a shape whose faces are planes: the disc lies in the true surface
  line,   ///< a cable, a twig
  volume, ///< foliage, or noise through and through
  sheet,  ///< a surface without thickness, both sides of which are meant: leaves, faces stored both ways round
  stray   ///< its neighbours are nearer to one another than it is to them
};

inline bool is_surface(Structure structure) {
  return structure == Structure::surface || structure == Structure::flat;
}

/// Two strips of a splat's plane, across each other, in which its disc counts: what it stands for has a border there.
struct ClipStrips {
  struct Strip {
    Eigen::Vector3d axis{0, 0, 0}; ///< unit, across the normal; 0: cuts nothing off
    double low = -1.0, high = 1.0; ///< along it from the centre, world units; may be infinite
  };
  std::array<Strip, 2> strip;
};

/// A point that ends at a border.
struct ClippedPoint {
  std::uint32_t point;
  ClipStrips clip;
};

/// Every attribute array is either empty (the attribute is missing) or as long as `position`.
struct PointCloud {
  std::vector<Eigen::Vector3d> position; ///< world units; double, so that map coordinates of 1e6 keep their millimetres
  std::vector<Eigen::Vector3f> normal; ///< as given: any length, zero or NaN where missing; unit after complete_cloud()
  std::vector<Eigen::Vector3f> colour; ///< [0,1] a channel, encoded as the file has it (usually sRGB)
  std::vector<float> radius;           ///< splat radius r_i, world units
  std::vector<float> area;             ///< effective area A_i, world units squared (method.md §4)
  std::vector<float> opacity;          ///< [0,1], of Gaussians: complete_cloud() drops the faintest
  std::vector<Structure> structure;    ///< filled by complete_cloud()
  std::vector<std::uint32_t> record;   ///< number of the point in its file, from 0; empty: its own index
  std::vector<std::uint16_t> station;  ///< index into `stations` of the scanner that saw it
  std::vector<Field> fields;           ///< those that were asked for (ReadRequest), and what stands in for colours
  std::vector<std::array<std::uint32_t, 3>> triangle; ///< faces, where the file has any; indices into `position`
  std::vector<Eigen::Vector3d> stations;              ///< positions of scanners; not an attribute of points
  std::vector<ClippedPoint> clipped;                  ///< points that end at borders, ascending; not an attribute
  bool normals_unsigned = false; ///< `normal` tells the plane of the surface, and either side of it

  std::size_t size() const { return position.size(); }
};

/// What became of one property of a file, for `pointgi info`: {"vertex.nx (float)", "normal"} or {…, "not used"}.
struct PropertyUse {
  std::string property;
  std::string use;
};

/// How a cloud was made, as far as it can be told: decides up, sides, view and light where the user does not.
enum class CloudKind {
  model,       ///< an object, closed or nearly so
  depth_frame, ///< one frame of a depth camera
  station,     ///< one scanner position that is known, or several
  terrain,     ///< a height field, as from the air
  room,        ///< an interior without a known station
  map,         ///< streets, sites: large, open, gravity known
  sparse,      ///< points of structure from motion: few, uneven, no surface
  foliage      ///< most points have no surface around them
};
const char* name_of(CloudKind kind);

/// Where a cloud is shown whose file has axes of different units: each point is moved from the middle by `scale`.
struct Placement {
  Eigen::Vector3d low, high; ///< bounds of the points in the file
  Eigen::Vector3d scale;     ///< an axis

  Eigen::Vector3d middle() const { return (low + high) / 2.0; }
  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const { return middle() + scale.cwiseProduct(p - middle()); }
};

/// What was found, estimated, dropped or odd on the way from a file to splats. Shown by `pointgi info`; warnings are
/// logged.
struct CloudReport {
  std::string format;                  ///< e.g. "PLY 1.0 binary_little_endian"
  std::vector<PropertyUse> properties; ///< in file order
  std::vector<std::string> fields;     ///< names of what the file has for each point, as a scene's keys may name them
  std::vector<std::string> warnings;   ///< full sentences, each with its remedy
  std::vector<std::string> notes;      ///< full sentences of what was chosen, logged as information
  std::size_t points_in_file = 0;
  std::size_t points_left_out = 0; ///< by the scene's keep, crop, clip and voxel
  std::size_t points_dropped = 0;  ///< not finite, or with radius <= 0
  std::size_t triangles = 0;
  bool sampled = false;     ///< the points were laid on a mesh: no file has them
  std::string normals_from; ///< "file", "file, flipped", "faces", "estimated (…)"
  std::string radii_from;   ///< "file", "estimated (…)"
  std::string areas_from;
  std::optional<Eigen::Vector3d> up;   ///< unit; what the format defines (LAS, PTX, E57: z), or the cloud's kind shows
  std::optional<CloudKind> usual_kind; ///< what files of this format hold, whatever it looks like
  /// Unit; how programs that write this format count upwards where they do not level their scenes (Gaussians: -y).
  std::optional<Eigen::Vector3d> usual_up;
  std::optional<Placement> placement; ///< degrees of longitude and latitude; PointCloud has them as the file does
  CloudKind kind = CloudKind::model;
  std::string kind_reason;               ///< by what it was recognised; empty: not looked at
  std::vector<Eigen::Vector3d> stations; ///< where the points were seen from, the file's coordinates; empty: not known
};

} // namespace pointgi
