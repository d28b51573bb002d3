#pragma once
#include <string>

namespace pointgi {

/// The bytes of a scene file. Throws Error(input), naming the file, when it is missing, not a regular file (a folder,
/// a FIFO, a device: never opened, so nothing can block), unreadable, empty, or larger than limits::scene_bytes.
std::string read_scene_text(const std::string& path);

/// Refuses brackets and dotted keys deeper than limits::nesting before the parser, which recurses, sees them.
/// Strings and comments are skipped; all else that is wrong with the text is left for the parser to say.
/// Throws Error(input): "file:line:column: ...".
void check_nesting(const std::string& text, const std::string& file);

} // namespace pointgi
