#include "host/measure/moves.h"
#include <algorithm>

namespace pointgi {

namespace {

constexpr const char* no_method = "none"; ///< of the exchange

std::string key_of(const std::string& text) {
  return text.substr(0, text.find('='));
}

std::string value_of(const std::string& text) {
  return text.substr(text.find('=') + 1);
}

bool has(const Overrides& overrides, const std::string& text) {
  return std::find(overrides.begin(), overrides.end(), text) != overrides.end();
}

template <typename Which>
void remove_if(Overrides& overrides, const Which& which) {
  overrides.erase(std::remove_if(overrides.begin(), overrides.end(), which), overrides.end());
}

bool is_of(const Knob& knob, const std::string& key) {
  return std::any_of(knob.values.begin(), knob.values.end(), [&](const KnobValue& value) {
    return std::any_of(value.overrides.begin(), value.overrides.end(),
                       [&](const std::string& text) { return key_of(text) == key; });
  });
}

} // namespace

std::string method_of(const Overrides& overrides, const std::string& otherwise) {
  for (const std::string& text : overrides)
    if (key_of(text) == method_key) return value_of(text);
  return otherwise;
}

Overrides with_value(const Overrides& overrides, const Knob& knob, const KnobValue& value,
                     const std::vector<Knob>& knobs, const std::string& method) {
  Overrides result = overrides;
  remove_if(result, [&](const std::string& text) {
    const std::string key = key_of(text);
    return is_of(knob, key) && (key != method_key || knob.key == method_key || !value.own);
  });
  if (!value.own) result.insert(result.end(), value.overrides.begin(), value.overrides.end());
  const std::string now = method_of(result, method);
  for (const Knob& other : knobs)
    if ((!other.method.empty() && other.method != now) || (other.of_exchange && now == no_method))
      remove_if(result, [&](const std::string& text) {
        const std::string key = key_of(text);
        return key != method_key && is_of(other, key) && !has(value.overrides, text);
      });
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

bool goes_with(const Overrides& overrides, const Knob& knob, const KnobValue& value, const std::string& method) {
  if (knob.key == method_key) return true;
  if (knob.of_exchange && method_of(overrides, method) == no_method) return false;
  const std::string asked = method_of(value.overrides, knob.method);
  return asked.empty() || asked == method_of(overrides, method);
}

std::optional<std::size_t> value_in(const Overrides& overrides, const Knob& knob) {
  const bool says = std::any_of(overrides.begin(), overrides.end(), [&](const std::string& text) {
    return key_of(text) != method_key ? is_of(knob, key_of(text)) : knob.key == method_key;
  });
  for (std::size_t i = 0; i < knob.values.size(); ++i) {
    const KnobValue& value = knob.values[i];
    if (says ? std::all_of(value.overrides.begin(), value.overrides.end(),
                           [&](const std::string& text) { return has(overrides, text); })
             : value.in_scene)
      return i;
  }
  return std::nullopt;
}

Overrides cheapest(const std::vector<Knob>& knobs, const std::string& method) {
  Overrides result;
  for (const Knob& knob : knobs) {
    if (!knob.falls || knob.values.empty() || knob.is_of_several_keys || knob.key == samples_key) continue;
    if (!is_number(knob.values.front().text)) continue; // another way, not less of the same
    if (!knob.method.empty() && knob.method != method) continue;
    if (knob.of_exchange && method == no_method) continue;
    result = with_value(result, knob, knob.values.front(), knobs, method);
  }
  return result;
}

std::string name_about(const Overrides& overrides, const Overrides& start, const std::string& start_name,
                       const std::vector<Knob>& knobs, const std::string& method) {
  const std::string now = method_of(overrides, method);
  const auto is_of_another_method = [&](const std::string& key) {
    return key != method_key && std::any_of(knobs.begin(), knobs.end(), [&](const Knob& knob) {
             const bool is_read =
                 (knob.method.empty() || knob.method == now) && !(knob.of_exchange && now == no_method);
             return !is_read && is_of(knob, key);
           });
  };
  const auto has_key = [&](const std::string& key) {
    return std::any_of(overrides.begin(), overrides.end(),
                       [&](const std::string& text) { return key_of(text) == key; });
  };
  /// What the scene has for a key, as an override says it; empty: it is not one of the knobs' values.
  const auto own_of = [&](const std::string& key) {
    for (const Knob& knob : knobs)
      for (const KnobValue& value : knob.values)
        if (knob.key == key && value.in_scene) return key + "=" + value.text;
    return std::string();
  };
  Overrides besides;
  for (const std::string& text : start) {
    const std::string key = key_of(text);
    if (has_key(key) || is_of_another_method(key)) continue;
    if (own_of(key).empty()) return name_of_overrides(overrides);
    besides.push_back(own_of(key));
  }
  for (const std::string& text : overrides)
    if (!has(start, text)) besides.push_back(text);
  const std::string plain = name_of_overrides(overrides);
  if (start.empty() || besides.empty()) return plain;
  const std::string about = start_name + "_" + name_of_overrides(besides);
  return about.size() < plain.size() ? about : plain;
}

std::string name_of_overrides(const Overrides& overrides) {
  std::string name;
  for (const std::string& text : overrides) {
    const std::string key = key_of(text);
    name += (name.empty() ? "" : "_") + key.substr(key.rfind('.') + 1) + "-" + value_of(text);
  }
  return name;
}

} // namespace pointgi
