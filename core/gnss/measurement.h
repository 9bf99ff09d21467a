// A raw epoch after preprocessing: what both estimators consume.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <string_view>

#include "core/capacity.h"
#include "core/gnss/satellite_state.h"
#include "core/gnss/signal.h"
#include "core/gnss/slip_cause.h"

namespace leonav {

// The values are on the wire: append only.
enum class Observable : std::uint8_t { kCode = 0, kCarrier = 1, kDoppler = 2 };

// Why a satellite or a measurement was used or left out. On the wire: append only.
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
  kNoUsableSignal = 9,  // no configured signal has a pseudorange
  kImplausible = 10,    // pseudorange or Doppler out of physical range
  kSatelliteCap = 11,   // the configured number of satellites per system is reached
  kCapacity = 12,       // a fixed table was full
  kNoPosition = 13,     // no approximate position yet, so nothing can be predicted
  kNotSolved = 14,      // epoch had too few satellites for a solution
};
std::string_view to_string(Reason reason);  // "used", "no_ephemeris", ...

// One satellite at one epoch. Vectors are in the ECEF frame of the instant of reception: the
// Earth's rotation during flight has been applied.
struct SatelliteInView {
  SatelliteId satellite;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();  // m, at transmission
  Eigen::Vector3d v_e =
      Eigen::Vector3d::Zero();  // m/s, at transmission, relative to rotating Earth
  double clock_m = 0.0;         // satellite clock times c
  double clock_drift_m_s = 0.0;
  double orbit_sigma_m = 0.0;
  double orbit_sigma_change_m = 0.0;  // as in SatelliteState
  std::uint32_t orbit_issue = 0;      // likewise
  // What other elements since the last epoch added to `carrier minus range`: 0 if they are the
  // same, NaN if the old ones are not there to compare.
  double orbit_step_m = 0.0;
  double ephemeris_age_s = 0.0;
  OrbitSource source = OrbitSource::kNone;
  bool clock_of_file = false;       // as in SatelliteState
  double elevation = 0.0;           // rad, at the approximate position; 0 if there is none
  double azimuth = 0.0;             // rad
  double troposphere_m = 0.0;       // slant delay applied
  double wet_mapping = 0.0;         // of a wet delay at zenith beyond it
  double path_m = 0.0;              // what else lengthens the path of all signals: gravity, tides
  double wind_up_cycles = 0.0;      // of the carrier
  double antenna_m = 0.0;           // carrier: what the antennas' patterns lengthen it by
  std::uint32_t antenna_issue = 0;  // of these patterns: another one, another correction
  double ionosphere_l1_m = 0.0;     // slant delay on L1 by the model; 0 for ionosphere-free use
  double cn0_dbhz = 0.0;            // strongest signal
  std::uint32_t arc = 0;            // of its carrier; 0: none used
  bool arc_started = false;         // here
  SlipCauses arc_causes;            // why the one before it ended; none at a satellite's first
  Reason reason = Reason::kUsed;
};

// One scalar range (m) or range rate (m/s), corrected so that the model is
//   code:    |p_sat - p_antenna| + clock offset of the time base
//   carrier: the same + its arc's ambiguity
//   doppler: range_rate(...) of core/gnss/range_model.h + clock drift of the time base
// (satellite clock, group delay, troposphere, ionosphere are already out; of a wet delay w beyond
// the modelled one, code and carrier hold wet_mapping w).
struct Measurement {
  std::uint16_t satellite_index = 0;  // into MeasurementEpoch::satellites
  Observable observable = Observable::kCode;
  SignalCode code;         // first signal
  SignalCode second_code;  // set for an ionosphere-free combination
  double value = 0.0;
  double sigma = 0.0;
  // Code only: the part of sigma that stays alike from epoch to epoch, and for how long: orbit,
  // clock, group delay, ionosphere by a model.
  double correlated_sigma = 0.0;
  double correlation_time_s = 0.0;
  // Carrier only.
  std::uint32_t arc = 0;       // identity of the uninterrupted arc; 0: none
  double wander = 0.0;         // m/sqrt(s): how the arc's constant is not one
  double disturbance_m = 0.0;  // 1 sigma of a step in it since the last epoch (another orbit)
  Reason reason = Reason::kUsed;
};

struct MeasurementEpoch {
  std::uint64_t index = 0;  // k
  GpsTime time;             // receiver's time tag
  Eigen::Vector3d approximate_p_e =
      Eigen::Vector3d::Zero();  // used for elevation and delays; zero: none
  // 1 sigma, each axis, of a step in the position that the measurements tell since the last epoch
  // (other antenna patterns).
  double position_disturbance_m = 0.0;
  boost::container::static_vector<SatelliteInView, kMaxSatellites> satellites;
  boost::container::static_vector<Measurement, kMaxMeasurements> measurements;
};

}  // namespace leonav
