// split_key_path() takes the path of a key apart.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

namespace leonav {

// Returns the groups and the key of "group.key"; a part is empty where nothing stands between two
// dots.
inline std::vector<std::string> split_key_path(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    parts.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace leonav
