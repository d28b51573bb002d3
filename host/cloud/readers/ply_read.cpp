#include "host/cloud/readers/ply.h"
#include "host/cloud/readers/ply_binary.h"
#include "host/cloud/readers/ply_faces.h"
#include "host/cloud/readers/ply_layout.h"
#include "host/cloud/readers/ply_row.h"
#include "host/cloud/readers/ply_text.h"
#include "host/cloud/readers/point_sink.h"
#include "host/run.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

/// Walks through the body, element by element in file order. `Body` is PlyBinaryBody or PlyAsciiBody.
template <class Body>
class Reader {
public:
  Reader(const PlyHeader& header, const PlyLayout& layout, const InputFile& file, CloudReport& report)
      : header_(header), layout_(layout), file_(file), body_(header, file), report_(report),
        vertex_count_(header.elements[layout.vertex_element].count),
        sink_(layout.plan, static_cast<std::size_t>(vertex_count_), file.path()),
        faces_(static_cast<std::size_t>(vertex_count_)) {}

  PointCloud read() {
    for (std::size_t e = 0; e < header_.elements.size(); ++e) {
      stop_if_asked();
      const PlyElement& element = header_.elements[e];
      if (e == layout_.vertex_element)
        read_vertices(element);
      else if (e == layout_.face_element)
        read_faces(element, layout_.face_list, false);
      else if (e == layout_.strip_element)
        read_faces(element, layout_.strip_list, true);
      else if (e == layout_.station_element)
        read_stations(element);
      else if (!body_.skip_element(element))
        for_each_record(element, [](std::size_t) { return false; });
    }
    PointCloud cloud = sink_.finish(report_);
    faces_.finish(colour_types(), cloud, report_);
    set_stations(cloud);
    warn_of_leftovers();
    return cloud;
  }

private:
  void skip_property(const PlyProperty& property) {
    body_.skip(property.type, property.is_list ? body_.list_count(property) : 1);
  }

  void stop_now_and_then(std::uint64_t record) {
    if (record % 65536 == 0) stop_if_asked();
  }

  /// `read(p)` takes the value of property p from the body, or returns false: it is skipped then. `after_each` follows.
  template <class Read, class AfterEach>
  void for_each_record(const PlyElement& element, const Read& read, const AfterEach& after_each) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      stop_now_and_then(i);
      body_.begin_record(element, i);
      for (std::size_t p = 0; p < element.properties.size(); ++p)
        if (!read(p)) skip_property(element.properties[p]);
      body_.end_record();
      after_each();
    }
  }
  template <class Read>
  void for_each_record(const PlyElement& element, const Read& read) {
    for_each_record(element, read, [] {});
  }

  /// `read` of for_each_record() for three numbers.
  bool read_triple(const PlyElement& element, const std::array<std::size_t, 3>& triple, std::size_t p,
                   Eigen::Vector3d& values) {
    const auto at = std::find(triple.begin(), triple.end(), p);
    if (at == triple.end()) return false;
    values[at - triple.begin()] = body_.scalar(element.properties[p].type);
    return true;
  }

  void read_vertices(const PlyElement& vertex) {
    if (body_.read_points(vertex, layout_.plan, sink_)) return;
    PlyRow row(vertex, layout_.plan);
    for (std::uint64_t i = 0; i < vertex.count; ++i) {
      stop_now_and_then(i);
      body_.begin_record(vertex, i);
      sink_.put(static_cast<std::size_t>(i), row.read(body_));
      body_.end_record();
    }
  }

  void read_stations(const PlyElement& element) {
    Eigen::Vector3d position;
    for_each_record(
        element, [&](std::size_t p) { return read_triple(element, layout_.station_position, p, position); },
        [&] {
          if (!position.allFinite()) body_.fail_record("a scanner position is not finite; remove the element station");
          stations_.push_back(position);
        });
  }

  void read_faces(const PlyElement& element, std::size_t list, bool strips) {
    const bool coloured = !strips && layout_.face_colour[0] != PlyLayout::none;
    // A face takes at least as many bytes as its count, which was checked against the file's size.
    if (!strips) faces_.reserve(static_cast<std::size_t>(element.count));
    Eigen::Vector3d value;
    for_each_record(
        element,
        [&](std::size_t p) {
          if (p != list) return coloured && read_triple(element, layout_.face_colour, p, value);
          read_indices(element.properties[p]);
          return true;
        },
        [&] {
          if (coloured) faces_.add_colour(value.cast<float>());
          if (strips)
            faces_.add_strips();
          else
            faces_.add_fan();
        });
  }

  void read_indices(const PlyProperty& property) {
    const std::size_t count = body_.list_count(property);
    std::vector<std::int64_t>& indices = faces_.indices();
    indices.clear();
    for (std::size_t k = 0; k < count; ++k) {
      const double index = body_.scalar(property.type);
      const bool valid = index >= 0.0 && index < static_cast<double>(vertex_count_) && index == std::floor(index);
      if (!valid && index != -1.0)
        body_.fail_record("a vertex index is " + text_of(index) + ", expected 0 to " +
                          std::to_string(vertex_count_ - 1) + "; the faces belong to another cloud or are corrupt");
      indices.push_back(valid ? static_cast<std::int64_t>(index) : -1);
    }
  }

  static std::string text_of(double index) {
    const bool whole = index == std::floor(index) && std::abs(index) < 1e15;
    return whole ? std::to_string(static_cast<long long>(index)) : std::to_string(index);
  }

  std::array<FieldType, 3> colour_types() const {
    std::array<FieldType, 3> types{};
    for (std::size_t k = 0; k < 3 && layout_.face_colour[k] != PlyLayout::none; ++k)
      types[k] = header_.elements[layout_.face_element].properties[layout_.face_colour[k]].type;
    return types;
  }

  void set_stations(PointCloud& cloud) {
    if (stations_.size() == 1 && cloud.station.empty()) cloud.station.assign(cloud.size(), 0);
    const auto wrong = std::find_if(cloud.station.begin(), cloud.station.end(),
                                    [&](std::uint16_t station) { return station >= stations_.size(); });
    if (wrong != cloud.station.end())
      throw Error(ErrorKind::input,
                  file_.path() + ": line " + std::to_string(header_.elements[layout_.station_element].line) +
                      ": vertex " + std::to_string(wrong - cloud.station.begin()) +
                      " names a station that there is not; expected 0 to " + std::to_string(stations_.size() - 1));
    report_.stations = stations_;
    cloud.stations = std::move(stations_);
  }

  void warn_of_leftovers() {
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
  const InputFile& file_;
  Body body_;
  CloudReport& report_;
  std::uint64_t vertex_count_;
  PointSink sink_;
  PlyFaces faces_;
  std::vector<Eigen::Vector3d> stations_;
};

} // namespace

PointCloud read_ply(const std::string& path, const ReadRequest& request, CloudReport& report) {
  const InputFile file(path);
  const PlyHeader header = read_ply_header(file);
  report.format = std::string("PLY 1.0 ") + name_of(header.format);
  if (header.up >= 0) report.up = Eigen::Vector3d::Unit(header.up);
  const PlyLayout layout = plan_ply(header, request, path, report);
  const PlyElement& vertex = header.elements[layout.vertex_element];
  const std::string place = path + ": line " + std::to_string(vertex.line) + ": ";
  if (vertex.count == 0)
    throw Error(ErrorKind::input, place + "the cloud is empty (element vertex 0); expected one point or more");
  check_ply_counts(header, file.size(), path);
  if (vertex.count > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::input, place + std::to_string(vertex.count) +
                                      " points, expected at most 4294967295; thin the cloud out or split it");
  return header.format == PlyFormat::ascii ? Reader<PlyAsciiBody>(header, layout, file, report).read()
                                           : Reader<PlyBinaryBody>(header, layout, file, report).read();
}

} // namespace pointgi
