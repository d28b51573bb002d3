#include "host/scene/overrides.h"
#include "host/error.h"
#include "host/scene/limits.h"
#include "host/scene/scene_text.h"
#include "host/scene/toml_words.h"
#include <charconv>

namespace pointgi {
namespace {

struct Override {
  std::string origin; ///< "--set key.path=value", as errors name it
  std::vector<std::string> path;
  std::string value;
};

[[noreturn]] void refuse(const Override& set, const std::string& what) {
  // Names may be from the scene file; what was typed is told as it was.
  throw Error(ErrorKind::usage, set.origin + ": " + harmless(what));
}

std::string joined(const std::vector<std::string>& path, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i)
    text += (i > 0 ? "." : "") + path[i];
  return text;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Cuts at the first "=" outside quotes and at the dots before it.
Override split(const std::string& text) {
  Override set{"--set " + text, {}, {}};
  std::string part;
  bool quoted_part = false;
  char quote = 0;
  const auto close_part = [&] {
    if (!quoted_part) part = trimmed(part);
    if (part.empty() && !quoted_part) refuse(set, "the key path has an empty part, expected key.path=value");
    set.path.push_back(part);
    part.clear();
    quoted_part = false;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      if (c == quote)
        quote = 0;
      else
        part += c;
    } else if (c == '"' || c == '\'') {
      quote = c;
      quoted_part = true;
    } else if (c == '.' || c == '=') {
      close_part();
      if (set.path.size() > limits::nesting)
        refuse(set, "the key path has more than " + std::to_string(limits::nesting) + " parts");
      if (c == '.') continue;
      set.value = trimmed(text.substr(i + 1));
      return set;
    } else if (!quoted_part) {
      part += c;
    }
  }
  refuse(set, "has no \"=\", expected key.path=value, e.g. render.spp=64");
}

/// Parses `text` as a document whose every node remembers the --set that it came from.
toml::table parse(const std::string& text, const Override& set) {
  return toml::parse(text, set.origin);
}

toml::table parsed_value(const Override& set) {
  if (set.value.empty()) refuse(set, "has no value, expected key.path=value; an empty text is written \"\"");
  if (set.value.find('\n') != std::string::npos) refuse(set, "the value has a line break, expected one TOML value");
  try {
    check_nesting(set.value, set.origin);
    toml::table document = parse("value = " + set.value, set);
    if (document.size() == 1) return document;
  } catch (const toml::parse_error& error) {
    // A broken array, table or quoted text is a mistake; a bare word is a text without its quotes.
    if (std::string("[{\"'").find(set.value.front()) != std::string::npos)
      refuse(set, "the value is not valid TOML: " + std::string(error.description()));
  }
  toml::table document = parse("value = ''", set);
  *document.get_as<std::string>("value") = set.value;
  return document;
}

std::optional<std::size_t> as_index(const std::string& part) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc{} || end != part.data() + part.size()) return std::nullopt;
  return index;
}

/// The element of the array at path[0 .. depth) that path[depth] names.
toml::node& element(toml::array& array, const Override& set, std::size_t depth) {
  const std::string& part = set.path[depth];
  const std::string holder = joined(set.path, depth);
  std::vector<std::string> names;
  for (toml::node& node : array) {
    const toml::table* table = node.as_table();
    const auto* name = table != nullptr ? table->get_as<std::string>("name") : nullptr;
    if (name == nullptr) continue;
    if (name->get() == part) return node;
    names.push_back(name->get());
  }
  const std::optional<std::size_t> index = as_index(part);
  if (index && *index < array.size()) return array[*index];
  std::string expected =
      array.empty() ? "there is none" : "expected an index from 0 to " + std::to_string(array.size() - 1);
  if (!names.empty()) expected += " or a name" + hint(part, names, "names");
  refuse(set, holder + " has no element " + quoted(part) + ": " + expected);
}

/// Puts `value` in the place of `target`, which may be of another type: arrays and tables own their nodes, so the
/// holder does the exchange.
template <class Replace>
void exchange(toml::table&& document, Replace&& replace) {
  std::move(*document.get("value")).visit([&](auto&& node) { replace(std::forward<decltype(node)>(node)); });
}

toml::node& descend(toml::node& holder, const Override& set, std::size_t depth) {
  const std::string& part = set.path[depth];
  if (toml::array* array = holder.as_array()) return element(*array, set, depth);
  toml::table* table = holder.as_table();
  if (table == nullptr)
    refuse(set, joined(set.path, depth) + " is " + found_text(holder) + " and holds no key " + quoted(part));
  if (table->get(part) == nullptr) {
    toml::table made = parse("value = {}", set);
    table->insert(toml::key(part, made.source()), std::move(*made.get_as<toml::table>("value")));
  }
  return *table->get(part);
}

void put(toml::node& holder, const Override& set) {
  const std::string& part = set.path.back();
  const std::size_t depth = set.path.size() - 1;
  if (toml::array* array = holder.as_array()) {
    toml::node& old = element(*array, set, depth);
    std::size_t index = 0;
    while (array->get(index) != &old)
      ++index;
    exchange(parsed_value(set), [&](auto&& node) {
      array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(index), std::forward<decltype(node)>(node));
    });
    return;
  }
  toml::table* table = holder.as_table();
  if (table == nullptr)
    refuse(set, joined(set.path, depth) + " is " + found_text(holder) + " and holds no key " + quoted(part));
  toml::table document = parsed_value(set);
  const toml::key key(part, document.source()); // the key, too, is reported as the --set
  table->erase(part);
  exchange(std::move(document), [&](auto&& node) { table->insert(key, std::forward<decltype(node)>(node)); });
}

} // namespace

void apply_overrides(toml::table& scene, const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides) {
    const Override set = split(text);
    toml::node* holder = &scene;
    for (std::size_t depth = 0; depth + 1 < set.path.size(); ++depth)
      holder = &descend(*holder, set, depth);
    put(*holder, set);
  }
}

} // namespace pointgi
