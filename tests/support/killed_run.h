#pragma once
/// The program, ended by SIGKILL in the midst of its work.
#include "tests/support/temporary_folder.h"
#include <csignal>
#include <fcntl.h>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace pointgi::test {

/// Starts the program with words separated by spaces, asks `is_time` every few milliseconds, and kills the program as
/// soon as it says so. Returns whether it was killed; false: it had ended by itself. Its words go to `log`.
inline bool run_and_kill(const std::string& words, const std::string& log, const std::function<bool()>& is_time) {
  std::vector<std::string> arguments{POINTGI_BINARY};
  std::istringstream in(words);
  for (std::string word; in >> word;)
    arguments.push_back(word);
  std::vector<char*> argv;
  for (std::string& argument : arguments)
    argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    const int file = open(log.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  for (int status = 0;;) {
    if (waitpid(child, &status, WNOHANG) == child) return false;
    if (is_time()) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return WIFSIGNALED(status);
    }
    usleep(2000);
  }
}

/// Files below the folder whose names end so.
inline std::size_t files_that_end(const std::string& folder, const std::string& end) {
  std::size_t count = 0;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    count += name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
  }
  return count;
}

} // namespace pointgi::test
