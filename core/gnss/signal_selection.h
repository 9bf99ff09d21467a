// Which of a satellite's signals are used, and which two of them are combined.
#pragma once
#include <boost/container/static_vector.hpp>
#include <span>

#include "core/gnss/gnss_config.h"
#include "core/gnss/observation.h"

namespace leonav {

// A combination that amplifies the noise more than this is not formed: L2 with L5 (17), B3I with
// B2a (9) and E5a with E6 (9) lose more than a broadcast ionosphere model does; L1 with L5 (2.6)
// or L2 (3.0) and B1I with B3I (3.5) pass.
inline constexpr double kMaxCombinationNoise = 5.0;

// Pointers into the span given to select_signals; best first, at most one per band.
struct SelectedSignals {
  boost::container::static_vector<const SignalObservation*, kMaxSignals> bands;
  const SignalObservation* first = nullptr;   // to be used alone or as first of the pair
  const SignalObservation* second = nullptr;  // nullptr: no useful second frequency
  bool any_pseudorange = false;               // some signal had one, plausible or not
  bool any_plausible = false;                 // and within the physical range, whatever its C/N0
};

// Whether band `a` of a system is to be preferred to band `b`: the order of select_signals().
bool band_comes_first(System system, const SignalPreference& preference, char a, char b);

// Bounds on a pseudorange, receiver clock error of some 30 ms included: a geostationary satellite
// is never farther than 43,000 km. A LEO satellite is so near that 3 ms suffice to make its
// pseudorange negative, which the models take as they take any other: tag and pseudorange share the
// clock error.
bool is_plausible_pseudorange(System system, double pseudorange_m);

// `observations`: all signals of one satellite. Bands in the order of the preference (first band,
// second bands, then the others by falling frequency: a receiver may track none of the preferred
// ones), attributes within a band likewise (then alphabetically). Signals without a plausible
// pseudorange or below the C/N0 mask are passed over.
SelectedSignals select_signals(std::span<const SignalObservation> observations,
                               const SignalPreference& preference, double cn0_mask_dbhz);

}  // namespace leonav
