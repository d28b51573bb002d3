#pragma once
/// Calls into libraries that may crash, tried out in a child process first.
#include <functional>
#include <string>

namespace pointgi {

struct Trial {
  std::string outcome; ///< what the work returned; empty where it crashed
  int status = 0;      ///< of waitpid(): 0 where it did not, and where no child could be made
};

/// Runs `work` in a child, whose stdout and stderr go nowhere, and waits for its end. Threads of this process are not
/// there in the child: the work may wait for none of them.
Trial try_in_child(const std::function<std::string()>& work);

} // namespace pointgi
