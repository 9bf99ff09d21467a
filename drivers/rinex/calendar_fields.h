// This unit parses dates and times in fixed columns.
#pragma once
#include <optional>
#include <string_view>

#include "core/base/gps_time.h"

namespace leonav {

// Returns whether the text has blanks only.
bool is_blank(std::string_view text);

// Parses date and time from five integers and seconds with up to nine decimals. The decimals are
// read as an integer, so that 0.4299102 s is 429910200 ns exactly. The calendar is read as GPS
// time. Returns nullopt if a field is not a number or out of range (years 1980-2099).
std::optional<GpsTime> time_fields(std::optional<int> year, std::string_view month,
                                   std::string_view day, std::string_view hour,
                                   std::string_view minute, std::string_view second);

// Completes a two-digit year: 80-99 are 1980-1999, 00-79 are 2000-2079 (RINEX 2.11, 6.5). Other
// years are unchanged.
int complete_year(int year);

}  // namespace leonav
