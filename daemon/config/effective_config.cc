#include "daemon/config/effective_config.h"

#include <algorithm>
#include <vector>

#include "daemon/config/internal/key_path.h"

namespace leonav {
namespace {

constexpr std::size_t kCommentColumn = 46;

// A comment ends with its line, and no file's name may end it earlier.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

// A value that follows from another key stays a default, so that the other key can be overridden.
std::string effective_value(const ConfigKey& key) { return key.given ? key.value : key.built_in; }

std::string origin_text(const ConfigKey& key) {
  const std::string origin = "from: " + key.origin;
  return effective_value(key) == key.value ? origin : key.value + ", " + origin;
}

// Keys of one group stand together.
std::string grouped(const std::vector<ConfigKey>& keys) {
  std::string text;
  std::vector<std::string> open;  // groups
  for (const ConfigKey& key : keys) {
    std::vector<std::string> groups = split_key_path(key.path);
    const std::string name = groups.back();
    groups.pop_back();
    std::size_t same = 0;
    while (same < open.size() && same < groups.size() && open[same] == groups[same]) ++same;
    for (std::size_t i = same; i < groups.size(); ++i) {
      text += (i == 0 && !text.empty() ? "\n" : "") + std::string(2 * i, ' ') + groups[i] + ":\n";
    }
    open = groups;
    const std::string line =
        std::string(2 * groups.size(), ' ') + name + ": " + effective_value(key);
    const std::size_t padding = line.size() + 2 < kCommentColumn ? kCommentColumn - line.size() : 2;
    text += line + std::string(padding, ' ') + "# " + one_line(origin_text(key)) + "\n";
  }
  return text;
}

const ConfigKey* preset_of(const ConfigOrigin& source) {
  const auto preset = std::find_if(source.keys.begin(), source.keys.end(),
                                   [](const ConfigKey& one) { return one.path == "preset"; });
  return preset == source.keys.end() || preset->is_default() ? nullptr : &*preset;
}

}  // namespace

std::string effective_text(const ConfigOrigin& source, Extent extent) {
  std::vector<ConfigKey> keys;
  for (const ConfigKey& key : source.keys) {
    if (key.path == "preset") continue;  // resolved into the other keys
    if (extent == Extent::kAllKeys || !key.is_default()) keys.push_back(key);
  }
  std::string title = "# " + one_line(source.name);
  const ConfigKey* preset = preset_of(source);
  if (preset != nullptr && source.name != "preset " + preset->value) {
    title += " on preset " + preset->value;
  }
  title += extent == Extent::kAllKeys ? ": every key\n" : ": keys that differ from the defaults\n";
  if (keys.empty()) return title + "{}\n";
  return title + grouped(keys);
}

}  // namespace leonav
