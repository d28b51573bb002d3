#include "tests/golden/faults/fault_sweep.h"
#include <CL/cl.h>
#include <atomic>
#include <cerrno>
#include <mutex>
#include <thread>

namespace pointgi::test {

namespace {

/// A function and what it may answer; its calls take the codes in turn.
struct FailingFunction {
  const char* kind;
  const char* name;
  std::vector<int> codes;
};

const std::vector<FailingFunction>& failing_functions() {
  constexpr int memory = CL_MEM_OBJECT_ALLOCATION_FAILURE, resources = CL_OUT_OF_RESOURCES,
                host_memory = CL_OUT_OF_HOST_MEMORY, nobody_knows = -9999; // NVIDIA's for an illegal access
  static const std::vector<FailingFunction> functions{
      {"build", "clCreateProgramWithSource", {host_memory, resources}},
      {"build", "clCreateProgramWithBinary", {CL_INVALID_BINARY, host_memory}},
      {"build", "clBuildProgram", {CL_BUILD_PROGRAM_FAILURE, CL_COMPILER_NOT_AVAILABLE, host_memory}},
      {"build", "clGetProgramInfo", {resources, CL_INVALID_PROGRAM}},
      {"build", "clGetProgramBuildInfo", {resources, CL_INVALID_VALUE}},
      {"build", "clCreateKernel", {host_memory, resources}},
      {"buffer", "clCreateBuffer", {memory, resources, host_memory}},
      {"buffer", "clSetMemObjectDestructorCallback", {host_memory, resources}},
      {"image", "clCreateImage", {memory, CL_IMAGE_FORMAT_NOT_SUPPORTED, resources}},
      {"image", "clEnqueueWriteImage", {memory, resources}},
      {"enqueue", "clSetKernelArg", {host_memory, CL_INVALID_ARG_SIZE, resources}},
      {"enqueue", "clGetKernelInfo", {resources, host_memory}},
      {"enqueue", "clGetKernelWorkGroupInfo", {resources, host_memory}},
      {"enqueue", "clEnqueueNDRangeKernel", {resources, memory, CL_INVALID_WORK_GROUP_SIZE, host_memory, nobody_knows}},
      {"enqueue", "clEnqueueWriteBuffer", {memory, resources, nobody_knows}},
      {"enqueue", "clEnqueueFillBuffer", {memory, resources}},
      {"enqueue", "clEnqueueCopyBuffer", {memory, resources}},
      {"enqueue", "clFlush", {resources, host_memory}},
      {"read", "clEnqueueReadBuffer", {memory, resources, nobody_knows}},
      {"read", "clFinish", {resources, host_memory}},
      {"event", "clWaitForEvents", {CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST, resources}},
      {"event", "clGetEventProfilingInfo", {CL_PROFILING_INFO_NOT_AVAILABLE, resources}},
      {"device", "clGetPlatformIDs", {host_memory, -1001}}, // CL_PLATFORM_NOT_FOUND_KHR
      {"device", "clGetPlatformInfo", {host_memory}},
      {"device", "clGetDeviceIDs", {CL_DEVICE_NOT_FOUND, resources}},
      {"device", "clGetDeviceInfo", {resources, host_memory}},
      {"device", "clCreateContext", {CL_DEVICE_NOT_AVAILABLE, host_memory}},
      {"device", "clCreateCommandQueue", {host_memory, resources}},
      {"thread", "pthread_create", {EAGAIN}},
      {"file", "open", {EACCES, EMFILE, ENOSPC}},
      {"file", "fopen", {EACCES, EMFILE}},
      {"file", "read", {EIO, EINTR, 0}},
      {"file", "pread", {EIO, EINTR, 0}},
      {"file", "write", {ENOSPC, EIO, EINTR, 0}},
      {"file", "pwrite", {ENOSPC, EIO, EINTR, 0}},
      {"file", "fsync", {EIO, ENOSPC}},
      {"file", "close", {EIO, ENOSPC}},
      {"file", "rename", {EACCES, EIO}},
      {"file", "mkdir", {EACCES, ENOSPC}},
      {"file", "stat", {EACCES, EIO}},
      {"file", "fstat", {EIO}},
  };
  return functions;
}

std::size_t count_of(const CallReport& calls, const std::string& name) {
  const auto found = calls.counts.find(name);
  return found == calls.counts.end() ? 0 : found->second;
}

} // namespace

std::vector<std::string> fault_kinds() {
  return {"build", "buffer", "image", "enqueue", "read",       "event",    "device",
          "lost",  "thread", "file",  "killed",  "allocation", "exhausted"};
}

std::vector<Fault> faults_of(const std::string& kind, const CallReport& calls) {
  const std::vector<std::string> kinds = fault_kinds();
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw std::invalid_argument("no kind of fault: " + kind);
  std::vector<Fault> faults;
  if (kind == "allocation" || kind == "exhausted")
    for (const std::string& place : calls.places)
      faults.push_back({"allocation", place, 0, kind == "exhausted"});
  if (kind == "lost")
    for (const char* call : {"clEnqueueNDRangeKernel", "clWaitForEvents", "clEnqueueReadBuffer"})
      for (std::size_t n = 1; n <= count_of(calls, call); ++n)
        faults.push_back({call, std::to_string(n), n % 2 == 0 ? CL_OUT_OF_RESOURCES : -9999, true});
  for (const FailingFunction& function : failing_functions()) {
    const bool kills = kind == "killed" && function.kind == std::string("file");
    if (kind != function.kind && !kills) continue;
    for (std::size_t n = 1; n <= count_of(calls, function.name); ++n)
      faults.push_back(
          {function.name, std::to_string(n), kills ? kill_there : function.codes[n % function.codes.size()], false});
  }
  return faults;
}

FaultTally try_faults(const FaultScene& scene, const std::vector<Fault>& faults) {
  FaultTally tally;
  std::mutex mutex;
  std::atomic<std::size_t> next{0};
  const auto work = [&](int slot) {
    for (std::size_t at; (at = next++) < faults.size();) {
      const Judgement judgement = scene.judge(faults[at], slot);
      const std::lock_guard<std::mutex> lock(mutex);
      ++tally.tried;
      tally.right_pictures += judgement.outcome == Outcome::right_picture;
      tally.clear_errors += judgement.outcome == Outcome::clear_error;
      tally.killed += judgement.outcome == Outcome::killed;
      tally.not_met += judgement.outcome == Outcome::not_met;
      if (judgement.outcome == Outcome::broken) tally.findings.push_back(judgement.finding);
    }
  };
  std::thread second(work, 2);
  work(1);
  second.join();
  for (const int slot : {1, 2})
    if (const std::string wrong = scene.undisturbed("", slot); !wrong.empty())
      tally.findings.push_back(scene.way().name + ": after the faults an undisturbed run fails: " + wrong);
  return tally;
}

} // namespace pointgi::test
