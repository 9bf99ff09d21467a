// A checkpoint as a small YAML file.
#pragma once
#include <optional>
#include <string>

#include "core/navigator/checkpoint.h"

namespace leonav {

// nullopt: there is no such file. Throws ConfigError, with the file, the line and the key where
// they are known, for one that is damaged, cut short, or holds what cannot be.
std::optional<Checkpoint> load_checkpoint(const std::string& path);

// In one step: whenever the power is cut, `path` is the file of before or the new one, whole. What
// a cut leaves beside it (`path`.tmp) is overwritten the next time. Empty: done; else what failed.
// `checkpoint` must be one that check() lets pass.
std::string save_checkpoint(const std::string& path, const Checkpoint& checkpoint);

// Empty: there is none any more; else what failed.
std::string remove_checkpoint(const std::string& path);

}  // namespace leonav
