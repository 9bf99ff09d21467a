// This unit selects the signals of a satellite and the two that are combined.
#pragma once
#include <boost/container/static_vector.hpp>
#include <span>

#include "core/gnss/measurement/gnss_config.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// A combination that amplifies the noise by more than this is not formed: L2 with L5 (17), B3I with
// B2a (9) and E5a with E6 (9) lose more than a broadcast ionosphere model does; L1 with L5 (2.6) or
// L2 (3.0) and B1I with B3I (3.5) are below.
inline constexpr double kMaxCombinationNoise = 5.0;

// The selected signals, best first, at most one per band. They point into the span given to
// select_signals.
struct SelectedSignals {
  boost::container::static_vector<const SignalObservation*, kMaxSignals> bands;
  const SignalObservation* first = nullptr;   // to be used alone or as first of the pair
  const SignalObservation* second = nullptr;  // nullptr: no useful second frequency
  bool any_pseudorange = false;               // some signal had a pseudorange, plausible or not
  bool any_plausible = false;  // and one within the physical range, whatever its C/N0
};

// Returns whether band `a` of a system is preferred to band `b`, in the order of select_signals().
bool band_comes_first(System system, const SignalPreference& preference, char a, char b,
                      const BandPlan& bands = {});

// Returns whether a pseudorange is within physical bounds, which include a receiver clock error of
// some 30 ms. A geostationary satellite is never farther than 43,000 km. A LEO satellite is so near
// that 3 ms suffice to make its pseudorange negative; the models accept that, since tag and
// pseudorange share the clock error.
bool is_plausible_pseudorange(System system, double pseudorange_m);

// Selects from `observations`, all signals of one satellite. Bands are in the order of the
// preference: first band, second bands, then the others by falling frequency, because a receiver
// may track none of the preferred ones. Attributes within a band are in the order of the
// preference, then alphabetical. Signals without a plausible pseudorange or below the C/N0 mask are
// skipped, and those on bands that `plan` does not have.
SelectedSignals select_signals(std::span<const SignalObservation> observations,
                               const SignalPreference& preference, double cn0_mask_dbhz,
                               const BandPlan& plan = {});

}  // namespace leonav
