#pragma once
/// Every variant there is, and what each asks of the device. The shared tests, `pointgi profile`, `devices --check` and
/// compilers for other devices take their variants from here.
#include "host/cl/device.h"
#include "host/passes/variant.h"
#include <vector>

namespace pointgi {

/// One thing that must hold for some variants.
struct Precondition {
  const char* sentence; ///< "packets go through the wide form"
  bool (*concerns)(const TraversalVariant&);
  bool (*holds)(const TraversalVariant&, const DeviceInfo&);
};

const std::vector<Precondition>& preconditions();

/// The sentence of the first precondition that the variant breaks on this device; empty when it is valid there. Images
/// may still be too small for a large cloud (host/passes/device_pools.h: images_fit).
std::string why_not(const TraversalVariant& variant, const DeviceInfo& device);

/// The variant that the others are measured and checked against: the plainest, proved by linear scans.
TraversalVariant reference_variant();

/// What a form is where neither the user nor a tuned file says more.
TraversalVariant plain_variant(TraversalForm form);

/// All that give the same answers, the reference first; those with fast math, which give nearly the same, last.
/// Steps by an absolute delta are not among them: they may jump over surfaces.
std::vector<TraversalVariant> all_variants();

/// Those of all_variants() whose tracing kernels or pools differ: render-only differences are left out.
std::vector<TraversalVariant> tracing_variants();

/// A program and the kinds of device that its variants are for.
struct ProgramUse {
  Program program;
  bool cpu = false, gpu = false;
};

/// Distinct programs, those of the tests among them: every walk, absolute delta included, with no scene feature and
/// with all of them; every work-group with the usual walks only, for one does not depend on the other and all of their
/// combinations would be compiled for a quarter of an hour. With the usual walk of each form and the usual work-group,
/// all that any scene asks a GPU for (features_on()): `gpu` is what is built there, not what is known to run well.
std::vector<ProgramUse> all_programs();

/// A device of this kind that lacks nothing, to ask what is valid without a device.
DeviceInfo ideal_device(bool cpu);

} // namespace pointgi
