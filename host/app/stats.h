#pragma once
#include "host/app/picture_output.h"
#include "host/cl/session.h"
#include "host/photon/trace_photons.h"
#include "host/render/render.h"
#include "host/stages/indirect_stages.h"
#include "host/stages/stages.h"
#include "host/tune/tuned.h"
#include "octree/pack/pools.h"
#include <nlohmann/json.hpp>

namespace pointgi {

/// What `--stats` writes (interface.md: Stats).
struct Stats {
  std::string command, integrator;
  const Scene* scene = nullptr;
  OctreeSummary octree;
  const Session* session = nullptr;
  RenderTotals render;                      ///< of the command render
  const IndirectLight* indirect = nullptr;  ///< null, or without applies: there was none
  std::optional<PhotonLedger> photons;      ///< absent: none were sent
  double photon_watts = 1.0;                ///< W of the ledger's unit
  std::optional<DenoisedPictures> denoised; ///< absent: pictures were not
  VariantChoice variant;
  double seconds = 0.0;
};

/// Writes the JSON object atomically. Throws Error(output).
void write_stats(const std::string& path, const Stats& stats, const StageLog& stages);

/// A variant's choices by their words in a scene file, and its name.
nlohmann::json variant_json(const TraversalVariant& variant);

/// Writes text atomically, for --trace. Throws Error(output).
void write_text(const std::string& path, const std::string& text);

} // namespace pointgi
