#pragma once
/// A point cloud as it came from a file or a sampler: world units, double positions, attributes that may be missing.
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pointgi {

/// Every attribute array is either empty (the attribute is missing) or as long as `position`.
struct PointCloud {
  std::vector<Eigen::Vector3d> position; ///< world units; double, so that map coordinates of 1e6 keep their millimetres
  std::vector<Eigen::Vector3f> normal;   ///< direction as given; unit length only after complete_cloud()
  std::vector<Eigen::Vector3f> colour;   ///< [0,1] a channel, encoded as the file has it (usually sRGB)
  std::vector<float> radius;             ///< splat radius r_i, world units
  std::vector<float> area;               ///< effective area A_i, world units squared (method.md §4)
  std::vector<std::array<std::uint32_t, 3>> triangle; ///< faces, where the file has any; indices into `position`

  std::size_t size() const { return position.size(); }
};

/// What became of one property of a file, for `pointgi info`: {"vertex.nx (float)", "normal"} or {…, "not used"}.
struct PropertyUse {
  std::string property;
  std::string use;
};

/// What was found, estimated, dropped or odd on the way from a file to splats. Shown by `pointgi info`; warnings are
/// logged.
struct CloudReport {
  std::string format;                  ///< e.g. "PLY 1.0 binary_little_endian"
  std::vector<PropertyUse> properties; ///< in file order
  std::vector<std::string> warnings;   ///< full sentences, each with its remedy
  std::size_t points_in_file = 0;
  std::size_t points_dropped = 0; ///< not finite, or with radius <= 0
  std::size_t triangles = 0;
  std::string normals_from; ///< "file", "file, flipped", "faces", "estimated (…)"
  std::string radii_from;   ///< "file", "estimated (…)"
  std::string areas_from;
};

} // namespace pointgi
