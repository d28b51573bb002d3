#include "host/cloud/readers/ply_binary.h"
#include "host/cloud/readers/record_pieces.h"
#include "host/cloud/readers/record_values.h"
#include <algorithm>

namespace pointgi {

namespace {

constexpr std::size_t window_bytes = std::size_t{4} << 20;

bool has_lists(const PlyElement& element) {
  return std::any_of(element.properties.begin(), element.properties.end(),
                     [](const PlyProperty& property) { return property.is_list; });
}

/// Where in a record the values are that somebody reads.
struct ReadValue {
  std::size_t offset;
  FieldType type;
  std::size_t field;
};

std::vector<ReadValue> values_of(const PlyElement& vertex, const FieldPlan& plan) {
  std::vector<ReadValue> values;
  std::size_t offset = 0;
  for (std::size_t f = 0; f < vertex.properties.size(); ++f) {
    if (plan.is_read(f)) values.push_back({offset, plan.fields[f].type, f});
    offset += size_of(vertex.properties[f].type);
  }
  return values;
}

} // namespace

double ply_value(const char* bytes, FieldType type, bool swap) {
  if (!swap) return value_at(bytes, type);
  char turned[sizeof(double)];
  std::reverse_copy(bytes, bytes + size_of(type), turned);
  return value_at(turned, type);
}

PlyBinaryBody::PlyBinaryBody(const PlyHeader& header, const InputFile& file)
    : file_(file), swap_(header.format == PlyFormat::binary_big_endian), window_(new char[window_bytes]),
      window_begin_(header.body_offset), at_(window_.get()), end_(at_) {}

void PlyBinaryBody::go_to(std::uint64_t position) {
  window_begin_ = position;
  at_ = end_ = window_.get();
}

void PlyBinaryBody::move_window(std::size_t bytes) {
  if (left() < bytes) fail("the file ends within a value; it is truncated");
  go_to(position());
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(window_bytes, left()));
  file_.read(window_begin_, window_.get(), size);
  end_ = at_ + size;
}

std::size_t PlyBinaryBody::list_count(const PlyProperty& list) {
  const std::uint64_t place = position();
  const double count = scalar(list.count_type);
  const auto fits = static_cast<double>(left() / size_of(list.type));
  if (count < 0 || count > fits)
    fail_at(place, "the list " + quoted_bytes(list.name) + " announces " +
                       std::to_string(static_cast<long long>(count)) + " items, expected 0 to " +
                       std::to_string(static_cast<long long>(fits)) +
                       ", which the rest of the file can hold; the file is truncated or corrupt");
  return static_cast<std::size_t>(count);
}

void PlyBinaryBody::skip(FieldType type, std::size_t items) {
  if (items > left() / size_of(type)) fail("the file ends within a value; it is truncated");
  const std::uint64_t bytes = static_cast<std::uint64_t>(items) * size_of(type);
  if (bytes <= static_cast<std::uint64_t>(end_ - at_))
    at_ += bytes;
  else
    go_to(position() + bytes);
}

std::uint64_t PlyBinaryBody::size_of_records(const PlyElement& element) {
  if (has_lists(element)) return 0;
  std::uint64_t record = 0;
  for (const PlyProperty& property : element.properties)
    record += size_of(property.type);
  if (record > 0 && element.count > left() / record) {
    begin_record(element, left() / record);
    fail_at(position() + index_ * record, "the file ends within a value; it is truncated");
  }
  return element.count * record;
}

bool PlyBinaryBody::skip_element(const PlyElement& element) {
  if (has_lists(element)) return false;
  go_to(position() + size_of_records(element));
  return true;
}

bool PlyBinaryBody::read_points(const PlyElement& vertex, const FieldPlan& plan, PointSink& sink) {
  if (has_lists(vertex)) return false;
  const std::uint64_t bytes = size_of_records(vertex);
  const auto record = static_cast<std::size_t>(bytes / vertex.count);
  const std::vector<ReadValue> values = values_of(vertex, plan);
  for_each_piece(file_, position(), record, static_cast<std::size_t>(vertex.count),
                 [&](std::size_t first, std::size_t end, const char* piece) {
                   std::vector<double> row(plan.fields.size());
                   for (std::size_t i = first; i < end; ++i, piece += record) {
                     for (const ReadValue& value : values)
                       row[value.field] = ply_value(piece + value.offset, value.type, swap_);
                     sink.put(i, row.data());
                   }
                 });
  go_to(position() + bytes);
  return true;
}

std::string PlyBinaryBody::trailing() const {
  if (left() == 0) return "";
  return std::to_string(left()) + " bytes from byte " + std::to_string(position()) + " on";
}

void PlyBinaryBody::fail_at(std::uint64_t byte, const std::string& what) const {
  throw Error(ErrorKind::input, file_.path() + ": byte " + std::to_string(byte) + " (" + printable(element_->name) +
                                    " " + std::to_string(index_) + " of " + std::to_string(element_->count) +
                                    "): " + what);
}

} // namespace pointgi
