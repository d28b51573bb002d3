#pragma once
/// A checked view of one table of a scene file. Every refusal is an Error(input) of the form
/// `scene.toml:12:3: render.spp: expected an integer from 1 to 65536, found "many"`.
#include "host/error.h"
#include "host/scene/limits.h"
#include "host/scene/scene.h"
#include "host/scene/toml_words.h"
#include <optional>
#include <string>
#include <vector>

namespace pointgi {

/// The keys that one `type = "..."` of a table has beyond the common ones.
struct TypedKeys {
  std::string type;
  std::vector<std::string> keys;
};

/// Borrows the table and the file's name: both outlive it.
class TableReader {
public:
  /// `path` is the table's key path, as --set takes it ("render", "material.glass", "cloud.0"; "" is the root).
  TableReader(const toml::table& table, const std::string& file, std::string path)
      : table_(&table), file_(&file), path_(std::move(path)) {}

  void rename(std::string path) { path_ = std::move(path); }

  /// Refuses every key that is not among `keys`, with the nearest of them.
  void allow_only(const std::vector<std::string>& keys) const;

  /// Reads `type`, then refuses keys of no type (the nearest known is named) and keys of another type (it is named).
  std::string typed(const std::vector<std::string>& common, const std::vector<TypedKeys>& types) const;

  std::vector<std::string> keys() const; ///< in the order of their names
  bool has(const char* key) const { return table_->get(key) != nullptr; }
  const toml::node* find(const char* key) const { return table_->get(key); }
  SourcePlace place() const;                ///< of the table
  SourcePlace place(const char* key) const; ///< of the key's value; of the table when the key is absent

  // Absent keys give nothing; present ones are checked. No number is ever NaN or infinite.
  std::optional<long long> integer(const char* key, limits::IntegerRange range) const;
  std::optional<double> number(const char* key, const limits::NumberRange& range) const;
  std::optional<Vector3d> vector3(const char* key, const limits::NumberRange& range) const;
  std::optional<std::vector<double>> numbers(const char* key, const limits::NumberRange& range) const; ///< one or more
  std::optional<bool> boolean(const char* key) const;
  std::optional<std::string> text(const char* key) const;                                          ///< not empty
  std::optional<std::vector<std::string>> texts(const char* key, std::size_t count) const;         ///< not empty
  std::optional<std::string> choice(const char* key, const std::vector<std::string>& words) const; ///< one of `words`

  // Absent keys are refused.
  double need_number(const char* key, const limits::NumberRange& range) const;
  Vector3d need_vector3(const char* key, const limits::NumberRange& range) const;
  std::string need_text(const char* key, const char* what) const;

  std::optional<TableReader> table(const char* key) const; ///< [key]
  std::vector<TableReader> tables(const char* key) const;  ///< [[key]], with paths "key.0", "key.1", ...
  /// The same where they are written as a value: key = { … }. `example` shows it in the error.
  std::optional<TableReader> inline_table(const char* key, const char* example) const;

  /// Throws Error(input) "place of the key's value: path.key: what".
  [[noreturn]] void fail(const char* key, const std::string& what) const;
  /// Throws Error(input) "place of the table: path: what".
  [[noreturn]] void fail(const std::string& what) const;

private:
  std::string path_to(std::string_view key) const;
  [[noreturn]] void unexpected(const char* key, const std::string& expected) const;
  [[noreturn]] void missing(const char* key, const std::string& expected) const;
  [[noreturn]] void refuse_key(const toml::key& key, const std::string& what) const;

  const toml::table* table_;
  const std::string* file_;
  std::string path_;
};

} // namespace pointgi
