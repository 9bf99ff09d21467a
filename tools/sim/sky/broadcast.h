// This unit produces the navigation messages of a sky.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "tools/sim/sky/ephemeris_fit.h"
#include "tools/sim/sky/true_sky.h"

namespace leonav::sim {

// Statistics of the fits of one system.
struct FitStatistics {
  long count = 0;
  double sum_m2 = 0.0, worst_m = 0.0;
  double rms_m() const;
  void add(const EphemerisFit& fit);
};

// The messages of all satellites.
struct BroadcastMessages {
  std::vector<Ephemeris> ephemerides;                 // by satellite, then time
  std::array<FitStatistics, kSystemCount> residuals;  // of the fits against the true orbits
};

// Returns the messages of every satellite whose constellation has broadcast products.
//
// Elements are fitted to the true orbit with the error of its issue; the clock polynomial is of
// first degree; health and group delays are included. Reference times are multiples of the
// interval. GPS sends an issue two hours ahead of its reference time, a LEO satellite half an
// interval, the others from it on, so that ages are realistic.
BroadcastMessages make_broadcast(const Scenario& scenario, const TrueSky& sky);

// The message that one satellite would send for `toe_s` (from the start) under the name `as`: the
// arc of +-`half_span_s` around it, with `errors` added.
struct IssueRequest {
  SatelliteId as;
  double toe_s = 0.0, half_span_s = 7200.0;
  Eigen::Vector3d orbit_error_m = Eigen::Vector3d::Zero();  // along, cross, radial
  double clock_error_m = 0.0;
  double lead_s = 0.0;  // from the transmission to toe
};
// Fits one issue.
EphemerisFit fit_issue(const Scenario& scenario, const TrueSatellite& satellite,
                       const IssueRequest& request);

// Orbits are needed for so long before the start and after the end.
inline constexpr double kBroadcastMargin_s = 14'700.0;

}  // namespace leonav::sim
