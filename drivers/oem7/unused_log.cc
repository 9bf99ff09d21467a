#include <algorithm>
#include <iterator>

#include "drivers/oem7/oem7_decoder.h"

namespace leonav {
namespace {

struct LogName {
  std::uint16_t id;
  const char* text;
};

constexpr LogName kNames[] = {
    {25, "RAWGPSSUBFRAME (turn on RAWEPHEM)"},
    {37, "VERSION"},
    {42, "BESTPOS"},
    {47, "PSRPOS"},
    {48, "SATVIS"},
    {73, "ALMANAC"},
    {74, "RAWALM"},
    {83, "TRACKSTAT"},
    {93, "RXSTATUS"},
    {94, "RXSTATUSEVENT"},
    {99, "BESTVEL"},
    {101, "TIME"},
    {128, "RXCONFIG"},
    {174, "PSRDOP"},
    {241, "BESTXYZ"},
    {263, "INSATT"},
    {264, "INSCOV"},
    {287, "RAWWAASFRAME (system not used)"},
    {320, "INSCOVS"},
    {507, "INSPVA"},
    {508, "INSPVAS"},
    {723, "GLOEPHEMERIS (system not used)"},
    {726, "BESTUTM"},
    {812, "CORRIMUDATA"},
    {813, "CORRIMUDATAS"},
    {971, "HEADING"},
    {1124, "GALFNAVRAWEPHEMERIS (turn on GALFNAVEPHEMERIS)"},
    {1126, "GALINAVRAWEPHEMERIS (turn on GALINAVEPHEMERIS)"},
    {1163, "PSRDOP2"},
    {1336, "QZSSEPHEMERIS (system not used)"},
    {1362, "IMURATECORRIMUS"},
    {1465, "INSPVAX"},
    {1695, "BDSRAWNAVSUBFRAME (turn on BDSEPHEMERIS)"},
    {1734, "RANGECMP3 (turn on RANGE, RANGECMP, RANGECMP2 or RANGECMP4)"},
    {2051, "INSSTDEV"},
    {2264, "CORRIMUS"},
    {2537, "RANGECMP5 (turn on RANGE, RANGECMP, RANGECMP2 or RANGECMP4)"},
};

}  // namespace

std::string unused_log_text(std::uint16_t message_id) {
  const auto found =
      std::find_if(std::begin(kNames), std::end(kNames),
                   [message_id](const LogName& name) { return name.id == message_id; });
  if (found == std::end(kNames)) return "log " + std::to_string(message_id);
  return found->text;
}

}  // namespace leonav
