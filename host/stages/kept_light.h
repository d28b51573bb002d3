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

/// Not the radiosity, of which the irradiance was gathered.
void pack(Packer& to, const RadiosityField& field);
void unpack(Unpacker& from, RadiosityField& field);

void pack(Packer& to, const TracedPhotons& traced);
void unpack(Unpacker& from, TracedPhotons& traced);

} // namespace pointgi
