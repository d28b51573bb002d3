#include "host/cl/session.h"
#include "host/error.h"
#include <algorithm>

namespace pointgi {

namespace {

std::string megabytes(std::uint64_t bytes) {
  return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
}

bool is_memory_error(int code) {
  return code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_RESOURCES || code == CL_OUT_OF_HOST_MEMORY ||
         code == CL_INVALID_BUFFER_SIZE;
}

[[noreturn]] void rethrow(const cl::Error& error, const DeviceInfo& info, const std::string& doing) {
  const std::string text = info.name + ": " + doing + " failed: " + cl_error_name(error.err());
  if (is_memory_error(error.err()))
    throw Error(ErrorKind::memory, text + "; the device has " + megabytes(info.memory_bytes) +
                                       " in all; use a smaller scene, or another --device");
  throw Error(ErrorKind::device, text);
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
    rethrow(error, info_, "opening the device");
  }
}

Session::~Session() = default;

cl::Kernel Session::kernel(const std::string& file, const std::string& options, const std::string& name) {
  const cl::Program& built = program(file, options);
  try {
    return cl::Kernel(built, name.c_str());
  } catch (const cl::Error& error) {
    throw Error(ErrorKind::internal, "kernels/" + file + " has no kernel " + name + ": " + cl_error_name(error.err()));
  }
}

void Session::account(const cl::Memory& memory, std::uint64_t bytes) {
  bytes_->now += bytes;
  bytes_->peak = std::max(bytes_->peak, bytes_->now.load());
  // The counter outlives the session as long as memory does: whoever holds the last reference ends the count.
  struct Release {
    std::shared_ptr<Bytes> total;
    std::uint64_t bytes;
  };
  auto* release = new Release{bytes_, bytes};
  const auto callback = [](cl_mem, void* data) {
    auto* r = static_cast<Release*>(data);
    r->total->now -= r->bytes;
    delete r;
  };
  if (clSetMemObjectDestructorCallback(memory(), callback, release) != CL_SUCCESS) delete release;
}

cl::Buffer Session::allocate_bytes(std::size_t bytes, cl_mem_flags flags) {
  // Zero-sized buffers do not exist in OpenCL; an unused argument still needs one.
  const std::size_t size = std::max<std::size_t>(bytes, 16);
  if (size > info_.max_allocation_bytes)
    throw Error(ErrorKind::memory, info_.name + ": a buffer of " + megabytes(size) +
                                       " is needed, and the device gives " + megabytes(info_.max_allocation_bytes) +
                                       " at most in one piece; use a smaller cloud, or another --device");
  try {
    cl::Buffer buffer(context_, flags, size);
    account(buffer, size);
    return buffer;
  } catch (const cl::Error& error) {
    rethrow(error, info_, "allocating " + megabytes(size));
  }
}

void Session::write_bytes(const cl::Buffer& buffer, const void* data, std::size_t bytes) {
  if (bytes == 0) return;
  try {
    queue_.enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes, data);
  } catch (const cl::Error& error) {
    rethrow(error, info_, "copying " + megabytes(bytes) + " to the device");
  }
}

void Session::read_bytes(const cl::Buffer& buffer, void* data, std::size_t bytes) {
  if (bytes == 0) return;
  try {
    queue_.enqueueReadBuffer(buffer, CL_TRUE, 0, bytes, data);
  } catch (const cl::Error& error) {
    rethrow(error, info_, "copying " + megabytes(bytes) + " from the device");
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
    rethrow(error, info_, "making an image1d_buffer");
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
    rethrow(error, info_, "making an image");
  }
}

namespace {

std::string name_of(const cl::Kernel& kernel) {
  std::string name = kernel.getInfo<CL_KERNEL_FUNCTION_NAME>();
  name.erase(std::find(name.begin(), name.end(), '\0'), name.end());
  return name;
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
  throw Error(ErrorKind::device, info_.name + ": argument " + std::to_string(index) + " of " + name_of(kernel) +
                                     " was refused: " + cl_error_name(error.err()));
}

double Session::run(cl::Kernel& kernel, const LaunchShape& shape, cl_uint arguments) {
  if (before_launch_) before_launch_();
  try {
    check_launch(kernel, device_, info_, shape, arguments);
    cl::Event event;
    queue_.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(shape.global[0], shape.global[1]),
                                cl::NDRange(shape.local[0], shape.local[1]), nullptr, &event);
    event.wait();
    const auto returned = std::chrono::steady_clock::now();
    const std::uint64_t start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
                        end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    const double seconds = 1e-9 * static_cast<double>(end - start);
    const std::string name = name_of(kernel);
    KernelTime& time = times_[name];
    time.launches += 1;
    time.seconds += seconds;
    if (recording_) launches_.push_back({name, label_, start, end, returned});
    return seconds;
  } catch (const cl::Error& error) {
    rethrow(error, info_, "running a kernel");
  }
}

} // namespace pointgi
