#include "tests/fakes/faults/fault.h"
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <link.h>
#include <mutex>
#include <unistd.h>
#include <unwind.h>

namespace faults {

namespace {

struct Wanted {
  const char* call = std::getenv("FAULT_CALL");
  const char* at = std::getenv("FAULT_AT");
  int code = static_cast<int>(number_of("FAULT_CODE", -5));
  bool lasts = number_of("FAULT_LASTS", 0) != 0;
  std::size_t number = at != nullptr ? std::strtoull(at, nullptr, 10) : 0;
  std::uint64_t place = at != nullptr ? std::strtoull(at, nullptr, 16) : 0;
};

const Wanted& wanted() {
  static const Wanted found;
  return found;
}

std::atomic<Call*> first_call{nullptr};
std::atomic<std::size_t> strikes_so_far{0};
std::atomic<bool> running{false};

bool is(const char* a, const char* b) {
  return a != nullptr && std::strcmp(a, b) == 0;
}

/// "clFinish", and not "close".
bool is_opencl(const char* name) {
  return std::strncmp(name, "cl", 2) == 0 && name[2] < 'a';
}

/// Code of a library that was there when the program began; drivers come later.
struct Module {
  std::uintptr_t begin, end, base;
  enum Kind { program, passed_through, ours, other } kind;
};
constexpr std::size_t most_modules = 128;
Module modules[most_modules];
std::size_t module_count = 0;

Module::Kind kind_of(const char* name, bool is_first) {
  if (is_first) return Module::program;
  const char* const slash = std::strrchr(name, '/');
  const char* const file = slash != nullptr ? slash + 1 : name;
  for (const char* library : {"libstdc++", "libc.", "libm.", "libspdlog", "libfmt", "libOpenEXR", "libIex", "libImath"})
    if (std::strncmp(file, library, std::strlen(library)) == 0) return Module::passed_through;
  return std::strncmp(file, "libpointgi_faults", 17) == 0 ? Module::ours : Module::other;
}

int add_module(dl_phdr_info* info, std::size_t, void*) {
  static bool is_first = true;
  const Module::Kind kind = kind_of(info->dlpi_name, is_first);
  is_first = false;
  for (int i = 0; i < info->dlpi_phnum && module_count < most_modules; ++i) {
    const ElfW(Phdr)& part = info->dlpi_phdr[i];
    if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
    const std::uintptr_t begin = info->dlpi_addr + part.p_vaddr;
    modules[module_count++] = {begin, begin + part.p_memsz, info->dlpi_addr, kind};
  }
  return 0;
}

const Module* module_of(std::uintptr_t address) {
  for (std::size_t i = 0; i < module_count; ++i)
    if (modules[i].begin <= address && address < modules[i].end) return &modules[i];
  return nullptr;
}

/// The program's own frames nearest to a call.
constexpr int most_frames = 3;
struct Frames {
  std::uintptr_t offsets[most_frames] = {};
  int count = 0;
  bool of_program = false;
};

_Unwind_Reason_Code take_frame(_Unwind_Context* context, void* data) {
  Frames& frames = *static_cast<Frames*>(data);
  const std::uintptr_t address = _Unwind_GetIP(context);
  const Module* const module = module_of(address);
  if (module != nullptr && (module->kind == Module::ours || module->kind == Module::passed_through))
    return _URC_NO_REASON;
  if (module == nullptr || module->kind == Module::other) return _URC_END_OF_STACK;
  frames.of_program = true;
  frames.offsets[frames.count++] = address - module->base;
  return frames.count < most_frames ? _URC_NO_REASON : _URC_END_OF_STACK;
}

thread_local bool looking = false; ///< the unwinder may allocate

Frames frames_of_caller() {
  Frames frames;
  if (looking) return frames;
  looking = true;
  _Unwind_Backtrace(take_frame, &frames);
  looking = false;
  return frames;
}

std::uint64_t place_of(const Frames& frames) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (int i = 0; i < frames.count; ++i)
    hash = (hash ^ frames.offsets[i]) * 0x100000001b3ull;
  return hash == 0 ? 1 : hash;
}

/// Places of allocations, in a table that allocates nothing.
struct Place {
  std::uint64_t hash;
  std::size_t count;
  Frames frames;
};
constexpr std::size_t most_places = 1 << 15;
Place places[most_places];
std::mutex places_mutex;

Place& entry_of(std::uint64_t hash) {
  std::size_t at = hash % most_places;
  while (places[at].hash != 0 && places[at].hash != hash)
    at = (at + 1) % most_places;
  places[at].hash = hash;
  return places[at];
}

void report() {
  const char* const path = std::getenv("FAULT_REPORT");
  if (path == nullptr) return;
  const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return;
  for (Call* call = first_call; call != nullptr; call = call->next) {
    if (call->count > 0) dprintf(file, "count %s %zu\n", call->name, call->count.load());
    if (call->largest > 0) dprintf(file, "largest %s %zu\n", call->name, call->largest.load());
    if (call->live != 0) dprintf(file, "live %s %ld\n", call->name, call->live.load());
  }
  for (const Place& place : places) {
    if (place.hash == 0) continue;
    dprintf(file, "place %016llx %zu", static_cast<unsigned long long>(place.hash), place.count);
    for (int i = 0; i < place.frames.count; ++i)
      dprintf(file, " %zx", static_cast<std::size_t>(place.frames.offsets[i]));
    dprintf(file, "\n");
  }
  dprintf(file, "struck %zu\n", strikes_so_far.load());
  close(file);
}

struct WholeRun {
  WholeRun() {
    dl_iterate_phdr(add_module, nullptr);
    unsetenv("LD_PRELOAD"); // drivers start linkers
  }
  ~WholeRun() { report(); }
} whole_run;

int (*real_main)(int, char**, char**) = nullptr;

int watched_main(int argc, char** argv, char** environment) {
  running = true;
  const int result = real_main(argc, argv, environment);
  running = false;
  return result;
}

} // namespace

Call::Call(const char* call_name) : name(call_name), is_opencl(faults::is_opencl(call_name)), next(first_call) {
  while (!first_call.compare_exchange_weak(next, this)) {
  }
}

bool strikes(Call& call) {
  if (!running) return false;
  const std::size_t number = ++call.count;
  const Wanted& w = wanted();
  if (w.call == nullptr) return false;
  const bool begins = is(w.call, call.name) && number == w.number;
  const bool is_later = w.lasts && strikes_so_far > 0 && (is_opencl(w.call) ? call.is_opencl : is(w.call, call.name));
  if (begins || is_later) ++strikes_so_far;
  return begins || is_later;
}

int code() {
  return wanted().code;
}
std::size_t struck() {
  return strikes_so_far;
}
bool lasts() {
  return wanted().lasts;
}
bool is_running() {
  return running;
}

bool called_by_program(std::uint64_t* place) {
  const Frames frames = frames_of_caller();
  if (place != nullptr && frames.of_program) {
    *place = place_of(frames);
    const std::lock_guard<std::mutex> lock(places_mutex);
    entry_of(*place).frames = frames;
  }
  return frames.of_program;
}

bool is_in_program(const void* return_address) {
  const Module* const module = module_of(reinterpret_cast<std::uintptr_t>(return_address));
  return module != nullptr && module->kind == Module::program;
}

bool may_be_of_program(const void* return_address) {
  const Module* const module = module_of(reinterpret_cast<std::uintptr_t>(return_address));
  return module != nullptr && module->kind != Module::other;
}

bool allocation_strikes(std::uint64_t place) {
  {
    const std::lock_guard<std::mutex> lock(places_mutex);
    ++entry_of(place).count;
  }
  const Wanted& w = wanted();
  if (!is(w.call, "allocation")) return false;
  const bool begins = strikes_so_far == 0 && place == w.place;
  const bool is_later = w.lasts && strikes_so_far > 0;
  if (begins || is_later) ++strikes_so_far;
  return begins || is_later;
}

double number_of(const char* variable, double otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr || *text == '\0' ? otherwise : std::strtod(text, nullptr);
}

} // namespace faults

/// Where main begins and ends.
extern "C" __attribute__((visibility("default"))) int __libc_start_main(int (*main)(int, char**, char**), int argc,
                                                                        char** argv, void (*init)(), void (*fini)(),
                                                                        void (*rtld_fini)(), void* stack_end) {
  faults::real_main = main;
  return faults::real<int(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*)>(
      "__libc_start_main")(faults::watched_main, argc, argv, init, fini, rtld_fini, stack_end);
}
