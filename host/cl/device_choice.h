#pragma once
/// Which device to use where some may not work.
#include "host/cl/device.h"
#include <functional>

namespace pointgi {

/// Says what is wrong with the device of this place in the list; empty: it works.
using DeviceTest = std::function<std::string(std::size_t)>;

struct DeviceChoice {
  std::size_t place = 0;
  std::vector<std::string> warnings; ///< one for each device that would have been taken and does not work
};

std::vector<DeviceInfo> infos_of(const std::vector<Device>& devices);

/// The places of `devices` in the order in which they are tried where nobody names one: GPUs, those of most memory
/// first; CPU devices; all others.
std::vector<std::size_t> by_preference(const std::vector<DeviceInfo>& devices);

/// By `selector`: a place in `devices`, "cpu", "gpu", or a part of a name (case does not matter), of several the first
/// of by_preference; empty: the first of by_preference that works. Devices other than CPUs are asked `test` before they
/// are taken. Throws Error(device) that lists what there is where none is found, or that says what is wrong with the
/// one that `selector` names, or with all.
DeviceChoice choose_among(const std::vector<DeviceInfo>& devices, const std::string& selector, const DeviceTest& test);

} // namespace pointgi
