#include "host/measure/report.h"
#include "host/atomic_file.h"
#include "host/measure/report_page.h"
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

namespace pointgi {
namespace {

std::string base64(const std::string& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? digits[(bits >> (18 - 6 * k)) & 63] : '=';
  }
  return text;
}

/// JSON that neither ends the script element that it stands in nor opens a comment there. Outside of strings JSON has
/// none of these characters.
std::string inside_script(const std::string& json) {
  static const std::pair<std::string_view, const char*> escapes[] = {
      {"<", "\\u003c"}, {">", "\\u003e"}, {"&", "\\u0026"}, {"\u2028", "\\u2028"}, {"\u2029", "\\u2029"}};
  std::string text;
  text.reserve(json.size());
  for (std::size_t i = 0; i < json.size();) {
    const auto* escape = std::find_if(std::begin(escapes), std::end(escapes),
                                      [&](const auto& e) { return json.compare(i, e.first.size(), e.first) == 0; });
    if (escape == std::end(escapes)) {
      text += json[i++];
      continue;
    }
    text += escape->second;
    i += escape->first.size();
  }
  return text;
}

std::string written(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// The PNG files that `trade` names, as data URIs by their names; one that is the same as an earlier one, as settings
/// that change speed alone have it, as that one's name.
nlohmann::json pictures_of(const Trade& trade, const std::string& folder) {
  nlohmann::json pictures = nlohmann::json::object();
  std::map<std::string, std::string> names;
  const auto add = [&](const std::string& name) {
    if (pictures.contains(name)) return;
    std::ifstream file(std::filesystem::path(folder) / name, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    // Whatever else a damaged trade.json may name does not belong in a page that is passed on.
    if (bytes.rfind("\x89PNG\r\n", 0) != 0) return;
    const auto [first, is_new] = names.emplace(bytes, name);
    pictures[name] = is_new ? "data:image/png;base64," + base64(bytes) : first->second;
  };
  if (!trade.reference.picture.empty()) add(trade.reference.picture);
  for (const MeasuredRun& run : trade.runs)
    if (!run.picture.empty()) add(run.picture);
  return pictures;
}

nlohmann::json commands_of(const Trade& trade) {
  nlohmann::json commands = nlohmann::json::object();
  for (const MeasuredRun& run : trade.runs)
    if (run.refused.empty()) commands[run.name] = command_of(trade, run);
  return commands;
}

const std::string& page_file(const std::string& name) {
  for (const EmbeddedFile& file : report_page())
    if (file.name == name) return file.text;
  throw std::logic_error("host/measure/page has no file " + name);
}

} // namespace

void write_report(const Trade& trade, const std::string& trade_json, const std::string& folder) {
  const auto part = [&](const std::string& name) {
    if (name == "trade") return inside_script(trade_json);
    if (name == "pictures") return inside_script(written(pictures_of(trade, folder)));
    if (name == "commands") return inside_script(written(commands_of(trade)));
    return page_file(name);
  };
  // {{name}} of page.html stands for a file of the page or for one of the three above.
  const std::string& page = page_file("page.html");
  std::string text;
  std::size_t at = 0;
  for (std::size_t open; (open = page.find("{{", at)) != std::string::npos;) {
    const std::size_t close = page.find("}}", open);
    text += page.substr(at, open - at) + part(page.substr(open + 2, close - open - 2));
    at = close + 2;
  }
  text += page.substr(at);

  AtomicFile file((std::filesystem::path(folder) / report_name).string());
  file.write(text.data(), text.size());
  file.commit();
}

} // namespace pointgi
