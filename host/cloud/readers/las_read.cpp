#include "host/cloud/readers/las_read.h"
#include "host/cloud/geographic.h"
#include "host/cloud/readers/las_crs.h"
#include "host/cloud/readers/las_fields.h"
#include "host/cloud/readers/las_records.h"
#include "host/cloud/readers/point_sink.h"
#include <atomic>
#include <fmt/format.h>

namespace pointgi {

namespace {

/// How many points the file's maker would rather not have shown.
struct Marked {
  std::atomic<std::size_t> withheld{0};
  std::atomic<std::size_t> noise{0};
};

/// Bit 7 of the classification's byte in old formats, bit 2 of the byte before it in new ones.
bool is_withheld(const char* record, unsigned format) {
  return (record[15] & (format <= 5 ? 0x80 : 0x04)) != 0;
}

/// Class 7 is low noise, class 18 of new formats high noise.
bool is_noise(const char* record, unsigned format) {
  const int code = format <= 5 ? record[15] & 31 : record[16];
  return code == 7 || (format > 5 && code == 18);
}

/// Converters to a format with colours leave them at 0 where the scan had none.
void leave_out_black(const LasRecords& records, const LasHeader& header, std::vector<LasColumn>& columns,
                     CloudReport& report) {
  const std::size_t byte = las_colour_byte(header.format);
  const auto is_coloured = [byte](const char* record) {
    return std::any_of(record + byte, record + byte + 6, [](char c) { return c != 0; });
  };
  if (byte == 0 || records.any(is_coloured)) return;
  columns.erase(std::remove_if(columns.begin(), columns.end(),
                               [byte](const LasColumn& c) { return c.byte >= byte && c.byte < byte + 6; }),
                columns.end());
  report.notes.push_back("the colours of all points are 0: the file is taken as one without colours");
}

FieldPlan plan_las(const std::vector<LasColumn>& columns, const ReadRequest& request, const std::string& path,
                   CloudReport& report) {
  std::vector<FieldInfo> fields;
  for (const LasColumn& column : columns)
    fields.push_back(column.info);
  return plan_fields(std::move(fields), request, path, "byte 104", report);
}

PointCloud read_points(const InputFile& file, const LasRecords& records, const LasHeader& header,
                       const std::vector<LasColumn>& columns, const FieldPlan& plan, Marked& marked,
                       CloudReport& report) {
  std::vector<std::size_t> read;
  for (std::size_t f = 0; f < columns.size(); ++f)
    if (plan.is_read(f)) read.push_back(f);
  const auto count = static_cast<std::size_t>(header.points);
  PointSink sink(plan, count, file.path());
  records.for_each_piece([&](std::size_t first, std::size_t end, const char* record) {
    std::vector<double> row(columns.size());
    std::size_t withheld = 0, noise = 0;
    for (std::size_t i = first; i < end; ++i, record += header.record_bytes) {
      for (const std::size_t f : read)
        row[f] = las_value(record, columns[f]);
      sink.put(i, row.data());
      withheld += is_withheld(record, header.format) ? 1u : 0u;
      noise += is_noise(record, header.format) ? 1u : 0u;
    }
    marked.withheld += withheld;
    marked.noise += noise;
  });
  return sink.finish(report);
}

void tell_of_marked(const Marked& marked, const LasHeader& header, CloudReport& report) {
  if (marked.withheld > 0)
    report.notes.push_back(fmt::format("{} points are marked as withheld and were kept; keep = {{ withheld = [0] }} of "
                                       "the [[cloud]] leaves them out",
                                       marked.withheld.load()));
  if (marked.noise > 0)
    report.notes.push_back(fmt::format("{} points are classified as noise (class 7{}) and were kept; keep = {{ "
                                       "classification = [...] }} of the [[cloud]] names the classes that stay",
                                       marked.noise.load(), header.format > 5 ? " or 18" : ""));
  if (header.format == 4 || header.format == 5 || header.format >= 9)
    report.notes.push_back(fmt::format("the waveforms of point format {} are not read", header.format));
}

/// Up, and degrees as lengths.
void place(const PointCloud& cloud, const LasHeader& header, LasCoordinates coordinates, CloudReport& report) {
  report.up = Eigen::Vector3d::UnitZ();
  if (coordinates == LasCoordinates::geocentric) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : cloud.position)
      mean += p / static_cast<double>(cloud.size());
    // Away from the Earth's centre; files that only claim to be geocentric lie elsewhere. [m]
    if (mean.norm() > 6.3e6 && mean.norm() < 6.45e6) report.up = mean.normalized();
    return;
  }
  if (coordinates == LasCoordinates::projected) return;
  const bool declared = coordinates == LasCoordinates::geographic;
  // Degrees that are stored in coarser steps than this, a metre, are of no use to anybody.
  if (!declared && std::max(std::abs(header.scale.x()), std::abs(header.scale.y())) > 1e-5) return;
  report.placement = degrees_to_metres(cloud.position, declared);
  if (!report.placement) return;
  const Placement& placement = *report.placement;
  const auto text_of = [](const Eigen::Vector3d& p) {
    return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", p.x(), p.y(), p.z());
  };
  report.notes.push_back(
      fmt::format("x and y are {} degrees of longitude and latitude, from {} to {}: they are shown as "
                  "metres, x times {:.6g} and y times {:.6g} about the middle",
                  declared ? "declared to be" : "taken for", text_of(placement.low), text_of(placement.high),
                  placement.scale.x(), placement.scale.y()));
}

} // namespace

PointCloud read_las(const std::string& path, const ReadRequest& request, CloudReport& report) {
  const InputFile file(path);
  const LasHeader header = read_las_header(file, true);
  const LasRecords records(file, header);
  report.format =
      fmt::format("{} 1.{}, point format {}", header.is_compressed ? "LAZ" : "LAS", header.minor, header.format);
  report.warnings.insert(report.warnings.end(), header.warnings.begin(), header.warnings.end());
  std::vector<LasColumn> columns = las_columns(header, read_las_extras(file, header, report.warnings));
  leave_out_black(records, header, columns, report);
  Marked marked;
  PointCloud cloud =
      read_points(file, records, header, columns, plan_las(columns, request, path, report), marked, report);
  tell_of_marked(marked, header, report);
  place(cloud, header, las_coordinates(file, header), report);
  return cloud;
}

} // namespace pointgi
