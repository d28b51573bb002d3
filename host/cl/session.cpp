#include "host/cl/session.h"
#include "host/cl/device_clock.h"
#include "host/cl/resource_error.h"
#include "host/error.h"
#include <algorithm>

namespace pointgi {

namespace {

using Clock = std::chrono::steady_clock;

/// "1048577 bytes (2 MiB)".
std::string amount(std::uint64_t bytes) {
  return std::to_string(bytes) + " bytes (" + megabytes(bytes) + ")";
}

bool is_memory_error(int code) {
  return code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_HOST_MEMORY || code == CL_INVALID_BUFFER_SIZE;
}

} // namespace

LaunchShape LaunchShape::line(std::size_t count, std::size_t group) {
  const std::size_t groups = std::max<std::size_t>(1, (count + group - 1) / group);
  return {{groups * group, 1}, {group, 1}};
}

LaunchShape LaunchShape::grid(std::size_t columns, std::size_t rows, std::size_t x, std::size_t y) {
  const auto padded = [](std::size_t count, std::size_t group) {
    return std::max<std::size_t>(1, (count + group - 1) / group) * group;
  };
  return {{padded(columns, x), padded(rows, y)}, {x, y}};
}

Session::Session(const Device& device) : info_(device.info), device_(device.handle) {
  try {
    context_ = cl::Context(device_);
    queue_ = cl::CommandQueue(context_, device_, CL_QUEUE_PROFILING_ENABLE);
  } catch (const cl::Error& error) {
    fail(error, "opening the device");
  }
}

Session::~Session() = default;

void Session::ask_faults(const DeviceCall& call) const {
  const int code = faults_ ? faults_(call) : CL_SUCCESS;
  if (code != CL_SUCCESS) throw cl::Error(code, "injected");
}

void Session::fail(const cl::Error& error, const std::string& doing, const std::string& needed) const {
  const std::string text = info_.name + ": " + doing + " failed: " + cl_error_name(error.err());
  const std::uint64_t held = bytes_->now;
  const std::string there = (needed.empty() ? "" : "; " + needed) + "; buffers hold " + amount(held) +
                            ", and the device has " + amount(info_.memory_bytes) + " in all";
  if (is_memory_error(error.err()))
    throw ResourceError(ErrorKind::memory, text + there + "; use a smaller scene, or another --device");
  // Drivers say it of registers, local memory and launches that a watchdog ended, of memory too.
  if (error.err() == CL_OUT_OF_RESOURCES)
    throw ResourceError(ErrorKind::device, text + there +
                                               ". The kernel may need more registers or local memory than there are, a "
                                               "launch may have been lost, or memory is short; use another --device, "
                                               "or a smaller scene if memory is short");
  throw Error(ErrorKind::device, text + "; use another --device, or a newer driver");
}

cl::Kernel Session::kernel(const std::string& file, const std::string& options, const std::string& name) {
  const cl::Program& built = program(file, options);
  try {
    return cl::Kernel(built, name.c_str());
  } catch (const cl::Error& error) {
    if (error.err() != CL_INVALID_KERNEL_NAME) fail(error, "making the kernel " + name);
    throw Error(ErrorKind::internal, "kernels/" + file + " has no kernel " + name + ": " + cl_error_name(error.err()));
  }
}

void Session::account(const cl::Memory& memory, std::uint64_t bytes) {
  // The counter outlives the session as long as memory does: whoever holds the last reference ends the count.
  struct Release {
    std::shared_ptr<Bytes> total;
    std::uint64_t bytes;
  };
  auto release = std::make_unique<Release>(Release{bytes_, bytes});
  bytes_->now += bytes;
  bytes_->peak = std::max(bytes_->peak, bytes_->now.load());
  const auto callback = [](cl_mem, void* data) {
    auto* r = static_cast<Release*>(data);
    r->total->now -= r->bytes;
    delete r;
  };
  if (clSetMemObjectDestructorCallback(memory(), callback, release.get()) == CL_SUCCESS)
    release.release();
  else // nobody would say when it is given back, and what is held would only grow
    bytes_->now -= bytes;
}

cl::Buffer Session::allocate_bytes(std::size_t bytes, cl_mem_flags flags) {
  // Zero-sized buffers do not exist in OpenCL; an unused argument still needs one.
  const std::size_t size = std::max<std::size_t>(bytes, 16);
  if (size > info_.max_allocation_bytes)
    throw ResourceError(ErrorKind::memory, info_.name + ": a buffer of " + amount(size) +
                                               " is needed, and the device gives " +
                                               amount(info_.max_allocation_bytes) +
                                               " at most in one piece; use a smaller cloud, or another --device");
  try {
    ask_faults({DeviceCall::Kind::allocation, {}, size, 0});
    // Drivers that share their memory with the host promise more than there is.
    if (bytes_->now + size > info_.memory_bytes) throw cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE);
    cl::Buffer buffer(context_, flags, size);
    account(buffer, size);
    return buffer;
  } catch (const cl::Error& error) {
    // No kernel, no registers: a device that has no resources for a buffer has no memory.
    fail(error.err() == CL_OUT_OF_RESOURCES ? cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE) : error,
         "allocating a buffer", amount(size) + " are needed");
  }
}

void Session::write_bytes(const cl::Buffer& buffer, const void* data, std::size_t bytes, std::size_t from) {
  if (bytes == 0) return;
  try {
    ask_faults({DeviceCall::Kind::upload, {}, bytes, 0});
    queue_.enqueueWriteBuffer(buffer, CL_TRUE, from, bytes, data);
  } catch (const cl::Error& error) {
    fail(error, "copying " + amount(bytes) + " to the device");
  }
}

void Session::read_bytes(const cl::Buffer& buffer, void* data, std::size_t bytes, std::size_t from) {
  if (bytes == 0) return;
  try {
    ask_faults({DeviceCall::Kind::download, {}, bytes, 0});
    queue_.enqueueReadBuffer(buffer, CL_TRUE, from, bytes, data);
  } catch (const cl::Error& error) {
    fail(error, "copying " + amount(bytes) + " from the device");
  }
}

/// A value of a size that the standard has no pattern for is copied, twice as many at a time.
void Session::fill_bytes(const cl::Buffer& buffer, const void* value, std::size_t size, std::size_t count) {
  if (count == 0) return;
  const bool is_pattern = size <= 128 && (size & (size - 1)) == 0;
  try {
    if (is_pattern) {
      cl_event event = nullptr; // the C call: the C++ one wants a type of its own for each size
      const int code = clEnqueueFillBuffer(queue_(), buffer(), value, size, 0, size * count, 0, nullptr, &event);
      if (code != CL_SUCCESS) throw cl::Error(code, "clEnqueueFillBuffer");
      cl::Event(event).wait();
      return;
    }
    write_bytes(buffer, value, size);
    for (std::size_t done = 1; done < count;) {
      const std::size_t more = std::min(done, count - done);
      queue_.enqueueCopyBuffer(buffer, buffer, 0, done * size, more * size);
      done += more;
    }
    queue_.finish();
  } catch (const cl::Error& error) {
    fail(error, "filling " + amount(size * count));
  }
}

namespace {

cl::ImageFormat texel_format(bool is_float) {
  return {CL_RGBA, cl_channel_type(is_float ? CL_FLOAT : CL_UNSIGNED_INT32)};
}

} // namespace

cl::Memory Session::upload_image1d(const void* texels, std::size_t count, bool is_float) {
  if (!info_.images || count > info_.image_buffer_texels)
    throw Error(ErrorKind::device, info_.name + ": an image1d_buffer of " + std::to_string(count) +
                                       " texels is needed, and the device gives " +
                                       std::to_string(info_.image_buffer_texels) + "; use storage = \"buffer\"");
  const cl::Buffer buffer = allocate_bytes(16 * count, CL_MEM_READ_ONLY);
  write_bytes(buffer, texels, 16 * count);
  try {
    return cl::Image1DBuffer(context_, CL_MEM_READ_ONLY, texel_format(is_float), std::max<std::size_t>(count, 1),
                             buffer);
  } catch (const cl::Error& error) {
    fail(error, "making an image1d_buffer");
  }
}

cl::Memory Session::upload_image2d(const void* texels, std::size_t count, bool is_float, unsigned width_log2) {
  const std::size_t width = std::size_t{1} << width_log2,
                    height = std::max<std::size_t>(1, (count + width - 1) / width);
  if (!info_.images || width > info_.image2d_width || height > info_.image2d_height)
    throw Error(ErrorKind::device, info_.name + ": an image of " + std::to_string(width) + " x " +
                                       std::to_string(height) + " texels is needed, and the device gives " +
                                       std::to_string(info_.image2d_width) + " x " +
                                       std::to_string(info_.image2d_height) + "; use storage = \"buffer\"");
  try {
    ask_faults({DeviceCall::Kind::allocation, {}, 16 * width * height, 0});
    cl::Image2D image(context_, CL_MEM_READ_ONLY, texel_format(is_float), width, height);
    account(image, 16 * width * height);
    const auto write = [&](std::size_t rows_from, std::size_t w, std::size_t rows) {
      if (rows == 0) return;
      queue_.enqueueWriteImage(
          image, CL_TRUE, {0, rows_from, 0}, {w, rows, 1}, 0, 0,
          const_cast<void*>(static_cast<const void*>(static_cast<const char*>(texels) + 16 * rows_from * width)));
    };
    write(0, width, count / width);
    if (count % width != 0) write(count / width, count % width, 1);
    return image;
  } catch (const cl::Error& error) {
    fail(error, "making an image");
  }
}

namespace {

/// For messages and times, and so of a device that is lost, too.
std::string name_of(const cl::Kernel& kernel) {
  try {
    std::string name = kernel.getInfo<CL_KERNEL_FUNCTION_NAME>();
    name.erase(std::find(name.begin(), name.end(), '\0'), name.end());
    return name;
  } catch (const cl::Error&) {
    return "a kernel";
  }
}

std::string needs_of(const cl::Kernel& kernel, const cl::Device& device, std::size_t items) {
  const std::string text = std::to_string(items) + " work-items";
  try {
    return text + " need " + amount(kernel.getWorkGroupInfo<CL_KERNEL_PRIVATE_MEM_SIZE>(device)) +
           " of private memory each and " + amount(kernel.getWorkGroupInfo<CL_KERNEL_LOCAL_MEM_SIZE>(device)) +
           " of local memory a group";
  } catch (const cl::Error&) {
    return text;
  }
}

/// What would only fail on the device, or on another device than the developer's.
void check_launch(const cl::Kernel& kernel, const cl::Device& device, const DeviceInfo& info, const LaunchShape& shape,
                  cl_uint arguments) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::internal, "launch of " + name_of(kernel) + " refused: " + why);
  };
  const cl_uint wanted = kernel.getInfo<CL_KERNEL_NUM_ARGS>();
  if (arguments != wanted)
    refuse("it takes " + std::to_string(wanted) + " arguments, not " + std::to_string(arguments));
  for (int d = 0; d < 2; ++d)
    if (shape.local[d] == 0 || shape.global[d] == 0 || shape.global[d] % shape.local[d] != 0)
      refuse("the work-group does not divide the range");
  const std::size_t group = shape.local[0] * shape.local[1];
  const std::size_t most = kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device);
  if (group > most)
    throw Error(ErrorKind::device, info.name + ": " + name_of(kernel) + " needs work-groups of " +
                                       std::to_string(group) + ", the device gives " + std::to_string(most) +
                                       "; choose another --device");
  if (kernel.getWorkGroupInfo<CL_KERNEL_LOCAL_MEM_SIZE>(device) > info.local_memory_bytes)
    throw Error(ErrorKind::device,
                info.name + ": too little local memory for " + name_of(kernel) + "; choose another --device");
}

} // namespace

void Session::refuse_argument(const cl::Kernel& kernel, cl_uint index, const cl::Error& error) const {
  fail(error, "giving argument " + std::to_string(index) + " to " + name_of(kernel));
}

void Session::enqueue(cl::Kernel& kernel, const LaunchShape& shape, cl_uint arguments, cl::Event& event) {
  const std::size_t items = shape.global[0] * shape.global[1];
  try {
    check_launch(kernel, device_, info_, shape, arguments);
    ask_faults({DeviceCall::Kind::launch, name_of(kernel), 0, items});
    queue_.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(shape.global[0], shape.global[1]),
                                cl::NDRange(shape.local[0], shape.local[1]), nullptr, &event);
  } catch (const cl::Error& error) {
    fail(error, "launching " + name_of(kernel), needs_of(kernel, device_, items));
  }
}

double Session::wait(const cl::Kernel& kernel, const cl::Event& event, Clock::time_point called) {
  const auto seconds_since = [](Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  };
  LaunchTimes times;
  try {
    queue_.flush();
    const Clock::time_point waiting = Clock::now();
    event.wait();
    times.wait_seconds = seconds_since(waiting);
  } catch (const cl::Error& error) {
    // The event knows the cause, the wait only that there is one. What a part of the launch has added to its results
    // would be added twice by another try: no ResourceError.
    cl_int status = 0;
    if (clGetEventInfo(event(), CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr) != CL_SUCCESS ||
        status >= 0)
      status = error.err();
    throw Error(ErrorKind::device, info_.name + ": " + name_of(kernel) +
                                       " was launched and did not end: " + cl_error_name(status) +
                                       "; the driver's watchdog may have ended it, or the driver is at fault: use "
                                       "another --device, or a newer driver");
  }
  times.call_seconds = seconds_since(called);
  const auto read = [&](cl_profiling_info what, std::uint64_t& ns) { // no exception: some drivers have no clock
    return clGetEventProfilingInfo(event(), what, sizeof ns, &ns, nullptr) == CL_SUCCESS;
  };
  if (!read(CL_PROFILING_COMMAND_START, times.start_ns) || !read(CL_PROFILING_COMMAND_END, times.end_ns))
    times.start_ns = times.end_ns = 0;
  const double seconds = seconds_of(times);
  const std::string name = name_of(kernel);
  KernelTime& time = times_[name];
  time.launches += 1;
  time.seconds += seconds;
  const bool has_clock = is_believable(times);
  if (!has_clock) times.end_ns = times.start_ns + static_cast<std::uint64_t>(1e9 * seconds);
  if (recording_) launches_.push_back({name, label_, times.start_ns, times.end_ns, called, has_clock});
  return seconds;
}

double Session::run(cl::Kernel& kernel, const LaunchShape& shape, cl_uint arguments) {
  if (before_launch_) before_launch_();
  const Clock::time_point called = Clock::now();
  cl::Event event;
  enqueue(kernel, shape, arguments, event);
  return wait(kernel, event, called);
}

} // namespace pointgi
