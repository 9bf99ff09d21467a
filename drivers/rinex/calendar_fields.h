// Dates and times in fixed columns.
#pragma once
#include <optional>
#include <string_view>

#include "core/time/gps_time.h"

namespace leonav {

bool is_blank(std::string_view text);

// Date and time as five integers and seconds with up to nine decimals. The decimals are read as an
// integer, so that 0.4299102 s is 429910200 ns exactly. nullopt if one of them is not a number or
// out of range (years 1980-2099). The calendar is read as GPS time.
std::optional<GpsTime> time_fields(std::optional<int> year, std::string_view month,
                                   std::string_view day, std::string_view hour,
                                   std::string_view minute, std::string_view second);

// Two-digit years: 80-99 are 1980-1999, 00-79 are 2000-2079 (RINEX 2.11, 6.5). Others unchanged.
int complete_year(int year);

}  // namespace leonav
