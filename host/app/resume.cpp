#include "host/app/resume.h"
#include "host/atomic_file.h"
#include <spdlog/spdlog.h>

namespace pointgi {

std::string checkpoint_folder(const std::string& output) {
  return output + ".checkpoint";
}

std::unique_ptr<Checkpoint> open_checkpoint(const LightOptions& options, const std::string& output,
                                            std::function<std::string()> key) {
  const std::string folder = checkpoint_folder(output);
  const bool is_there = Checkpoint::is_in(folder);
  auto checkpoint =
      std::make_unique<Checkpoint>(CheckpointOptions{folder, std::move(key), options.checkpoint_seconds, options.resume,
                                                     [](const std::string& text) { spdlog::warn("{}", text); }});
  if (is_there && checkpoint->take_folder() && !options.resume)
    spdlog::info("{}: an earlier run has kept work here, which --resume goes on from; without that all is done again",
                 folder);
  if (options.resume && !is_there) spdlog::info("--resume: nothing is kept in {}: all is done", folder);
  if (options.resume) remove_unfinished(output);
  return checkpoint;
}

void close_checkpoint(Checkpoint* checkpoint, const std::string& output, bool interrupted) {
  if (checkpoint == nullptr) return;
  if (checkpoint->found() > 0) spdlog::info("{} pieces of work were an earlier run's", checkpoint->found());
  if (!interrupted) return checkpoint->remove();
  try {
    checkpoint->flush();
  } catch (const std::bad_alloc&) { // the run has ended for a reason of its own
  }
  if (const std::string folder = checkpoint_folder(output); Checkpoint::is_in(folder) && checkpoint->take_folder())
    spdlog::info("the same command with --resume goes on from {}", folder);
}

} // namespace pointgi
