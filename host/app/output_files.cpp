#include "host/app/output_files.h"
#include "host/atomic_file.h"
#include "host/error.h"
#include "host/scene/input_files.h"
#include <filesystem>

namespace pointgi {

namespace {

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(a, ignored) == std::filesystem::weakly_canonical(b, ignored) ||
         std::filesystem::equivalent(a, b, ignored);
}

} // namespace

void require_outputs(const std::string& input, const Scene& scene, const std::vector<OutputFile>& outputs) {
  std::vector<std::string> inputs{input};
  for (const std::string& file : input_files(scene))
    inputs.push_back(file);
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    if (output->file.empty()) continue;
    for (const std::string& in : inputs)
      if (same_file(in, output->file))
        throw Error(ErrorKind::usage,
                    output->by_default
                        ? output->file + " would be written, but is an input, which would be lost; name another with " +
                              output->option
                        : std::string(output->option) + ": " + output->file +
                              " is an input, which would be lost; choose another name");
    for (auto other = outputs.begin(); other != output; ++other)
      if (!other->file.empty() && same_file(other->file, output->file))
        throw Error(ErrorKind::usage, std::string(output->option) + ": " + output->file + " is what " + other->option +
                                          " writes, too; choose another name");
    const AtomicFile probe(output->file);
  }
}

} // namespace pointgi
