#pragma once
/// The folder that a command writes its files into.
#include <string>
#include <vector>

namespace pointgi {

/// The path of the file `name` of `folder`.
std::string file_in(const std::string& folder, const std::string& name);

/// Makes the folder and those above it, where they are not there. Throws Error(output).
void make_folder(const std::string& folder);

/// For before the work, not after it: makes the folders of the files `names` of `folder`, and tries each file without
/// changing it. Throws Error(output).
void require_writable(const std::string& folder, const std::vector<std::string>& names);

} // namespace pointgi
