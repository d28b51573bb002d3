#include "host/cloud/input_file.h"
#include "host/cloud/readers/point_sink.h"
#include "host/cloud/readers/ptx.h"
#include "host/cloud/readers/ptx_grid.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <limits>

namespace pointgi {

namespace {

/// A part of a grid's body.
struct GridPiece {
  TextPiece text;
  const PtxGrid* grid = nullptr;
  std::size_t lines = 0;
  std::size_t points = 0; ///< lines with a return
  std::size_t first_line = 0;
  std::size_t first_point = 0;
  std::uint16_t station = 0;
};

/// The numbers of a line, as many as there are up to `most`. The first word that is none ends them.
std::size_t numbers_of(std::string_view line, std::array<double, 7>& numbers, std::size_t most) {
  TextWords words(line, {});
  std::string_view word;
  std::size_t count = 0;
  while (count < most && words.next(word) && parse_number(word, false, numbers[count]))
    ++count;
  return count;
}

/// Whether a line is a ray that came back: a line that can't be read counts as one, and fails when it is.
bool has_return(std::string_view line) {
  std::array<double, 7> numbers{};
  line = trimmed(line);
  if (line.empty()) return false;
  if (line.front() >= '1' && line.front() <= '9') return true;
  return numbers_of(line, numbers, 3) < 3 || numbers[0] != 0.0 || numbers[1] != 0.0 || numbers[2] != 0.0;
}

class PtxReader {
public:
  PtxReader(const std::string& path, const std::vector<PtxGrid>& grids) : path_(path) {
    for (const PtxGrid& grid : grids)
      for (const TextPiece& text : split_at_line_ends(grid.body.begin, grid.body.end)) {
        pieces_.emplace_back();
        pieces_.back().text = text;
        pieces_.back().grid = &grid;
      }
    parallel_ranges(pieces_.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t p = first; p < last; ++p) {
        TextLines lines(pieces_[p].text.begin, pieces_[p].text.end);
        for (; lines.next(); ++pieces_[p].lines)
          pieces_[p].points += has_return(lines.text()) ? 1u : 0u;
      }
    });
    const PtxGrid* grid = nullptr;
    std::size_t line = 0;
    for (GridPiece& piece : pieces_) {
      line = piece.grid == grid ? line : piece.grid->first_line;
      grid = piece.grid;
      piece.first_line = line;
      piece.first_point = points_;
      line += piece.lines;
      points_ += piece.points;
      values_ = std::max(values_, grid->values);
    }
  }

  PointCloud read(const ReadRequest& request, CloudReport& report) {
    if (points_ == 0 || points_ > std::numeric_limits<std::uint32_t>::max())
      throw Error(ErrorKind::input, path_ + ": line 1: " + std::to_string(points_) +
                                        " points with a return, expected 1 to 4294967295; " +
                                        (points_ == 0 ? "export the scan again" : "split the file"));
    std::vector<FieldInfo> fields{{"x", FieldType::f64}, {"y", FieldType::f64}, {"z", FieldType::f64}};
    if (values_ > 3) fields.push_back({"intensity", FieldType::f32});
    if (values_ > 4)
      for (const char* colour : {"red", "green", "blue"})
        fields.push_back({colour, FieldType::u8});
    PointSink sink(plan_fields(std::move(fields), request, path_, "line 1", report), points_, path_);
    const std::vector<Eigen::Vector3d> stations = number_stations();
    std::vector<std::uint16_t> station(points_);
    parallel_ranges(pieces_.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t p = first; p < last; ++p)
        read_piece(pieces_[p], sink, station);
    });
    PointCloud cloud = sink.finish(report);
    cloud.station = std::move(station);
    cloud.stations = stations;
    report.stations = stations;
    return cloud;
  }

  std::size_t points() const { return points_; }

private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw Error(ErrorKind::input, path_ + ": line " + std::to_string(line) + ": " + what);
  }

  /// Grids that have points become stations, in their order.
  std::vector<Eigen::Vector3d> number_stations() {
    std::vector<Eigen::Vector3d> stations;
    const PtxGrid* last = nullptr;
    for (GridPiece& piece : pieces_) {
      if (piece.points == 0) continue;
      if (piece.grid != last) stations.push_back(piece.grid->station);
      last = piece.grid;
      piece.station = static_cast<std::uint16_t>(stations.size() - 1);
    }
    return stations;
  }

  void read_piece(const GridPiece& piece, PointSink& sink, std::vector<std::uint16_t>& station) const {
    std::size_t point = piece.first_point;
    TextLines lines(piece.text.begin, piece.text.end, piece.first_line);
    while (lines.next()) {
      if (!has_return(lines.text())) continue;
      std::array<double, 7> row{};
      const std::size_t found = numbers_of(lines.text(), row, piece.grid->values);
      if (found < piece.grid->values)
        fail(lines.line(), "expected " + std::to_string(piece.grid->values) +
                               " numbers (x y z, intensity, red green blue), found " +
                               quoted_bytes(trimmed(lines.text())));
      const Eigen::Vector3d world = piece.grid->turn * Eigen::Vector3d(row[0], row[1], row[2]) + piece.grid->move;
      std::copy_n(world.data(), 3, row.begin());
      if (found < 7) // another grid of the file may have colours: grey then stands for those of this one
        std::fill_n(row.begin() + 4, 3, found > 3 ? std::clamp(255.0 * row[3], 0.0, 255.0) : 128.0);
      station[point] = piece.station;
      sink.put(point++, row.data());
    }
  }

  const std::string& path_;
  std::vector<GridPiece> pieces_;
  std::size_t points_ = 0;
  std::size_t values_ = 3; ///< the most that a grid's lines have
};

} // namespace

PointCloud read_ptx(const std::string& path, const ReadRequest& request, CloudReport& report) {
  const FileBytes bytes = read_whole_file(path);
  const std::vector<PtxGrid> grids = find_ptx_grids(bytes.data.get(), bytes.data.get() + bytes.size, path);
  PtxReader reader(path, grids);
  report.format = "PTX";
  report.up = Eigen::Vector3d::UnitZ();
  PointCloud cloud = reader.read(request, report);
  std::size_t cells = 0;
  for (const PtxGrid& grid : grids)
    cells += grid.cells;
  report.notes.push_back(std::to_string(cloud.stations.size()) + " scanner " +
                         (cloud.stations.size() == 1 ? "position" : "positions") + " with " +
                         std::to_string(cloud.size()) + " points; " + std::to_string(cells - cloud.size()) +
                         " rays had no return");
  if (std::any_of(grids.begin(), grids.end(), [](const PtxGrid& grid) { return grid.transposed; }))
    report.notes.push_back("a grid's matrix has its translation in the last column, not in the last row: it was read "
                           "as one for column vectors");
  return cloud;
}

bool recognises_ptx(const char* data, std::size_t size) {
  try {
    TextLines lines(data, data + size);
    (void)parse_ptx_header(lines, "");
    return true;
  } catch (const Error&) {
    return false;
  }
}

} // namespace pointgi
