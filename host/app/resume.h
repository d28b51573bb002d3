#pragma once
/// --resume: what a run keeps beside its output while it works, and how the next run goes on from it.
#include "host/app/commands.h"
#include "host/cache/checkpoint.h"
#include <memory>

namespace pointgi {

/// OUT.exr.checkpoint.
std::string checkpoint_folder(const std::string& output);

/// `key`: checkpoint_key(), asked when something is kept or found; what it refers to must live as long. The log hears
/// what is there of an earlier run, and whether it is used.
std::unique_ptr<Checkpoint> open_checkpoint(const LightOptions& options, const std::string& output,
                                            std::function<std::string()> key);

/// At the end of a run: of one that was interrupted what waits is kept, and the log tells how to go on; else the
/// folder goes. `checkpoint`: may be null.
void close_checkpoint(Checkpoint* checkpoint, const std::string& output, bool interrupted);

/// What `work` returns. Where it throws, what waits is kept first.
template <typename Work>
auto resumable(Checkpoint* checkpoint, const std::string& output, const Work& work) {
  try {
    return work();
  } catch (...) {
    close_checkpoint(checkpoint, output, true);
    throw;
  }
}

} // namespace pointgi
