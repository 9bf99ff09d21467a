// IntegrityConfig holds the integrity risk, the model of the errors, and the alert limits.
#pragma once

namespace leonav {

// Overbound is the heavy-tailed distribution that stands for an error of 1 sigma `sigma`:
//   (1 - tail_share) N(0, (sigma_factor sigma)^2)
//     + tail_share N(0, (tail_factor sigma_factor sigma)^2)
// A symmetric distribution of this form bounds the error on both sides (paired overbound: Rife,
// Pullen, Enge, Pervan, "Paired overbounding for nonideal LAAS and WAAS error distributions", IEEE
// TAES 42(4), 2006).
struct Overbound {
  double sigma_factor = 1.0;  // inflates the stated sigma
  double tail_share = 0.05;   // share of the errors that come from the wider distribution
  double tail_factor = 2.0;   // its sigma in sigmas of the core

  bool operator==(const Overbound&) const = default;
};

// The configuration of the protection levels.
struct IntegrityConfig {
  // Probability per hour that an error exceeds its level without a warning; for each of the
  // horizontal, vertical and heading level alone.
  double risk_per_hour = 1e-5;
  // Time after which errors are independent. The shorter, the more independent errors an hour has.
  double error_correlation_s = 10.0;
  Overbound overbound;
  // Faults that begin in an hour: of one satellite, and of all satellites of a system at once; of
  // low orbits the third, for both.
  double satellite_faults_per_hour = 1e-4, system_faults_per_hour = 1e-4,
         leo_faults_per_hour = 1e-3;
  // Cycle slips of one satellite in an hour that their tests miss.
  double missed_slips_per_hour = 1e-2;
  // Time from the begin of a fault until it is detected, or its effect is gone.
  double fault_exposure_s = 600.0;
  // Levels above these make the health DEGRADED, m; 0: no limit.
  double horizontal_alert_limit_m = 0.0, vertical_alert_limit_m = 0.0;

  bool operator==(const IntegrityConfig&) const = default;
};

}  // namespace leonav
