#include "host/cloud/splat_size.h"
#include "host/cloud/cell_polygon.h"
#include "host/cloud/quantile.h"
#include "host/cloud/smooth_cell.h"
#include "host/cloud/unfold.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double stray_factor = 3.0; // of the cloud's median spacing: open and sparser than this is a stray clump

// A cell is exact when no neighbour left out could be nearer than twice its farthest corner. Where 20 do not suffice,
// more are fetched; 160 see across a density step of 16 and tell it from a boundary.
constexpr std::array<unsigned, 3> neighbour_stages = {20, 56, 160};
constexpr double longest_reach = 3.0; // of a cell on its open side, in spacings; radius <= 3.6 spacings follows
constexpr float largest_step =
    3.0f; // of the spacing, that cells reach across (with longest_reach: a 16-fold density step)
constexpr double widest_gap = 125.0 / 180.0 * pi; // between neighbours; wider and the surface ends there
constexpr double straight_gap = 1.1 * pi;         // up to here the boundary is straight; wider, and it turns a corner
constexpr double corner_gap = 1.6 * pi;           // up to here
constexpr double least_cosine = 0.7;     // of neighbours' normals; where they are rougher discs would grow into blobs
constexpr unsigned alike_candidates = 8; // points looked at, of those that share a site

struct Candidate {
  Eigen::Vector2d offset;
  float spacing;
};

/// Makes the cells of one range of sites; holds the scratch space of a thread.
class CellMaker {
public:
  CellMaker(const Sites& sites, const std::vector<Eigen::Vector3f>& normals, const SiteSpacing& spacing,
            bool faces_agree)
      : sites_(sites), normals_(normals), site_normals_(spacing.normal), spacing_(spacing.spacing),
        faces_agree_(faces_agree), one_a_site_(normals.size() == sites.size()) {}

  struct Cell {
    double area, reach; ///< local units
    bool capped;
  };

  /// How much wider than their cells discs must be where normals are noisy: neighbours tilt away from each other, and a
  /// disc tilted by an angle covers its cosine of the way across. 1 on smooth surfaces. Of the cell made last.
  double widening() const { return widening_; }

  /// Where the surface ends beside the cell made last, local units; an axis of 0 in strips that say nothing.
  const ClipStrips& rim() const { return rim_; }

  void go_to(std::uint32_t site) {
    site_ = site;
    found_ = 0;
  }

  Cell cell(const Eigen::Vector3f& normal) {
    const TangentFrame frame(normal.cast<double>());
    rim_ = {};
    if (const std::optional<Cell> found = smooth_cell(frame)) return *found;
    for (std::size_t stage = 0;; ++stage) {
      const bool last = stage + 1 == neighbour_stages.size() || sites_.size() - 1 <= neighbour_stages[stage];
      const unsigned count = fetch(neighbour_stages[stage]);
      if (count > 0) {
        const double known = std::sqrt(static_cast<double>(near_[count - 1].distance2));
        CellPolygon polygon(known);
        lay_flat(frame, count, &polygon);
        const double reach = std::sqrt(polygon.reach2());
        // Exact; but a cell that reaches over to the next island of points is not meant, however exact.
        if (!polygon.open() && 2.0 * reach <= known && reach <= longest_reach * static_cast<double>(spacing_[site_]))
          return {polygon.area(), reach, false};
      }
      if (!last) continue;
      lay_flat(frame, count, nullptr);
      return bounded_cell(frame, count);
    }
  }

private:
  /// The first `count` neighbours of the site, fetched once for all points there.
  unsigned fetch(unsigned count) {
    if (found_ < std::min(count, sites_.size() - 1)) found_ = sites_.nearest(site_, count, near_.data());
    return std::min(count, found_);
  }

  /// The cell that most points have.
  std::optional<Cell> smooth_cell(const TangentFrame& frame) {
    if (fetch(SmoothCell::neighbours) < SmoothCell::neighbours) return {};
    const Eigen::Vector3d origin = sites_.position(site_);
    const double own = spacing_[site_], scale = 1.0 / own;
    for (unsigned j = 0; j < SmoothCell::neighbours; ++j) {
      const Eigen::Vector3d e = (sites_.position(near_[j].site) - origin) * scale;
      smooth_.set(j, e.cast<float>(), normal_at(near_[j].site, frame.n));
    }
    const double known = std::sqrt(static_cast<double>(near_[SmoothCell::neighbours - 1].distance2)) / own;
    const std::optional<SmoothCell::Cell> found = smooth_.find(frame, std::min(known, 2.0 * longest_reach));
    if (!found) return {};
    widening_ = 1.0 / std::clamp(smooth_.cosine(), least_cosine, 1.0);
    return Cell{found->area * own * own, found->reach * own, false};
  }

  /// Of the points at a neighbouring site the one that faces most alike: at a shared edge, the one on this side of it.
  Eigen::Vector3f normal_at(std::uint32_t site, const Eigen::Vector3d& like) const {
    Eigen::Vector3f best = site_normals_[site];
    if (one_a_site_ && faces_agree_) return best;
    const Sites::Points points = sites_.points(site);
    double alike = agreement(best, like);
    for (std::size_t p = 1; p < std::min<std::size_t>(points.size(), alike_candidates); ++p) {
      const Eigen::Vector3f& other = normals_[points.first[p]];
      if (agreement(other, like) <= alike) continue;
      best = other;
      alike = agreement(other, like);
    }
    return faces_agree_ || best.cast<double>().dot(like) >= 0 ? best : Eigen::Vector3f(-best);
  }
  double agreement(const Eigen::Vector3f& a, const Eigen::Vector3d& b) const {
    const double cosine = a.cast<double>().dot(b);
    return faces_agree_ ? cosine : std::abs(cosine);
  }

  /// Fills candidate_. With a polygon, cuts it, and leaves out what would not change it.
  void lay_flat(const TangentFrame& frame, unsigned count, CellPolygon* polygon) {
    candidates_ = 0;
    std::array<double, spacing_neighbours> cosine;
    const Eigen::Vector3d& origin = sites_.position(site_);
    const double usual = spacing_[site_];
    for (unsigned j = 0; j < count; ++j) {
      const std::uint32_t other = near_[j].site;
      const bool is_near = candidates_ < spacing_neighbours; // these tell of roughness, too
      const bool can_be_left_out = polygon != nullptr && !is_near;
      const auto distance2 = static_cast<double>(near_[j].distance2);
      if (can_be_left_out && polygon->is_beyond(shortest_path2(distance2, usual))) break; // and so are all that follow
      Candidate& candidate = candidate_[candidates_];
      const Eigen::Vector3d normal = normal_at(other, frame.n).cast<double>();
      const Eigen::Vector3d e = sites_.position(other) - origin;
      if (can_be_left_out && polygon->is_beyond(shortest_path2(frame, normal, e))) continue;
      if (!unfold(frame, normal, e, usual, candidate.offset)) continue;
      if (polygon != nullptr) polygon->cut(candidate.offset);
      if (is_near) cosine[candidates_] = normal.dot(frame.n);
      candidate.spacing = spacing_[other];
      ++candidates_;
    }
    // The third of six: a crease, across which the normals of one or two neighbours differ, is not roughness.
    const unsigned m = std::min(candidates_, spacing_neighbours);
    std::nth_element(cosine.begin(), cosine.begin() + m / 3, cosine.begin() + m);
    widening_ = m == 0 ? 1.0 : 1.0 / std::clamp(cosine[m / 3], least_cosine, 1.0);
  }

  /// The cell of a point at the rim of what its neighbours span, or beside a large step in density.
  Cell bounded_cell(const TangentFrame& frame, unsigned count) {
    const double own = spacing_[site_];
    // An isolated site lies farther off than its spacing, which is its neighbours', can explain.
    const bool isolated = count > 0 && spacing_of(near_.data(), count) > spacing_[site_] * 1.001f;
    // A point on the dense side of a step, or just beside it, has a cell as large as those of the sparse side; but no
    // straggler among the candidates may stretch it further.
    double largest = own;
    if (!isolated && candidates_ > 0) {
      for (unsigned j = 0; j < candidates_; ++j)
        ordered_[j] = candidate_[j].spacing;
      const auto middle = ordered_.begin() + (candidates_ - 1) / 2;
      std::nth_element(ordered_.begin(), middle, ordered_.begin() + candidates_);
      const float most = *std::max_element(middle, ordered_.begin() + candidates_);
      largest = std::max(own, static_cast<double>(std::min(most, largest_step * *middle)));
    }
    CellPolygon polygon = bounded_polygon(frame, longest_reach * largest, own, isolated);
    const bool open = polygon.open();
    if (open && largest > own)
      polygon = bounded_polygon(frame, longest_reach * own, own, isolated); // not filled by neighbours either
    return {polygon.area(), std::sqrt(polygon.reach2()), isolated || open};
  }

  CellPolygon bounded_polygon(const TangentFrame& frame, double reach, double own, bool isolated) {
    CellPolygon polygon(reach);
    for (unsigned j = 0; j < candidates_; ++j)
      polygon.cut(candidate_[j].offset);
    close_gaps(frame, polygon, 2.0 * reach, own, isolated);
    return polygon;
  }

  /// Where no neighbour within `view` is seen over a wide angle the surface ends: neighbours are made up one local
  /// spacing away, so that the cell ends half a spacing outside.
  void close_gaps(const TangentFrame& frame, CellPolygon& polygon, double view, double own, bool isolated) {
    unsigned seen = 0;
    double nearest = std::numeric_limits<double>::max();
    for (unsigned j = 0; j < candidates_; ++j) {
      const Eigen::Vector2d& q = candidate_[j].offset;
      const double distance = q.norm();
      if (distance > view) continue;
      nearest = std::min(nearest, distance);
      angle_[seen++] = std::atan2(q.y(), q.x());
    }
    if (seen == 0) angle_[seen++] = 0.0;
    std::sort(angle_.begin(), angle_.begin() + seen);
    const auto gap_after = [&](unsigned a) {
      return a + 1 < seen ? angle_[a + 1] - angle_[a] : angle_[0] + 2.0 * pi - angle_[a];
    };
    double filled = 2.0 * pi;
    unsigned wide = 0;
    for (unsigned a = 0; a < seen; ++a)
      if (gap_after(a) > widest_gap) {
        filled -= gap_after(a);
        ++wide;
      }
    rim_ = {};
    // The spacing was found as if neighbours were all around; they fill only part of the circle.
    double distance = own;
    if (!isolated && nearest < std::numeric_limits<double>::max())
      distance = std::min(own, std::max(own * std::sqrt(std::max(filled, 0.0) / (2.0 * pi)), nearest));
    for (unsigned a = 0; a < seen; ++a) {
      const double gap = gap_after(a);
      if (gap <= widest_gap) continue;
      if (!isolated && wide == 1) set_rim(frame, angle_[a], gap, 0.5 * distance);
      const int ghosts = std::max(1, static_cast<int>(std::ceil(gap / (0.5 * pi) - 0.05)) - 1);
      for (int g = 1; g <= ghosts; ++g) {
        const double angle = angle_[a] + gap * g / (ghosts + 1);
        polygon.cut(distance * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      }
    }
    if (candidates_ == 0) polygon.cut({distance, 0.0}); // a square
  }

  /// Of a gap that begins at the angle `from`.
  void set_rim(const TangentFrame& frame, double from, double gap, double limit) {
    const auto strip = [&](double angle) {
      return ClipStrips::Strip{std::cos(angle) * frame.u + std::sin(angle) * frame.v,
                               -std::numeric_limits<double>::infinity(), limit};
    };
    if (gap <= straight_gap)
      rim_.strip = {strip(from + 0.5 * gap), {}};
    else if (gap <= corner_gap)
      rim_.strip = {strip(from + 0.5 * pi), strip(from + gap - 0.5 * pi)};
  }

  const Sites& sites_;
  const std::vector<Eigen::Vector3f>& normals_;
  const std::vector<Eigen::Vector3f>& site_normals_;
  const std::vector<float>& spacing_;
  bool faces_agree_, one_a_site_;
  std::uint32_t site_ = 0;
  unsigned found_ = 0;
  unsigned candidates_ = 0;
  double widening_ = 1.0;
  ClipStrips rim_;
  SmoothCell smooth_;
  std::array<Neighbour, neighbour_stages.back()> near_;
  std::array<Candidate, neighbour_stages.back()> candidate_;
  std::array<double, neighbour_stages.back() + 1> angle_;
  std::array<float, neighbour_stages.back()> ordered_;
};

/// How many points at a site share the cell of one of them: those on the same side of the surface. A leaf that is
/// stored as coincident fronts and backs has its area twice.
class Sharing {
public:
  Sharing(const Sites::Points& points, const std::vector<Eigen::Vector3f>& normals, bool faces_agree)
      : normals_(normals), first_(*points.begin()), faces_agree_(faces_agree) {
    for (const std::uint32_t point : points)
      ++count_[side(point)];
  }
  double with(std::uint32_t point) const { return count_[side(point)]; }

private:
  int side(std::uint32_t point) const {
    return faces_agree_ && static_cast<double>(normals_[point].dot(normals_[first_])) < opposite_cosine ? 1 : 0;
  }
  const std::vector<Eigen::Vector3f>& normals_;
  std::uint32_t first_;
  bool faces_agree_;
  std::array<double, 2> count_{0, 0};
};

} // namespace

float positive_float(double value) {
  return static_cast<float>(std::clamp(value, static_cast<double>(std::numeric_limits<float>::min()),
                                       static_cast<double>(std::numeric_limits<float>::max())));
}

SplatSizes splat_sizes(const Sites& sites, const std::vector<Eigen::Vector3f>& normals, const SiteSpacing& spacing,
                       bool faces_agree, bool noisy) {
  SplatSizes sizes;
  sizes.radius.resize(normals.size());
  sizes.area.resize(normals.size());
  std::atomic<std::size_t> capped{0};
  constexpr std::size_t grain = 512;
  std::vector<std::vector<ClippedPoint>> rims((sites.size() + grain - 1) / grain);
  const double unit = sites.unit();
  const double usual = median(spacing.spacing.size(), [&](std::size_t s) { return spacing.spacing[s]; });
  parallel_ranges(sites.size(), grain, [&](std::size_t begin, std::size_t end) {
    CellMaker maker(sites, normals, spacing, faces_agree);
    std::size_t capped_here = 0;
    for (std::size_t s = begin; s < end; ++s) {
      const auto site = static_cast<std::uint32_t>(s);
      const Sites::Points points = sites.points(site);
      maker.go_to(site);
      const auto set = [&](std::uint32_t point, const CellMaker::Cell& cell, double sharing) {
        // A clump of stray points far from the rest is sparse and open: its discs stay in the size of the others'.
        const bool stray = cell.capped && spacing.spacing[s] > stray_factor * usual;
        const double reach = stray ? std::min(cell.reach, stray_factor * usual) : cell.reach;
        sizes.radius[point] = positive_float(reach * splat_overlap * (noisy ? maker.widening() : 1.0) * unit);
        sizes.area[point] = positive_float(cell.area / sharing * unit * unit);
        capped_here += cell.capped;
        if (!maker.rim().strip[0].axis.isZero(0)) rims[begin / grain].push_back({point, maker.rim()});
      };
      if (points.size() == 1) {
        set(*points.begin(), maker.cell(spacing.normal[s]), 1.0);
        continue;
      }
      const Sharing sharing(points, normals, faces_agree);
      CellMaker::Cell cell{};
      const Eigen::Vector3f* before = nullptr;
      for (const std::uint32_t point : points) {
        if (before == nullptr || normals[point] != *before) cell = maker.cell(normals[point]);
        before = &normals[point];
        set(point, cell, sharing.with(point));
      }
    }
    capped += capped_here;
  });
  sizes.capped = capped;
  for (const auto& part : rims)
    sizes.rims.insert(sizes.rims.end(), part.begin(), part.end());
  for (ClippedPoint& rim : sizes.rims)
    for (ClipStrips::Strip& strip : rim.clip.strip)
      strip.high *= unit;
  return sizes;
}

} // namespace pointgi
