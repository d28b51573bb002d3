#pragma once
/// A library that is loaded before all others (LD_PRELOAD) and has calls of the program fail as a driver, a disk or a
/// full memory would: the program is the one that is shipped, and knows nothing of it. What the environment says:
///   FAULT_CALL=NAME    the call that fails: an OpenCL function, a system call, or "allocation"
///   FAULT_AT=N         its N-th call, from 1; of "allocation" the place in the program, as FAULT_REPORT names it
///   FAULT_CODE=CODE    what it answers: an OpenCL code or an errno; 0: of calls that move bytes half are moved;
///                      -9: the program is killed in the system call
///   FAULT_LASTS=1      from then on all OpenCL calls answer so, but those that release: the device is lost; of
///                      "allocation" and system calls: all of that name fail from then on
///   FAULT_REPORT=FILE  written at the end: "count NAME N", "place HASH ADDRESS…", "live NAME N",
///                      "largest NAME BYTES", "struck N"
///   DEVICE_PLATFORM=NAME, DEVICE_LARGEST_BUFFER=BYTES, DEVICE_NO_IMAGES=1   what the device says of itself, and does
///   DEVICE_ITEMS_PER_SECOND=N  a clock of its own: N work-items take a second; a launch of over 2 s is ended
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <dlfcn.h>

namespace faults {

/// A function that may fail: one static object each, which knows how often it was called.
struct Call {
  explicit Call(const char* call_name);

  const char* name;
  bool is_opencl;
  std::atomic<std::size_t> count{0};
  std::atomic<long> live{0};           ///< objects that it made and that are still there
  std::atomic<std::size_t> largest{0}; ///< bytes of a call
  Call* next;
};

/// Counts this call. Whether it is to fail; its code is then code().
bool strikes(Call& call);
int code();
/// The first call that fails was met; of the calls that failed.
std::size_t struck();
bool lasts();

/// The function that would have been called.
template <typename Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// Between main's beginning and its end; before and after it nothing fails.
bool is_running();

/// Whether the program itself called, perhaps through the standard library: not a driver, not another library.
/// `place`: a number for the last calls on the way, the same in each run.
bool called_by_program(std::uint64_t* place = nullptr);
/// The same for a call straight from the program's code.
bool is_in_program(const void* return_address);
/// Whether called_by_program() is worth asking: the caller is the program or what the program calls through.
bool may_be_of_program(const void* return_address);

/// An allocation at `place`: counts it, and says whether it fails.
bool allocation_strikes(std::uint64_t place);

/// A number of the environment; `otherwise` where it is not set.
double number_of(const char* variable, double otherwise);

} // namespace faults
