#include "host/cl/kernel_source.h"
#include "host/cache/binary_cache.h"
#include "host/cl/embedded_kernels.h"
#include "host/error.h"
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <vector>

namespace pointgi {

namespace {

std::string read_kernel_file(const std::string& name, const std::string& included_by) {
  if (const char* folder = std::getenv("POINTGI_KERNEL_DIR"); folder != nullptr && *folder != '\0') {
    std::ifstream file(std::string(folder) + "/" + name);
    if (!file)
      throw Error(ErrorKind::usage, "POINTGI_KERNEL_DIR=" + std::string(folder) + ": no file " + name + included_by +
                                        "; point it at a folder like the project's kernels/, or unset it");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  for (const EmbeddedFile& file : embedded_kernels())
    if (file.name == name) return file.text;
  throw Error(ErrorKind::internal, "no embedded kernel file " + name + included_by);
}

/// The name in `#include "name"`, or empty.
std::string included_name(const std::string& line) {
  const std::string start = "#include \"";
  if (line.compare(0, start.size(), start) != 0) return {};
  return line.substr(start.size(), line.find('"', start.size()) - start.size());
}

/// The conditionals around a line, outermost first, each by a number of its own; a branch is another conditional.
class Conditionals {
public:
  /// A header's own guard does not count.
  void read(const std::string& line) {
    const std::size_t at = line.find_first_not_of(' ');
    if (at == std::string::npos || line[at] != '#') return;
    const std::string word = line.substr(std::min(line.find_first_not_of(' ', at + 1), line.size()));
    const auto begins = [&](const char* with) { return word.rfind(with, 0) == 0; };
    if (begins("if")) {
      around_.push_back(line.rfind("#ifndef POINTGI_", 0) == 0 ? 0 : ++last_);
    } else if (begins("el") && !around_.empty()) {
      around_.back() = ++last_;
    } else if (begins("endif") && !around_.empty()) {
      around_.pop_back();
    }
  }

  std::vector<int> here() const {
    std::vector<int> counted;
    std::copy_if(around_.begin(), around_.end(), std::back_inserter(counted), [](int number) { return number != 0; });
    return counted;
  }

private:
  std::vector<int> around_; ///< 0: a guard
  int last_ = 0;
};

/// Writes files one behind another, each once.
class Flattener {
public:
  void append(const std::string& name, const std::string& included_by) {
    const std::vector<int> here = conditionals_.here();
    const auto [known, is_new] = written_in_.emplace(name, here);
    if (!is_new) {
      // Where a conditional of the first place is false and those of this place are true, the file would be missing.
      const std::vector<int>& first = known->second;
      if (first.size() > here.size() || !std::equal(first.begin(), first.end(), here.begin()))
        throw Error(ErrorKind::internal, "kernels/" + name + included_by +
                                             " was included inside another conditional before; include it outside, "
                                             "before both");
      return;
    }
    const std::string text = read_kernel_file(name, included_by);
    out += "#line 1 \"kernels/" + name + "\"\n";
    // No std::getline: where memory ends it ends the file, as at its last line, and what is left of it may compile.
    for (std::size_t begin = 0, number = 1; begin < text.size(); ++number) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::string line = text.substr(begin, end - begin);
      begin = end + 1;
      conditionals_.read(line);
      const std::string included = included_name(line);
      if (included.empty()) {
        out += line + "\n";
        continue;
      }
      append(included, " (included by " + name + ":" + std::to_string(number) + ")");
      out += "#line " + std::to_string(number + 1) + " \"kernels/" + name + "\"\n";
    }
  }

  std::string out;

private:
  Conditionals conditionals_;
  std::map<std::string, std::vector<int>> written_in_;
};

} // namespace

std::string kernel_file(const std::string& name) {
  return read_kernel_file(name, "");
}

std::string kernel_source(const std::string& file) {
  Flattener flattener;
  flattener.append(file, "");
  return std::move(flattener.out);
}

std::uint64_t kernels_hash() {
  std::uint64_t hash = fnv1a("kernels");
  for (const EmbeddedFile& file : embedded_kernels())
    hash = fnv1a(kernel_file(file.name), hash);
  return hash;
}

} // namespace pointgi
