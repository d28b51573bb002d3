#pragma once
#include "host/app/stages.h"
#include "host/cl/session.h"
#include "host/passes/render.h"
#include "octree/pack/pools.h"

namespace pointgi {

/// What `--stats` writes (interface.md: Stats).
struct Stats {
  std::string command;
  const Scene* scene = nullptr;
  OctreeSummary octree;
  const Session* session = nullptr;
  RenderTotals render;
  double seconds = 0.0;
};

/// Writes the JSON object atomically. Throws Error(output).
void write_stats(const std::string& path, const Stats& stats, const StageLog& stages);

/// Writes text atomically, for --trace. Throws Error(output).
void write_text(const std::string& path, const std::string& text);

/// Most memory that the process has held, bytes.
std::uint64_t host_peak_bytes();

} // namespace pointgi
