// This function makes a path of a configuration relative to the configuration's folder.
#pragma once
#include <filesystem>
#include <string>

namespace leonav {

// An empty path stays empty.
inline std::string in_folder(const std::string& folder, const std::string& path) {
  return path.empty() ? "" : (std::filesystem::path(folder) / path).string();
}

}  // namespace leonav
