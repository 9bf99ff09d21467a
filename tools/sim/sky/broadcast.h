// The navigation messages of a sky.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "tools/sim/sky/ephemeris_fit.h"
#include "tools/sim/sky/true_sky.h"

namespace leonav::sim {

struct FitStatistics {
  long count = 0;
  double sum_m2 = 0.0, worst_m = 0.0;
  double rms_m() const;
  void add(const EphemerisFit& fit);
};

struct BroadcastMessages {
  std::vector<Ephemeris> ephemerides;                 // by satellite, then time
  std::array<FitStatistics, kSystemCount> residuals;  // of the fits against the true orbits
};

// Of every satellite whose constellation is told of by broadcast: elements fitted to the true orbit
// with the error of its issue, clock polynomial of first degree, health and group delays. Reference
// times are multiples of the interval; GPS sends an issue two hours ahead of it, the others from it
// on, so that ages are as they are in truth.
BroadcastMessages make_broadcast(const Scenario& scenario, const TrueSky& sky);

// What one satellite would send for `toe_s` (from the start) under the name `as`: the arc of
// +-`half_span_s` around it with `errors` on it.
struct IssueRequest {
  SatelliteId as;
  double toe_s = 0.0, half_span_s = 7200.0;
  Eigen::Vector3d orbit_error_m = Eigen::Vector3d::Zero();  // along, cross, radial
  double clock_error_m = 0.0;
};
EphemerisFit fit_issue(const Scenario& scenario, const TrueSatellite& satellite,
                       const IssueRequest& request);

// What is needed of the orbits before the start and after the end.
inline constexpr double kBroadcastMargin_s = 14'700.0;

}  // namespace leonav::sim
