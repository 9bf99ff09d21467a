// The ionosphere delays the lower frequency more: are the codes of two bands the right way round?
#pragma once
#include <array>

#include "core/capacity.h"
#include "core/conventions/convention.h"
#include "core/gnss/measurement.h"
#include "core/gnss/observation.h"
#include "core/gnss/satellite_catalog.h"

namespace leonav {

// Each satellite's two codes tell its slant delay, but for delays within the receiver, which are
// alike for all of a system. So the delay must grow towards the horizon, as the slant does. The
// satellites' group delays fit one order only, so both orders are tried.
class CodeOrderCheck {
 public:
  void clear() { *this = CodeOrderCheck(); }
  // `seen`: the elevations of the satellites of `epoch`.
  void add(const RawEpoch& epoch, const MeasurementEpoch& seen, const SatelliteCatalog& catalog);
  ConventionFinding judge() const;

 private:
  struct Mean {
    float n = 0.0F, slant = 0.0F;    // sums
    std::array<float, 2> delay_m{};  // likewise: codes as they came, codes exchanged
  };
  // Of the delay on L1 over the slant, with a constant for each system.
  struct Line {
    bool known = false;
    double slope = 0.0, sigma = 0.0;  // m at the zenith
  };
  Line line(std::size_t exchanged) const;

  std::array<Mean, kMaxEphemerisSatellites> satellites_{};
};

}  // namespace leonav
