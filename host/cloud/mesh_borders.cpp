#include "host/cloud/mesh_borders.h"
#include "octree/parallel.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace pointgi {

using Eigen::Vector3d;

namespace {

constexpr double smooth_cosine = 0.766;      // 40°: between the faces of a coarse round surface and an edge
constexpr double odd_cosine = -0.5;          // 120°: of faces that fold back, as few things do
constexpr double most_odd = 0.01;            // of a mesh's edges
constexpr double mostly_doubled = 0.5;       // of them
constexpr double folded_back = -0.9;         // cosine: the two sides of a sheet
constexpr double across_cosine = 0.9;        // of two borders' axes; nearer to parallel and they are one
constexpr double inward = 0.1;               // sine of the turn at a corner from which it counts as one
constexpr std::size_t most_borders = 64;     // there
constexpr std::size_t most_triangles = 256;  // looked at around a place
constexpr double grown = 1.5;                // of a radius: discs grow up to an edge
constexpr int most_rounds = 100;             // edges that a fold is shortened by
constexpr std::size_t most_at_edge = 16;     // triangles; more, and the edge counts as an end
constexpr std::uint32_t most_at_vertex = 64; // triangles of one that is split
constexpr double unbounded = std::numeric_limits<double>::infinity();

bool before(const MeshSide& a, const MeshSide& b) {
  return std::tie(a.low, a.high, a.slot) < std::tie(b.low, b.high, b.slot);
}

bool has_area(const std::vector<Vector3d>& position, const std::array<std::uint32_t, 3>& triangle) {
  for (const std::uint32_t corner : triangle)
    if (corner >= position.size() || !position[corner].allFinite()) return false;
  const Vector3d u = position[triangle[1]] - position[triangle[0]], v = position[triangle[2]] - position[triangle[0]];
  const double longest = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  return longest > 0 && (u / longest).cross(v / longest).norm() > 1e-12; // as face_normals() asks
}

/// The same number for corners in one place; none for those of triangles without an area.
std::vector<std::uint32_t> weld(const std::vector<Vector3d>& position, const MeshBorders::Triangles& triangles) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < position.size(); ++i)
    if (position[i].allFinite()) order.push_back(i);
  const auto key = [&](std::uint32_t i) { return std::tie(position[i].x(), position[i].y(), position[i].z()); };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b) || (key(a) == key(b) && a < b); });
  std::vector<std::uint32_t> place(position.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    place[order[i]] = i > 0 && key(order[i - 1]) == key(order[i]) ? place[order[i - 1]] : order[i];
  std::vector<std::uint32_t> vertex(3 * triangles.size(), MeshBorders::none);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (has_area(position, triangles[t]))
      for (std::size_t k = 0; k < 3; ++k)
        vertex[3 * t + k] = place[triangles[t][k]];
  return vertex;
}

/// Unit, in the triangle's plane, across the edge a b towards c; zero where there is no such direction.
Vector3d into_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d along = (b - a).normalized(), to = c - a;
  const Vector3d across = to - to.dot(along) * along;
  const double length = across.norm();
  return length > 1e-9 * to.norm() ? Vector3d(across / length) : Vector3d::Zero();
}

/// A border near a place.
struct Border {
  std::uint32_t from, to; ///< vertices
  Vector3d begin, end;    ///< from the place
  Vector3d axis;          ///< unit, in the tangent plane, outwards
  double limit;           ///< along it
};

double distance2_to_segment(const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp(-a.dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + t * along).squaredNorm();
}

/// Whether the surface turns inwards where two borders meet within reach.
bool turns_inwards(const std::vector<Border>& borders, double reach) {
  for (const Border& a : borders)
    for (const Border& b : borders) {
      if (&a == &b) continue;
      for (const auto& [vertex, corner] : {std::pair(a.from, a.begin), std::pair(a.to, a.end)}) {
        if ((vertex != b.from && vertex != b.to) || corner.norm() > reach) continue;
        const Vector3d away = (vertex == b.from ? b.end : b.begin) - corner;
        if (away.dot(a.axis) > inward * away.norm()) return true;
      }
    }
  return false;
}

/// The part of a segment within reach of the place.
std::array<Vector3d, 2> within(const Border& border, double reach) {
  const Vector3d along = (border.end - border.begin).normalized();
  const double middle = -border.begin.dot(along), length = (border.end - border.begin).norm();
  const Vector3d foot = border.begin + middle * along;
  const double half = std::sqrt(std::max(0.0, reach * reach - foot.squaredNorm()));
  return {border.begin + std::clamp(middle - half, 0.0, length) * along,
          border.begin + std::clamp(middle + half, 0.0, length) * along};
}

/// One border of those that run on from each other, which all lie within it: a bent one is not cut into.
ClipStrips::Strip joined(const std::vector<Border>& borders, std::size_t first, double reach, std::vector<bool>& used) {
  Vector3d axis = Vector3d::Zero();
  std::vector<std::size_t> members;
  for (std::size_t k = first; k < borders.size(); ++k) {
    if (used[k] || borders[k].limit >= reach || borders[k].axis.dot(borders[first].axis) < across_cosine) continue;
    used[k] = true;
    members.push_back(k);
    axis += borders[k].axis;
  }
  axis.normalize();
  double limit = 0;
  for (const std::size_t k : members)
    for (const Vector3d& end : within(borders[k], reach))
      limit = std::max(limit, end.dot(axis));
  return {axis, -unbounded, limit};
}

} // namespace

MeshBorders::MeshBorders(const std::vector<Vector3d>& position, const Triangles& triangles)
    : position_(position), triangles_(triangles), vertex_(weld(position, triangles)),
      across_(3 * triangles.size(), none) {
  std::vector<MeshSide> sides;
  sides.reserve(3 * triangles.size());
  std::vector<Vector3d> into(3 * triangles.size(), Vector3d::Zero());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t* v = &vertex_[3 * t];
    if (!is_used(t)) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto slot = static_cast<std::uint32_t>(3 * t + k);
      const std::uint32_t a = v[k], b = v[(k + 1) % 3];
      into[slot] = into_triangle(position[a], position[b], position[v[(k + 2) % 3]]);
      sides.push_back({std::min(a, b), std::max(a, b), slot});
    }
  }
  std::sort(sides.begin(), sides.end(), before);
  std::vector<Fold> folds;
  std::size_t odd = 0;                                 // sides that fold back, or of three
  std::size_t doubled = 0;                             // sides of four, as where faces are stored both ways round
  std::vector<std::uint32_t> ends(position.size(), 0); // of edges where the surface ends or is folded, at each vertex
  for (std::size_t i = 0, past = 0; i < sides.size(); i = past) {
    for (past = i + 1; past < sides.size() && sides[past].low == sides[i].low && sides[past].high == sides[i].high;)
      ++past;
    bool is_end = false;
    odd += past - i == 3 ? 3 : 0;
    doubled += past - i == 4 ? 4 : 0;
    const bool crowded = past - i > most_at_edge;
    if (crowded) {
      odd += past - i;
      is_end = true;
    }
    for (std::size_t a = i; a < past && !crowded; ++a) {
      // Of several the flattest, and of a face and its back the one that is wound alike.
      double best = -1.0;
      std::uint32_t next = none;
      for (std::size_t b = i; b < past; ++b) {
        const bool alike = vertex_[sides[a].slot] != vertex_[sides[b].slot];
        const double cosine = -into[sides[a].slot].dot(into[sides[b].slot]) + (alike ? 1e-3 : 0.0);
        if (b == a || cosine <= best) continue;
        best = cosine;
        next = sides[b].slot / 3;
      }
      if (best > smooth_cosine) {
        across_[sides[a].slot] = next;
      } else {
        is_end = true;
        odd += next != none && best < odd_cosine;
        if (best > folded_back) folds.push_back({sides[a], next});
      }
    }
    if (is_end) {
      ++ends[sides[i].low];
      ++ends[sides[i].high];
    }
  }
  // Flaps, and faces that pass through each other: nothing tells what ends there.
  const auto all = static_cast<double>(sides.size());
  if (static_cast<double>(odd) > most_odd * all && static_cast<double>(doubled) < mostly_doubled * all) {
    std::fill(across_.begin(), across_.end(), none);
    return;
  }
  unfold_loose(folds, ends);
  any_ = std::any_of(sides.begin(), sides.end(), [&](const MeshSide& side) { return across_[side.slot] == none; });
}

/// Edges go on or meet others. A fold that stops in the middle of a surface is one of a coarse or noisy mesh.
void MeshBorders::unfold_loose(std::vector<Fold>& folds, std::vector<std::uint32_t>& ends) {
  const auto is_loose = [&](const Fold& fold) { return ends[fold.side.low] < 2 || ends[fold.side.high] < 2; };
  bool any = true;
  for (int round = 0; any && round < most_rounds; ++round) {
    any = false;
    for (std::size_t i = 0, past = 0; i < folds.size(); i = past) {
      for (past = i + 1; past < folds.size() && folds[past].side.low == folds[i].side.low &&
                         folds[past].side.high == folds[i].side.high;)
        ++past;
      if (across_[folds[i].side.slot] != none || !is_loose(folds[i])) continue;
      any = true;
      for (std::size_t k = i; k < past; ++k)
        across_[folds[k].side.slot] = folds[k].next;
      --ends[folds[i].side.low];
      --ends[folds[i].side.high];
    }
  }
}

bool MeshBorders::faces_along(std::size_t triangle, const Vector3d& normal) const {
  const auto corner = [&](int k) -> const Vector3d& { return position_[vertex_[3 * triangle + k]]; };
  const Vector3d span = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  return span.dot(normal) > 0.5 * span.norm();
}

ClipStrips MeshBorders::around(const Vector3d& place, const Vector3d& normal, const std::vector<std::uint32_t>& from,
                               double reach) const {
  std::vector<std::uint32_t> seen = from;
  std::vector<Border> borders;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen.size() > most_triangles || borders.size() > most_borders) return {};
    const std::size_t t = seen[i];
    if (!is_used(t)) continue;
    if (i >= from.size() && !faces_along(t, normal)) continue; // round a lip: its border is another one's
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = vertex_[3 * t + k], b = vertex_[3 * t + (k + 1) % 3], c = vertex_[3 * t + (k + 2) % 3];
      const Vector3d begin = position_[a] - place, end = position_[b] - place;
      if (!(distance2_to_segment(begin, end) < reach * reach)) continue;
      const std::uint32_t next = across(t, k);
      if (next != none) {
        if (std::find(seen.begin(), seen.end(), next) == seen.end()) seen.push_back(next);
        continue;
      }
      Vector3d axis = -into_triangle(position_[a], position_[b], position_[c]);
      axis -= axis.dot(normal) * normal;
      const double length = axis.norm();
      if (!(length > 0.5)) continue; // of a surface that has bent away
      axis /= length;
      borders.push_back({a, b, begin, end, axis, std::max(0.0, begin.dot(axis))});
    }
  }
  // Where both sides of an edge are the place's own, as at a vertex with one normal for both, nothing ends.
  const auto is_inside = [&](const Border& border) {
    return std::count_if(borders.begin(), borders.end(), [&](const Border& other) {
             return std::minmax(border.from, border.to) == std::minmax(other.from, other.to);
           }) > 1;
  };
  std::vector<Border> ends;
  std::copy_if(borders.begin(), borders.end(), std::back_inserter(ends),
               [&](const Border& border) { return !is_inside(border); });
  borders = std::move(ends);
  ClipStrips clip;
  if (borders.empty() || turns_inwards(borders, reach)) return clip;
  std::sort(borders.begin(), borders.end(), [](const Border& a, const Border& b) { return a.limit < b.limit; });
  std::vector<bool> used(borders.size(), false);
  for (ClipStrips::Strip& strip : clip.strip)
    for (std::size_t first = 0; first < borders.size() && borders[first].limit < reach; ++first) {
      if (used[first]) continue;
      strip = joined(borders, first, reach, used);
      break;
    }
  return clip;
}

namespace {

/// The triangles at each point: those of point p are of[first[p]] .. of[first[p + 1] - 1].
struct Incident {
  std::vector<std::uint32_t> first, of;

  Incident(std::size_t points, const MeshBorders::Triangles& triangles) : first(points + 1, 0) {
    for (const auto& t : triangles)
      for (const std::uint32_t corner : t)
        if (corner < points) ++first[corner + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    of.resize(first.back());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (const std::uint32_t corner : triangles[t])
        if (corner < points) of[next[corner]++] = t;
  }
};

template <class T>
void repeat(std::vector<T>& values, const std::vector<std::uint32_t>& sources) {
  if (values.empty()) return;
  values.reserve(values.size() + sources.size());
  for (const std::uint32_t source : sources)
    values.push_back(values[source]);
}

} // namespace

void split_at_edges(PointCloud& cloud) {
  const MeshBorders borders(cloud.position, cloud.triangle);
  if (!borders.any()) return;
  const Incident incident(cloud.size(), cloud.triangle);
  std::vector<std::uint32_t> sources;
  const auto points = static_cast<std::uint32_t>(cloud.size());
  std::vector<std::uint32_t> left, group;
  for (std::uint32_t p = 0; p < points; ++p) {
    if (incident.first[p + 1] - incident.first[p] > most_at_vertex) continue; // the tip of a fan
    left.clear();
    std::copy_if(incident.of.begin() + incident.first[p], incident.of.begin() + incident.first[p + 1],
                 std::back_inserter(left), [&](std::uint32_t t) { return borders.is_used(t); });
    for (bool first = true; !left.empty(); first = false) {
      group = {left.back()};
      left.pop_back();
      for (std::size_t i = 0; i < group.size(); ++i)
        for (int k = 0; k < 3; ++k) {
          const auto next = std::find(left.begin(), left.end(), borders.across(group[i], k));
          if (next == left.end()) continue;
          group.push_back(*next);
          left.erase(next);
        }
      if (first) continue;
      const auto number = static_cast<std::uint32_t>(points + sources.size());
      sources.push_back(p);
      for (const std::uint32_t t : group)
        std::replace(cloud.triangle[t].begin(), cloud.triangle[t].end(), p, number);
    }
  }
  if (sources.empty()) return;
  if (cloud.record.empty()) {
    cloud.record.resize(points);
    std::iota(cloud.record.begin(), cloud.record.end(), 0u);
  }
  repeat(cloud.position, sources);
  repeat(cloud.normal, sources);
  repeat(cloud.colour, sources);
  repeat(cloud.radius, sources);
  repeat(cloud.area, sources);
  repeat(cloud.opacity, sources);
  repeat(cloud.structure, sources);
  repeat(cloud.record, sources);
  repeat(cloud.station, sources);
  for (Field& field : cloud.fields)
    repeat(field.values, sources);
}

void borders_from_faces(PointCloud& cloud) {
  const MeshBorders borders(cloud.position, cloud.triangle);
  if (!borders.any()) return;
  const Incident incident(cloud.size(), cloud.triangle);
  constexpr std::size_t grain = 4096;
  std::vector<std::vector<ClippedPoint>> found((cloud.size() + grain - 1) / grain);
  parallel_ranges(cloud.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> from;
    for (std::size_t p = begin; p < end; ++p) {
      from.assign(incident.of.begin() + incident.first[p], incident.of.begin() + incident.first[p + 1]);
      const ClipStrips clip =
          borders.around(cloud.position[p], cloud.normal[p].cast<double>(), from, grown * cloud.radius[p]);
      if (!clip.strip[0].axis.isZero(0)) found[begin / grain].push_back({static_cast<std::uint32_t>(p), clip});
    }
  });
  for (const auto& part : found)
    cloud.clipped.insert(cloud.clipped.end(), part.begin(), part.end());
}

} // namespace pointgi
