#include "host/cloud/readers/ply.h"
#include "host/cloud/readers/ply_body.h"
#include "host/cloud/readers/ply_layout.h"
#include "host/cloud/readers/point_sink.h"
#include "host/run.h"
#include <algorithm>
#include <limits>

namespace pointgi {

namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using Stations = std::vector<Eigen::Vector3d>;

/// Walks through the body, element by element in file order. `Body` is PlyBinaryBody or PlyAsciiBody.
template <class Body>
class Reader {
public:
  Reader(const PlyHeader& header, const PlyLayout& layout, Body body, PointSink& sink, Triangles& triangles,
         Stations& stations, CloudReport& report)
      : header_(header), layout_(layout), body_(body), sink_(sink), triangles_(triangles), stations_(stations),
        report_(report), vertex_count_(header.elements[layout.vertex_element].count) {}

  void read() {
    for (std::size_t e = 0; e < header_.elements.size(); ++e) {
      if (e == layout_.vertex_element)
        read_vertices(header_.elements[e]);
      else if (e == layout_.face_element)
        read_faces(header_.elements[e], layout_.face_list, false);
      else if (e == layout_.strip_element)
        read_faces(header_.elements[e], layout_.strip_list, true);
      else if (e == layout_.station_element)
        read_stations(header_.elements[e]);
      else
        skip_element(header_.elements[e]);
    }
    warn_of_leftovers();
  }

private:
  void skip_property(const PlyProperty& property) {
    body_.skip(property.type, property.is_list ? body_.list_count(property) : 1);
  }

  void skip_element(const PlyElement& element) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body_.begin_record(element, i);
      for (const PlyProperty& property : element.properties)
        skip_property(property);
      body_.end_record();
    }
  }

  void read_vertices(const PlyElement& vertex) {
    const auto count = static_cast<std::size_t>(vertex.count);
    const FieldPlan& plan = layout_.plan;
    std::vector<double> row(plan.fields.size());
    const auto station_field = static_cast<std::size_t>(
        std::find(plan.slot.begin(), plan.slot.end(), static_cast<int>(slot_station)) - plan.slot.begin());
    for (std::size_t i = 0; i < count; ++i) {
      if (i % 65536 == 0) stop_if_asked();
      body_.begin_record(vertex, i);
      std::size_t field = 0;
      for (const PlyProperty& property : vertex.properties) {
        if (property.is_list) {
          skip_property(property);
          continue;
        }
        if (plan.is_read(field))
          row[field] = body_.scalar(plan.fields[field].type);
        else
          skip_property(property);
        ++field;
      }
      body_.end_record();
      if (station_field < row.size()) check_station(row[station_field]);
      sink_.put(i, row.data());
    }
  }

  void check_station(double index) {
    const double count = static_cast<double>(header_.elements[layout_.station_element].count);
    if (!(index >= 0.0 && index < count) || index != std::floor(index))
      body_.fail_record("the index of its station is " + text_of(index) + ", expected 0 to " + text_of(count - 1.0) +
                        "; the file is corrupt");
  }

  void read_stations(const PlyElement& element) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body_.begin_record(element, i);
      Eigen::Vector3d position = Eigen::Vector3d::Zero();
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const auto& axes = layout_.station_axes;
        const auto axis = std::find(axes.begin(), axes.end(), p);
        if (axis == axes.end())
          skip_property(element.properties[p]);
        else
          position[axis - axes.begin()] = body_.scalar(element.properties[p].type);
      }
      body_.end_record();
      if (!position.allFinite()) body_.fail_record("a scanner position is not finite; remove the element station");
      stations_.push_back(position);
    }
  }

  void read_faces(const PlyElement& element, std::size_t list, bool strips) {
    // A face takes at least as many bytes as its count, which was checked against the file's size.
    if (!strips) triangles_.reserve(static_cast<std::size_t>(element.count));
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body_.begin_record(element, i);
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        if (p == list)
          read_indices(element.properties[p]);
        else
          skip_property(element.properties[p]);
      }
      body_.end_record();
      if (strips)
        add_strips();
      else
        add_fan();
    }
  }

  /// Fills indices_; -1 stands for the restart marker that some writers put into faces.
  void read_indices(const PlyProperty& property) {
    const std::size_t count = body_.list_count(property);
    indices_.clear();
    for (std::size_t k = 0; k < count; ++k) {
      const double index = body_.scalar(property.type);
      const bool valid = index >= 0.0 && index < static_cast<double>(vertex_count_) && index == std::floor(index);
      if (!valid && index != -1.0)
        body_.fail_record("a vertex index is " + text_of(index) + ", expected 0 to " +
                          std::to_string(vertex_count_ - 1) + "; the faces belong to another cloud or are corrupt");
      indices_.push_back(valid ? static_cast<std::int64_t>(index) : -1);
    }
  }

  static std::string text_of(double index) {
    const bool whole = index == std::floor(index) && std::abs(index) < 1e15;
    return whole ? std::to_string(static_cast<long long>(index)) : std::to_string(index);
  }

  void add_triangle(std::int64_t a, std::int64_t b, std::int64_t c) {
    triangles_.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  }

  void add_fan() {
    if (std::find(indices_.begin(), indices_.end(), -1) != indices_.end()) {
      ++faces_with_marker_;
      return;
    }
    if (indices_.size() < 3) ++faces_too_small_;
    for (std::size_t k = 2; k < indices_.size(); ++k)
      add_triangle(indices_[0], indices_[k - 1], indices_[k]);
  }

  /// Every second triangle of a strip is wound the other way round; repeated vertices are turns, not triangles.
  void add_strips() {
    std::size_t start = 0;
    for (std::size_t k = 0; k < indices_.size(); ++k) {
      if (indices_[k] < 0) {
        start = k + 1;
        continue;
      }
      if (k < start + 2) continue;
      const std::int64_t a = indices_[k - 2], b = indices_[k - 1], c = indices_[k];
      if (a == b || b == c || a == c) continue;
      if ((k - start) % 2 == 0)
        add_triangle(a, b, c);
      else
        add_triangle(b, a, c);
    }
  }

  void warn_of_leftovers() {
    if (faces_with_marker_ > 0)
      report_.warnings.push_back(std::to_string(faces_with_marker_) +
                                 " faces hold the vertex index -1 and were left out; save the mesh with plain faces if "
                                 "they matter.");
    if (faces_too_small_ > 0)
      report_.warnings.push_back(std::to_string(faces_too_small_) +
                                 " faces have fewer than three corners and were left out; nothing needs to be done.");
    const std::string surplus = body_.surplus();
    if (!surplus.empty())
      report_.warnings.push_back(
          "there are lines with more values than the header declares (" + surplus +
          "); the values at their ends were not read. Declare them as properties if they matter.");
    const std::string trailing = body_.trailing();
    if (!trailing.empty())
      report_.warnings.push_back("the file goes on after its last record (" + trailing +
                                 ", not read); if points are missing, correct the counts in the header.");
  }

  const PlyHeader& header_;
  const PlyLayout& layout_;
  Body body_;
  PointSink& sink_;
  Triangles& triangles_;
  Stations& stations_;
  CloudReport& report_;
  std::uint64_t vertex_count_;
  std::vector<std::int64_t> indices_; ///< of the face being read
  std::size_t faces_with_marker_ = 0;
  std::size_t faces_too_small_ = 0;
};

} // namespace

PointCloud read_ply(const std::string& path, const ReadRequest& request, CloudReport& report) {
  const FileBytes bytes = read_whole_file(path);
  const PlyHeader header = parse_ply_header(bytes.data.get(), bytes.size, path);
  report.format = std::string("PLY 1.0 ") + name_of(header.format);
  const PlyLayout layout = plan_ply(header, request, path, report);
  const PlyElement& vertex = header.elements[layout.vertex_element];
  if (vertex.count == 0)
    throw Error(ErrorKind::input, path + ": line " + std::to_string(vertex.line) +
                                      ": the cloud is empty (element vertex 0); expected one point or more");
  check_ply_counts(header, bytes.size, path);
  if (vertex.count > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::input, path + ": line " + std::to_string(vertex.line) + ": " + std::to_string(vertex.count) +
                                      " points, expected at most 4294967295; thin the cloud out or split it");
  PointSink sink(layout.plan, static_cast<std::size_t>(vertex.count), path);
  Triangles triangles;
  Stations stations;
  if (header.format == PlyFormat::ascii)
    Reader<PlyAsciiBody>(header, layout, PlyAsciiBody(header, bytes, path), sink, triangles, stations, report).read();
  else
    Reader<PlyBinaryBody>(header, layout, PlyBinaryBody(header, bytes, path), sink, triangles, stations, report).read();
  PointCloud cloud = sink.finish(report);
  cloud.triangle = std::move(triangles);
  report.triangles = cloud.triangle.size();
  report.stations = stations;
  cloud.stations = std::move(stations);
  if (header.up >= 0) report.up = Eigen::Vector3d::Unit(header.up);
  return cloud;
}

} // namespace pointgi
