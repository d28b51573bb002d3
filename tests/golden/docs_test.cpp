/// The documentation keeps its promises: commands run, scenes load, links, files and test cases are there.
///
/// Conventions of README.md and docs/: each line of a ```sh block is a command that is run here, in one folder a file,
/// with small stand-ins for the clouds and scenes that it reads. A ```toml block is a complete scene, a ```toml
/// fragment block is loaded behind a few lines that name what it refers to. Other blocks are text.
#include "host/scene/load_scene.h"
#include "tests/support/fake_oidn.h"
#include "tests/support/markdown.h"
#include "tests/support/run_program.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

using namespace pointgi;
using namespace pointgi::test;
namespace fs = std::filesystem;

namespace {

const fs::path root = POINTGI_SOURCE_DIR;

/// README.md and every page below docs/.
std::vector<MarkdownFile> pages() {
  std::vector<MarkdownFile> all = {read_markdown(root / "README.md")};
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") all.push_back(read_markdown(entry.path()));
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return all;
}

/// Commands of blocks that are not run, each with its reason.
bool exempt(const std::string& command) {
  static const char* const beginnings[] = {
      "./scripts/test",  // this test is part of it
      "./scripts/setup", // installs packages
      "./scripts/build", // the program under test is built already
      "sudo ",
      "apt-get ",
      "pip ",
      "git ", // change the machine, or need the network
      "cmake ",
      "ninja ",
      "c++ ",                    // tests/api builds against the installed package
      "pdal ",                   // a converter that need not be installed
      "scripts/import",          // installs packages of Python; has tests of its own
      "pointgi devices --check", // compiles every program for minutes: part of the device tests
      "scripts/gallery",
      "scripts/bench",
      "build/release/bench" // measurements, minutes to hours
  };
  return std::any_of(std::begin(beginnings), std::end(beginnings),
                     [&](const char* beginning) { return command.rfind(beginning, 0) == 0; });
}

/// 600 points of a ball with normals and colours.
std::string ball_of_points() {
  std::ostringstream ply;
  ply << "ply\nformat ascii 1.0\nelement vertex 600\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
    ply << "property float " << name << "\n";
  for (const char* name : {"red", "green", "blue"})
    ply << "property uchar " << name << "\n";
  ply << "end_header\n";
  for (int i = 0; i < 600; ++i) { // Fibonacci's lattice: even
    const double z = 1.0 - (2.0 * i + 1.0) / 600.0, r = std::sqrt(1.0 - z * z), a = 2.399963229728653 * i;
    for (int repeat = 0; repeat < 2; ++repeat)
      ply << r * std::cos(a) << " " << z << " " << r * std::sin(a) << " ";
    ply << "180 150 120\n";
  }
  return ply.str();
}

/// A file that a command reads, small, by its name's ending.
void make_stand_in(const TemporaryFolder& folder, const std::string& name) {
  const std::string path = folder.file(name);
  if (fs::exists(path)) return;
  fs::create_directories(fs::path(path).parent_path());
  const std::string ending = fs::path(name).extension();
  if (ending == ".ply") folder.write(name, ball_of_points());
  if (ending == ".toml") folder.write(name, mirror_scene());
  if (ending == ".hdr")
    folder.write(name, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x80\x80\x40\x80\x81");
  if (ending == ".obj") folder.write(name, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
}

using Words = std::vector<std::string>;

Words words_of(const std::string& line) {
  Words words;
  std::istringstream in(line);
  for (std::string word; in >> word && word[0] != '#';)
    words.push_back(word);
  return words;
}

/// Sets an option of the command to a value, whether or not the command has it.
void set_option(Words& words, const std::string& option, const std::string& value, bool add = true) {
  const auto at = std::find(words.begin(), words.end(), option);
  if (at != words.end() && at + 1 != words.end())
    *(at + 1) = value;
  else if (add)
    words.insert(words.end(), {option, value});
}

/// The program's arguments of a command line: as they are, but that pictures are small and profiles short.
/// `before`: the variables in front of it. Empty where the line is no command of the program.
Words arguments_of(const std::string& line, std::string& before) {
  Words words = words_of(line);
  while (!words.empty() && std::regex_match(words[0], std::regex("[A-Z_]+=.*"))) {
    before += words[0] + " ";
    words.erase(words.begin());
  }
  if (words.empty()) return {};
  if (words[0] == "./scripts/render") { // as the script does behind its build
    words[0] = "render";
    if (words.size() == 1 || words[1][0] == '-')
      words.insert(words.begin() + 1, {"scenes/demo/room.toml", "-o", "out/room.exr"});
  } else if (words[0] == "pointgi" || words[0] == "build/release/pointgi") {
    words.erase(words.begin());
  } else {
    return {};
  }
  if (words.empty() || std::find(words.begin(), words.end(), "--help") != words.end()) return words;
  if (words[0] == "render") {
    set_option(words, "--size", "32x24");
    const auto has = [&](const char* option) { return std::find(words.begin(), words.end(), option) != words.end(); };
    if (has("--time"))
      set_option(words, "--time", "1");
    else if (!has("--error"))
      set_option(words, "--spp", "1");
    set_option(words, "--pixelbounds", "4,20,2,14", false);
    words.insert(words.end(), {"--set", "caustics.photons=2000"});
  }
  if (words[0] == "measure") {
    set_option(words, "--size", "32x32");
    set_option(words, "--budget", "2");
    set_option(words, "--knobs", "spp");
    words.insert(words.end(), {"--set", "caustics.photons=2000"});
  }
  const bool measures = std::none_of(words.begin(), words.end(), [](const std::string& word) {
    return word == "--list" || word == "--write-programs";
  });
  if (words[0] == "profile" && measures) {
    set_option(words, "--filter", "wide-lanes8-morton-leaf64-packet-8x4");
    set_option(words, "--rounds", "1");
    words.push_back("--no-store");
  }
  return words;
}

/// Makes what the command reads and the folders that it writes to.
void prepare(const TemporaryFolder& folder, const Words& words) {
  for (std::size_t i = 1; i < words.size(); ++i) {
    const bool output = words[i - 1] == "-o" || words[i - 1].rfind("--", 0) == 0;
    if (output)
      fs::create_directories(fs::path(folder.file(words[i])).parent_path());
    else
      make_stand_in(folder, words[i]);
  }
}

/// A scene of what a fragment refers to, and the fragment.
std::string completed(const std::string& fragment) {
  std::string scene = fragment.find("version =") == std::string::npos ? "version = 1\n" : "";
  std::vector<std::string> named;
  const auto has = [&](const std::string& name) { return std::find(named.begin(), named.end(), name) != named.end(); };
  named = all_matches(fragment, "(?:^|\n)name = \"([^\"]+)\"");
  scene += fragment + "\n";
  for (const std::string& name : all_matches(fragment, "(?:^|\n)material = \"([^\"]+)\""))
    if (!has(name)) {
      scene += "[[material]]\nname = \"" + name + "\"\ntype = \"diffuse\"\n";
      named.push_back(name);
    }
  if (fragment.find("[[shape]]") == std::string::npos && fragment.find("[[cloud]]") == std::string::npos)
    scene += "[[material]]\nname = \"of the test\"\ntype = \"diffuse\"\n[[shape]]\ntype = \"sphere\"\n"
             "centre = [0, 0, 0]\nradius = 1\nspacing = 0.1\nmaterial = \"of the test\"\n";
  return scene;
}

std::string joined(const std::vector<std::string>& lines, const char* between) {
  std::string text;
  for (const std::string& line : lines)
    text += line + between;
  return text;
}

} // namespace

TEST_CASE("every command of the documentation ends well", "[long]") {
  const FakeOidn fake; // --denoise is run with it
  std::size_t run_count = 0;
  for (const MarkdownFile& page : pages()) {
    const TemporaryFolder folder;
    for (const FencedBlock& block : page.blocks) {
      if (block.kind != "sh") continue;
      for (std::size_t i = 0; i < block.lines.size(); ++i) {
        const std::string& line = block.lines[i];
        if (words_of(line).empty() || exempt(line)) continue;
        INFO(page.path.string() << ":" << block.first_line + static_cast<int>(i) << ": " << line);
        std::string before;
        const Words words = arguments_of(line, before);
        CHECK(!words.empty()); // neither a command of the program nor exempt
        if (words.empty()) continue;
        prepare(folder, words);
        const Run run = run_program(joined(words, " "), "cd " + folder.file("") + " && " + before);
        INFO(run.err);
        CHECK(run.code == 0);
        run_count += 1;
      }
    }
  }
  CHECK(run_count >= 20); // or the blocks are no longer found
}

TEST_CASE("every scene of the documentation loads") {
  std::size_t loaded = 0;
  for (const MarkdownFile& page : pages()) {
    for (const FencedBlock& block : page.blocks) {
      if (block.kind.rfind("toml", 0) != 0) continue;
      INFO(page.path.string() << ":" << block.first_line);
      CHECK((block.kind == "toml" || block.kind == "toml fragment"));
      const std::string text = joined(block.lines, "\n");
      const TemporaryFolder folder;
      for (const std::string& name : all_matches(text, "\\b(?:file|map) = \"([^\"]+)\""))
        make_stand_in(folder, name);
      CHECK_NOTHROW(load_scene(folder.write("scene.toml", block.kind == "toml" ? text : completed(text))));
      loaded += 1;
    }
  }
  CHECK(loaded >= 8); // or the blocks are no longer found
}

TEST_CASE("the scenes of the gallery load") {
  for (const auto& entry : fs::directory_iterator(root / "scenes" / "gallery")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path().string());
    const TemporaryFolder folder;
    const std::string text = contents(entry.path());
    for (const std::string& name : all_matches(text, "\\b(?:file|map) = \"([^\"]+)\""))
      make_stand_in(folder, name);
    CHECK_NOTHROW(load_scene(folder.write("scene.toml", text)));
  }
}

TEST_CASE("links, sources and test cases that the documentation names are there") {
  std::vector<MarkdownFile> all = pages();
  all.push_back(read_markdown(root / "CONTRIBUTING.md"));
  for (const MarkdownFile& page : all) {
    INFO(page.path.string());
    for (const std::string& link : all_matches(page.prose, "\\]\\(([^)#]+)(#[^)]*)?\\)")) {
      if (link.find("://") != std::string::npos) continue;
      CAPTURE(link);
      CHECK(fs::exists(page.path.parent_path() / link));
    }
    for (const std::string& source :
         all_matches(page.prose, "`((?:kernels|octree|fmm|host|tests|scenes|scripts)/[^` ]+)`")) {
      if (source.find_first_of("*ABCDEFGHIJKLMNOPQRSTUVWXYZ") != std::string::npos) continue; // NAME.cl, *.ply
      CAPTURE(source);
      CHECK(fs::exists(root / source));
    }
    const std::vector<std::string> files = all_matches(page.prose, "`(tests/[^`]+)` \"([^\"]+)\"", 1);
    const std::vector<std::string> cases = all_matches(page.prose, "`(tests/[^`]+)` \"([^\"]+)\"", 2);
    for (std::size_t i = 0; i < files.size(); ++i) {
      CAPTURE(files[i], cases[i]);
      CHECK(contents(root / files[i]).find("TEST_CASE(\"" + cases[i]) != std::string::npos);
    }
  }
}

TEST_CASE("the README is short, and its two commands stand on the first screen") {
  const MarkdownFile readme = read_markdown(root / "README.md");
  CHECK(readme.lines <= 100);
  for (const std::string command : {"./scripts/render", "./scripts/test"}) {
    CAPTURE(command);
    bool early = false;
    for (const FencedBlock& block : readme.blocks)
      for (std::size_t i = 0; i < block.lines.size(); ++i)
        early = early || (words_of(block.lines[i]) == Words{command} && block.first_line + static_cast<int>(i) <= 60);
    CHECK(early);
  }
}
