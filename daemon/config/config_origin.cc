#include "daemon/config/daemon_config.h"

namespace leonav {

std::string ConfigOrigin::place_of(std::string_view key) const {
  std::string place;
  for (const ConfigKey& one : keys)
    if (one.path == key && one.given) place = one.origin + (one.origin == "--set" ? " " : ": ");
  return place.append(key);
}

}  // namespace leonav
