#include "host/cloud/readers/ptx_grid.h"
#include "host/cloud/input_file.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

[[noreturn]] void fail(const std::string& file, std::size_t line, const std::string& what) {
  throw Error(ErrorKind::input, file + ": line " + std::to_string(line) + ": " + what);
}

bool next_filled(TextLines& lines) {
  while (lines.next())
    if (!trimmed(lines.text()).empty()) return true;
  return false;
}

/// The numbers of the header's next line, exactly `count`.
template <std::size_t count>
std::array<double, count> header_line(TextLines& lines, const char* what, const std::string& file) {
  if (!next_filled(lines))
    fail(file, std::max<std::size_t>(1, lines.line()),
         std::string("the file ends in a grid's header, expected ") + what + "; it is cut off");
  std::array<double, count> numbers{};
  TextWords words(lines.text(), {});
  std::string_view word;
  std::size_t found = 0;
  while (found < count && words.next(word) && parse_number(word, false, numbers[found]) &&
         std::isfinite(numbers[found]))
    ++found;
  if (found < count || words.next(word))
    fail(file, lines.line(), std::string("expected ") + what + ", found " + quoted_bytes(trimmed(lines.text())));
  return numbers;
}

std::size_t cell_count(TextLines& lines, const char* what, const std::string& file) {
  const double count = header_line<1>(lines, what, file)[0];
  constexpr double most = 4294967295.0;
  if (count < 0.0 || count > most || count != std::floor(count))
    fail(file, lines.line(),
         std::string("expected ") + what + ", a whole number from 0 to 4294967295, found " +
             quoted_bytes(trimmed(lines.text())));
  return static_cast<std::size_t>(count);
}

} // namespace

PtxGrid parse_ptx_header(TextLines& lines, const std::string& file) {
  PtxGrid grid;
  const std::size_t columns = cell_count(lines, "the number of columns of a grid", file);
  grid.cells = columns * cell_count(lines, "the number of rows of a grid", file); // below 2^64: both are below 2^32
  const std::array<double, 3> scanner = header_line<3>(lines, "the scanner's position (3 numbers)", file);
  for (int axis = 0; axis < 3; ++axis)
    (void)header_line<3>(lines, "an axis of the scanner (3 numbers)", file); // the matrix tells them again
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    const std::array<double, 4> numbers = header_line<4>(lines, "a row of the matrix (4 numbers)", file);
    matrix.row(row) = Eigen::RowVector4d(numbers[0], numbers[1], numbers[2], numbers[3]);
  }
  const auto moves = [](const Eigen::Matrix4d& m) { return !m.row(3).head<3>().isZero(0.0); };
  grid.transposed = !moves(matrix) && moves(matrix.transpose());
  if (grid.transposed) matrix.transposeInPlace();
  grid.turn = matrix.topLeftCorner<3, 3>().transpose();
  grid.move = matrix.row(3).head<3>().transpose();
  grid.station = moves(matrix) ? grid.move : Eigen::Vector3d(scanner[0], scanner[1], scanner[2]);
  return grid;
}

namespace {

/// Where a line begins, and its number.
struct LinePlace {
  const char* at;
  std::size_t line;
};

/// Finds lines that are far on, on all cores.
class LineIndex {
public:
  LineIndex(const char* begin, const char* end) : end_(end) {
    for (const TextPiece& text : split_at_line_ends(begin, end))
      pieces_.push_back({text, 0, 0});
    parallel_ranges(pieces_.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t p = first; p < last; ++p) {
        TextLines lines(pieces_[p].text.begin, pieces_[p].text.end);
        while (lines.next()) {
          ++pieces_[p].lines;
          pieces_[p].filled += trimmed(lines.text()).empty() ? 0u : 1u;
        }
      }
    });
  }

  /// The line after `filled` lines that are not empty. Where the text ends before, `filled` is left at the number that
  /// is missing.
  LinePlace after(LinePlace place, std::size_t& filled) const {
    auto piece = std::upper_bound(pieces_.begin(), pieces_.end(), place.at,
                                  [](const char* at, const Piece& p) { return at < p.text.end; });
    for (; filled > 0 && piece != pieces_.end(); ++piece) {
      if (place.at == piece->text.begin && piece->filled <= filled) {
        filled -= piece->filled;
        place = {piece->text.end, place.line + piece->lines};
        continue;
      }
      TextLines lines(place.at, piece->text.end, place.line);
      while (filled > 0 && lines.next()) {
        filled -= trimmed(lines.text()).empty() ? 0u : 1u;
        place = {lines.rest(), lines.line() + 1};
      }
    }
    return place;
  }

private:
  struct Piece {
    TextPiece text;
    std::size_t lines;
    std::size_t filled; ///< lines that are not empty
  };
  const char* end_;
  std::vector<Piece> pieces_;
};

/// How many values the first filled line of a body has.
std::size_t values_of_body(const TextPiece& body, std::size_t first_line, const std::string& file) {
  TextLines lines(body.begin, body.end, first_line);
  if (!next_filled(lines)) return 3;
  const std::size_t values = count_words(lines.text(), {}, 8);
  if (values != 3 && values != 4 && values != 7)
    fail(file, lines.line(),
         "expected 3, 4 or 7 numbers (x y z, intensity, red green blue), found " + quoted_bytes(trimmed(lines.text())));
  return values;
}

} // namespace

std::vector<PtxGrid> find_ptx_grids(const char* begin, const char* end, const std::string& file) {
  constexpr std::size_t most_grids = 65535; // stations are numbered with 16 bits
  std::vector<PtxGrid> grids;
  const LineIndex index(begin, end);
  LinePlace place{begin, 1};
  while (true) {
    TextLines lines(place.at, end, place.line);
    if (!grids.empty()) { // empty lines may follow the last grid
      TextLines rest = lines;
      if (!next_filled(rest)) break;
    }
    if (grids.size() == most_grids)
      fail(file, place.line, "more than 65535 grids, which is as many stations as a cloud can have; split the file");
    PtxGrid grid = parse_ptx_header(lines, file);
    grid.first_line = lines.line() + 1;
    std::size_t missing = grid.cells;
    place = index.after({lines.rest(), grid.first_line}, missing);
    if (missing > 0)
      fail(file, place.line,
           "the file ends " + std::to_string(missing) + " lines before the last of the " + std::to_string(grid.cells) +
               " points of grid " + std::to_string(grids.size() + 1) + "; it is cut off");
    grid.body = {lines.rest(), place.at};
    grid.values = values_of_body(grid.body, grid.first_line, file);
    grids.push_back(grid);
  }
  return grids;
}

} // namespace pointgi
