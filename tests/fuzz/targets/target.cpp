#include "tests/fuzz/targets/target.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <omp.h>
#include <sanitizer/allocator_interface.h>
#include <stdexcept>
#include <unistd.h>

namespace pointgi::test {

namespace {

namespace fs = std::filesystem;

std::size_t taken = 0, peak = 0;

void note_malloc(const volatile void*, std::size_t bytes) {
  taken += bytes;
  peak = std::max(peak, taken);
}

void note_free(const volatile void* block) {
  // What was taken before the hooks were there is not counted.
  taken -= std::min(taken, __sanitizer_get_allocated_size(const_cast<const void*>(block)));
}

std::string made_folder() {
  std::error_code missing;
  const char* wanted = std::getenv("TMPDIR");
  const fs::path memory = "/dev/shm";
  const fs::path parent = wanted != nullptr ? fs::path(wanted)
                          : fs::is_directory(memory, missing) && access(memory.c_str(), W_OK) == 0
                              ? memory
                              : fs::temp_directory_path();
  std::string name = (parent / "pointgi_fuzz_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder " + name);
  return name;
}

struct Folder {
  std::string path = made_folder();
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

} // namespace

void require_kept(const std::string& broken) {
  if (broken.empty()) return;
  std::fprintf(stderr, "broken promise: %s\n", broken.c_str());
  std::abort();
}

const std::string& scratch_folder() {
  static const Folder folder;
  return folder.path;
}

std::string write_input(const std::string& name, std::string_view bytes) {
  const std::string path = scratch_folder() + "/" + name;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  const bool written = file != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  if (file == nullptr || std::fclose(file) != 0 || !written) {
    std::fprintf(stderr, "%s: cannot be written; is the disk full?\n", path.c_str());
    std::_Exit(1); // no finding
  }
  return path;
}

std::size_t peak_bytes() {
  return peak;
}
std::size_t allocated_bytes() {
  return taken;
}
void reset_peak() {
  peak = taken;
}

} // namespace pointgi::test

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  using namespace pointgi::test;
  // Each input is small, and what takes one thread is told from run to run.
  omp_set_num_threads(1);
  setenv("POINTGI_CACHE_DIR", (scratch_folder() + "/cache").c_str(), 1);
  __sanitizer_install_malloc_and_free_hooks(note_malloc, note_free);
  return 0;
}
