// These functions write the sentences of satellites: GSA, those in use, and GSV, those in view.
//
// GPS, Galileo and BeiDou have system identifiers 1, 3 and 4 and talkers GP, GA and GB, in GSA too:
// readers that do not know the identifier, as gpsd 3.22, take satellites of GN for GPS. Satellites
// that the standard has no number for are left out: those in low orbit, and GPS above 32. Source:
// NMEA 0183 v4.10, GSA and GSV; BeiDou's identifiers are those of v4.11.
#pragma once
#include <string>

#include "core/navigator/interface/solution.h"
#include "drivers/nmea/sky_view.h"

namespace leonav {

// One GSA for each system with used satellites, at most twelve each; one without satellites where
// none is used. `sky` is null where no recent epoch is known.
std::string gsa_sentences(const Solution& solution, const SkyView* sky);
// GSV for each system with satellites in view; none without.
std::string gsv_sentences(const SkyView* sky);

}  // namespace leonav
