#include "drivers/rtcm3/rtcm3_decoder.h"

namespace leonav {
namespace {

struct Range {
  std::uint16_t first, last;
  std::string_view text;
};

// The first range that a number lies in counts.
constexpr Range kRanges[] = {
    {1001, 1004, "GPS observations of the old form (turn on MSM4 to MSM7)"},
    {1009, 1012, "GLONASS observations of the old form (system not used)"},
    {1013, 1013, "system parameters"},
    {1020, 1020, "GLONASS ephemeris (system not used)"},
    {1029, 1029, "text"},
    {1041, 1041, "NavIC ephemeris (system not used)"},
    {1043, 1043, "SBAS ephemeris (system not used)"},
    {1044, 1044, "QZSS ephemeris (system not used)"},
    {1063, 1068, "SSR corrections of GLONASS (system not used)"},
    {1081, 1087, "GLONASS observations (system not used)"},
    {1101, 1107, "SBAS observations (system not used)"},
    {1111, 1117, "QZSS observations (system not used)"},
    {1131, 1137, "NavIC observations (system not used)"},
    {1230, 1230, "GLONASS code and phase biases (system not used)"},
    {1246, 1270, "SSR corrections of a system not used, or of the ionosphere"},
    {4076, 4076, "IGS SSR corrections of a system not used, or of the ionosphere"},
    {4001, 4095, "a maker's own message"},
};

}  // namespace

std::string_view unused_message_text(std::uint16_t message_number) {
  for (const Range& range : kRanges) {
    if (message_number >= range.first && message_number <= range.last) return range.text;
  }
  return "a message that is not read";
}

bool is_ephemeris_of_unused_system(std::uint16_t message_number) {
  return unused_message_text(message_number).ends_with("ephemeris (system not used)");
}

}  // namespace leonav
