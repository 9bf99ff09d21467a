// replace_file() and remove_file() leave the old file or the new one, whenever the power fails.
#pragma once
#include <string>
#include <string_view>

namespace leonav {

// Writes beside the file (`.tmp`), then renames. Returns what went wrong, with the path; empty:
// nothing.
std::string replace_file(const std::string& path, std::string_view content);
// A file that is not there is removed.
std::string remove_file(const std::string& path);

}  // namespace leonav
