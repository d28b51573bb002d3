#include "host/denoise/denoiser.h"
#include "host/error.h"
#include "host/trial.h"
#include <cmath>
#include <cstring>
#include <sys/wait.h>
#include <vector>

namespace pointgi {

namespace {

const char update_remedy[] = "; install another version of Open Image Denoise 2 and set POINTGI_OIDN to its folder";

/// The library's error since the last call; empty: there was none.
std::string error_text(const OidnFunctions& functions, OidnDeviceObject* device, int& code) {
  const char* message = nullptr;
  code = functions.get_device_error(device, &message);
  if (code == oidn_no_error) return {};
  return message != nullptr && *message != '\0' ? message : "error " + std::to_string(code);
}

void require_version(const OidnLibrary& library, int major, const std::string& version) {
  if (major == 2) return;
  throw Error(ErrorKind::usage, "--denoise: " + library.file + " is Open Image Denoise " + version + ", which is too " +
                                    (major < 2 ? "old" : "new") + ": version 2 is needed" + update_remedy);
}

} // namespace

Denoiser::Denoiser(int threads)
    : library_(load_oidn()), device_(library_.functions.new_device(oidn_cpu), library_.functions.release_device) {
  const OidnFunctions& f = library_.functions;
  const auto fail = [&](const std::string& text) {
    return Error(ErrorKind::usage, "--denoise: " + library_.file + " cannot denoise on this processor: " +
                                       (text.empty() ? "no reason is given" : text) + update_remedy);
  };
  int code = oidn_no_error;
  OidnDeviceObject* const device = device_.get();
  if (device == nullptr) throw fail(error_text(f, nullptr, code));
  const int major = f.get_device_int(device, "versionMajor");
  version_ = std::to_string(major) + "." + std::to_string(f.get_device_int(device, "versionMinor")) + "." +
             std::to_string(f.get_device_int(device, "versionPatch"));
  require_version(library_, major, version_);
  f.set_device_int(device, "numThreads", threads);
  f.set_device_bool(device, "setAffinity", false); // the host's threads go on afterwards, wherever there is room
  f.commit_device(device);
  if (const std::string text = error_text(f, device, code); !text.empty()) throw fail(text);
}

void Denoiser::filter(const DenoiseImages& images) const {
  const OidnFunctions& f = library_.functions;
  const std::unique_ptr<OidnFilterObject, void (*)(OidnFilterObject*)> filter(f.new_filter(device_.get(), "RT"),
                                                                              f.release_filter);
  int code = oidn_no_error;
  const auto check = [&] {
    const std::string text = error_text(f, device_.get(), code);
    if (filter != nullptr && text.empty()) return;
    throw Error(code == oidn_out_of_memory ? ErrorKind::memory : ErrorKind::device,
                "--denoise: Open Image Denoise " + version_ +
                    " failed: " + (text.empty() ? "no reason is given" : text) +
                    (code == oidn_out_of_memory ? "; set a smaller --size, or leave --denoise out" : update_remedy));
  };
  if (filter == nullptr) check();
  const std::size_t pixel = 3 * sizeof(float), row = pixel * static_cast<std::size_t>(images.width);
  const auto set = [&](const char* name, const float* data) {
    if (data == nullptr) return;
    f.set_filter_image(filter.get(), name, const_cast<float*>(data), oidn_float3,
                       static_cast<std::size_t>(images.width), static_cast<std::size_t>(images.height), 0, pixel, row);
  };
  set("color", images.light);
  set("albedo", images.albedo);
  set("normal", images.normal);
  set("output", images.output);
  if (images.light != nullptr) {
    f.set_filter_bool(filter.get(), "hdr", true);
    f.set_filter_bool(filter.get(), "cleanAux", images.clean);
  }
  f.commit_filter(filter.get());
  check();
  f.execute_filter(filter.get());
  check();
}

namespace {

/// The trial, in the process of its own.
void denoise_small_picture() {
  constexpr int side = 16;
  const Denoiser denoiser(1);
  std::vector<float> grey(3 * side * side, 0.5f), output(grey.size());
  DenoiseImages images;
  images.width = images.height = side;
  images.light = images.albedo = images.normal = grey.data();
  images.output = output.data();
  denoiser.filter(images);
  for (const float value : output)
    if (!std::isfinite(value))
      throw Error(ErrorKind::usage, "--denoise: " + denoiser.file() + " makes a grey picture into " +
                                        std::to_string(value) + update_remedy);
}

/// A byte for the kind of an error, then its text; nothing where there was none.
std::string outcome_of_trial() {
  try {
    denoise_small_picture();
  } catch (const Error& error) {
    return static_cast<char>('0' + static_cast<int>(error.kind())) + std::string(error.what());
  } catch (const std::exception& error) {
    return static_cast<char>('0' + static_cast<int>(ErrorKind::internal)) + std::string(error.what());
  }
  return {};
}

} // namespace

void try_denoiser() {
  const Trial trial = try_in_child(outcome_of_trial);
  if (!trial.outcome.empty()) throw Error(static_cast<ErrorKind>(trial.outcome[0] - '0'), trial.outcome.substr(1));
  if (trial.status != 0)
    throw Error(
        ErrorKind::usage,
        "--denoise: the library of Open Image Denoise crashes" +
            (WIFSIGNALED(trial.status) ? std::string(" (") + strsignal(WTERMSIG(trial.status)) + ")" : std::string()) +
            ": it is damaged, or this processor cannot run it" + update_remedy);
}

} // namespace pointgi
