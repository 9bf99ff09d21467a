// An EpochReport holds the estimate at one GNSS epoch and how each measurement was used.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/filter/update/motion_constraint.h"
#include "core/gnss/measurement/measurement.h"
#include "core/inertial/alignment/alignment_need.h"
#include "core/navigator/interface/checkpoint.h"
#include "core/navigator/interface/solution.h"
#include "core/vehicle/constraint_report.h"

namespace leonav {

// One measurement of the update: code, carrier or Doppler, in the same fields.
struct AidingReport {
  SatelliteId satellite;
  Observable observable = Observable::kCode;
  SignalCode code, second_code;
  double observation = 0.0;  // m or m/s
  double innovation = 0.0;
  double innovation_variance = 0.0;
  double residual = 0.0;       // what the update left of the innovation
  double test_ratio = 0.0;     // |innovation| / sigma of innovation
  double weight_factor = 1.0;  // IGG-III
  Reason reason = Reason::kUsed;
};

struct SatelliteReport {
  SatelliteId satellite;
  Reason reason = Reason::kUsed;          // kUsed if any of its measurements counted
  double elevation = 0.0, azimuth = 0.0;  // rad
  double cn0_dbhz = 0.0;
  double ephemeris_age_s = 0.0;
  OrbitSource source = OrbitSource::kNone;
  bool clock_from_file = false;  // precise: the clock is from a clock file
  std::uint32_t arc = 0;         // identity of the uninterrupted carrier arc; 0: not used
  bool arc_started = false;      // at this epoch
  SlipCauses arc_causes;         // why the arc before it ended; none at a satellite's first
};

// `solution` is the estimate at the epoch itself.
struct EpochReport {
  std::uint64_t sequence = 0;
  std::uint64_t index = 0;  // k
  GpsTime time;
  bool empty = false;  // issued by the Sequencer because no GNSS came
  Solution solution;
  int satellites_used = 0;
  double pdop = 0.0, hdop = 0.0, vdop = 0.0;
  std::array<double, kMaxSystemTimes> clock_m{};  // NaN where not estimated
  std::array<double, kMaxSystemTimes> clock_drift_m_s{};
  AlignmentNeed alignment;  // nothing: there is an attitude, or never will be; not on the wire
  double wet_delay_m = 0.0, wet_delay_sigma_m = 0.0;  // at zenith, beyond the model's; NaN: none
  double nis = 0.0;  // normalized innovation squared over all used measurements
  int nis_degrees = 0;
  boost::container::static_vector<SatelliteReport, kMaxSatellites> satellites;
  boost::container::static_vector<AidingReport, kMaxMeasurements> aiding;
  ConstraintInstants constraints;  // since the last epoch; not on the wire
  ConstraintReports constraint_reports;
  // For the next run; nullopt: there is no filter. Not on the wire. The sigma of its heading is pi
  // where there is no heading.
  std::optional<Checkpoint> checkpoint;
};

}  // namespace leonav
