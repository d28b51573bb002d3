#pragma once
/// The program as a user starts it.
#include "tests/support/temporary_folder.h"
#include <cstdio>
#include <string>
#include <sys/wait.h>

namespace pointgi::test {

struct Run {
  int code = -1;   ///< exit code, or 128 + signal
  std::string out; ///< stdout
  std::string err; ///< stderr
};

/// `arguments` as a shell reads them; `before` goes in front of the program: variables, `timeout`, `ulimit …;`.
inline Run run_program(const std::string& arguments, const std::string& before = "") {
  const TemporaryFolder folder;
  const std::string out = folder.file("out"), err = folder.file("err");
  const std::string command = before + " " POINTGI_BINARY " " + arguments + " >" + out + " 2>" + err + " </dev/null";
  const int status = std::system(command.c_str());
  Run run;
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  const auto text = [](const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  run.out = text(out);
  run.err = text(err);
  return run;
}

/// A scene that renders in a blink: a ball under a light.
inline const char* small_scene() {
  return "version = 1\n[render]\nsize = [40, 30]\nspp = 4\n"
         "[camera]\nposition = [0.0, 0.6, 3.0]\nlook_at = [0.0, 0.0, 0.0]\nfov_deg = 40.0\n"
         "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\nalbedo = [0.6, 0.6, 0.6]\n"
         "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 0.8\nspacing = 0.05\nmaterial = \"grey\"\n"
         "[[light]]\ntype = \"point\"\nposition = [1.0, 2.0, 2.0]\npower_w = [90.0, 90.0, 90.0]\n";
}

/// The same with a mirror below.
inline std::string mirror_scene() {
  return std::string(small_scene()) +
         "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\n"
         "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, -1.0, -1.0]\nedge_u = [0.0, 0.0, 2.0]\n"
         "edge_v = [2.0, 0.0, 0.0]\nspacing = 0.1\nmaterial = \"mirror\"\n";
}

} // namespace pointgi::test
