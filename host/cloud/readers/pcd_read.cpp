#include "host/cloud/readers/pcd_read.h"
#include "host/cloud/readers/lzf.h"
#include "host/cloud/readers/pcd_columns.h"
#include "host/cloud/readers/point_sink.h"
#include "host/cloud/readers/record_pieces.h"
#include "host/cloud/readers/text_lines.h"
#include <atomic>
#include <fmt/format.h>
#include <mutex>

namespace pointgi {

namespace {

/// What the three kinds of data share.
struct Reading {
  const InputFile& file;
  const PcdHeader& header;
  std::vector<PcdColumn> columns;
  std::vector<std::size_t> read; ///< indices of the columns that are wanted
  PointSink& sink;
  CloudReport& report;
};

[[noreturn]] void fail(const InputFile& file, const char* unit, std::uint64_t at, const std::string& what) {
  throw Error(ErrorKind::input, fmt::format("{}: {} {}: {}", file.path(), unit, at, what));
}

void read_binary(const Reading& job) {
  const auto record_bytes = static_cast<std::size_t>(job.header.record_bytes());
  const auto count = static_cast<std::size_t>(job.header.points);
  for_each_piece(job.file, job.header.body, record_bytes, count,
                 [&](std::size_t first, std::size_t end, const char* record) {
                   std::vector<double> row(job.columns.size());
                   for (std::size_t i = first; i < end; ++i, record += record_bytes) {
                     for (const std::size_t c : job.read) {
                       const PcdColumn& column = job.columns[c];
                       row[c] = value_at(record + column.field_begin + column.byte, column.info.type);
                     }
                     job.sink.put(i, row.data());
                   }
                 });
  const std::uint64_t points_end = job.header.body + static_cast<std::uint64_t>(count) * record_bytes;
  const std::uint64_t left = job.file.size() - points_end;
  if (left >= record_bytes)
    job.report.warnings.push_back(fmt::format("the file goes on after its last point ({} bytes from byte {} on, not "
                                              "read); if points are missing, correct the counts in the header.",
                                              left, points_end));
}

struct Block {
  std::unique_ptr<char[]> bytes;
  std::size_t size = 0;
};

Block allocate(const InputFile& file, std::uint64_t size) {
  Block block;
  block.size = static_cast<std::size_t>(size);
  block.bytes.reset(new (std::nothrow) char[block.size]);
  if (!block.bytes)
    throw Error(ErrorKind::memory, fmt::format("{}: {} bytes of points do not fit into memory; thin the cloud out or "
                                               "split it",
                                               file.path(), size));
  return block;
}

/// Two sizes of 32 bits, then one block. PCL fills the file up behind it.
Block decompress(const InputFile& file, const PcdHeader& header) {
  const std::uint64_t body = header.body;
  std::array<char, 8> sizes{};
  if (file.size() - body < sizes.size())
    fail(file, "byte", file.size(), "the file ends before the sizes of its compressed data; it is truncated");
  file.read(body, sizes.data(), sizes.size());
  const std::uint64_t packed = little_endian<std::uint32_t>(&sizes[0]);
  const std::uint64_t unpacked = little_endian<std::uint32_t>(&sizes[4]);
  const std::uint64_t begin = body + sizes.size(), left = file.size() - begin;
  if (packed > left)
    fail(file, "byte", body,
         fmt::format("{} bytes of compressed data are announced, {} follow; the file is truncated", packed, left));
  const std::uint64_t expected = header.points * header.record_bytes();
  if (unpacked != expected)
    fail(file, "byte", body + 4,
         fmt::format("{} bytes of points are announced, expected {} ({} points of {} bytes); the header is corrupt",
                     unpacked, expected, header.points, header.record_bytes()));
  if (unpacked > packed * lzf_most)
    fail(file, "byte", body,
         fmt::format("{} bytes cannot hold {} compressed ones; the file is corrupt", packed, unpacked));
  const Block from = allocate(file, packed);
  file.read(begin, from.bytes.get(), from.size);
  Block to = allocate(file, unpacked);
  const std::size_t stop = decompress_lzf(from.bytes.get(), from.size, to.bytes.get(), to.size);
  if (stop > from.size)
    fail(file, "byte", begin + from.size, "the compressed data end before the last point; the file is corrupt");
  if (stop < from.size) fail(file, "byte", begin + stop, "the compressed data make no sense here; the file is corrupt");
  return to;
}

/// Field by field: all points' x, all points' y ...
void read_compressed(const Reading& job) {
  const Block block = decompress(job.file, job.header);
  const auto count = static_cast<std::size_t>(job.header.points);
  parallel_ranges(count, 1 << 14, [&](std::size_t first, std::size_t end) {
    std::vector<double> row(job.columns.size());
    for (std::size_t i = first; i < end; ++i) {
      for (const std::size_t c : job.read) {
        const PcdColumn& column = job.columns[c];
        const char* field = block.bytes.get() + column.field_begin * count;
        row[c] = value_at(field + i * column.field_bytes + column.byte, column.info.type);
      }
      job.sink.put(i, row.data());
    }
  });
}

/// Some lines of the text, and what precedes them.
struct Piece {
  TextPiece text;
  std::size_t lines = 0, points = 0; ///< in it
  std::size_t first_line = 0, first_point = 0;
};

bool is_blank(std::string_view line) {
  return trimmed(line).empty();
}

std::vector<Piece> split_lines(const char* begin, const char* end, std::size_t first_line) {
  std::vector<Piece> pieces;
  for (const TextPiece& text : split_at_line_ends(begin, end))
    pieces.push_back({text});
  parallel_ranges(pieces.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p)
      for (TextLines lines(pieces[p].text.begin, pieces[p].text.end); lines.next(); ++pieces[p].lines)
        pieces[p].points += is_blank(lines.text()) ? 0u : 1u;
  });
  std::size_t line = first_line, point = 0;
  for (Piece& piece : pieces) {
    piece.first_line = line;
    piece.first_point = point;
    line += piece.lines;
    point += piece.points;
  }
  return pieces;
}

/// Lines of text with as many values as the header declares; further ones at their ends are counted.
class TextRows {
public:
  explicit TextRows(const Reading& job) : job_(job), column_of_(values_of(job.header), none) {
    for (const std::size_t c : job.read)
      column_of_[job.columns[c].place] = c;
  }

  void read(const Piece& piece) {
    std::vector<double> row(job_.columns.size());
    std::size_t point = piece.first_point;
    TextLines lines(piece.text.begin, piece.text.end, piece.first_line);
    while (lines.next() && point < job_.header.points) {
      if (is_blank(lines.text())) continue;
      read_row(lines, row);
      job_.sink.put(point++, row.data());
    }
  }

  std::size_t long_lines() const { return long_lines_; }

private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  static std::size_t values_of(const PcdHeader& header) {
    std::size_t values = 0;
    for (const PcdField& field : header.fields)
      values += field.values;
    return values;
  }

  void read_row(const TextLines& line, std::vector<double>& row) {
    TextWords words(line.text(), {});
    std::string_view word;
    for (std::size_t place = 0; place < column_of_.size(); ++place) {
      if (!words.next(word))
        fail(job_.file, "line", line.line(),
             fmt::format("{} values, expected {} as the header declares; the file is truncated or corrupt", place,
                         column_of_.size()));
      const std::size_t c = column_of_[place];
      if (c == none) continue;
      if (!parse_number(word, false, row[c]))
        fail(job_.file, "line", line.line(), "expected a number, found " + quoted_bytes(word));
      if (job_.columns[c].packs_in_float) row[c] = packed_in_text(row[c]);
    }
    if (words.next(word)) ++long_lines_;
  }

  const Reading& job_;
  std::vector<std::size_t> column_of_; ///< of each value of a line
  std::atomic<std::size_t> long_lines_{0};
};

void read_ascii(const Reading& job) {
  const FileBytes bytes = read_whole_file(job.file.path());
  const std::vector<Piece> pieces =
      split_lines(bytes.data.get() + job.header.body, bytes.data.get() + bytes.size, job.header.body_line);
  const std::size_t points = pieces.empty() ? 0 : pieces.back().first_point + pieces.back().points;
  const std::size_t lines = pieces.empty() ? job.header.body_line : pieces.back().first_line + pieces.back().lines;
  if (points < job.header.points)
    fail(job.file, "line", lines,
         fmt::format("the file ends after {} points, expected {}; it is truncated or its header is wrong", points,
                     job.header.points));
  TextRows rows(job);
  parallel_ranges(pieces.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p)
      rows.read(pieces[p]);
  });
  if (rows.long_lines() > 0)
    job.report.warnings.push_back(fmt::format("{} lines have more values than the header declares; the values at "
                                              "their ends were not read. Declare them as FIELDS if they matter.",
                                              rows.long_lines()));
  if (points > job.header.points)
    job.report.warnings.push_back(fmt::format("the file goes on after its last point ({} more lines, not read); if "
                                              "points are missing, correct the counts in the header.",
                                              points - job.header.points));
}

/// Where the sensor was. One at 0 0 0 is what programs write that know nothing of it.
void take_viewpoint(const PcdHeader& header, PointCloud& cloud, CloudReport& report) {
  if (!header.viewpoint || header.viewpoint->position.isZero(0.0)) return;
  const Eigen::Vector3d& position = header.viewpoint->position;
  cloud.stations = {position};
  cloud.station.assign(cloud.size(), 0);
  report.stations = cloud.stations;
  report.notes.push_back(fmt::format("the scanner's position is that of VIEWPOINT, [{:.6g}, {:.6g}, {:.6g}]",
                                     position.x(), position.y(), position.z()));
}

PcdHeader read_header(const InputFile& file) {
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 1 << 20)), '\0');
  file.read(0, head.data(), head.size());
  return parse_pcd_header(head.data(), head.size(), file.size(), file.path());
}

} // namespace

PointCloud read_pcd(const std::string& path, const ReadRequest& request, CloudReport& report) {
  const InputFile file(path);
  const PcdHeader header = read_header(file);
  report.usual_up = Eigen::Vector3d::UnitZ(); // robots' maps; depth cameras' frames are known by other signs
  report.format = std::string("PCD ") + name_of(header.data);
  if (header.height > 1) report.format += fmt::format(", {} x {}", header.width, header.height);
  report.warnings.insert(report.warnings.end(), header.warnings.begin(), header.warnings.end());
  const std::vector<PcdColumn> columns = pcd_columns(header);
  std::vector<FieldInfo> fields;
  for (const PcdColumn& column : columns)
    fields.push_back(column.info);
  const FieldPlan plan =
      plan_fields(std::move(fields), request, path, fmt::format("line {}", header.body_line - 1), report);
  std::vector<std::size_t> read;
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (plan.is_read(c)) read.push_back(c);
  PointSink sink(plan, static_cast<std::size_t>(header.points), path);
  const Reading job{file, header, columns, read, sink, report};
  if (header.data == PcdData::ascii)
    read_ascii(job);
  else if (header.data == PcdData::binary)
    read_binary(job);
  else
    read_compressed(job);
  PointCloud cloud = sink.finish(report);
  take_viewpoint(header, cloud, report);
  return cloud;
}

} // namespace pointgi
