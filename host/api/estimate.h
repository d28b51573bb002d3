#pragma once
/// What a picture will cost, told before it is made. For the command line; not installed.
#include "host/api/film.h"
#include <string>
#include <vector>

namespace pointgi::api {

/// One stage, by the name that it has in the log and in --stats.
struct StageEstimate {
  std::string stage;
  bool runs = false;
  std::string why;         ///< it runs, or does not
  double seconds = 0.0;    ///< by the wall clock; stages that have run already: those that they took
  std::uint64_t bytes = 0; ///< that the device holds while it runs, at most: what is there before among them
  double items = 0.0;      ///< in the stage's own unit, as StageRecord
  std::string unit;
};

struct PictureEstimate {
  std::vector<StageEstimate> stages; ///< in the order in which they run
  double exchange_rays = 0.0;        ///< that decide which points see each other
  unsigned applies = 0;              ///< of the exchange: applies of the operator, or passes

  double seconds() const;
  std::uint64_t peak_bytes() const;
  const StageEstimate* stage(const std::string& name) const; ///< nullptr: it is not there
};

/// Of the picture that `film` shows of the prepared scene, its light solved anew and no V-map kept. The stages that
/// prepared the scene are told as they were, `plan` is run, of the others a small part is: in some seconds, more where
/// kernels have to be built, which is not in the figures. Neither the context's log of stages nor the kept V-maps
/// change. Throws as Light and Film do.
PictureEstimate estimate_picture(const Prepared& prepared, const FilmOptions& film = {}, const RunControl& run = {});

} // namespace pointgi::api
