#pragma once
/// One device at work: context, queue, programs, buffers, launches. The only route to the OpenCL API.
#include "host/cl/device.h"
#include "host/cl/resource_error.h"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace pointgi {

/// Device seconds and launches of one kernel since the session began.
struct KernelTime {
  std::size_t launches = 0;
  double seconds = 0.0;
};

/// A call of the device's, as tests may have it fail.
struct DeviceCall {
  enum class Kind { build, allocation, upload, download, launch };
  Kind kind;
  std::string name;           ///< of the program's file or the kernel; else empty
  std::uint64_t bytes = 0;    ///< of an allocation, upload or download
  std::size_t work_items = 0; ///< of a launch
};

/// For tests: says what the device answers to a call instead of being asked, CL_SUCCESS to let it be asked.
using FaultInjector = std::function<int(const DeviceCall&)>;

/// One launch as the device's clock saw it.
struct LaunchRecord {
  std::string kernel;
  std::string label;                            ///< what the caller said it works on; may be empty
  std::uint64_t start_ns = 0, end_ns = 0;       ///< the device's clock, whose zero is its own
  std::chrono::steady_clock::time_point called; ///< when the host asked for it: before start_ns
  bool has_clock = true;                        ///< what the device's clock said can be believed
};

/// Typed device memory of a fixed number of elements; frees itself.
template <typename T>
struct Buffer {
  cl::Buffer handle;
  std::size_t size = 0;
};

/// What a launch needs besides the kernel's arguments. Sizes are in work-items; local must divide global.
struct LaunchShape {
  std::size_t global[2] = {1, 1};
  std::size_t local[2] = {1, 1};

  /// 1-D: `count` work-items, padded to whole groups of `group`.
  static LaunchShape line(std::size_t count, std::size_t group = 64);
  /// 2-D: `columns` x `rows` work-items, padded to whole groups of x by y.
  static LaunchShape grid(std::size_t columns, std::size_t rows, std::size_t x, std::size_t y);
};

class Session {
public:
  /// Throws Error(device) when the device cannot be opened.
  explicit Session(const Device& device);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const DeviceInfo& info() const { return info_; }

  /// The program of kernels/<file> built with `options` ("-D NAME=VALUE ..."); from memory, from the cache folder, or
  /// compiled. Throws Error(device) with device, driver, options and the compiler's log, whose lines name our files.
  const cl::Program& program(const std::string& file, const std::string& options);

  /// A kernel of it. Throws Error(internal) for an unknown name.
  cl::Kernel kernel(const std::string& file, const std::string& options, const std::string& name);

  template <typename T>
  Buffer<T> allocate(std::size_t size, cl_mem_flags flags = CL_MEM_READ_WRITE) {
    return {allocate_bytes(size * sizeof(T), flags), size};
  }
  template <typename T>
  Buffer<T> upload(const T* data, std::size_t size) {
    Buffer<T> buffer = allocate<T>(size, CL_MEM_READ_ONLY);
    write_bytes(buffer.handle, data, size * sizeof(T));
    return buffer;
  }
  template <typename T, typename Allocator>
  Buffer<T> upload(const std::vector<T, Allocator>& data) {
    return upload(data.data(), data.size());
  }
  /// The elements [first, first + size), which the buffer has room for.
  template <typename T>
  void write(const Buffer<T>& buffer, const T* data, std::size_t size, std::size_t first = 0) {
    write_bytes(buffer.handle, data, size * sizeof(T), first * sizeof(T));
  }
  /// The elements [first, first + count).
  template <typename T>
  std::vector<T> download(const Buffer<T>& buffer, std::size_t count, std::size_t first = 0) {
    std::vector<T> data(count);
    read_bytes(buffer.handle, data.data(), count * sizeof(T), first * sizeof(T));
    return data;
  }

  /// The first `count` elements become `value`, of which one alone travels to the device.
  template <typename T>
  void fill(const Buffer<T>& buffer, const T& value, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>, "its bytes are what the device gets");
    fill_bytes(buffer.handle, &value, sizeof(T), count);
  }

  /// `texels` RGBA texels of four 32-bit words as image1d_buffer, or as image2d with rows of 2^width_log2 texels.
  cl::Memory upload_image1d(const void* texels, std::size_t count, bool is_float);
  cl::Memory upload_image2d(const void* texels, std::size_t count, bool is_float, unsigned width_log2);

  /// Runs the kernel with these arguments, a list of memory objects being as many, and waits; returns the device's
  /// seconds, which also go to kernel_times(). Checks work-group, local memory and argument count before the device
  /// sees them. Throws ResourceError when the device refuses the launch for want of memory or other resources, and
  /// nothing was run; Error(device) for all else, a launch that it began and lost among it.
  template <typename... Args>
  double launch(cl::Kernel& kernel, const LaunchShape& shape, const Args&... args) {
    cl_uint index = 0;
    try {
      (set_argument(kernel, index, args), ...);
    } catch (const cl::Error& error) {
      refuse_argument(kernel, index, error);
    }
    return run(kernel, shape, index);
  }

  const std::map<std::string, KernelTime>& kernel_times() const { return times_; }
  /// From now on every launch is kept, for traces: some 100 bytes each.
  void record_launches() { recording_ = true; }
  void label_launches(const std::string& label) { label_ = label; }
  const std::vector<LaunchRecord>& launches() const { return launches_; }
  /// Every program that was asked for: file and options.
  std::vector<std::pair<std::string, std::string>> programs_asked() const;
  std::size_t programs_compiled() const { return compiled_; }
  std::size_t programs_from_cache() const { return from_cache_; }
  /// Given as source to a driver that keeps compiled kernels itself; whether it compiled them again only it knows.
  std::size_t programs_kept_by_driver() const { return kept_by_driver_; }
  std::uint64_t held_bytes() const { return bytes_->now; }
  std::uint64_t peak_bytes() const { return bytes_->peak; }
  /// From now on peak_bytes() is of what is there now and comes later.
  void forget_peak() { bytes_->peak = bytes_->now; }
  /// What the device may still have for what is kept on it. Half of it where its memory is the host's.
  std::uint64_t bytes_left() const {
    const std::uint64_t left = info_.memory_bytes - std::min<std::uint64_t>(info_.memory_bytes, bytes_->now);
    return info_.is_cpu ? left / 2 : left;
  }

  /// From now on called before every launch: it may show progress, or throw to end the work there. Empty: nothing is.
  void before_launches(std::function<void()> call) { before_launch_ = std::move(call); }

  /// From now on asked before every build, allocation, copy and launch. Empty: the device alone answers.
  void inject_faults(FaultInjector faults) { faults_ = std::move(faults); }

  /// Writes every program built from now on, as the compiler sees it, and its options to this folder (--dump-kernels).
  void dump_kernels_to(const std::string& folder) { dump_folder_ = folder; }

private:
  struct Bytes {
    std::atomic<std::uint64_t> now{0}; ///< drivers give memory back on threads of their own
    std::uint64_t peak = 0;
  };

  cl::Buffer allocate_bytes(std::size_t bytes, cl_mem_flags flags);
  void write_bytes(const cl::Buffer& buffer, const void* data, std::size_t bytes, std::size_t from = 0);
  void read_bytes(const cl::Buffer& buffer, void* data, std::size_t bytes, std::size_t from = 0);
  void fill_bytes(const cl::Buffer& buffer, const void* value, std::size_t size, std::size_t count);
  void ask_faults(const DeviceCall& call) const;
  cl::Program build(const std::string& file, const std::string& options);
  void dump(const std::string& file, const std::string& options, const std::string& source) const;
  void account(const cl::Memory& memory, std::uint64_t bytes);
  /// For a call that did not succeed; `needed` says what it wanted of the device.
  [[noreturn]] void fail(const cl::Error& error, const std::string& doing, const std::string& needed = {}) const;
  [[noreturn]] void refuse_argument(const cl::Kernel& kernel, cl_uint index, const cl::Error& error) const;
  double run(cl::Kernel& kernel, const LaunchShape& shape, cl_uint arguments);
  void enqueue(cl::Kernel& kernel, const LaunchShape& shape, cl_uint arguments, cl::Event& event);
  double wait(const cl::Kernel& kernel, const cl::Event& event, std::chrono::steady_clock::time_point called);

  template <typename T>
  static void set_argument(cl::Kernel& kernel, cl_uint& index, const T& value) {
    kernel.setArg(index, value);
    ++index;
  }
  template <typename T>
  static void set_argument(cl::Kernel& kernel, cl_uint& index, const Buffer<T>& value) {
    set_argument(kernel, index, value.handle);
  }
  static void set_argument(cl::Kernel& kernel, cl_uint& index, const std::vector<cl::Memory>& values) {
    for (const cl::Memory& value : values)
      set_argument(kernel, index, value);
  }

  DeviceInfo info_;
  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::map<std::string, cl::Program> programs_;
  std::map<std::string, KernelTime> times_;
  std::shared_ptr<Bytes> bytes_ = std::make_shared<Bytes>();
  std::size_t compiled_ = 0;
  std::size_t from_cache_ = 0;
  std::size_t kept_by_driver_ = 0;
  std::string dump_folder_;
  std::function<void()> before_launch_;
  FaultInjector faults_;
  bool recording_ = false;
  std::string label_;
  std::vector<LaunchRecord> launches_;
};

/// The text of an OpenCL error code: "CL_OUT_OF_RESOURCES (-5)".
std::string cl_error_name(int code);

} // namespace pointgi
