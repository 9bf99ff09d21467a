// Why a satellite named in a RINEX file is not used.
#pragma once
#include <string_view>

namespace leonav {

// The reason for ReadCounts; empty if leonav uses the satellite.
std::string_view satellite_refusal(std::string_view name);

}  // namespace leonav
