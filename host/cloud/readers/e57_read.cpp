#include "host/cloud/readers/e57_read.h"
#include "host/cloud/readers/e57_node.h"
#include "host/cloud/readers/e57_points.h"
#include "host/cloud/readers/point_sink.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace pointgi {

namespace {

constexpr std::size_t grain = 1 << 15;
constexpr std::size_t none = static_cast<std::size_t>(-1);
using Names = std::array<const char*, 3>;
constexpr Names cartesian{"cartesianX", "cartesianY", "cartesianZ"};
constexpr Names spherical{"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
constexpr Names normal_names{"nor:normalX", "nor:normalY", "nor:normalZ"};
constexpr Names colour_names{"colorRed", "colorGreen", "colorBlue"};

struct Scan {
  E57Points points;
  Eigen::Isometry3d pose;
  bool is_spherical = false;
  std::size_t state = none;    ///< field that says which records are invalid
  double full_colour = 0.0;    ///< its value of full brightness; 0: it has no colours
  std::vector<std::size_t> at; ///< for each column of the cloud its field here, or none
};

/// The cloud's columns: positions, then what any of the scans has, then the station.
struct Columns {
  std::vector<std::string> theirs; ///< E57's name; empty for positions and the station
  std::vector<FieldInfo> ours;
};

bool has_all(const E57Points& points, const Names& names) {
  return std::all_of(names.begin(), names.end(), [&](const char* n) { return points.find(n) < points.fields.size(); });
}

bool is_colour(const std::string& name) {
  return std::any_of(colour_names.begin(), colour_names.end(), [&](const char* n) { return name == n; });
}

/// From colorLimits, else from the type of the points. Some writers give the brightest value that occurs: limits just
/// below a whole number of bits mean these bits.
double full_colour(const E57File& file, const XmlNode& scan, const E57Points& points) {
  if (!has_all(points, colour_names)) return 0.0;
  const E57Field& red = points.fields[points.find(colour_names[0])];
  double full = red.is_float ? 1.0 : static_cast<double>(red.maximum) * red.scale + red.offset;
  if (const XmlNode* limits = scan.child("colorLimits")) full = e57_number(file, *limits, "colorRedMaximum", full);
  if (red.is_float && full > 0.0 && full <= 1.0) return full;
  if (full >= 1.0 && full <= 255.0) return 255.0;
  return full > 255.0 && full < 0.9 * 65535.0 ? full : 65535.0;
}

Scan parse_scan(const E57File& file, const XmlNode& node) {
  const XmlNode* points = node.child("points");
  if (points == nullptr) file.fail(file.xml_begin(), "a scan has no points; the description (XML) is corrupt");
  Scan scan;
  scan.points = parse_e57_points(file, *points);
  scan.pose = e57_pose(file, node);
  scan.is_spherical = !has_all(scan.points, cartesian);
  if (scan.points.count > 0 && scan.is_spherical && !has_all(scan.points, spherical))
    file.fail(file.xml_begin(), "a scan has neither cartesian nor spherical coordinates; export it with them");
  scan.full_colour = full_colour(file, node, scan.points);
  const std::size_t state = scan.points.find(scan.is_spherical ? "sphericalInvalidState" : "cartesianInvalidState");
  if (state < scan.points.fields.size()) scan.state = state;
  return scan;
}

std::string our_name(const std::string& theirs) {
  static const std::pair<const char*, const char*> names[] = {{"colorRed", "red"},
                                                              {"colorGreen", "green"},
                                                              {"colorBlue", "blue"},
                                                              {"nor:normalX", "nx"},
                                                              {"nor:normalY", "ny"},
                                                              {"nor:normalZ", "nz"},
                                                              {"returnIndex", "return_number"},
                                                              {"returnCount", "number_of_returns"},
                                                              {"rowIndex", "row"},
                                                              {"columnIndex", "column"},
                                                              {"timeStamp", "time"}};
  for (const auto& [from, to] : names)
    if (theirs == from) return to;
  const std::size_t colon = theirs.find(':');
  return colon == std::string::npos ? theirs : theirs.substr(colon + 1); // a field of an extension
}

bool is_coordinate(const std::string& name) {
  const auto is = [&](const char* n) { return name == n; };
  return std::any_of(cartesian.begin(), cartesian.end(), is) || std::any_of(spherical.begin(), spherical.end(), is) ||
         name == "cartesianInvalidState" || name == "sphericalInvalidState";
}

/// Of two scans' types one that holds both.
FieldType wider(FieldType a, FieldType b) {
  if (a == b) return a;
  if (is_float(a) || is_float(b)) return FieldType::f64;
  return size_of(a) > size_of(b) ? a : b;
}

void add_column(const E57Field& field, bool eight_bit, Columns& columns) {
  const FieldType type = !is_colour(field.name) ? field.type() : eight_bit ? FieldType::u8 : FieldType::u16;
  const auto known = std::find(columns.theirs.begin(), columns.theirs.end(), field.name);
  if (known != columns.theirs.end()) {
    FieldType& ours = columns.ours[static_cast<std::size_t>(known - columns.theirs.begin())].type;
    ours = wider(ours, type);
    return;
  }
  const std::string name = our_name(field.name);
  const auto is_taken = [&](const FieldInfo& other) { return other.name == name; };
  if (name == "station" || std::any_of(columns.ours.begin(), columns.ours.end(), is_taken)) return;
  columns.theirs.push_back(field.name);
  columns.ours.push_back({name, type, 1.0, 0.0});
}

Columns find_columns(const E57File& file, const std::vector<Scan>& scans) {
  Columns columns;
  for (const char* axis : {"x", "y", "z"}) {
    columns.theirs.emplace_back();
    columns.ours.push_back({axis, FieldType::f64, 1.0, 0.0});
  }
  const bool eight_bit = std::all_of(scans.begin(), scans.end(), [](const Scan& scan) {
    return scan.full_colour == 0.0 || scan.full_colour == 255.0;
  });
  for (const Scan& scan : scans)
    for (const E57Field& field : scan.points.fields) {
      if (is_coordinate(field.name)) continue;
      if (columns.ours.size() > 1000) file.fail(file.xml_begin(), "the scans have more than 1000 different fields");
      add_column(field, eight_bit, columns);
    }
  columns.theirs.emplace_back();
  columns.ours.push_back({"station", FieldType::u16, 1.0, 0.0});
  return columns;
}

void connect(const Columns& columns, Scan& scan) {
  for (const std::string& theirs : columns.theirs) {
    const std::size_t field = theirs.empty() ? none : scan.points.find(theirs.c_str());
    scan.at.push_back(field < scan.points.fields.size() ? field : none);
  }
}

/// Records of the scan that are valid.
std::vector<std::uint32_t> valid_records(const E57Streams& streams, const Scan& scan) {
  std::vector<std::uint32_t> valid;
  for (std::uint64_t i = 0; i < scan.points.count; ++i)
    if (scan.state == none || streams.value(scan.state, i) == 0.0) valid.push_back(static_cast<std::uint32_t>(i));
  return valid;
}

Eigen::Vector3d position_of(const E57Streams& streams, const Scan& scan, const std::array<std::size_t, 3>& axes,
                            std::uint64_t record) {
  const Eigen::Vector3d v(streams.value(axes[0], record), streams.value(axes[1], record),
                          streams.value(axes[2], record));
  if (!scan.is_spherical) return scan.pose * v;
  const double flat = v.x() * std::cos(v.z()); // range, azimuth from x to y, elevation
  return scan.pose * Eigen::Vector3d(flat * std::cos(v.y()), flat * std::sin(v.y()), v.x() * std::sin(v.z()));
}

class Reader {
public:
  Reader(const std::string& path, const ReadRequest& request, CloudReport& report)
      : file_(path), request_(request), report_(report) {}

  PointCloud read() {
    parse();
    const Columns columns = find_columns(file_, scans_);
    const FieldPlan plan = plan_fields(columns.ours, request_, file_.path(),
                                       "byte " + std::to_string(file_.xml_begin()) + ": the description", report_);
    for (Scan& scan : scans_)
      connect(columns, scan);
    const std::size_t count = count_valid();
    PointSink sink(plan, count, file_.path());
    std::size_t first = 0;
    for (std::size_t s = 0; s < scans_.size(); ++s)
      first += put_scan(s, first, columns, plan, sink);
    PointCloud cloud = sink.finish(report_);
    for (const Scan& scan : scans_)
      cloud.stations.emplace_back(scan.pose.translation());
    report_.stations = cloud.stations;
    report_.up = Eigen::Vector3d::UnitZ();
    return cloud;
  }

private:
  void parse() {
    const std::vector<char> text = file_.read(file_.xml_begin(), file_.xml_bytes());
    const XmlNode root = parse_xml({text.data(), text.size()}, [this](std::size_t byte, const std::string& what) {
      file_.fail(file_.xml_begin() + byte, what);
    });
    report_.format = "E57 1.0";
    const XmlNode* data = root.child("data3D");
    std::uint64_t records = 0;
    if (data != nullptr)
      for (const XmlNode& node : data->children) {
        scans_.push_back(parse_scan(file_, node));
        records += scans_.back().points.count;
      }
    if (records == 0) file_.fail(file_.xml_begin(), "the file holds no points; the cloud is empty");
    if (scans_.size() > 65535 || records > std::numeric_limits<std::uint32_t>::max())
      file_.fail(file_.xml_begin(), std::to_string(scans_.size()) + " scans of " + std::to_string(records) +
                                        " points, expected at most 65535 and 4294967295; split the file");
  }

  /// The points that will be, after a first look at the states alone.
  std::size_t count_valid() {
    std::size_t valid = 0, invalid = 0;
    for (const Scan& scan : scans_) {
      const auto records = static_cast<std::size_t>(scan.points.count);
      std::size_t here = records;
      if (scan.state != none && records > 0) {
        std::vector<bool> wanted(scan.points.fields.size(), false);
        wanted[scan.state] = true;
        here = valid_records(E57Streams(file_, scan.points, wanted), scan).size();
      }
      valid += here;
      invalid += records - here;
    }
    if (valid == 0) file_.fail(file_.xml_begin(), "all points are marked as invalid; the cloud is empty");
    if (invalid > 0)
      report_.notes.push_back(
          fmt::format("{} of {} records are marked as invalid and were left out", invalid, valid + invalid));
    return valid;
  }

  /// Returns how many points it put.
  std::size_t put_scan(std::size_t s, std::size_t first, const Columns& columns, const FieldPlan& plan,
                       PointSink& sink) const {
    const Scan& scan = scans_[s];
    if (scan.points.count == 0) return 0;
    std::array<std::size_t, 3> axes{};
    for (std::size_t k = 0; k < 3; ++k)
      axes[k] = scan.points.find(scan.is_spherical ? spherical[k] : cartesian[k]);
    std::vector<bool> wanted(scan.points.fields.size(), false);
    for (std::size_t c = 0; c < columns.ours.size(); ++c)
      if (scan.at[c] != none && plan.is_read(c)) wanted[scan.at[c]] = true;
    for (const std::size_t axis : axes)
      wanted[axis] = true;
    if (scan.state != none) wanted[scan.state] = true;
    const E57Streams streams(file_, scan.points, wanted);
    const std::vector<std::uint32_t> valid = valid_records(streams, scan);
    const std::vector<double> missing = missing_values(columns);
    const std::vector<std::pair<double, double>> change = changes(scan, columns);
    parallel_ranges(valid.size(), grain, [&](std::size_t begin, std::size_t end) {
      std::vector<double> row(missing);
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t c = 3; c + 1 < row.size(); ++c)
          if (scan.at[c] != none && plan.is_read(c))
            row[c] = streams.value(scan.at[c], valid[i]) * change[c].first + change[c].second;
        Eigen::Map<Eigen::Vector3d>(row.data()) = position_of(streams, scan, axes, valid[i]);
        turn_normal(scan, columns, row);
        row.back() = static_cast<double>(s);
        sink.put(first + i, row.data());
      }
    });
    return valid.size();
  }

  /// A row of what stands where a scan lacks a field.
  static std::vector<double> missing_values(const Columns& columns) {
    std::vector<double> row(columns.ours.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t c = 0; c < row.size(); ++c)
      if (is_colour(columns.theirs[c])) row[c] = columns.ours[c].type == FieldType::u8 ? 255.0 : 65535.0;
    return row;
  }

  /// What a scan's value of a column is multiplied by, and what is added: colours of all scans have one range, returns
  /// count from 1.
  static std::vector<std::pair<double, double>> changes(const Scan& scan, const Columns& columns) {
    std::vector<std::pair<double, double>> result(columns.ours.size(), {1.0, 0.0});
    for (std::size_t c = 0; c < result.size(); ++c) {
      if (is_colour(columns.theirs[c]) && columns.ours[c].type != FieldType::u8 && scan.full_colour > 0.0)
        result[c].first = 65535.0 / scan.full_colour;
      if (columns.theirs[c] == "returnIndex") result[c].second = 1.0;
    }
    return result;
  }

  /// Normals are in the scan's frame, as positions are.
  static void turn_normal(const Scan& scan, const Columns& columns, std::vector<double>& row) {
    std::array<std::size_t, 3> place{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = std::find(columns.theirs.begin(), columns.theirs.end(), normal_names[k]);
      if (found == columns.theirs.end()) return;
      place[k] = static_cast<std::size_t>(found - columns.theirs.begin());
    }
    const Eigen::Vector3d turned = scan.pose.linear() * Eigen::Vector3d(row[place[0]], row[place[1]], row[place[2]]);
    for (std::size_t k = 0; k < 3; ++k)
      row[place[k]] = turned[static_cast<int>(k)];
  }

  E57File file_;
  const ReadRequest& request_;
  CloudReport& report_;
  std::vector<Scan> scans_;
};

} // namespace

PointCloud read_e57(const std::string& path, const ReadRequest& request, CloudReport& report) {
  return Reader(path, request, report).read();
}

} // namespace pointgi
