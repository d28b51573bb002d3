#include "host/cl/kernel_source.h"
#include "host/cl/embedded_kernels.h"
#include "host/error.h"
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

namespace pointgi {

namespace {

std::string read_kernel_file(const std::string& name, const std::string& included_by) {
  if (const char* folder = std::getenv("POINTGI_KERNEL_DIR"); folder != nullptr && *folder != '\0') {
    std::ifstream file(std::string(folder) + "/" + name);
    if (!file)
      throw Error(ErrorKind::usage, "POINTGI_KERNEL_DIR=" + std::string(folder) + ": no file " + name + included_by +
                                        "; point it at a folder like the project's kernels/, or unset it");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
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

void append(const std::string& name, const std::string& included_by, std::set<std::string>& done, std::string& out) {
  if (!done.insert(name).second) return;
  std::istringstream lines(read_kernel_file(name, included_by));
  out += "#line 1 \"kernels/" + name + "\"\n";
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string included = included_name(line);
    if (included.empty()) {
      out += line + "\n";
      continue;
    }
    append(included, " (included by " + name + ":" + std::to_string(number) + ")", done, out);
    out += "#line " + std::to_string(number + 1) + " \"kernels/" + name + "\"\n";
  }
}

} // namespace

std::string kernel_file(const std::string& name) {
  return read_kernel_file(name, "");
}

std::string kernel_source(const std::string& file) {
  std::set<std::string> done;
  std::string out;
  append(file, "", done, out);
  return out;
}

} // namespace pointgi
