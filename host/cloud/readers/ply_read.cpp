#include "host/cloud/precision.h"
#include "host/cloud/readers/ply.h"
#include "host/cloud/readers/ply_body.h"
#include "host/cloud/readers/ply_layout.h"
#include "host/run.h"
#include <algorithm>
#include <limits>

namespace pointgi {

namespace {

/// Walks through the body, element by element in file order. `Body` is PlyBinaryBody or PlyAsciiBody.
template <class Body>
class Reader {
public:
  Reader(const PlyHeader& header, const PlyLayout& layout, Body body, PointCloud& cloud, CloudReport& report)
      : header_(header), layout_(layout), body_(body), cloud_(cloud), report_(report),
        vertex_count_(header.elements[layout.vertex_element].count) {}

  void read() {
    for (std::size_t e = 0; e < header_.elements.size(); ++e) {
      if (e == layout_.vertex_element)
        read_vertices(header_.elements[e]);
      else if (e == layout_.face_element)
        read_faces(header_.elements[e], layout_.face_list, false);
      else if (e == layout_.strip_element)
        read_faces(header_.elements[e], layout_.strip_list, true);
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
    cloud_.position.resize(count);
    cloud_.normal.resize(layout_.has_normal ? count : 0);
    cloud_.colour.resize(layout_.has_colour ? count : 0);
    cloud_.radius.resize(layout_.has_radius ? count : 0);
    std::array<double, slot_count> row{};
    for (std::size_t i = 0; i < count; ++i) {
      if (i % 65536 == 0) stop_if_asked();
      body_.begin_record(vertex, i);
      for (std::size_t p = 0; p < vertex.properties.size(); ++p) {
        const PlyProperty& property = vertex.properties[p];
        if (layout_.slots[p] == slot_none)
          skip_property(property);
        else
          row[static_cast<std::size_t>(layout_.slots[p])] = body_.scalar(property.type);
      }
      body_.end_record();
      cloud_.position[i] = Eigen::Vector3d(row[slot_position], row[slot_position + 1], row[slot_position + 2]);
      if (layout_.has_normal) cloud_.normal[i] = vector_at(row, slot_normal);
      if (layout_.has_colour) cloud_.colour[i] = vector_at(row, slot_colour);
      if (layout_.has_radius) cloud_.radius[i] = static_cast<float>(row[slot_radius]);
    }
  }

  static Eigen::Vector3f vector_at(const std::array<double, slot_count>& row, int slot) {
    return Eigen::Vector3d(row[slot], row[slot + 1], row[slot + 2]).cast<float>();
  }

  void read_faces(const PlyElement& element, std::size_t list, bool strips) {
    // A face takes at least as many bytes as its count, which was checked against the file's size.
    if (!strips) cloud_.triangle.reserve(static_cast<std::size_t>(element.count));
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
    cloud_.triangle.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
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
  PointCloud& cloud_;
  CloudReport& report_;
  std::uint64_t vertex_count_;
  std::vector<std::int64_t> indices_; ///< of the face being read
  std::size_t faces_with_marker_ = 0;
  std::size_t faces_too_small_ = 0;
};

/// Brings the colours to [0,1] by the type they have in the file. Values that are not finite stay what they are.
void scale_colours(const PlyLayout& layout, std::vector<Eigen::Vector3f>& colours, CloudReport& report) {
  Eigen::Array3f scale;
  float largest_float = 0.0f;
  float largest_short = 0.0f;
  bool any_short = false;
  for (int k = 0; k < 3; ++k) {
    const PlyType type = layout.colour_type[static_cast<std::size_t>(k)];
    scale[k] = is_float(type) ? 1.0f : type == PlyType::u16 ? 1.0f / 65535.0f : 1.0f / 255.0f;
    any_short = any_short || type == PlyType::u16;
    float& largest = is_float(type) ? largest_float : largest_short;
    if (is_float(type) || type == PlyType::u16)
      for (const Eigen::Vector3f& colour : colours)
        if (std::isfinite(colour[k])) largest = std::max(largest, colour[k]);
  }
  // A thousandth of grace: a conversion elsewhere may have rounded white up, and that is no sign of 0..255.
  if (largest_float > 1.001f) {
    for (int k = 0; k < 3; ++k)
      if (is_float(layout.colour_type[static_cast<std::size_t>(k)])) scale[k] = 1.0f / 255.0f;
    report.warnings.push_back("the colours are floats up to " + std::to_string(largest_float) +
                              ", expected 0 to 1; they were taken as 0 to 255. Divide them by 255 or store them as "
                              "uchar to be sure.");
  }
  if (any_short && largest_short > 0.0f && largest_short <= 255.0f)
    report.warnings.push_back("the colours are of type ushort but none is above 255, so that they come out nearly "
                              "black; store them as uchar if they are meant as 0 to 255.");
  for (Eigen::Vector3f& colour : colours)
    for (int k = 0; k < 3; ++k)
      if (std::isfinite(colour[k])) colour[k] = std::clamp(colour[k] * scale[k], 0.0f, 1.0f);
}

} // namespace

PointCloud read_ply(const std::string& path, const ReadRequest&, CloudReport& report) {
  PointCloud cloud;
  PlyLayout layout;
  {
    // In a block of its own: the file's bytes are given back before the passes over the cloud.
    const FileBytes bytes = read_whole_file(path);
    const PlyHeader header = parse_ply_header(bytes.data.get(), bytes.size, path);
    report.format = std::string("PLY 1.0 ") + name_of(header.format);
    layout = plan_ply(header, path, report);
    const PlyElement& vertex = header.elements[layout.vertex_element];
    if (vertex.count == 0)
      throw Error(ErrorKind::input, path + ": line " + std::to_string(vertex.line) +
                                        ": the cloud is empty (element vertex 0); expected one point or more");
    check_ply_counts(header, bytes.size, path);
    if (vertex.count > std::numeric_limits<std::uint32_t>::max())
      throw Error(ErrorKind::input, path + ": line " + std::to_string(vertex.line) + ": " +
                                        std::to_string(vertex.count) +
                                        " points, expected at most 4294967295; thin the cloud out or split it");
    report.points_in_file = static_cast<std::size_t>(vertex.count);
    if (header.format == PlyFormat::ascii)
      Reader<PlyAsciiBody>(header, layout, PlyAsciiBody(header, bytes, path), cloud, report).read();
    else
      Reader<PlyBinaryBody>(header, layout, PlyBinaryBody(header, bytes, path), cloud, report).read();
  }
  report.triangles = cloud.triangle.size();
  if (layout.has_colour) scale_colours(layout, cloud.colour, report);
  if (const auto warning = float_precision_warning(cloud.position, layout.is_float32))
    report.warnings.push_back(*warning);
  return cloud;
}

} // namespace pointgi
