// This unit explains why a satellite named in a RINEX file is not used.
#pragma once
#include <string_view>

namespace leonav {

// Returns the reason for ReadCounts, or an empty text if leonav uses the satellite.
std::string_view satellite_refusal(std::string_view name);

}  // namespace leonav
