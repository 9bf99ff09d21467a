#include "drivers/rinex/satellite_refusal.h"

#include "core/gnss/signals/satellite.h"

namespace leonav {

std::string_view satellite_refusal(std::string_view name) {
  if (satellite_from_string(name)) return {};
  switch (name.empty() ? '\0' : name[0]) {
    case 'R':
      return "GLONASS satellite (system not used)";
    case 'S':
      return "SBAS satellite (system not used)";
    case 'J':
      return "QZSS satellite (system not used)";
    case 'I':
      return "NavIC satellite (system not used)";
    default:
      return "satellite name that is not readable";
  }
}

}  // namespace leonav
