#include "host/denoise/oidn_library.h"
#include "host/error.h"
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <elf.h>
#include <filesystem>
#include <fstream>
#include <link.h>

namespace pointgi {

namespace {

namespace fs = std::filesystem;

const char* const usual_names[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so"};
const char remedy[] =
    "; run `pip install pyoidn` and set POINTGI_OIDN to the folder pyoidn/oidn/lib of that package, or "
    "to where Open Image Denoise 2 is installed";

Error unusable(const std::string& what) {
  return Error(ErrorKind::usage, "--denoise: " + what + remedy);
}

/// Its file names in a folder: those of everyone, then full versions, the newest first.
std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> files, versions;
  std::error_code ignored;
  for (const char* name : usual_names)
    if (fs::exists(folder / name, ignored)) files.push_back(folder / name);
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().filename().string().rfind("libOpenImageDenoise.so.2.", 0) == 0) versions.push_back(entry.path());
  std::sort(versions.rbegin(), versions.rend());
  files.insert(files.end(), versions.begin(), versions.end());
  return files;
}

template <typename Function>
void find(void* library, const char* name, Function& function, std::string& missing) {
  void* const at = dlsym(library, name);
  if (at == nullptr) missing += (missing.empty() ? "" : ", ") + std::string(name);
  std::memcpy(&function, &at, sizeof at); // POSIX has them of one size
}

OidnFunctions functions_of(void* library, const std::string& file) {
  OidnFunctions f{};
  std::string missing;
  find(library, "oidnNewDevice", f.new_device, missing);
  find(library, "oidnSetDeviceInt", f.set_device_int, missing);
  find(library, "oidnSetDeviceBool", f.set_device_bool, missing);
  find(library, "oidnGetDeviceInt", f.get_device_int, missing);
  find(library, "oidnGetDeviceError", f.get_device_error, missing);
  find(library, "oidnCommitDevice", f.commit_device, missing);
  find(library, "oidnReleaseDevice", f.release_device, missing);
  find(library, "oidnNewFilter", f.new_filter, missing);
  find(library, "oidnSetSharedFilterImage", f.set_filter_image, missing);
  find(library, "oidnSetFilterBool", f.set_filter_bool, missing);
  find(library, "oidnCommitFilter", f.commit_filter, missing);
  find(library, "oidnExecuteFilter", f.execute_filter, missing);
  find(library, "oidnReleaseFilter", f.release_filter, missing);
  if (missing.empty()) return f;
  if (dlsym(library, "oidnSetDevice1i") != nullptr)
    throw unusable(file + " is of Open Image Denoise 1, which is too old: version 2 is needed");
  throw unusable(file + " lacks functions of Open Image Denoise 2: " + missing);
}

/// The loader's own message where a library is not found in its usual places names the library, and not another that it
/// needs.
bool is_not_found(const std::string& message, const std::string& name) {
  return message.rfind(name + ": cannot open shared object file: No such file", 0) == 0;
}

/// As the program is.
bool is_for_this_machine(const ElfW(Ehdr) & library) {
  std::ifstream in("/proc/self/exe", std::ios::binary);
  ElfW(Ehdr) own;
  if (!in.read(reinterpret_cast<char*>(&own), sizeof own)) return true; // the loader will say
  return library.e_ident[EI_CLASS] == own.e_ident[EI_CLASS] && library.e_ident[EI_DATA] == own.e_ident[EI_DATA] &&
         library.e_machine == own.e_machine;
}

std::string path_of(void* library, const std::string& name) {
  const link_map* map = nullptr;
  if (dlinfo(library, RTLD_DI_LINKMAP, &map) != 0 || map == nullptr || *map->l_name == '\0') return name;
  return map->l_name;
}

} // namespace

std::vector<std::string> oidn_candidates(const char* named) {
  if (named == nullptr || *named == '\0') return {std::begin(usual_names), std::end(usual_names)};
  std::error_code ignored;
  if (!fs::exists(named, ignored)) throw unusable(std::string("POINTGI_OIDN names ") + named + ", which is not there");
  if (!fs::is_directory(named, ignored)) return {fs::absolute(named).string()}; // a bare name is no file to the loader
  std::vector<std::string> files = files_in(fs::absolute(named));
  if (files.empty())
    throw unusable(std::string("POINTGI_OIDN names the folder ") + named + ", in which there is no " + usual_names[0]);
  return files;
}

std::string why_not_loadable(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(file, failed);
  if (!in || failed) return "cannot be read";
  ElfW(Ehdr) header;
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header) || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0)
    return "is no library";
  if (!is_for_this_machine(header)) return "is a library for another kind of machine";
  if (header.e_type != ET_DYN || header.e_phentsize != sizeof(ElfW(Phdr))) return "is no library";
  for (std::uint64_t i = 0; i < header.e_phnum; ++i) {
    ElfW(Phdr) part;
    in.seekg(static_cast<std::streamoff>(header.e_phoff + i * sizeof part));
    if (!in.read(reinterpret_cast<char*>(&part), sizeof part)) return "is damaged: it ends too early";
    if (part.p_type == PT_LOAD && (part.p_offset > size || part.p_filesz > size - part.p_offset))
      return "is damaged: it ends too early";
  }
  return {};
}

OidnLibrary load_oidn() {
  const char* const named = std::getenv("POINTGI_OIDN");
  const std::vector<std::string> candidates = oidn_candidates(named);
  for (const std::string& name : candidates) {
    if (name[0] == '/')
      if (const std::string reason = why_not_loadable(name); !reason.empty()) throw unusable(name + " " + reason);
    void* const library = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      const char* const message = dlerror();
      const std::string text = message != nullptr ? message : "no reason is given";
      if (name[0] != '/' && is_not_found(text, name)) continue;
      throw unusable(name + " cannot be loaded: " + text);
    }
    const std::string file = path_of(library, name);
    return {file, functions_of(library, file)};
  }
  throw unusable(std::string("Intel Open Image Denoise was not found: POINTGI_OIDN is not set, and where the loader "
                             "looks there is no ") +
                 usual_names[0] + " and no " + usual_names[1]);
}

} // namespace pointgi
