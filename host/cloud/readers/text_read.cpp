#include "host/cloud/input_file.h"
#include "host/cloud/readers/point_sink.h"
#include "host/cloud/readers/ptx.h"
#include "host/cloud/readers/text.h"
#include "host/cloud/readers/text_columns.h"
#include "host/cloud/readers/text_layout.h"
#include "octree/parallel.h"
#include <cstring>
#include <limits>

namespace pointgi {

namespace {

struct TextCount {
  std::size_t line;
  std::string_view text;
  std::size_t points_before; ///< in the file
};

/// A piece of the text and what precedes it.
struct CountedPiece {
  TextPiece text;
  std::size_t lines = 0;
  std::size_t points = 0;
  std::vector<TextCount> counts;
  std::size_t first_line = 0;
  std::size_t first_point = 0;
};

class TextReader {
public:
  TextReader(const std::string& path, const char* begin, const char* end, std::size_t first_line, TextLayout layout)
      : path_(path), layout_(std::move(layout)) {
    for (const TextPiece& piece : split_at_line_ends(begin, end)) {
      pieces_.emplace_back();
      pieces_.back().text = piece;
    }
    parallel_ranges(pieces_.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t p = first; p < last; ++p)
        count_lines(pieces_[p]);
    });
    std::size_t line = first_line;
    for (CountedPiece& piece : pieces_) {
      piece.first_line = line;
      piece.first_point = points_;
      for (TextCount& count : piece.counts) {
        count.line += line;
        count.points_before += points_;
        counts_.push_back(count);
      }
      line += piece.lines;
      points_ += piece.points;
    }
    last_line_ = line == first_line ? first_line : line - 1;
  }

  PointCloud read(const ReadRequest& request, CloudReport& report) {
    check_counts(report);
    const std::size_t names_line = layout_.header_line != 0 ? layout_.header_line : 1;
    FieldPlan plan = plan_fields(layout_.columns, request, path_, "line " + std::to_string(names_line), report);
    for (std::size_t f = 0; f < plan.fields.size(); ++f)
      if (plan.is_read(f)) columns_read_ = f + 1;
    PointSink sink(plan, points_, path_);
    parallel_ranges(pieces_.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t p = first; p < last; ++p)
        read_piece(pieces_[p], plan, sink);
    });
    return sink.finish(report);
  }

  std::size_t points() const { return points_; }

private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw Error(ErrorKind::input, path_ + ": line " + std::to_string(line) + ": " + what);
  }

  void count_lines(CountedPiece& piece) const {
    TextLines lines(piece.text.begin, piece.text.end, 0);
    while (lines.next()) {
      ++piece.lines;
      const TextLine kind = kind_of_line(lines.text(), layout_.separator);
      if (kind == TextLine::count) piece.counts.push_back({lines.line(), trimmed(lines.text()), piece.points});
      if (kind == TextLine::values) ++piece.points;
    }
  }

  /// Counts are often left as they were when points were cut away: what the file has is taken, and said.
  void check_counts(CloudReport& report) const {
    std::size_t wrong = 0;
    std::string first_wrong;
    for (std::size_t c = 0; c < counts_.size(); ++c) {
      const std::size_t next = c + 1 < counts_.size() ? counts_[c + 1].points_before : points_;
      const std::string_view text = counts_[c].text;
      if (text.front() == '-')
        fail(counts_[c].line, "the line announces " + printable(text) + " points, expected 0 or more");
      const std::size_t found = next - counts_[c].points_before;
      double announced = 0.0;
      if (!parse_number(text, false, announced) || announced == static_cast<double>(found)) continue;
      if (wrong++ == 0)
        first_wrong = "line " + std::to_string(counts_[c].line) + " announces " + printable(text) + " points and " +
                      std::to_string(found) + " follow, which were read";
    }
    if (wrong > 0)
      report.warnings.push_back(first_wrong +
                                (wrong > 1 ? " (so do " + std::to_string(wrong - 1) + " lines more)" : "") +
                                "; if points are missing, the file was cut off: get it again");
    if (points_ == 0) fail(last_line_, "the file ends without a point; expected lines of x y z and more");
    if (points_ > std::numeric_limits<std::uint32_t>::max())
      fail(last_line_,
           std::to_string(points_) + " points, expected at most 4294967295; thin the cloud out or split it");
  }

  void read_piece(const CountedPiece& piece, const FieldPlan& plan, PointSink& sink) const {
    std::vector<double> row(plan.fields.size(), std::numeric_limits<double>::quiet_NaN());
    std::size_t point = piece.first_point;
    TextLines lines(piece.text.begin, piece.text.end, piece.first_line);
    while (lines.next()) {
      if (kind_of_line(lines.text(), layout_.separator) != TextLine::values) continue;
      read_row(lines, plan, row);
      sink.put(point++, row.data());
    }
  }

  void read_row(const TextLines& line, const FieldPlan& plan, std::vector<double>& row) const {
    TextWords words(line.text(), layout_.separator);
    std::string_view word;
    for (std::size_t c = 0; c < columns_read_; ++c) {
      if (!words.next(word))
        fail(line.line(), std::to_string(c) + (c == 1 ? " value" : " values") + ", expected " +
                              std::to_string(columns_read_) + " or more; the file is cut off or mixes layouts");
      if (!plan.is_read(c) || parse_number(word, layout_.separator.decimal_comma, row[c])) continue;
      row[c] = std::numeric_limits<double>::quiet_NaN();
      if (!word.empty() && plan.slot[c] != slot_none)
        fail(line.line(), "expected a number for " + printable(plan.fields[c].name) + " (value " +
                              std::to_string(c + 1) + " of the line), found " + quoted_bytes(word));
    }
  }

  const std::string& path_;
  TextLayout layout_;
  std::vector<CountedPiece> pieces_;
  std::vector<TextCount> counts_;
  std::size_t points_ = 0;
  std::size_t last_line_ = 0;
  std::size_t columns_read_ = 0; ///< of each line; what follows is passed over
};

std::string columns_note(const TextLayout& layout) {
  constexpr std::size_t most = 16; // what a sentence holds
  std::string names;
  for (std::size_t c = 0; c < std::min(most, layout.columns.size()); ++c)
    names += (c > 0 ? ", " : "") + printable(layout.columns[c].name);
  if (layout.columns.size() > most) names += " and " + std::to_string(layout.columns.size() - most) + " more";
  const std::string by = layout.colmap            ? "as COLMAP writes its points"
                         : layout.header_line > 0 ? "by the names in line " + std::to_string(layout.header_line)
                                                  : "by what they hold";
  return "the columns of the text, separated by " + std::string(layout.separator.name()) +
         (layout.separator.decimal_comma ? " with decimal commas" : "") + ", were taken as " + names + " (" + by +
         "); a first line of names, as in \"x y z red green blue\", decides otherwise";
}

/// The byte order mark of UTF-8, which some editors write.
std::size_t mark_size(const char* data, std::size_t size) {
  return size >= 3 && std::memcmp(data, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

} // namespace

PointCloud read_text(const std::string& path, const ReadRequest& request, CloudReport& report) {
  const FileBytes bytes = read_whole_file(path);
  const char* begin = bytes.data.get() + mark_size(bytes.data.get(), bytes.size);
  const char* end = bytes.data.get() + bytes.size;
  TextLayout layout = find_text_layout(begin, end, 1, path);
  report.format = layout.colmap ? "points3D.txt of COLMAP" : has_extension(path, ".pts") ? "PTS" : "text";
  if (layout.colmap) {
    report.usual_kind = CloudKind::sparse;
    report.usual_up = -Eigen::Vector3d::UnitY(); // as its cameras count
  }
  report.notes.push_back(columns_note(layout));
  std::size_t first_line = 1;
  if (layout.header_is_data) {
    TextLines lines(begin, end);
    while (lines.next() && lines.line() < layout.header_line) {
    }
    begin = lines.rest();
    first_line = layout.header_line + 1;
  }
  return TextReader(path, begin, end, first_line, std::move(layout)).read(request, report);
}

bool recognises_text(const char* data, std::size_t size) {
  if (recognises_ptx(data, size)) return false;
  const char* begin = data + mark_size(data, size);
  const char* end = data + size;
  while (size == 4096 && end > begin && end[-1] != '\n' && end[-1] != '\r')
    --end; // the last line may be cut
  try {
    const TextLayout layout = find_text_layout(begin, end, 1, "");
    bool all = have_position(layout.columns);
    double number = 0.0;
    TextLines lines(begin, end);
    while (all && lines.next()) {
      if (lines.line() == layout.header_line || kind_of_line(lines.text(), layout.separator) != TextLine::values)
        continue;
      TextWords words(lines.text(), layout.separator);
      std::string_view word;
      for (std::size_t c = 0; c < std::min<std::size_t>(3, layout.columns.size()) && all; ++c)
        all = words.next(word) && parse_number(word, layout.separator.decimal_comma, number);
    }
    return all;
  } catch (const Error&) {
    return false;
  }
}

} // namespace pointgi
