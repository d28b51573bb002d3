#include "host/app/numbers.h"
#include "host/error.h"
#include "host/scene/limits.h"
#include <algorithm>
#include <fmt/format.h>

namespace pointgi {

std::vector<int> whole_numbers(const std::string& text, char separator, std::size_t count, const std::string& form) {
  std::vector<int> numbers;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    const std::string part = text.substr(at, end - at);
    if (part.empty() || part.size() > 9 || part.find_first_not_of("0123456789") != std::string::npos) break;
    numbers.push_back(std::stoi(part));
    at = end + 1;
  }
  if (numbers.size() != count || at <= text.size()) throw Error(ErrorKind::usage, form + ", found \"" + text + "\"");
  return numbers;
}

std::pair<int, int> size_of(const std::string& text, int least) {
  const auto most = static_cast<int>(limits::image_side.high);
  const std::string form =
      fmt::format("--size: expected WIDTHxHEIGHT of {} to {} pixels each, for example 640x480", least, most);
  const std::vector<int> size = whole_numbers(text, 'x', 2, form);
  if (std::min(size[0], size[1]) < least || std::max(size[0], size[1]) > most)
    throw Error(ErrorKind::usage, form + ", found \"" + text + "\"");
  return {size[0], size[1]};
}

} // namespace pointgi
