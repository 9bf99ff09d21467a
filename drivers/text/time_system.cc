#include "drivers/text/time_system.h"

#include <algorithm>
#include <array>

#include "core/base/calendar.h"

namespace leonav {
namespace {

constexpr int kTaiMinusGpsSeconds = 19;

}  // namespace

bool is_known_time_system(std::string_view name) {
  constexpr std::array<std::string_view, 9> kKnown = {"GPS", "GAL", "QZS", "IRN", "BDT",
                                                      "BDS", "TAI", "UTC", "GLO"};
  return std::find(kKnown.begin(), kKnown.end(), name) != kKnown.end();
}

GpsTime gps_time_of(GpsTime reading, std::string_view time_system) {
  if (time_system == "BDT" || time_system == "BDS") {
    return reading.plus_seconds(-kBeidouMinusGpsSeconds);
  }
  if (time_system == "TAI") return reading.plus_seconds(-kTaiMinusGpsSeconds);
  return time_system == "UTC" || time_system == "GLO" ? gps_from_utc(reading) : reading;
}

}  // namespace leonav
