#include "host/scene/toml_reader.h"
#include "host/scene/nearest.h"
#include <algorithm>
#include <cmath>
#include <iterator>

namespace pointgi {
namespace {

bool contains(const std::vector<std::string>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool inside(double value, const limits::NumberRange& range) {
  if (!std::isfinite(value)) return false;
  return (range.open_low ? value > range.low : value >= range.low) &&
         (range.open_high ? value < range.high : value <= range.high);
}

/// Integers are numbers too: `scale = 10`.
std::optional<double> as_number(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
  return std::nullopt;
}

/// What a user of another format would look for, and what to do instead.
std::string habit_hint(std::string_view key) {
  if (key == "include" || key == "import")
    return "; a scene cannot include another file: list every cloud, shape and light in this one";
  return {};
}

/// How a whole number is written that stands there as a float: `photons = 1e6`.
std::string as_integer_hint(const toml::node& node, limits::IntegerRange range) {
  const auto* number = node.as_floating_point();
  if (number == nullptr) return {};
  const double value = number->get();
  const bool fits =
      value == std::trunc(value) && value >= static_cast<double>(range.low) && value <= static_cast<double>(range.high);
  return fits ? "; write " + std::to_string(static_cast<long long>(value)) : std::string();
}

} // namespace

std::string TableReader::path_to(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

SourcePlace TableReader::place() const {
  return place_of(table_->source(), *file_);
}

SourcePlace TableReader::place(const char* key) const {
  const toml::node* node = table_->get(key);
  return node != nullptr ? place_of(node->source(), *file_) : place();
}

std::vector<std::string> TableReader::keys() const {
  std::vector<std::string> keys;
  for (auto&& [key, node] : *table_)
    keys.emplace_back(key.str());
  return keys;
}

void TableReader::fail(const char* key, const std::string& what) const {
  throw Error(ErrorKind::input, harmless(place(key).text() + ": " + path_to(key) + ": " + what));
}

void TableReader::fail(const std::string& what) const {
  throw Error(ErrorKind::input, harmless(place().text() + ": " + (path_.empty() ? "" : path_ + ": ") + what));
}

void TableReader::unexpected(const char* key, const std::string& expected) const {
  fail(key, "expected " + expected + ", found " + found_text(*table_->get(key)));
}

void TableReader::missing(const char* key, const std::string& expected) const {
  fail(key, "missing, expected " + expected);
}

void TableReader::refuse_key(const toml::key& key, const std::string& what) const {
  throw Error(ErrorKind::input,
              harmless(place_of(key.source(), *file_).text() + ": " + path_to(key.str()) + ": " + what));
}

void TableReader::allow_only(const std::vector<std::string>& keys) const {
  for (auto&& [key, node] : *table_) {
    if (contains(keys, key.str())) continue;
    const std::string habit = habit_hint(key.str());
    if (!habit.empty()) refuse_key(key, "unknown key" + habit);
    // A key that stands there already was not meant a second time: "edge_w" beside edge_u is edge_v.
    std::vector<std::string> unused;
    std::copy_if(keys.begin(), keys.end(), std::back_inserter(unused), [&](auto& k) { return !has(k.c_str()); });
    const std::string word(key.str());
    refuse_key(key, "unknown key" + hint(word, nearest(word, unused).empty() ? keys : unused, "keys"));
  }
}

std::string TableReader::typed(const std::vector<std::string>& common, const std::vector<TypedKeys>& types) const {
  // Lists for error texts are made only when there is an error: a million lights pass through here.
  const toml::node* node = table_->get("type");
  const auto* found = node != nullptr ? node->as_string() : nullptr;
  const auto own_type = std::find_if(types.begin(), types.end(),
                                     [&](auto& entry) { return found != nullptr && entry.type == found->get(); });
  if (own_type == types.end()) {
    std::vector<std::string> names;
    for (const TypedKeys& entry : types)
      names.push_back(entry.type);
    choice("type", names);
    missing("type", any_of(names));
  }
  const TypedKeys& own = *own_type;

  const auto is_own = [&](std::string_view key) {
    return key == "type" || contains(common, key) || contains(own.keys, key);
  };
  const auto stranger =
      std::find_if(table_->begin(), table_->end(), [&](const auto& entry) { return !is_own(entry.first.str()); });
  if (stranger == table_->end()) return own.type;

  const toml::key& key = stranger->first;
  std::vector<std::string> keys{"type"};
  keys.insert(keys.end(), common.begin(), common.end());
  keys.insert(keys.end(), own.keys.begin(), own.keys.end());
  std::vector<std::string> others;
  for (const TypedKeys& entry : types)
    if (contains(entry.keys, key.str())) others.push_back(entry.type);
  if (others.empty()) allow_only(keys);
  std::string list;
  for (const std::string& name : keys)
    list += (list.empty() ? "" : ", ") + name;
  refuse_key(key, "belongs to type " + any_of(others) + ", but this is of type " + quoted(own.type) +
                      "; known keys: " + list);
}

std::optional<long long> TableReader::integer(const char* key, limits::IntegerRange range) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  const auto* integer = node->as_integer();
  if (integer == nullptr || integer->get() < range.low || integer->get() > range.high)
    fail(key, "expected an integer from " + std::to_string(range.low) + " to " + std::to_string(range.high) +
                  ", found " + found_text(*node) + as_integer_hint(*node, range));
  return integer->get();
}

std::optional<double> TableReader::number(const char* key, const limits::NumberRange& range) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  const std::optional<double> value = as_number(*node);
  if (!value || !inside(*value, range)) unexpected(key, std::string("a number ") + range.words);
  return value;
}

std::optional<Vector3d> TableReader::vector3(const char* key, const limits::NumberRange& range) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  bool right = array != nullptr && array->size() == 3;
  Vector3d vector;
  for (int axis = 0; right && axis < 3; ++axis) {
    const std::optional<double> value = as_number((*array)[static_cast<std::size_t>(axis)]);
    right = value && inside(*value, range);
    vector[axis] = value.value_or(0.0);
  }
  if (!right) unexpected(key, std::string("three numbers ") + range.words);
  return vector;
}

std::optional<std::vector<double>> TableReader::numbers(const char* key, const limits::NumberRange& range) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  std::vector<double> values;
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i)
    if (const std::optional<double> value = as_number((*array)[i]); value && inside(*value, range))
      values.push_back(*value);
  if (array == nullptr || values.empty() || values.size() != array->size())
    unexpected(key, std::string("one number or more ") + range.words);
  return values;
}

std::optional<bool> TableReader::boolean(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  const auto* truth = node->as_boolean();
  if (truth == nullptr) unexpected(key, "true or false");
  return truth->get();
}

std::optional<std::string> TableReader::text(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  const auto* value = node->as_string();
  if (value == nullptr || value->get().empty()) unexpected(key, "a text that is not empty");
  // A NUL would cut the name short for the operating system: another file than the one named would be opened.
  if (value->get().find('\0') != std::string::npos) unexpected(key, "a text without NUL characters");
  return value->get();
}

std::optional<std::vector<std::string>> TableReader::texts(const char* key, std::size_t count) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  std::vector<std::string> values;
  if (const toml::array* array = node->as_array())
    for (const toml::node& element : *array)
      if (const auto* value = element.as_string(); value != nullptr && !value->get().empty())
        values.push_back(value->get());
  if (values.size() != count || node->as_array()->size() != count)
    unexpected(key, std::to_string(count) + " texts that are not empty");
  return values;
}

std::optional<std::string> TableReader::choice(const char* key, const std::vector<std::string>& words) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  const auto* value = node->as_string();
  if (value == nullptr) unexpected(key, any_of(words));
  if (!contains(words, value->get())) {
    const std::string near = nearest(value->get(), words);
    fail(key, "expected " + any_of(words) + ", found " + found_text(*node) +
                  (near.empty() ? "" : "; did you mean " + quoted(near) + "?"));
  }
  return value->get();
}

double TableReader::need_number(const char* key, const limits::NumberRange& range) const {
  if (!has(key)) missing(key, std::string("a number ") + range.words);
  return *number(key, range);
}

Vector3d TableReader::need_vector3(const char* key, const limits::NumberRange& range) const {
  if (!has(key)) missing(key, std::string("three numbers ") + range.words);
  return *vector3(key, range);
}

std::string TableReader::need_text(const char* key, const char* what) const {
  if (!has(key)) missing(key, what);
  return *text(key);
}

std::optional<TableReader> TableReader::inline_table(const char* key, const char* example) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) unexpected(key, std::string("a table, ") + example);
  return TableReader(*node->as_table(), *file_, path_to(key));
}

std::optional<TableReader> TableReader::table(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) unexpected(key, std::string("one table, written [") + key + "]");
  return TableReader(*node->as_table(), *file_, path_to(key));
}

std::vector<TableReader> TableReader::tables(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return {};
  const std::string expected = std::string("tables, each written [[") + key + "]]";
  const toml::array* array = node->as_array();
  if (array == nullptr) unexpected(key, expected);
  std::vector<TableReader> readers;
  readers.reserve(array->size());
  for (const toml::node& element : *array) {
    if (!element.is_table()) unexpected(key, expected);
    readers.emplace_back(*element.as_table(), *file_, path_to(key) + "." + std::to_string(readers.size()));
  }
  return readers;
}

} // namespace pointgi
