#pragma once
/// Whether a device answers right: asked before its pictures are believed.
#include "host/cl/session.h"

namespace pointgi {

/// Builds what a picture by the device's default variant begins with, and compares the nearest hits of some rays,
/// through pools in the variant's storage, images among them, with a linear scan on the host. About a second. Empty, or
/// what is wrong.
std::string self_test(Session& session);

/// By `selector`, as choose_among (host/cl/device_choice.h) says; devices other than CPUs are used where they pass the
/// self-test. Warnings go to the log. Throws Error(device).
Device choose_tested_device(const std::string& selector);

} // namespace pointgi
