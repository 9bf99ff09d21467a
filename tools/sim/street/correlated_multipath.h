// CorrelatedMultipath gives the errors of reflections that arrive with one satellite's signals, as
// random processes in time.
#pragma once
#include <array>
#include <cstdint>

#include "tools/sim/scenario/street_errors_config.h"
#include "tools/sim/street/gauss_markov.h"
#include "tools/sim/street/street_errors.h"

namespace leonav::sim {

// Code and carrier of signal s have the errors
//   sigma (sqrt(r) x_common + sqrt(1 - r) x_s),
// where x are Gauss-Markov processes and r is the correlation of the signals. Sigmas and
// correlation time are drawn per episode; an episode ends at random or when the satellite passes
// the limit of elevation. At its begin the sigmas change over a second, not at once, so that the
// carrier's error has a rate. A satellite whose direction turns faster than one in a medium orbit
// (1.2e-4 rad/s) has a shorter correlation time in proportion.
class CorrelatedMultipath {
 public:
  CorrelatedMultipath(const StreetErrorsConfig& config, std::uint64_t seed, std::size_t satellite);

  std::array<StreetSignalError, kTrackedSignals> at(const SatelliteSight& sight);

 private:
  struct Sigmas {
    double code_m = 0.0, carrier_m = 0.0, carrier_m_s = 0.0;  // with the carrier's rate
  };
  // Gauss-Markov processes of code or carrier.
  struct Processes {
    GaussMarkov common;
    std::array<GaussMarkov, kTrackedSignals> own;
  };
  void begin_episode(double t, bool is_low);
  Sigmas sigmas(double t) const;
  GaussMarkov::Value mixed(Processes* processes, std::size_t signal) const;

  StreetErrorsConfig config_;
  std::uint64_t seed_;
  std::size_t satellite_;
  Processes code_, carrier_;
  unsigned episode_ = 0;
  bool is_low_ = false;
  double t_ = 0.0, began_s_ = 0.0, until_s_ = 0.0, time_s_ = 1.0;
  Sigmas before_, now_;
  double argument_ = 0.0;  // in correlation times
};

}  // namespace leonav::sim
