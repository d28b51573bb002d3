/// The man page and the completions have the commands and options that the program has.
#include "tests/support/run_program.h"
#include <catch2/catch.hpp>
#include <regex>
#include <set>
#include <sstream>

using namespace pointgi;
using namespace pointgi::test;

namespace {

using Words = std::set<std::string>;

std::string content(const std::string& path) {
  std::ifstream file(path);
  REQUIRE(file);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

Words matches(const std::string& text, const std::string& pattern) {
  Words found;
  const std::regex expression(pattern);
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at)
    found.insert((*at)[1]);
  return found;
}

/// Options at the beginning of lines of a help text: "-o,--output TEXT".
Words options_in(const std::string& help) {
  Words options;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);)
    if (line.compare(0, 3, "  -") == 0)
      for (const std::string& option : matches(line.substr(0, line.find(' ', 3)) + ",", "(-[-a-z]+),"))
        options.insert(option);
  return options;
}

/// What a command has beyond the options of every command.
std::map<std::string, Words> options_of_commands() {
  const std::string help = run_program("--help").out;
  const std::string commands = help.substr(help.find("Subcommands:"));
  std::map<std::string, Words> found{{"", options_in(help)}};
  for (const std::string& command : matches(commands, "\n  ([a-z]+) "))
    found[command] = options_in(run_program(command + " --help").out);
  return found;
}

/// The part of `text` from `begin` to the next `end`.
std::string part(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  INFO(begin);
  REQUIRE(from != std::string::npos);
  return text.substr(from, text.find(end, from + begin.size()) - from);
}

const std::string texts = POINTGI_TEXTS;

} // namespace

TEST_CASE("the man page has every command and every option, and no other") {
  std::string page = content(texts + "/pointgi.1");
  page = std::regex_replace(page, std::regex("\\\\-"), "-");
  CHECK(page.find("\"pointgi " POINTGI_VERSION "\"") != std::string::npos);
  const auto commands = options_of_commands();
  REQUIRE(commands.size() >= 7);
  Words sections;
  for (const auto& [command, options] : commands) {
    CAPTURE(command);
    const std::string section = command.empty() ? part(page, ".SH OPTIONS OF EVERY COMMAND\n", ".SH COMMANDS")
                                                : part(page, ".SS " + command + "\n", "\n.S");
    Words found;
    for (const std::string& names : matches(section, "\\\\fB(-[^\\\\]*)\\\\fR"))
      for (const std::string& name : matches(names + ",", "(-[-a-z]+),"))
        found.insert(name);
    CHECK(found == options);
    if (!command.empty()) sections.insert(command);
  }
  CHECK(matches(page, ".SS ([a-z]+)\n") == sections);
}

TEST_CASE("bash completes a command's options and no other's") {
  const TemporaryFolder folder;
  const std::string script =
      folder.write("complete.sh", "source '" + texts +
                                      "/pointgi'\nCOMP_WORDS=(pointgi \"$@\")\n"
                                      "COMP_CWORD=$#\n_pointgi\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
  const auto complete = [&](const std::string& words) {
    const std::string out = folder.file("out");
    REQUIRE(std::system(("bash " + script + " " + words + " >" + out).c_str()) == 0);
    return matches(content(out), "([^\n]+)\n");
  };
  const auto commands = options_of_commands();
  Words names;
  for (const auto& [command, options] : commands) {
    CAPTURE(command);
    Words wanted = options;
    if (!command.empty()) {
      names.insert(command);
      wanted.insert({"-v", "--quiet"});
    }
    CHECK(complete((command.empty() ? "" : command + " ") + "-") == wanted);
  }
  Words first = names;
  first.insert(commands.at("").begin(), commands.at("").end());
  CHECK(complete("''") == first);
  CHECK(complete("ren") == Words{"render"});
  CHECK(complete("render x.toml --quality ''") == Words{"draft", "final", "high", "normal"});
  CHECK(complete("render x.toml --in") == Words{"--integrator"});
  CHECK(complete("render ''").empty()); // files
}

TEST_CASE("zsh completes a command's options and no other's") {
  const std::string script = content(texts + "/_pointgi");
  CHECK(script.compare(0, 17, "#compdef pointgi\n") == 0);
  const auto commands = options_of_commands();
  for (const auto& [command, options] : commands) {
    CAPTURE(command);
    const std::string section = command.empty() ? part(script, "_arguments -C", "case $state")
                                                : part(script, "\n    " + command + ")\n", ";;\n");
    CHECK(matches(section, "'\\*(-[-a-z]+)\\[") == options);
    if (!command.empty()) CHECK(script.find("    '" + command + ":") != std::string::npos);
  }
  if (std::system("command -v zsh >/dev/null") == 0)
    CHECK(std::system(("zsh -n '" + texts + "/_pointgi'").c_str()) == 0);
}

TEST_CASE("the documentation shows the program that is built against the installed library") {
  const std::string page = content(POINTGI_SOURCE_DIR "/docs/user/library.md");
  const std::string program = content(POINTGI_SOURCE_DIR "/tests/api/two_views.cpp");
  CHECK(part(page, "```cpp\n", "```\n") == "```cpp\n" + program);
  CHECK(std::count(program.begin(), program.end(), '\n') <= 40); // an example is read at a glance
}
