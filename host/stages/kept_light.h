#pragma once
/// What a checkpoint (host/cache/checkpoint.h) keeps of the stages of light.
#include "host/cache/checkpoint.h"
#include "host/photon/trace_photons.h"
#include "host/stages/indirect_stages.h"

namespace pointgi {

void pack(Packer& to, const ShaftLight& light);
void unpack(Unpacker& from, ShaftLight& light);

/// Not what light is solved with (IndirectLight::prepared) and what that says of itself.
void pack(Packer& to, const IndirectLight& light);
void unpack(Unpacker& from, IndirectLight& light);

/// What add_exchange() has solved.
struct AddedExchange {
  RadiosityField field;   ///< kept without the radiosity, of which the irradiance was gathered
  std::uint64_t rays = 0; ///< traced for it
};

void pack(Packer& to, const AddedExchange& added);
void unpack(Unpacker& from, AddedExchange& added);

void pack(Packer& to, const TracedPhotons& traced);
void unpack(Unpacker& from, TracedPhotons& traced);

} // namespace pointgi
