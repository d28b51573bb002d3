#include "host/cache/binary_cache.h"
#include "host/cl/kernel_source.h"
#include "host/cl/quirks.h"
#include "host/cl/session.h"
#include "host/error.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace pointgi {

namespace {

std::string build_log(const cl::Program& program, const cl::Device& device) {
  try {
    std::string log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    log.erase(std::find(log.begin(), log.end(), '\0'), log.end());
    return log;
  } catch (const cl::Error&) {
    return "(the driver gives no build log)";
  }
}

/// Throws cl::Error. The C call: the C++ one asks for the log of every build, so that a good build fails and a bad one
/// loses its code where a driver has no log to give.
void build_for(const cl::Program& program, const cl::Device& device, const std::string& options) {
  const cl_device_id id = device();
  const int code = clBuildProgram(program(), 1, &id, options.c_str(), nullptr, nullptr);
  if (code != CL_SUCCESS) throw cl::Error(code, "clBuildProgram");
}

/// Empty where the driver has none to give: the cache can do without.
std::vector<unsigned char> binary_of(const cl::Program& program) {
  try {
    const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
    return binaries.empty() ? std::vector<unsigned char>() : binaries.front();
  } catch (const cl::Error&) {
    return {};
  }
}

} // namespace

const cl::Program& Session::program(const std::string& file, const std::string& options) {
  const std::string name = file + "\n" + options;
  const auto found = programs_.find(name);
  return found != programs_.end() ? found->second : programs_.emplace(name, build(file, options)).first->second;
}

std::vector<std::pair<std::string, std::string>> Session::programs_asked() const {
  std::vector<std::pair<std::string, std::string>> asked;
  for (const auto& [name, program] : programs_) {
    const std::size_t end = name.find('\n');
    asked.emplace_back(name.substr(0, end), name.substr(end + 1));
  }
  return asked;
}

cl::Program Session::build(const std::string& file, const std::string& options) {
  const char* more = std::getenv("POINTGI_CL_OPTIONS"); // for people who debug kernels: -cl-opt-disable, -g
  const std::string all_options = "-cl-std=CL1.2" + (options.empty() ? "" : " " + options) + quirk_options(info_) +
                                  (more != nullptr && *more != '\0' ? " " + std::string(more) : "");
  const std::string source = kernel_source(file);
  dump(file, all_options, source);
  const std::string key = source + "\n" + all_options + "\n" + info_.platform + "\n" + info_.name + "\n" +
                          info_.driver + "\n" + info_.opencl;
  const std::vector<cl::Device> devices{device_};
  const bool by_driver = has_quirk(info_, Quirk::keeps_kernels);
  if (const auto binary = by_driver ? std::nullopt : load_binary(key)) {
    try {
      cl::Program program(context_, devices, cl::Program::Binaries{*binary});
      build_for(program, device_, all_options);
      ++from_cache_;
      return program;
    } catch (const cl::Error&) {
      // The driver refuses what another build of it wrote: compile anew.
    }
  }
  cl::Program program;
  try {
    ask_faults({DeviceCall::Kind::build, file, 0, 0});
    program = cl::Program(context_, source);
    build_for(program, device_, all_options);
  } catch (const cl::Error& error) {
    throw Error(ErrorKind::device, "kernels/" + file + " did not compile: " + cl_error_name(error.err()) +
                                       "\ndevice:  " + info_.name + " (" + info_.platform +
                                       ")\ndriver:  " + info_.driver + "\noptions: " + all_options + "\n" +
                                       build_log(program, device_) + "\n; use another --device, or a newer driver");
  }
  ++(by_driver ? kept_by_driver_ : compiled_);
  if (by_driver) return program;
  if (const auto binary = binary_of(program); !binary.empty()) store_binary(key, binary);
  return program;
}

void Session::dump(const std::string& file, const std::string& options, const std::string& source) const {
  if (dump_folder_.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(dump_folder_, ignored);
  std::string name = file;
  std::replace(name.begin(), name.end(), '/', '_');
  char hash[16]; // of one file there are programs of several options
  std::snprintf(hash, sizeof hash, "-%08x", static_cast<unsigned>(fnv1a(options) & 0xffffffffu));
  name.insert(name.rfind('.'), hash);
  std::ofstream out(dump_folder_ + "/" + name);
  out << "/* clBuildProgram options: " << options << " */\n" << source;
  if (!out)
    throw Error(ErrorKind::output,
                dump_folder_ + ": cannot write " + name + "; choose a writable --dump-kernels folder");
}

std::string cl_error_name(int code) {
  struct Name {
    int code;
    const char* name;
  };
#define NAME(code)                                                                                                     \
  { code, #code }
  static constexpr Name names[] = {NAME(CL_DEVICE_NOT_FOUND),
                                   NAME(CL_DEVICE_NOT_AVAILABLE),
                                   NAME(CL_COMPILER_NOT_AVAILABLE),
                                   NAME(CL_MEM_OBJECT_ALLOCATION_FAILURE),
                                   NAME(CL_OUT_OF_RESOURCES),
                                   NAME(CL_OUT_OF_HOST_MEMORY),
                                   NAME(CL_PROFILING_INFO_NOT_AVAILABLE),
                                   NAME(CL_IMAGE_FORMAT_NOT_SUPPORTED),
                                   NAME(CL_BUILD_PROGRAM_FAILURE),
                                   NAME(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST),
                                   NAME(CL_INVALID_VALUE),
                                   NAME(CL_INVALID_DEVICE),
                                   NAME(CL_INVALID_CONTEXT),
                                   NAME(CL_INVALID_QUEUE_PROPERTIES),
                                   NAME(CL_INVALID_COMMAND_QUEUE),
                                   NAME(CL_INVALID_MEM_OBJECT),
                                   NAME(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR),
                                   NAME(CL_INVALID_IMAGE_SIZE),
                                   NAME(CL_INVALID_BINARY),
                                   NAME(CL_INVALID_BUILD_OPTIONS),
                                   NAME(CL_INVALID_PROGRAM),
                                   NAME(CL_INVALID_PROGRAM_EXECUTABLE),
                                   NAME(CL_INVALID_KERNEL_NAME),
                                   NAME(CL_INVALID_KERNEL),
                                   NAME(CL_INVALID_ARG_INDEX),
                                   NAME(CL_INVALID_ARG_VALUE),
                                   NAME(CL_INVALID_ARG_SIZE),
                                   NAME(CL_INVALID_KERNEL_ARGS),
                                   NAME(CL_INVALID_WORK_GROUP_SIZE),
                                   NAME(CL_INVALID_WORK_ITEM_SIZE),
                                   NAME(CL_INVALID_EVENT),
                                   NAME(CL_INVALID_OPERATION),
                                   NAME(CL_INVALID_BUFFER_SIZE),
                                   NAME(CL_INVALID_IMAGE_DESCRIPTOR)};
#undef NAME
  for (const Name& entry : names)
    if (entry.code == code) return std::string(entry.name) + " (" + std::to_string(code) + ")";
  return "OpenCL error " + std::to_string(code);
}

} // namespace pointgi
