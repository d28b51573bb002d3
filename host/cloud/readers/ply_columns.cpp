#include "host/cloud/readers/ply_columns.h"
#include "host/cloud/input_file.h"
#include "host/cloud/readers/byte_stream.h"
#include "host/cloud/readers/ply_header.h"
#include "host/run.h"
#include <charconv>
#include <unordered_set>

namespace pointgi {

namespace {

constexpr std::string_view line_ends = "\r\n", blanks = " \t\v\f\r\n";

/// As PLY can hold it.
FieldType ply_type(FieldType type) {
  return type == FieldType::i64 || type == FieldType::u64 ? FieldType::f64 : type;
}

std::string property_line(const PointColumn& column) {
  return "property " + std::string(name_of(ply_type(column.type))) + " " + column.name;
}

/// The shortest text that is read as this value of the type.
std::string value_text(double value, FieldType type) {
  switch (type) {
  case FieldType::i8:
    return std::to_string(nearest_integer<std::int8_t>(value));
  case FieldType::u8:
    return std::to_string(nearest_integer<std::uint8_t>(value));
  case FieldType::i16:
    return std::to_string(nearest_integer<std::int16_t>(value));
  case FieldType::u16:
    return std::to_string(nearest_integer<std::uint16_t>(value));
  case FieldType::i32:
    return std::to_string(nearest_integer<std::int32_t>(value));
  case FieldType::u32:
    return std::to_string(nearest_integer<std::uint32_t>(value));
  default:
    break;
  }
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
  char text[40];
  const auto end = type == FieldType::f32 ? std::to_chars(text, std::end(text), static_cast<float>(value))
                                          : std::to_chars(text, std::end(text), value);
  return {text, end.ptr};
}

/// A PLY file that is written again.
class Rewriter {
public:
  Rewriter(const std::string& source, const std::vector<PointColumn>& columns)
      : file_(source), columns_(columns), bytes_(read_whole_file(source)),
        header_(parse_ply_header(bytes_.data.get(), bytes_.size, source)) {
    check_ply_counts(header_, bytes_.size, source);
    at_ = bytes_.data.get() + header_.body_offset;
    end_ = bytes_.data.get() + bytes_.size;
    // The line end of the header: as parse_ply_header takes it, that of the first line.
    const std::string_view text(bytes_.data.get(), bytes_.size);
    const std::size_t first = text.find_first_of(line_ends);
    line_end_ = text[first] == '\n' ? "\n" : text.compare(first, 2, "\r\n") == 0 ? "\r\n" : "\r";
  }

  void choose_properties(const std::map<std::string, std::string>& kept_as) {
    for (const PlyProperty& property : vertex().properties)
      names_.push_back(property.name);
    const std::unordered_set<std::string> all(names_.begin(), names_.end());
    for (std::string& name : names_) {
      const auto is_column = [&](const PointColumn& column) { return column.name == name; };
      if (std::none_of(columns_.begin(), columns_.end(), is_column)) continue;
      const auto other = kept_as.find(name);
      name = other != kept_as.end() && all.count(other->second) == 0 ? other->second : "";
    }
    all_stay_ = std::find(names_.begin(), names_.end(), "") == names_.end();
  }

  void write(ByteStream& out) {
    write_header(out);
    const char* body = at_;
    const bool ascii = header_.format == PlyFormat::ascii;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        out.bytes(body, static_cast<std::size_t>(at_ - body));
        if (ascii)
          write_lines(element, out);
        else
          write_records(element, out);
        body = at_;
        break; // what follows is copied
      }
      for (std::uint64_t i = 0; i < element.count; ++i)
        ascii ? static_cast<void>(next_line()) : step_over(element);
    }
    out.bytes(body, static_cast<std::size_t>(end_ - body));
  }

  const PlyElement& vertex() const {
    for (const PlyElement& element : header_.elements)
      if (element.name == "vertex") return element;
    throw Error(ErrorKind::input, file_ + ": the header declares no element vertex");
  }

  bool is_big_endian() const { return header_.format == PlyFormat::binary_big_endian; }

private:
  [[noreturn]] void fail_truncated() const {
    throw Error(ErrorKind::input, file_ + ": byte " + std::to_string(end_ - bytes_.data.get()) +
                                      ": the file ends within its elements; it is truncated, or was changed meanwhile");
  }

  /// Line by line; those of the vertex' properties as chosen, and behind them the columns'.
  void write_header(ByteStream& out) const {
    const std::string_view header(bytes_.data.get(), header_.body_offset);
    bool in_vertex = false;
    std::size_t property = 0;
    for (std::size_t at = 0; at < header.size();) {
      const std::size_t stop = std::min(header.find(line_end_.back(), at), header.size() - 1) + 1;
      const std::string_view line = header.substr(at, stop - at); // with its end
      at = stop;
      const std::vector<std::string_view> words = words_of(line);
      const std::string_view first = words.empty() ? std::string_view() : words[0];
      if (in_vertex && (first == "element" || first == "end_header")) {
        in_vertex = false;
        for (const PointColumn& column : columns_)
          out.text(property_line(column) + line_end_);
      }
      in_vertex = in_vertex || (first == "element" && words.size() > 1 && words[1] == "vertex");
      if (!in_vertex || first != "property") {
        out.text(line);
        continue;
      }
      const std::string& name = names_[property++];
      if (name.empty()) continue;
      const auto begin = static_cast<std::size_t>(words.back().data() - line.data());
      out.text(line.substr(0, begin));
      out.text(name);
      out.text(line.substr(begin + words.back().size()));
    }
  }

  static std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
      const std::size_t stop = line.find_first_of(blanks, at);
      words.push_back(line.substr(at, stop - at));
      at = stop == std::string_view::npos ? stop : line.find_first_not_of(blanks, stop);
    }
    return words;
  }

  /// Where a property of a record ends that begins here.
  const char* end_of(const PlyProperty& property, const char* begin) const {
    const std::size_t item = size_of(property.type), width = property.is_list ? size_of(property.count_type) : 0;
    const auto left = static_cast<std::size_t>(end_ - begin);
    if (left < (property.is_list ? width : item)) fail_truncated();
    if (!property.is_list) return begin + item;
    std::uint64_t count = 0;
    for (std::size_t k = 0; k < width; ++k) // the most significant first
      count = count << 8 | static_cast<unsigned char>(begin[is_big_endian() ? k : width - 1 - k]);
    if (count > (left - width) / item) fail_truncated(); // negative counts, too, are far beyond
    return begin + width + count * item;
  }

  void step_over(const PlyElement& element) {
    for (const PlyProperty& property : element.properties)
      at_ = end_of(property, at_);
  }

  void write_records(const PlyElement& element, ByteStream& out) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % 65536 == 0) stop_if_asked();
      const char* record = at_;
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const char* next = end_of(element.properties[p], at_);
        if (!all_stay_ && !names_[p].empty()) out.bytes(at_, static_cast<std::size_t>(next - at_));
        at_ = next;
      }
      if (all_stay_) out.bytes(record, static_cast<std::size_t>(at_ - record));
      for (const PointColumn& column : columns_)
        out.put(column.value(static_cast<std::size_t>(i)), ply_type(column.type));
    }
  }

  /// The next line that has a word in it.
  std::string_view next_line() {
    while (at_ < end_) {
      const char* begin = at_;
      while (at_ < end_ && *at_ != '\n' && *at_ != '\r')
        ++at_;
      const std::string_view line(begin, static_cast<std::size_t>(at_ - begin));
      if (at_ < end_) at_ += *at_ == '\r' && at_ + 1 < end_ && at_[1] == '\n' ? 2 : 1;
      if (line.find_first_not_of(blanks) != std::string_view::npos) return line;
    }
    fail_truncated();
  }

  void write_lines(const PlyElement& element, ByteStream& out) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % 65536 == 0) stop_if_asked();
      const std::vector<std::string_view> words = words_of(next_line());
      std::size_t word = 0;
      const auto take = [&](bool stays) {
        if (word >= words.size()) fail_truncated();
        if (stays) out.text(std::string(words[word]) + " ");
        ++word;
      };
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        std::size_t items = 1;
        if (element.properties[p].is_list) {
          if (word >= words.size()) fail_truncated();
          items = item_count(words[word]);
          take(!names_[p].empty());
        }
        for (std::size_t k = 0; k < items; ++k)
          take(!names_[p].empty());
      }
      std::string values;
      for (const PointColumn& column : columns_)
        values +=
            (values.empty() ? "" : " ") + value_text(column.value(static_cast<std::size_t>(i)), ply_type(column.type));
      out.text(values + line_end_);
    }
  }

  std::size_t item_count(std::string_view word) const {
    std::size_t count = 0;
    if (word.front() == '+') word.remove_prefix(1);
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (error != std::errc() || (stop != word.data() + word.size() && *stop != '.')) fail_truncated();
    return count;
  }

  const std::string& file_;
  const std::vector<PointColumn>& columns_;
  FileBytes bytes_;
  PlyHeader header_;
  std::string line_end_;
  const char* at_ = nullptr;
  const char* end_ = nullptr;
  std::vector<std::string> names_; ///< of the vertex' properties, as they are written; empty: they go
  bool all_stay_ = true;
};

} // namespace

void write_ply_columns(const std::string& path, std::size_t count, const std::vector<PointColumn>& columns) {
  AtomicFile file(path);
  ByteStream out(file);
  out.text("ply\nformat binary_little_endian 1.0\ncomment written by pointgi\nelement vertex " + std::to_string(count) +
           "\n");
  for (const PointColumn& column : columns)
    out.text(property_line(column) + "\n");
  out.text("end_header\n");
  for (std::size_t i = 0; i < count; ++i)
    for (const PointColumn& column : columns)
      out.put(column.value(i), ply_type(column.type));
  out.flush();
  file.commit();
}

void write_ply_with_columns(const std::string& source, const std::string& output,
                            const std::vector<PointColumn>& columns,
                            const std::map<std::string, std::string>& kept_as) {
  Rewriter rewriter(source, columns);
  rewriter.choose_properties(kept_as);
  AtomicFile file(output);
  ByteStream out(file, rewriter.is_big_endian());
  rewriter.write(out);
  out.flush();
  file.commit();
}

std::vector<std::string> ply_vertex_properties(const std::string& path) {
  std::vector<std::string> names;
  const std::vector<PointColumn> none;
  const Rewriter file(path, none);
  for (const PlyProperty& property : file.vertex().properties)
    if (!property.is_list) names.push_back(property.name);
  return names;
}

} // namespace pointgi
