#pragma once
/// The documentation as tests read it: fenced blocks, links, and what stands between backticks.
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace pointgi::test {

/// A block between fences of three backticks.
struct FencedBlock {
  std::string kind;               ///< what stands behind the opening fence: "sh", "toml", "toml fragment" …
  int first_line = 0;             ///< of the file, counted from 1
  std::vector<std::string> lines; ///< without the fences
};

/// One Markdown file, cut up.
struct MarkdownFile {
  std::filesystem::path path;
  std::vector<FencedBlock> blocks;
  std::string prose; ///< all that stands outside of blocks
  int lines = 0;
};

inline MarkdownFile read_markdown(const std::filesystem::path& path) {
  MarkdownFile file;
  file.path = path;
  std::ifstream in(path);
  FencedBlock* open = nullptr;
  for (std::string line; std::getline(in, line);) {
    file.lines += 1;
    if (line.rfind("```", 0) == 0) {
      if (open != nullptr) {
        open = nullptr;
      } else {
        file.blocks.push_back({line.substr(3), file.lines + 1, {}});
        open = &file.blocks.back();
      }
    } else if (open != nullptr) {
      open->lines.push_back(line);
    } else {
      file.prose += line + "\n";
    }
  }
  return file;
}

/// What the group `group` of `pattern` matches in `text`, every time.
inline std::vector<std::string> all_matches(const std::string& text, const char* pattern, int group = 1) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (auto at = std::sregex_iterator(text.begin(), text.end(), expression); at != std::sregex_iterator(); ++at)
    found.push_back((*at)[static_cast<std::size_t>(group)]);
  return found;
}

} // namespace pointgi::test
