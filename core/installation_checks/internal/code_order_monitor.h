// CodeOrderMonitor tests whether the codes of two bands were exchanged, by the sign of the
// ionospheric delay.
#pragma once
#include <array>

#include "core/base/capacity.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/observation.h"
#include "core/installation_checks/convention.h"

namespace leonav {

// The ionosphere delays the lower frequency more. The difference of a satellite's two codes
// therefore gives its slant delay, apart from receiver delays that are equal for all satellites of
// a system.
//
// The delay must grow towards the horizon as the slant factor does:
//   delay = zenith delay * slant(elevation) + constant of the system  (thin shell at 400 km).
// The satellites' group delays fit one order of the codes only, so that both orders are tried.
class CodeOrderMonitor {
 public:
  // `bands`: the carriers of the LEO satellites.
  explicit CodeOrderMonitor(const BandPlan& bands = {}) : bands_(bands) {}
  void clear() { *this = CodeOrderMonitor(bands_); }
  // Adds an epoch; `seen` holds the elevations of its satellites.
  void add(const RawEpoch& epoch, const MeasurementEpoch& seen,
           const EphemerisStore& ephemeris_store);
  // Returns kCodesExchanged if the exchanged order fits clearly and the labelled one does not.
  ConventionFinding evaluate() const;

 private:
  // Means of one satellite, over epochs.
  struct Mean {
    float n = 0.0F, slant = 0.0F;    // sums
    std::array<float, 2> delay_m{};  // sums: codes as received, codes exchanged
  };
  // The fit of the delay on L1 over the slant factor, with a constant for each system.
  struct Line {
    bool known = false;
    double slope = 0.0, sigma = 0.0;  // m at the zenith
  };
  Line line(std::size_t exchanged) const;

  BandPlan bands_;
  std::array<Mean, kMaxEphemerisSatellites> satellites_{};
};

}  // namespace leonav
