#include "host/scene/scene_text.h"
#include "host/error.h"
#include "host/scene/limits.h"
#include "host/scene/scene.h"
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace pointgi {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Error(ErrorKind::input, where + ": " + what);
}

[[noreturn]] void refuse_unread(const std::string& path, const std::string& why) {
  refuse(path, "cannot be read: " + why + "; check the file's permissions, and the disk");
}

/// Walks TOML text byte by byte, knowing only strings, comments and brackets.
class NestingScan {
public:
  NestingScan(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  void run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#')
        skip_comment();
      else if (c == '"' || c == '\'')
        skip_string(c);
      else
        structure(c);
    }
  }

private:
  void structure(char c) {
    switch (c) {
    case '[':
    case '{':
      dots_ = 0;
      deepen(++depth_, "brackets");
      break;
    case ']':
    case '}':
      dots_ = 0;
      depth_ -= depth_ > 0;
      break;
    case '.': // joins the parts of a key; a number has one at most
      deepen(++dots_, "dotted keys");
      break;
    case '=':
    case ',':
    case '\n':
      dots_ = 0;
      break;
    default:
      break;
    }
    step();
  }

  void deepen(unsigned depth, const char* what) const {
    if (depth > limits::nesting)
      refuse(SourcePlace{file_, line_, static_cast<unsigned>(at_ - line_start_ + 1)}.text(),
             std::string(what) + " nest deeper than " + std::to_string(limits::nesting) +
                 "; a scene needs 3 levels: check for brackets that are never closed");
  }

  void skip_comment() {
    while (at_ < text_.size() && text_[at_] != '\n')
      step();
  }

  /// From the opening quote to behind the closing one. A string of one line ends with the line at the latest, so that
  /// a forgotten quote cannot hide the rest of the file.
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool multiline = text_.compare(at_, 3, three) == 0;
    skip(multiline ? 3 : 1);
    while (at_ < text_.size()) {
      if (text_[at_] == '\\' && quote == '"')
        skip(2);
      else if (multiline && text_.compare(at_, 3, three) == 0)
        return close_multiline(quote);
      else if (!multiline && text_[at_] == '\n')
        return;
      else if (!multiline && text_[at_] == quote)
        return skip(1);
      else
        step();
    }
  }

  /// Up to two quotes of the text itself may stand right before the closing three.
  void close_multiline(char quote) {
    skip(3);
    for (int extra = 0; extra < 2 && at_ < text_.size() && text_[at_] == quote; ++extra)
      step();
  }

  void skip(std::size_t count) {
    for (; count > 0 && at_ < text_.size(); --count)
      step();
  }

  void step() {
    if (text_[at_++] != '\n') return;
    ++line_;
    line_start_ = at_;
  }

  const std::string& text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t line_start_ = 0;
  unsigned line_ = 1;
  unsigned depth_ = 0;
  unsigned dots_ = 0;
};

} // namespace

std::string read_scene_text(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    refuse(path, "no such file, expected a scene file; check the path, it is relative to the working directory");
  if (status.type() == fs::file_type::none) refuse_unread(path, error.message());
  if (status.type() == fs::file_type::directory) refuse(path, "is a folder, expected a scene file (TOML)");
  if (status.type() != fs::file_type::regular)
    refuse(path, "is a pipe, socket or device, expected a regular scene file; save the scene to a file first");
  const std::uintmax_t bytes = fs::file_size(path, error);
  if (error) refuse_unread(path, error.message());
  if (bytes > limits::scene_bytes)
    refuse(path, "has " + std::to_string(bytes) + " bytes, expected a scene file of at most " +
                     std::to_string(limits::scene_bytes) + "; points belong into a PLY file that a [[cloud]] names");
  std::ifstream in(path, std::ios::binary);
  std::string text(static_cast<std::size_t>(bytes), '\0');
  in.read(text.data(), static_cast<std::streamsize>(bytes));
  if (in.bad() || !in.is_open()) refuse_unread(path, std::strerror(errno));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.empty()) refuse(path, "is empty, expected a scene file, which begins with: version = 1");
  return text;
}

void check_nesting(const std::string& text, const std::string& file) {
  NestingScan(text, file).run();
}

} // namespace pointgi
