/// The OpenCL functions that the program calls.
#include "tests/fakes/faults/fault.h"
#include <CL/cl.h>
#include <algorithm>
#include <cstring>
#include <ctime>
#include <map>
#include <mutex>

namespace {

using faults::Call;
using faults::real;
using faults::strikes;

/// The clock of a device whose work-items all take the same time, and of the host that waits for it.
struct SimulatedClock {
  const double items_per_second = faults::number_of("DEVICE_ITEMS_PER_SECOND", 0.0);
  struct Launch {
    double begun, seconds;
  };
  std::mutex mutex;
  std::map<cl_event, Launch> launches;
  double now = 0.0; ///< what has passed besides the true time

  bool runs() const { return items_per_second > 0.0; }
  void launch(cl_event event, double items) {
    const std::lock_guard<std::mutex> lock(mutex);
    launches[event] = {now, items / items_per_second};
    now += items / items_per_second;
  }
  Launch of(cl_event event) {
    const std::lock_guard<std::mutex> lock(mutex);
    const auto found = launches.find(event);
    return found == launches.end() ? Launch{0.0, 0.0} : found->second;
  }
};

SimulatedClock& device_clock() {
  static SimulatedClock clock;
  return clock;
}

/// What Windows gives a launch.
constexpr double watchdog_seconds = 2.0;

bool is_ended_by_watchdog(cl_event event) {
  return device_clock().runs() && device_clock().of(event).seconds > watchdog_seconds;
}

double largest_buffer() {
  static const double bytes = faults::number_of("DEVICE_LARGEST_BUFFER", 0.0);
  return bytes;
}

bool has_no_images() {
  static const bool none = faults::number_of("DEVICE_NO_IMAGES", 0.0) != 0.0;
  return none;
}

template <typename Object>
Object refused(cl_int* code) {
  if (code != nullptr) *code = faults::code();
  return nullptr;
}

template <typename Object>
Object counted(Call& call, Object made) {
  if (made != nullptr) ++call.live;
  return made;
}

Call contexts("clCreateContext"), queues("clCreateCommandQueue"), buffers("clCreateBuffer"), images("clCreateImage"),
    sources("clCreateProgramWithSource"), binaries("clCreateProgramWithBinary"), kernels("clCreateKernel"),
    programs("programs"), memory("memory objects"), events("events"), all_kernels("kernels"), all_contexts("contexts"),
    all_queues("queues");

/// Answers a question about the device or platform by `bytes` of `answer`.
cl_int answered(const void* answer, std::size_t bytes, std::size_t room, void* value, std::size_t* needed) {
  if (value != nullptr && room >= bytes) std::memcpy(value, answer, bytes);
  if (needed != nullptr) *needed = bytes;
  return CL_SUCCESS;
}

} // namespace

// A function that returns its code.
#define ANSWERING(name, parameters, arguments)                                                                         \
  cl_int CL_API_CALL name parameters {                                                                                 \
    static Call call(#name);                                                                                           \
    static auto* const next = real<cl_int parameters>(#name);                                                          \
    return strikes(call) ? faults::code() : next arguments;                                                            \
  }
// One that makes an object, of which there is one more in `total`.
#define MAKING(object, call, total, name, parameters, arguments)                                                       \
  object CL_API_CALL name parameters {                                                                                 \
    static auto* const next = real<object parameters>(#name);                                                          \
    return strikes(call) ? refused<object>(code) : counted(total, next arguments);                                     \
  }
// One that ends a reference, or takes one more.
#define COUNTING(object, total, step, name)                                                                            \
  cl_int CL_API_CALL name(object one) {                                                                                \
    static auto* const next = real<cl_int(object)>(#name);                                                             \
    total.live += step;                                                                                                \
    return next(one);                                                                                                  \
  }
// One that is given to the queue; `event` may be asked for.
#define QUEUEING(name, parameters, arguments)                                                                          \
  cl_int CL_API_CALL name parameters {                                                                                 \
    static Call call(#name);                                                                                           \
    static auto* const next = real<cl_int parameters>(#name);                                                          \
    if (strikes(call)) return faults::code();                                                                          \
    const cl_int code = next arguments;                                                                                \
    if (code == CL_SUCCESS && event != nullptr) ++events.live;                                                         \
    return code;                                                                                                       \
  }

extern "C" {
using Waits = const cl_event*;
using Say = void(CL_CALLBACK*)(const char*, const void*, std::size_t, void*);
using Built = void(CL_CALLBACK*)(cl_program, void*);
using Gone = void(CL_CALLBACK*)(cl_mem, void*);
using Sizes = const std::size_t*;

ANSWERING(clGetPlatformIDs, (cl_uint room, cl_platform_id* found, cl_uint* count), (room, found, count))
ANSWERING(clGetDeviceIDs,
          (cl_platform_id platform, cl_device_type type, cl_uint room, cl_device_id* found, cl_uint* count),
          (platform, type, room, found, count))
ANSWERING(clBuildProgram,
          (cl_program program, cl_uint count, const cl_device_id* devices, const char* options, Built built,
           void* data),
          (program, count, devices, options, built, data))
ANSWERING(clGetProgramInfo,
          (cl_program program, cl_program_info what, std::size_t room, void* value, std::size_t* needed),
          (program, what, room, value, needed))
ANSWERING(clGetProgramBuildInfo,
          (cl_program program, cl_device_id device, cl_program_build_info what, std::size_t room, void* value,
           std::size_t* needed),
          (program, device, what, room, value, needed))
ANSWERING(clSetKernelArg, (cl_kernel kernel, cl_uint index, std::size_t size, const void* value),
          (kernel, index, size, value))
ANSWERING(clGetKernelInfo, (cl_kernel kernel, cl_kernel_info what, std::size_t room, void* value, std::size_t* needed),
          (kernel, what, room, value, needed))
ANSWERING(clGetKernelWorkGroupInfo,
          (cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info what, std::size_t room, void* value,
           std::size_t* needed),
          (kernel, device, what, room, value, needed))
ANSWERING(clSetMemObjectDestructorCallback, (cl_mem object, Gone gone, void* data), (object, gone, data))

MAKING(cl_context, contexts, all_contexts, clCreateContext,
       (const cl_context_properties* properties, cl_uint count, const cl_device_id* devices, Say say, void* data,
        cl_int* code),
       (properties, count, devices, say, data, code))
MAKING(cl_command_queue, queues, all_queues, clCreateCommandQueue,
       (cl_context context, cl_device_id device, cl_command_queue_properties properties, cl_int* code),
       (context, device, properties, code))
MAKING(cl_mem, images, memory, clCreateImage,
       (cl_context context, cl_mem_flags flags, const cl_image_format* format, const cl_image_desc* shape, void* data,
        cl_int* code),
       (context, flags, format, shape, data, code))
MAKING(cl_program, sources, programs, clCreateProgramWithSource,
       (cl_context context, cl_uint count, const char** texts, Sizes lengths, cl_int* code),
       (context, count, texts, lengths, code))
MAKING(cl_program, binaries, programs, clCreateProgramWithBinary,
       (cl_context context, cl_uint count, const cl_device_id* devices, Sizes lengths, const unsigned char** texts,
        cl_int* status, cl_int* code),
       (context, count, devices, lengths, texts, status, code))
MAKING(cl_kernel, kernels, all_kernels, clCreateKernel, (cl_program program, const char* name, cl_int* code),
       (program, name, code))

cl_mem CL_API_CALL clCreateBuffer(cl_context context, cl_mem_flags flags, std::size_t bytes, void* data, cl_int* code) {
  static auto* const next = real<cl_mem(cl_context, cl_mem_flags, std::size_t, void*, cl_int*)>("clCreateBuffer");
  if (strikes(buffers)) return refused<cl_mem>(code);
  buffers.largest = std::max(buffers.largest.load(), bytes); // of the one thread that asks
  if (largest_buffer() > 0.0 && static_cast<double>(bytes) > largest_buffer()) {
    if (code != nullptr) *code = CL_INVALID_BUFFER_SIZE;
    return nullptr;
  }
  return counted(memory, next(context, flags, bytes, data, code));
}

COUNTING(cl_context, all_contexts, -1, clReleaseContext)
COUNTING(cl_context, all_contexts, 1, clRetainContext)
COUNTING(cl_command_queue, all_queues, -1, clReleaseCommandQueue)
COUNTING(cl_command_queue, all_queues, 1, clRetainCommandQueue)
COUNTING(cl_mem, memory, -1, clReleaseMemObject)
COUNTING(cl_mem, memory, 1, clRetainMemObject)
COUNTING(cl_program, programs, -1, clReleaseProgram)
COUNTING(cl_program, programs, 1, clRetainProgram)
COUNTING(cl_kernel, all_kernels, -1, clReleaseKernel)
COUNTING(cl_kernel, all_kernels, 1, clRetainKernel)
COUNTING(cl_event, events, -1, clReleaseEvent)
COUNTING(cl_event, events, 1, clRetainEvent)

QUEUEING(clEnqueueReadBuffer,
         (cl_command_queue queue, cl_mem buffer, cl_bool waits, std::size_t from, std::size_t bytes, void* data,
          cl_uint count, Waits list, cl_event* event),
         (queue, buffer, waits, from, bytes, data, count, list, event))
QUEUEING(clEnqueueWriteBuffer,
         (cl_command_queue queue, cl_mem buffer, cl_bool waits, std::size_t from, std::size_t bytes, const void* data,
          cl_uint count, Waits list, cl_event* event),
         (queue, buffer, waits, from, bytes, data, count, list, event))
QUEUEING(clEnqueueFillBuffer,
         (cl_command_queue queue, cl_mem buffer, const void* value, std::size_t size, std::size_t from,
          std::size_t bytes, cl_uint count, Waits list, cl_event* event),
         (queue, buffer, value, size, from, bytes, count, list, event))
QUEUEING(clEnqueueCopyBuffer,
         (cl_command_queue queue, cl_mem source, cl_mem target, std::size_t from, std::size_t to, std::size_t bytes,
          cl_uint count, Waits list, cl_event* event),
         (queue, source, target, from, to, bytes, count, list, event))
QUEUEING(clEnqueueWriteImage,
         (cl_command_queue queue, cl_mem image, cl_bool waits, Sizes origin, Sizes region, std::size_t row,
          std::size_t slice, const void* data, cl_uint count, Waits list, cl_event* event),
         (queue, image, waits, origin, region, row, slice, data, count, list, event))

cl_int CL_API_CALL clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, Sizes offset,
                                          Sizes global, Sizes local, cl_uint count, Waits list, cl_event* event) {
  static Call call("clEnqueueNDRangeKernel");
  static auto* const next =
      real<cl_int(cl_command_queue, cl_kernel, cl_uint, Sizes, Sizes, Sizes, cl_uint, Waits, cl_event*)>(
          "clEnqueueNDRangeKernel");
  if (strikes(call)) return faults::code();
  const cl_int code = next(queue, kernel, dimensions, offset, global, local, count, list, event);
  if (code != CL_SUCCESS || event == nullptr) return code;
  ++events.live;
  double items = 1.0;
  for (cl_uint d = 0; d < dimensions; ++d)
    items *= static_cast<double>(global[d]);
  if (device_clock().runs()) device_clock().launch(*event, items);
  return code;
}

/// What was launched is waited for also where that fails: it still writes to memory that the program gives back.
cl_int CL_API_CALL clWaitForEvents(cl_uint count, Waits list) {
  static Call call("clWaitForEvents");
  static auto* const next = real<cl_int(cl_uint, Waits)>("clWaitForEvents");
  const bool is_struck = strikes(call);
  const cl_int code = next(count, list);
  if (is_struck) return faults::code();
  return std::any_of(list, list + count, is_ended_by_watchdog) ? CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST : code;
}
cl_int CL_API_CALL clFlush(cl_command_queue queue) {
  static Call call("clFlush");
  static auto* const next = real<cl_int(cl_command_queue)>("clFlush");
  static auto* const finish = real<cl_int(cl_command_queue)>("clFinish");
  if (!strikes(call)) return next(queue);
  finish(queue);
  return faults::code();
}
cl_int CL_API_CALL clFinish(cl_command_queue queue) {
  static Call call("clFinish");
  static auto* const next = real<cl_int(cl_command_queue)>("clFinish");
  const bool is_struck = strikes(call);
  const cl_int code = next(queue);
  return is_struck ? faults::code() : code;
}

cl_int CL_API_CALL clGetEventInfo(cl_event event, cl_event_info what, std::size_t room, void* value,
                                  std::size_t* needed) {
  static Call call("clGetEventInfo");
  static auto* const next = real<cl_int(cl_event, cl_event_info, std::size_t, void*, std::size_t*)>("clGetEventInfo");
  if (strikes(call)) return faults::code();
  const cl_int status = CL_OUT_OF_RESOURCES; // what drivers say of a launch that a watchdog ended
  if (what == CL_EVENT_COMMAND_EXECUTION_STATUS && is_ended_by_watchdog(event))
    return answered(&status, sizeof status, room, value, needed);
  return next(event, what, room, value, needed);
}

cl_int CL_API_CALL clGetEventProfilingInfo(cl_event event, cl_profiling_info what, std::size_t room, void* value,
                                           std::size_t* needed) {
  static Call call("clGetEventProfilingInfo");
  static auto* const next =
      real<cl_int(cl_event, cl_profiling_info, std::size_t, void*, std::size_t*)>("clGetEventProfilingInfo");
  if (strikes(call)) return faults::code();
  if (!device_clock().runs()) return next(event, what, room, value, needed);
  const SimulatedClock::Launch launch = device_clock().of(event);
  const double seconds = launch.begun + (what == CL_PROFILING_COMMAND_END ? launch.seconds : 0.0);
  const auto ns = static_cast<cl_ulong>(1e9 * (1.0 + seconds));
  return answered(&ns, sizeof ns, room, value, needed);
}

cl_int CL_API_CALL clGetPlatformInfo(cl_platform_id platform, cl_platform_info what, std::size_t room, void* value,
                                     std::size_t* needed) {
  static Call call("clGetPlatformInfo");
  static auto* const next =
      real<cl_int(cl_platform_id, cl_platform_info, std::size_t, void*, std::size_t*)>("clGetPlatformInfo");
  if (strikes(call)) return faults::code();
  const char* const name = std::getenv("DEVICE_PLATFORM");
  if (what == CL_PLATFORM_NAME && name != nullptr) return answered(name, std::strlen(name) + 1, room, value, needed);
  return next(platform, what, room, value, needed);
}

cl_int CL_API_CALL clGetDeviceInfo(cl_device_id device, cl_device_info what, std::size_t room, void* value,
                                   std::size_t* needed) {
  static Call call("clGetDeviceInfo");
  static auto* const next =
      real<cl_int(cl_device_id, cl_device_info, std::size_t, void*, std::size_t*)>("clGetDeviceInfo");
  if (strikes(call)) return faults::code();
  const cl_ulong bytes = static_cast<cl_ulong>(largest_buffer());
  if (what == CL_DEVICE_MAX_MEM_ALLOC_SIZE && bytes > 0) return answered(&bytes, sizeof bytes, room, value, needed);
  const cl_bool no = CL_FALSE;
  if (what == CL_DEVICE_IMAGE_SUPPORT && has_no_images()) return answered(&no, sizeof no, room, value, needed);
  return next(device, what, room, value, needed);
}

/// The program's clock goes on while it waits for the simulated device.
int clock_gettime(clockid_t which, timespec* time) noexcept {
  static auto* const next = real<int(clockid_t, timespec*)>("clock_gettime");
  const int result = next(which, time);
  if (result != 0 || which != CLOCK_MONOTONIC || !device_clock().runs()) return result;
  if (!faults::is_running() || !faults::called_by_program()) return result;
  double passed = 0.0;
  {
    const std::lock_guard<std::mutex> lock(device_clock().mutex);
    passed = device_clock().now;
  }
  const auto whole = static_cast<time_t>(passed);
  time->tv_sec += whole;
  time->tv_nsec += static_cast<long>(1e9 * (passed - static_cast<double>(whole)));
  if (time->tv_nsec >= 1'000'000'000) {
    time->tv_nsec -= 1'000'000'000;
    ++time->tv_sec;
  }
  return result;
}
}
