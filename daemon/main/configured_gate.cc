#include "daemon/main/configured_gate.h"

#include <string>

#include "daemon/config/load_config.h"
#include "drivers/text/parse.h"

namespace leonav {

std::unique_ptr<CommandGate> configured_gate(const DaemonConfig& config) {
  const std::string& path = config.commands.key_file;
  if (path.empty()) return nullptr;
  try {
    return std::make_unique<CommandGate>(CommandKey::from_file(path));
  } catch (const FileError& error) {
    throw ConfigError(config.source.place_of("commands.key_file") + ": " + error.what());
  }
}

}  // namespace leonav
