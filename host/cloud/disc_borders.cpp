#include "host/cloud/disc_borders.h"
#include "host/cloud/bent_surface.h"
#include "host/cloud/cell_polygon.h"
#include "host/cloud/faces.h"
#include "host/cloud/splat_size.h"
#include "host/cloud/unfold.h"
#include "octree/parallel.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointgi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr unsigned border_neighbours = 20; // as many as Sites keep
constexpr unsigned planes_a_site = 8;
constexpr double face_cosine = 0.9;     // 25°: of neighbours' normals, beyond which edges are looked for
constexpr double across_cosine = 0.9;   // of the axes of two borders; nearer to parallel and they are one
constexpr double beside_cosine = 0.7;   // of a border's axis with a direction that it bounds
constexpr double visible = 0.12;        // of the radius: what may stick out unclipped
constexpr float level_cosine = 0.9928f; // less than `visible` for a sine
constexpr double mesh_growth = 1.5;     // of a mesh's: borders are known that far off
constexpr double most_growth = 2.5;     // of a disc beside an edge; more, and the surroundings are not what they seem
constexpr double inside = 0.1;          // of the radius: how far at least points lie inside their edges
constexpr double most_noise = 0.8;      // spacings: a fifth of one at four standard deviations
constexpr double least_area = 1e-3;     // of a disc, over the square of its radius
constexpr double smooth_margin = 1.05;  // of the cell's reach: neighbours' planes need not meet where cells do
constexpr double tower = 1.05;          // radius over the spacing that is unusual
constexpr double pi = 3.14159265358979323846;
constexpr double ragged_gap = 90.0 / 180.0 * pi, straight_gap = 1.1 * pi; // between neighbours at a boundary
constexpr unsigned far_neighbours = 160; // in which one would lie beyond the gap, were it a hole
constexpr double in_gap = 0.8;           // cosine, 37°
constexpr unsigned beside_rim = 10;      // neighbours that a boundary is taken over from
constexpr std::size_t most_at_site = 16;
constexpr std::uint32_t no_rim = std::numeric_limits<std::uint32_t>::max();
constexpr double unbounded = std::numeric_limits<double>::infinity();

bool is_set(const ClipStrips::Strip& strip) {
  return !strip.axis.isZero(0);
}

/// Adds the half-plane axis . x <= limit, if there is room for it.
void add(ClipStrips& clip, const Vector3d& axis, double limit) {
  for (ClipStrips::Strip& strip : clip.strip) {
    if (!is_set(strip)) {
      strip = {axis, -unbounded, limit};
      return;
    }
    const double along = strip.axis.dot(axis);
    if (along > across_cosine) {
      strip.high = std::min(strip.high, limit);
      return;
    }
    if (along < -across_cosine) {
      strip.low = std::max(strip.low, -limit);
      return;
    }
  }
}

/// Finds how the discs of a range of sites end. In local units.
class BorderFinder {
public:
  /// `rim_number`: index into the evidence's rims of each point, or no_rim; empty where there are none.
  BorderFinder(const PointCloud& cloud, const Sites& sites, const SiteSpacing& spacing, const BorderEvidence& evidence,
               const std::vector<std::uint32_t>& rim_number)
      : cloud_(cloud), sites_(sites), spacing_(spacing.spacing), site_normals_(spacing.normal), evidence_(evidence),
        rim_number_(rim_number) {}

  struct Ends {
    ClipStrips clip;
    double radius = 0, area = 0; ///< of a disc that fills its face up to an edge; 0: as they were
    Vector3d normal{0, 0, 0};    ///< of that face, where it is one of several; 0: as it was
    Vector3d shift{0, 0, 0};     ///< of a point at its very edge: onto its own face
  };

  void go_to(std::uint32_t site) {
    site_ = site;
    count_ = sites_.nearest(site, std::min(border_neighbours, sites_.size() - 1), near_.data());
  }

  /// Whether nothing can stick out here: neighbours face alike, and the disc is of the usual size. Most sites are so.
  bool is_level() const {
    const std::uint32_t point = *sites_.points(site_).begin();
    if (evidence_.from_faces || sites_.points(site_).size() > 1 || rim_of(point) != nullptr ||
        cloud_.radius[point] / sites_.unit() >= tower * spacing_[site_])
      return false;
    const Eigen::Vector3f& n = site_normals_[site_];
    return std::all_of(near_.begin(), near_.begin() + count_,
                       [&](const Neighbour& near) { return n.dot(site_normals_[near.site]) > level_cosine; });
  }

  Ends find(std::uint32_t point) {
    const double radius = cloud_.radius[point] / sites_.unit();
    const Vector3d n = cloud_.normal[point].cast<double>();
    const TangentFrame frame(n);
    const ClipStrips rim = rim_at(point, frame, radius);
    if (is_beside_edge(n) && find_faces_around(n)) {
      Ends ends = ends_on_face(radius, rim);
      if (ends.radius > 0) return with_share(ends, point);
    }
    look_around(n, radius);
    return with_share(ends_on_surface(frame, radius, rim), point);
  }

private:
  /// A point on an edge, or past it by noise, would lie in the other face's disc: no light would reach it. It moves
  /// along its own face, towards the middle of what is left of its disc.
  static void move_inside(Ends& ends, const Vector3d& axis, double limit) {
    const double least = inside * ends.radius;
    if (limit >= least || ends.shift.dot(axis) <= limit - least) return;
    ends.shift -= (least - limit + ends.shift.dot(axis)) * axis;
  }
  static void settle(Ends& ends) {
    if (ends.shift.isZero(0)) return;
    for (ClipStrips::Strip& strip : ends.clip.strip) {
      const double moved = ends.shift.dot(strip.axis);
      strip.low -= moved;
      strip.high -= moved;
    }
    ends.radius += ends.shift.norm(); // it still covers what it did
  }

  /// Points at one site that face alike share their cell. A sliver between two borders keeps some area.
  Ends with_share(Ends ends, std::uint32_t point) const {
    if (!(ends.radius > 0)) return ends;
    const Sites::Points points = sites_.points(site_);
    const auto sharing = std::count_if(points.begin(), points.end(), [&](std::uint32_t other) {
      return cloud_.normal[other].dot(cloud_.normal[point]) > static_cast<float>(face_cosine);
    });
    const double least = least_area * ends.radius * ends.radius;
    ends.area = evidence_.areas_given
                    ? 0.0
                    : std::max(ends.area, least) / static_cast<double>(std::max<std::ptrdiff_t>(sharing, 1));
    return ends;
  }
  Vector3d offset(unsigned j) const { return sites_.position(near_[j].site) - sites_.position(site_); }

  /// Of the points at a site the normal of the one that faces most alike.
  Vector3d normal_alike(std::uint32_t site, const Vector3d& n) const {
    const Sites::Points points = sites_.points(site);
    Vector3d best = cloud_.normal[*points.begin()].cast<double>();
    for (std::size_t p = 1; p < std::min<std::size_t>(points.size(), planes_a_site); ++p) {
      const Vector3d other = cloud_.normal[points.first[p]].cast<double>();
      if (other.dot(n) > best.dot(n)) best = other;
    }
    return best;
  }

  const ClipStrips* rim_of(std::uint32_t point) const {
    return rim_number_.empty() || rim_number_[point] == no_rim ? nullptr : &evidence_.rims[rim_number_[point]].clip;
  }
  ClipStrips rim_at(std::uint32_t point, const TangentFrame& frame, double radius) const {
    if (const ClipStrips* own = rim_of(point)) return *own;
    if (evidence_.from_faces || radius < tower * spacing_[site_]) return {};
    const ClipStrips between = rim_number_.empty() ? ClipStrips{} : rim_between(frame);
    return is_set(between.strip[0]) ? between : rim_beyond_gap(frame);
  }
  /// The boundary where there is nothing beyond a gap between neighbours that bound the point's cell: what lies beyond
  /// a hole is found among so many.
  ClipStrips rim_beyond_gap(const TangentFrame& frame) const {
    // Quickly no, for most: ways to neighbours all around but for a gap of 90 degrees have a mean of 0.3.
    Vector3d ways = Vector3d::Zero();
    for (unsigned j = 0; j < count_; ++j)
      ways += offset(j).normalized();
    if (ways.norm() < 0.25 * count_) return {};
    std::array<double, border_neighbours> angle;
    const double usual = spacing_[site_];
    Vector2d flat;
    unsigned seen = 0;
    for (unsigned j = 0; j < count_; ++j)
      if (unfold(frame, normal_alike(near_[j].site, frame.n), offset(j), usual, flat))
        angle[seen++] = std::atan2(flat.y(), flat.x());
    if (2 * seen < border_neighbours) return {};
    std::sort(angle.begin(), angle.begin() + seen);
    double widest = 0, middle = 0;
    for (unsigned a = 0; a < seen; ++a) {
      const double gap = a + 1 < seen ? angle[a + 1] - angle[a] : angle[0] + 2.0 * pi - angle[a];
      if (gap <= widest) continue;
      widest = gap;
      middle = angle[a] + 0.5 * gap;
    }
    if (widest < ragged_gap || widest > straight_gap) return {};
    const Vector3d axis = std::cos(middle) * frame.u + std::sin(middle) * frame.v;
    if (!goes_on(axis, frame.n.cross(axis)) || !goes_on(axis, -frame.n.cross(axis))) return {};
    std::array<Neighbour, far_neighbours> far;
    const unsigned count = sites_.nearest(site_, std::min(far_neighbours, sites_.size() - 1), far.data());
    for (unsigned j = 0; j < count; ++j) {
      const Vector3d e = sites_.position(far[j].site) - sites_.position(site_);
      if (e.dot(axis) > in_gap * e.norm()) return {};
    }
    return {{{{axis, -unbounded, 0.5 * usual}, {}}}};
  }
  /// The boundary as neighbours on two sides have it: they stand a little farther out and bound the point's cell, which
  /// would be a tower between them.
  ClipStrips rim_between(const TangentFrame& frame) const {
    struct Rim {
      Vector3d axis, offset;
      double limit;
    };
    std::array<Rim, beside_rim> rim;
    unsigned count = 0;
    for (unsigned j = 0; j < std::min(count_, beside_rim); ++j)
      if (const ClipStrips* other = rim_of(*sites_.points(near_[j].site).begin())) {
        const ClipStrips::Strip& strip = other->strip[0];
        rim[count++] = {strip.axis, offset(j), offset(j).dot(strip.axis) + strip.high};
      }
    for (unsigned a = 0; a < count; ++a)
      for (unsigned b = a + 1; b < count; ++b) {
        Vector3d axis = rim[a].axis + rim[b].axis;
        axis -= axis.dot(frame.n) * frame.n;
        if (rim[a].axis.dot(rim[b].axis) < across_cosine || !(axis.norm() > 1.0)) continue;
        axis.normalize();
        const Vector3d along = frame.n.cross(axis);
        const double limit = std::max(rim[a].limit, rim[b].limit);
        if (rim[a].offset.dot(along) * rim[b].offset.dot(along) < 0 && limit > 0)
          return {{{{axis, -unbounded, limit}, {}}}};
      }
    return {};
  }

  /// Whether the boundary across `axis` goes on with a neighbour in the direction `along` it.
  bool goes_on(const Vector3d& axis, const Vector3d& along) const {
    for (unsigned j = 0; j < count_; ++j) {
      const Vector3d e = offset(j);
      if (e.norm() < 2.0 * spacing_[site_] && e.dot(along) > in_gap * e.norm() && e.dot(axis) > -0.5 * e.norm())
        return true;
    }
    return false;
  }

  // Edges of scans.

  /// Whether neighbours face so differently that an edge may be near.
  bool is_beside_edge(const Vector3d& n) const {
    return !evidence_.from_faces && sites_.size() > face_neighbours &&
           std::any_of(near_.begin(), near_.begin() + count_,
                       [&](const Neighbour& near) { return normal_alike(near.site, n).dot(n) < face_cosine; });
  }
  /// Fills faces_, and edge_ from 1 on. False where there are none.
  bool find_faces_around(const Vector3d& n) {
    std::array<Neighbour, face_neighbours> wide;
    std::array<NearPoint, face_neighbours + 1> near;
    const unsigned count = sites_.nearest(site_, face_neighbours, wide.data());
    const double usual = spacing_[site_];
    near[0] = {Vector3d::Zero(), n};
    for (unsigned j = 0; j < count; ++j)
      near[j + 1] = {(sites_.position(wide[j].site) - sites_.position(site_)) / usual, normal_alike(wide[j].site, n)};
    faces_ = find_faces(near.data(), count + 1, n, evidence_.normals_given);
    for (unsigned k = 0; k < faces_.count; ++k)
      faces_.plane[k].height *= usual;
    for (unsigned k = 1; k < faces_.count; ++k) {
      const Faces::Plane& other = faces_.plane[k];
      const Vector3d across = other.normal - other.normal.dot(faces_.plane[0].normal) * faces_.plane[0].normal;
      // Where the disc's plane, which goes through the point, meets the other face; noise may put the point past it.
      const double limit = other.height / across.norm();
      edge_[k] = other.sticks_out ? Edge{across.normalized(), limit} : Edge{-across.normalized(), -limit};
    }
    return faces_.count > 0 && faces_sensor(faces_.plane[0].normal);
  }
  bool faces_sensor(const Vector3d& n) const {
    return !evidence_.sensor || n.dot(sites_.to_local(*evidence_.sensor) - sites_.position(site_)) > 0;
  }
  /// Ends at the edges of the point's face. Normals beside an edge are not to be relied on: neighbours that are nearer
  /// to another face are not on this one. Radius 0: the disc would have to be too large.
  Ends ends_on_face(double radius, const ClipStrips& rim) const {
    const TangentFrame frame(faces_.plane[0].normal);
    CellPolygon cell(8.0 * radius);
    for (unsigned j = 0; j < count_; ++j)
      if (is_on_own_face(offset(j))) cell.cut(frame.flat(offset(j)));
    for (unsigned k = 1; k < faces_.count; ++k)
      cell.cut_at(frame.flat(edge_[k].axis), edge_[k].reach());
    cut_at(rim, frame, cell);
    const double reach = splat_overlap * std::sqrt(cell.reach2());
    Ends ends;
    if (cell.open() || reach > most_growth * radius || is_past_edge()) return ends;
    ends.radius = std::max(radius, reach);
    ends.area = cell.area();
    if (!evidence_.normals_given) ends.normal = frame.n;
    for (unsigned k = 1; k < faces_.count; ++k) // at an inner edge the other face stands before what reaches past it
      if (faces_.plane[k].sticks_out && edge_[k].limit < ends.radius) add(ends.clip, edge_[k].axis, edge_[k].reach());
    add_rim(ends, rim, ends.radius);
    for (unsigned k = 1; k < faces_.count; ++k)
      move_inside(ends, edge_[k].axis, edge_[k].limit);
    settle(ends);
    return ends;
  }
  /// Whether the point lies farther past an edge of its face than noise explains.
  bool is_past_edge() const {
    return std::any_of(edge_.begin() + 1, edge_.begin() + faces_.count,
                       [&](const Edge& edge) { return edge.limit < -most_noise * spacing_[site_]; });
  }
  bool is_on_own_face(const Vector3d& e) const {
    const auto off = [&](unsigned k) { return std::abs(e.dot(faces_.plane[k].normal) - faces_.plane[k].height); };
    for (unsigned k = 1; k < faces_.count; ++k)
      if (off(k) < off(0)) return false;
    return true;
  }

  // Everywhere else.

  void look_around(const Vector3d& n, double radius) {
    bent_.begin(n, radius, evidence_.normals_given);
    for (unsigned j = 0; j < count_; ++j) {
      const Sites::Points points = sites_.points(near_[j].site);
      for (std::size_t p = 0; p < std::min<std::size_t>(points.size(), planes_a_site); ++p) {
        const Vector3d m = cloud_.normal[points.first[p]].cast<double>();
        if (!(n.dot(m) > evidence_.followed_cosine)) bent_.add(offset(j), m);
      }
    }
  }
  /// Ends at rims, and where the surface is bent.
  Ends ends_on_surface(const TangentFrame& frame, double radius, const ClipStrips& rim) const {
    Ends ends;
    add_rim(ends, rim, radius);
    // The cell of a point that is farther from a mesh's edge may reach to it all the same.
    const bool fills_face = evidence_.from_faces && is_set(rim.strip[0]);
    const bool is_bent = bent_.worst([](const Vector3d&) { return true; }).height > visible * radius;
    if (!fills_face && !is_bent) return ends;
    CellPolygon cell(8.0 * radius);
    lay_cell(frame, rim, cell);
    if (cell.open()) return ends;
    if (fills_face) {
      ends.radius = std::clamp(splat_overlap * std::sqrt(cell.reach2()), radius, mesh_growth * radius);
      ends.area = cell.area();
      ends.clip = {};
      add_rim(ends, rim, ends.radius);
    }
    add_bent(ends.clip, frame, cell, radius);
    if (fills_face) {
      for (const ClipStrips::Strip& strip : rim.strip)
        if (is_set(strip)) move_inside(ends, strip.axis, strip.high);
      settle(ends);
    }
    return ends;
  }
  static void add_rim(Ends& ends, const ClipStrips& rim, double radius) {
    for (const ClipStrips::Strip& strip : rim.strip)
      if (is_set(strip) && strip.high < radius) add(ends.clip, strip.axis, strip.high);
  }
  static void cut_at(const ClipStrips& rim, const TangentFrame& frame, CellPolygon& cell) {
    for (const ClipStrips::Strip& strip : rim.strip)
      if (is_set(strip)) cell.cut_at(frame.flat(strip.axis), strip.high);
  }
  /// The point's cell, up to its rims.
  void lay_cell(const TangentFrame& frame, const ClipStrips& rim, CellPolygon& cell) const {
    for (unsigned j = 0; j < count_; ++j) {
      const Vector3d m = normal_alike(near_[j].site, frame.n);
      Vector2d flat;
      if (frame.n.dot(m) < detail::crease_cosine && is_beyond_edge(offset(j), rim)) continue;
      if (unfold(frame, m, offset(j), spacing_[site_], flat)) cell.cut(flat);
    }
    cut_at(rim, frame, cell);
  }
  /// Whether a neighbour lies on another face of a mesh.
  bool is_beyond_edge(const Vector3d& e, const ClipStrips& rim) const {
    return evidence_.from_faces && std::any_of(rim.strip.begin(), rim.strip.end(), [&](const ClipStrips::Strip& strip) {
             return is_set(strip) && e.dot(strip.axis) > 0.5 * strip.high;
           });
  }
  /// The cell's bounds where the disc would stick out most, across that, and on their other sides.
  void add_bent(ClipStrips& clip, const TangentFrame& frame, const CellPolygon& cell, double radius) const {
    const auto add_bound = [&](const Vector3d& axis) {
      add(clip, axis, smooth_margin * cell.reach_along(frame.flat(axis)));
    };
    const auto is_free = [&](const Vector3d& axis) {
      return std::none_of(clip.strip.begin(), clip.strip.end(), [&](const ClipStrips::Strip& strip) {
        return std::abs(strip.axis.dot(axis)) > beside_cosine;
      });
    };
    while (!is_set(clip.strip[1])) {
      const BentSurface::Worst worst = bent_.worst(is_free);
      if (worst.height < visible * radius) break;
      // Across the border that there is, so that the two do not leave a corner.
      const Vector3d& first = clip.strip[0].axis;
      add_bound((worst.axis - worst.axis.dot(first) * first).normalized());
    }
    for (const ClipStrips::Strip& strip : clip.strip)
      for (const double side : {1.0, -1.0}) {
        if (!is_set(strip) || (side > 0 ? strip.high < unbounded : strip.low > -unbounded)) continue;
        const Vector3d axis = side * strip.axis;
        const auto is_there = [&](const Vector3d& other) { return other.dot(axis) > beside_cosine; };
        if (bent_.worst(is_there).height >= visible * radius) add_bound(axis);
      }
  }

  struct Edge {
    Vector3d axis; ///< outwards
    double limit;  ///< below 0 where the point lies past it

    double reach() const { return std::max(0.0, limit); } ///< of the disc
  };

  const PointCloud& cloud_;
  const Sites& sites_;
  const std::vector<float>& spacing_;
  const std::vector<Eigen::Vector3f>& site_normals_; ///< all may have been turned since
  const BorderEvidence& evidence_;
  const std::vector<std::uint32_t>& rim_number_;
  std::uint32_t site_ = 0;
  unsigned count_ = 0;
  std::array<Neighbour, border_neighbours> near_;
  BentSurface bent_;
  Faces faces_; ///< heights in local units
  std::array<Edge, 3> edge_;
};

} // namespace

void clip_discs(PointCloud& cloud, const Sites& sites, const SiteSpacing& spacing, BorderEvidence&& evidence) {
  constexpr std::size_t grain = 2048;
  const double unit = sites.unit();
  const auto scale = [](ClipStrips& clip, double factor) {
    for (ClipStrips::Strip& strip : clip.strip) {
      strip.low *= factor;
      strip.high *= factor;
    }
  };
  std::vector<std::uint32_t> rim_number(evidence.rims.empty() ? 0 : cloud.size(), no_rim);
  for (std::uint32_t k = 0; k < evidence.rims.size(); ++k) {
    rim_number[evidence.rims[k].point] = k;
    scale(evidence.rims[k].clip, 1.0 / unit);
  }
  struct PointEnds {
    std::uint32_t point;
    BorderFinder::Ends ends;
  };
  std::vector<std::vector<PointEnds>> found((sites.size() + grain - 1) / grain);
  parallel_ranges(sites.size(), grain, [&](std::size_t begin, std::size_t end) {
    BorderFinder finder(cloud, sites, spacing, evidence, rim_number);
    for (auto s = static_cast<std::uint32_t>(begin); s < end; ++s) {
      if (sites.points(s).size() > most_at_site) continue; // a heap of points is no surface
      finder.go_to(s);
      if (finder.is_level()) continue;
      for (const std::uint32_t point : sites.points(s)) {
        const Structure structure = cloud.structure[point];
        if (!evidence.from_faces && structure != Structure::surface && structure != Structure::volume) continue;
        const BorderFinder::Ends ends = finder.find(point);
        if (is_set(ends.clip.strip[0]) || ends.radius > 0) found[begin / grain].push_back({point, ends});
      }
    }
  });
  // Not before all have looked at their neighbours.
  for (const auto& part : found)
    for (const auto& [point, ends] : part) {
      if (!ends.normal.isZero(0)) {
        cloud.normal[point] = ends.normal.cast<float>();
        cloud.structure[point] = Structure::surface; // one side of an edge, not a thing of its own
      }
      if (ends.radius > 0) {
        cloud.radius[point] = positive_float(ends.radius * unit);
        if (ends.area > 0) cloud.area[point] = positive_float(ends.area * unit * unit);
      }
      if (!ends.shift.isZero(0)) cloud.position[point] += ends.shift * unit;
      if (!is_set(ends.clip.strip[0])) continue;
      cloud.clipped.push_back({point, ends.clip});
      scale(cloud.clipped.back().clip, unit);
    }
  std::sort(cloud.clipped.begin(), cloud.clipped.end(),
            [](const ClippedPoint& a, const ClippedPoint& b) { return a.point < b.point; });
}

} // namespace pointgi
