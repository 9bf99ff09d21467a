// This header defines an epoch after preprocessing, as both estimators consume it.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <string_view>

#include "core/base/capacity.h"
#include "core/gnss/measurement/carrier_cycles.h"
#include "core/gnss/orbits/satellite_state.h"
#include "core/gnss/signals/signal.h"
#include "core/gnss/signals/slip_cause.h"

namespace leonav {

// The values are on the wire: append only.
enum class Observable : std::uint8_t { kCode = 0, kCarrier = 1, kDoppler = 2 };
std::string_view to_string(Observable observable);  // "code", "carrier", "doppler"

// Reason why a satellite or a measurement was used or excluded. On the wire: append only.
enum class Reason : std::uint8_t {
  kUsed = 0,
  kDownweighted = 1,    // used, with a robust factor below one
  kOutlier = 2,         // robust factor zero, or excluded by fault detection
  kSystemDisabled = 3,  // configuration leaves the system out
  kNoEphemeris = 4,
  kEphemerisTooOld = 5,
  kUnhealthy = 6,
  kLowElevation = 7,
  kLowCn0 = 8,
  kNoUsableSignal = 9,  // no signal of a known frequency has a pseudorange
  kImplausible = 10,    // pseudorange out of physical range
  kSatelliteCap = 11,   // the configured number of satellites per system is reached
  kCapacity = 12,       // a fixed table was full
  kNoPosition = 13,     // not used any more
  kNotSolved = 14,      // epoch had too few satellites for a solution
  kFaulty = 15,         // its carrier has drifted away from the others'
};
std::string_view to_string(Reason reason);  // "used", "no_ephemeris", ...
constexpr bool is_used(Reason reason) {
  return reason == Reason::kUsed || reason == Reason::kDownweighted;
}

// CodeVariances are those of a satellite's code as ionosphere-free pair and as single frequencies,
// m^2, at the configured sigmas; 0 where the satellite has no pair, or no position is known.
struct CodeVariances {
  double pair_noise = 0.0;
  double single_noise = 0.0;  // of the weighted mean over the bands
  double ionosphere = 0.0;    // of the single frequencies: what the model leaves
};

// What the prediction of a measurement needs of a satellite at one epoch. Vectors are in the ECEF
// frame of the instant of reception: the Earth's rotation during the flight of the signal has been
// applied.
struct SatelliteGeometry {
  SatelliteId satellite;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();  // m, at transmission
  Eigen::Vector3d v_e =
      Eigen::Vector3d::Zero();  // m/s, at transmission, relative to rotating Earth
  double elevation = 0.0;       // rad, at the approximate position; 0 if there is none
  double wet_mapping = 0.0;  // wet mapping function, for a zenith wet delay beyond the modelled one
};

// One satellite at one epoch.
struct SatelliteInView : SatelliteGeometry {
  double clock_m = 0.0;  // satellite clock times c
  double clock_drift_m_s = 0.0;
  double orbit_sigma_m = 0.0;
  double orbit_sigma_change_m = 0.0;  // as in SatelliteState
  std::uint32_t orbit_issue = 0;      // as in SatelliteState
  // Change of `carrier minus range` by a change of elements since the last epoch: 0 if the elements
  // are the same, NaN if the old ones are no longer stored.
  double orbit_step_m = 0.0;
  double ephemeris_age_s = 0.0;
  OrbitSource source = OrbitSource::kNone;
  bool at_antenna = false;       // as in SatelliteState
  bool clock_from_file = false;  // as in SatelliteState
  double azimuth = 0.0;          // rad
  double troposphere_m = 0.0;    // slant delay applied
  double path_m = 0.0;           // other lengthening of the path of all signals: gravity, tides
  double wind_up_cycles = 0.0;   // of the carrier
  double antenna_m = 0.0;        // lengthening of the carrier's path by the antenna patterns
  // Identity of these patterns; a new one means another correction.
  std::uint32_t antenna_issue = 0;
  double ionosphere_l1_m = 0.0;  // slant delay on L1 by the model; 0 for ionosphere-free use
  // Slant delay by the model that was added to the carrier; 0 for a pair. Identity of its
  // coefficients; a new one means another delay.
  double carrier_ionosphere_m = 0.0;
  std::uint32_t ionosphere_issue = 0;
  double cn0_dbhz = 0.0;  // strongest signal
  CodeVariances code_variances;
  std::uint32_t arc = 0;     // identity of its carrier arc; 0: none used
  bool arc_started = false;  // its arc starts at this epoch
  SlipCauses arc_causes;     // why the previous arc ended; none at a satellite's first arc
  Reason reason = Reason::kUsed;
};

// IonosphereError is what the model of the ionosphere leaves in a code, as far as all satellites
// have it in common: mapping (m/m) times the zenith ionosphere delay, of which zenith_sigma (m) is
// 1 sigma. The squares of the code's sigma and correlated_sigma contain `variance` (m^2), which is
// that of the whole slant, without what the receiver code biases take of it, and times the number
// of codes of the satellite that share it. Zeros: a pair, or a position is not known.
struct IonosphereError {
  double mapping = 0.0, zenith_sigma = 0.0, variance = 0.0;
};

// One scalar range (m) or range rate (m/s), corrected so that the model is
//   code:    |p_sat - p_antenna| + clock offset of the system time
//   carrier: the same + the ambiguity of the arc
//   doppler: predict_range_rate() of range_model.h + clock drift of the system time
// The satellite clock, group delay, troposphere and ionosphere are already removed. Code and
// carrier contain wet_mapping w of a zenith wet delay w beyond the modelled one, and a code of one
// frequency ionosphere.mapping of a zenith ionosphere delay beyond the modelled one.
//
// MeasuredObservable is the part that a prediction and tests of the residual need: the value of one
// observable with its sigma.
struct MeasuredObservable {
  std::uint16_t satellite_index = 0;  // into MeasurementEpoch::satellites
  Observable observable = Observable::kCode;
  SignalCode code;         // first signal
  SignalCode second_code;  // set for an ionosphere-free combination
  double value = 0.0;
  double sigma = 0.0;
  // Code only: the part of sigma that is correlated from epoch to epoch (orbit, clock, modelled
  // ionosphere).
  double correlated_sigma = 0.0;
  IonosphereError ionosphere;  // of a code of one frequency

  // Return the variance, and its part that is correlated from epoch to epoch, without what the
  // satellites have of the ionosphere in common, which a filter estimates.
  double own_variance() const { return sigma * sigma - ionosphere.variance; }
  double own_correlated_variance() const {
    return correlated_sigma * correlated_sigma - ionosphere.variance;
  }
};
struct Measurement : MeasuredObservable {
  double correlation_time_s = 0.0;  // code only: of correlated_sigma
  // Code only, m^2: the part of sigma^2 that lasts for minutes, without what the satellites have of
  // the ionosphere in common: orbit, clock, antenna, ionosphere, group delay, band, troposphere.
  double lasting_variance = 0.0;
  // Carrier only.
  std::uint32_t arc = 0;     // identity of the uninterrupted arc; 0: none
  double random_walk = 0.0;  // m/sqrt(s): random walk of the ambiguity
  // 1 sigma of a step of the ambiguity since the last epoch: another orbit, antenna pattern or
  // model of the ionosphere
  double disturbance_m = 0.0;
  CarrierCycles cycles;
  Reason reason = Reason::kUsed;
};

// All satellites and measurements of one epoch.
struct MeasurementEpoch {
  std::uint64_t index = 0;  // k
  GpsTime time;             // receiver's time tag
  Eigen::Vector3d approximate_p_e =
      Eigen::Vector3d::Zero();  // used for elevation and delays; zero: none
  // 1 sigma, each axis, of a step of the measured position since the last epoch, caused by other
  // antenna patterns.
  double position_disturbance_m = 0.0;
  // Step of the modelled zenith delay of the ionosphere on L1 since the last epoch: other
  // coefficients, m.
  double ionosphere_step_m = 0.0;
  boost::container::static_vector<SatelliteInView, kMaxSatellites> satellites;
  boost::container::static_vector<Measurement, kMaxMeasurements> measurements;
};

}  // namespace leonav
