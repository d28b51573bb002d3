#include "host/app/command_run.h"
#include "host/app/interrupt.h"
#include <spdlog/spdlog.h>

namespace pointgi {

CommandRun::CommandRun(bool quiet)
    : quiet_(quiet), control_{interrupted, [this](const StageProgress& news) { show(news); },
                              [this](LogLevel level, const std::string& text) {
                                if (progress_) progress_->hide();
                                write_log(level, text);
                              }},
      scope_(control_) {
  catch_interrupts();
}

void CommandRun::show(const StageProgress& news) {
  if (news.share)
    progress_->update(*news.share);
  else if (!news.done.empty())
    progress_->tell(news.done);
  else
    progress_.emplace(news.stage, quiet_);
}

void write_log(LogLevel level, const std::string& text) {
  switch (level) {
  case LogLevel::debug:
    spdlog::debug("{}", text);
    return;
  case LogLevel::info:
    spdlog::info("{}", text);
    return;
  case LogLevel::warning:
    spdlog::warn("{}", text);
  }
}

} // namespace pointgi
