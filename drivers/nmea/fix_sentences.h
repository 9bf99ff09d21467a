// These functions write the sentences of position, velocity, time and heading.
#pragma once
#include <string>

#include "core/navigator/interface/solution.h"
#include "drivers/nmea/sky_view.h"

namespace leonav {

// What a solution alone does not say.
struct FixOptions {
  // The geoid above the ellipsoid, m: the height above the sea is the solution's less this.
  double geoid_separation_m = 0.0;
  double dead_reckoning_limit_m = 50.0;  // fix_quality.h
};

// `sky` is null where no recent epoch is known. Without a position the fields are empty. Source:
// NMEA 0183 v4.10, chapter 6; talker GN.
std::string gga_sentence(const Solution& solution, const SkyView* sky, const FixOptions& options);
std::string rmc_sentence(const Solution& solution, const FixOptions& options);
std::string vtg_sentence(const Solution& solution, const FixOptions& options);
// Standard deviations north, east, up. Its ellipse stays empty: a solution has no correlations.
std::string gst_sentence(const Solution& solution);
// True heading: the yaw; empty without attitude.
std::string hdt_sentence(const Solution& solution);
std::string zda_sentence(const Solution& solution);

}  // namespace leonav
