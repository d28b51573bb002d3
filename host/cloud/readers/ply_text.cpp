#include "host/cloud/readers/ply_text.h"
#include "host/cloud/readers/ply_row.h"
#include "octree/parallel.h"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>

namespace pointgi {

namespace {

constexpr std::size_t block_bytes = std::size_t{16} << 20;
constexpr std::size_t piece_bytes = std::size_t{256} << 10;

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
bool ends_line(char c) {
  return c == '\n' || c == '\r';
}

/// Where the line after the one that holds `at` begins.
const char* after_line(const char* at, const char* end) {
  at = std::find_if(at, end, ends_line);
  if (at == end) return end;
  return at + (*at == '\r' && at + 1 < end && at[1] == '\n' ? 2 : 1);
}

/// Whole lines of a block, which one thread reads.
struct Piece {
  const char* begin;
  const char* end;
  std::size_t lines = 0;
  std::uint64_t filled = 0; ///< lines that have a word
  PlySurplus surplus;
  std::exception_ptr error;
};

std::vector<Piece> pieces_of(const char* begin, const char* end) {
  std::vector<Piece> pieces;
  while (begin < end) {
    const char* stop = static_cast<std::size_t>(end - begin) > piece_bytes ? after_line(begin + piece_bytes, end) : end;
    pieces.push_back({begin, stop, 0, 0, {}, nullptr});
    begin = stop;
  }
  return pieces;
}

template <class Body>
void for_each(std::vector<Piece>& pieces, const Body& body) {
  parallel_ranges(pieces.size(), 1, [&](std::size_t first, std::size_t end) {
    for (std::size_t p = first; p < end; ++p)
      body(p);
  });
}

} // namespace

void PlySurplus::add(const PlySurplus& later) {
  if (lines == 0) first_line = later.first_line;
  lines += later.lines;
}

/// Looks at each byte of the text once for LF and once for CR, as fast as memory is.
void PlyTextRecords::find_line_end() {
  const auto first = [](const char* begin, const char* end, char c) {
    const void* at = std::memchr(begin, c, static_cast<std::size_t>(end - begin));
    return at != nullptr ? static_cast<const char*>(at) : end;
  };
  if (line_feed_ == nullptr || line_feed_ < at_) line_feed_ = first(at_, end_, '\n');
  line_end_ = first(at_, line_feed_, '\r');
}

bool PlyTextRecords::next() {
  while (rest_ < end_) {
    at_ = rest_;
    line_ = next_line_++;
    find_line_end();
    rest_ = after_line(line_end_, end_);
    if (!at_line_end()) return true;
  }
  at_ = line_end_ = end_;
  line_ = next_line_;
  return false;
}

void PlyTextRecords::end_record() {
  if (at_line_end()) return;
  surplus_.add({1, line_});
}

double PlyTextRecords::scalar(FieldType type) {
  if (at_line_end())
    fail("fewer values than the header declares: expected another one (" + std::string(name_of(type)) + ")");
  const std::string_view text = word();
  const double value = number(text);
  if (!is_float(type)) check_whole(value, type, text);
  return value;
}

std::size_t PlyTextRecords::list_count(const PlyProperty& list) {
  const double count = scalar(list.count_type);
  // Each item takes a blank and a digit at least.
  const auto fits = static_cast<double>((line_end_ - at_) / 2);
  if (count < 0 || count > fits)
    fail("the list " + quoted_bytes(list.name) + " announces " + std::to_string(static_cast<long long>(count)) +
         " items, expected 0 to " + std::to_string(static_cast<long long>(fits)) + ", which the line can hold");
  return static_cast<std::size_t>(count);
}

void PlyTextRecords::skip(FieldType, std::size_t items) {
  for (std::size_t i = 0; i < items; ++i)
    (void)scalar(FieldType::f64);
}

bool PlyTextRecords::at_line_end() {
  while (at_ < line_end_ && is_blank(*at_))
    ++at_;
  return at_ == line_end_;
}

std::string_view PlyTextRecords::word() {
  const char* start = at_;
  while (at_ < line_end_ && !is_blank(*at_))
    ++at_;
  return {start, static_cast<std::size_t>(at_ - start)};
}

double PlyTextRecords::number(std::string_view text) const {
  const char* first = text.data();
  const char* last = first + text.size();
  if (*first == '+' && text.size() > 1 && first[1] != '-') ++first;
  double value = 0.0;
  const auto [stop, error] = std::from_chars(first, last, value);
  if (stop != last || error == std::errc::invalid_argument)
    fail("expected a number, found " + quoted_bytes(text) +
         (text.find(',') != std::string_view::npos ? "; the decimal sign is a point, and blanks separate values" : ""));
  if (error == std::errc::result_out_of_range) {
    // Too small is zero and too large is infinite, as a conversion to float would have it.
    const std::size_t exponent = text.find_first_of("eE");
    const bool tiny = exponent != std::string_view::npos && exponent + 1 < text.size() && text[exponent + 1] == '-';
    value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
    return *first == '-' ? -value : value;
  }
  return value;
}

void PlyTextRecords::check_whole(double value, FieldType type, std::string_view text) const {
  const int bits = static_cast<int>(8 * size_of(type));
  const bool is_signed = type == FieldType::i8 || type == FieldType::i16 || type == FieldType::i32;
  const double low = is_signed ? -std::ldexp(1.0, bits - 1) : 0.0;
  const double high = std::ldexp(1.0, is_signed ? bits - 1 : bits) - 1.0;
  if (!(value >= low && value <= high) || value != std::floor(value))
    fail("expected a whole number from " + std::to_string(static_cast<long long>(low)) + " to " +
         std::to_string(static_cast<long long>(high)) + " (" + name_of(type) + "), found " + quoted_bytes(text));
}

void PlyTextRecords::fail(const std::string& what) const {
  throw Error(ErrorKind::input, *file_ + ": line " + std::to_string(line_) + " (" + printable(element_->name) + " " +
                                    std::to_string(index_) + " of " + std::to_string(element_->count) + "): " + what);
}

PlyAsciiBody::PlyAsciiBody(const PlyHeader& header, const InputFile& file)
    : file_(file), next_block_(header.body_offset), records_(file.path(), nullptr, nullptr, header.body_line) {}

void PlyAsciiBody::start(const char* begin, const char* end, std::size_t first_line) {
  surplus_.add(records_.surplus());
  records_ = PlyTextRecords(file_.path(), begin, end, first_line);
}

bool PlyAsciiBody::load_block() {
  const std::uint64_t left = file_.size() - next_block_;
  if (left == 0) return false;
  for (std::uint64_t want = block_bytes;; want *= 2) { // until it holds a line
    const auto size = static_cast<std::size_t>(std::min(want, left));
    if (size > capacity_) {
      block_.reset(new char[size]);
      capacity_ = size;
    }
    file_.read(next_block_, block_.get(), size);
    const char* end = block_.get() + size;
    if (size < left) {
      --end; // a CR there may be half a line end
      while (end > block_.get() && !ends_line(end[-1]))
        --end;
      if (end == block_.get()) continue;
      if (end[-1] == '\r' && *end == '\n') ++end;
    }
    next_block_ += static_cast<std::uint64_t>(end - block_.get());
    start(block_.get(), end, records_.next_line());
    return true;
  }
}

bool PlyAsciiBody::next_line() {
  while (!records_.next())
    if (!load_block()) return false;
  return true;
}

void PlyAsciiBody::begin_record(const PlyElement& element, std::uint64_t index) {
  const bool found = next_line();
  records_.name_record(element, index);
  if (!found) records_.fail("the file ends here; it is truncated");
}

bool PlyAsciiBody::read_points(const PlyElement& vertex, const FieldPlan& plan, PointSink& sink) {
  for (std::uint64_t done = 0; done < vertex.count;) {
    if (records_.rest() == records_.end() && !load_block()) {
      begin_record(vertex, done); // which complains
    }
    done += read_block(vertex, plan, done, sink);
  }
  return true;
}

std::uint64_t PlyAsciiBody::read_block(const PlyElement& vertex, const FieldPlan& plan, std::uint64_t first,
                                       PointSink& sink) {
  std::vector<Piece> pieces = pieces_of(records_.rest(), records_.end());
  for_each(pieces, [&](std::size_t p) {
    PlyTextRecords lines(file_.path(), pieces[p].begin, pieces[p].end, 0);
    while (lines.next())
      ++pieces[p].filled;
    pieces[p].lines = lines.next_line();
  });
  std::vector<std::size_t> line(pieces.size() + 1, records_.next_line());
  std::vector<std::uint64_t> point(pieces.size() + 1, first);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    line[p + 1] = line[p] + pieces[p].lines;
    point[p + 1] = std::min(point[p] + pieces[p].filled, vertex.count);
  }
  // A piece that other elements begin in ends for us where the last point does.
  for_each(pieces, [&](std::size_t p) {
    Piece& piece = pieces[p];
    PlyTextRecords lines(file_.path(), piece.begin, piece.end, line[p]);
    try {
      PlyRow row(vertex, plan);
      for (std::uint64_t i = point[p]; i < point[p + 1] && lines.next(); ++i) {
        lines.name_record(vertex, i);
        sink.put(static_cast<std::size_t>(i), row.read(lines));
        lines.end_record();
      }
    } catch (...) {
      piece.error = std::current_exception();
    }
    piece.surplus = lines.surplus();
    if (point[p + 1] < vertex.count) return;
    piece.end = lines.rest();
    piece.lines = lines.next_line() - line[p];
  });
  std::size_t last = 0; // the piece after which the points of this block have ended
  while (last + 1 < pieces.size() && point[last + 1] < vertex.count)
    ++last;
  const char* const end = records_.end();
  start(pieces[last].end, end, line[last] + pieces[last].lines);
  for (const Piece& piece : pieces) {
    if (piece.error) std::rethrow_exception(piece.error); // of the first line, whoever met his first
    surplus_.add(piece.surplus);
  }
  return point.back() - first;
}

std::string PlyAsciiBody::trailing() {
  if (!next_line()) return "";
  return "text from line " + std::to_string(records_.line()) + " on";
}

std::string PlyAsciiBody::surplus() const {
  PlySurplus all = surplus_;
  all.add(records_.surplus());
  if (all.lines == 0) return "";
  return std::to_string(all.lines) + ", the first is line " + std::to_string(all.first_line);
}

} // namespace pointgi
