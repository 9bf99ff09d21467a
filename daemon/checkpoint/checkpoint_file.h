// A checkpoint is read from and written to a small YAML file.
#pragma once
#include <optional>
#include <string>

#include "core/navigator/interface/checkpoint.h"

namespace leonav {

// nullopt: there is no such file. Throws ConfigError, with the file, the line and the key where
// they are known, for a file that is damaged, cut short, or holds values out of range.
std::optional<Checkpoint> load_checkpoint(const std::string& path);

// Replaces the file in one step: after a power cut `path` is the earlier file or the new one,
// whole. A file `path`.tmp that is left then is overwritten the next time. `checkpoint` must pass
// check(). Returns an empty string, or the failure.
std::string save_checkpoint(const std::string& path, const Checkpoint& checkpoint);

// Returns an empty string when there is no such file any more, or the failure.
std::string remove_checkpoint(const std::string& path);

}  // namespace leonav
