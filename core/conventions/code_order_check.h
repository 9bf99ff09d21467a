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
// alike for all of a system. So the delay must grow towards the horizon, as the slant does.
class CodeOrderCheck {
 public:
  void clear() { *this = CodeOrderCheck(); }
  // `seen`: the elevations of the satellites of `epoch`.
  void add(const RawEpoch& epoch, const MeasurementEpoch& seen, const SatelliteCatalog& catalog);
  ConventionFinding judge() const;

 private:
  struct Mean {
    float n = 0.0F, slant = 0.0F, delay_m = 0.0F;  // sums
  };
  std::array<Mean, kMaxEphemerisSatellites> satellites_{};
};

}  // namespace leonav
