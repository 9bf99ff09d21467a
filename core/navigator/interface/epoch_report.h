// EpochReport holds the estimate at one GNSS epoch and how each measurement was used.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/filter/error_model/learned_summary.h"
#include "core/filter/update/motion_constraint.h"
#include "core/gnss/measurement/measurement.h"
#include "core/inertial/alignment/alignment_need.h"
#include "core/integrity/fault_hypothesis.h"
#include "core/navigator/interface/checkpoint.h"
#include "core/navigator/interface/solution.h"
#include "core/vehicle/constraint_report.h"

namespace leonav {

// One measurement of the update. Codes, carriers (m) and Dopplers (m/s) use the same fields.
struct AidingReport {
  SatelliteId satellite;
  Observable observable = Observable::kCode;
  SignalCode code, second_code;
  double observation = 0.0;          // corrected measurement, m or m/s
  double innovation = 0.0;           // measured minus predicted, m or m/s
  double innovation_variance = 0.0;  // m^2 or (m/s)^2
  double residual = 0.0;             // what the update leaves of the innovation, m or m/s
  double test_ratio = 0.0;           // |innovation| / sigma of the innovation
  double weight_factor = 1.0;        // IGG-III, from 0 to 1
  Reason reason = Reason::kUsed;
};

// One satellite of the epoch, used or not.
struct SatelliteReport {
  SatelliteId satellite;
  Reason reason = Reason::kUsed;  // kUsed if any of its measurements was used
  // rad; NaN where it has no orbit
  double elevation = std::numeric_limits<double>::quiet_NaN();
  double azimuth = std::numeric_limits<double>::quiet_NaN();
  double cn0_dbhz = 0.0;
  double ephemeris_age_s = 0.0;
  OrbitSource source = OrbitSource::kNone;
  bool clock_from_file = false;  // of precise states: the clock is from a clock file
  std::uint32_t arc = 0;         // identity of the carrier arc; 0: the carrier is not used
  bool arc_started = false;      // the arc begins at this epoch
  SlipCauses arc_causes;         // why the previous arc ended; none at a satellite's first arc
};

// The report of one epoch, with the estimate at the epoch itself. Some members stay within the
// process and are not on the wire.
struct EpochReport {
  std::uint64_t sequence = 0;
  std::uint64_t index = 0;  // index k of the epoch
  GpsTime time;
  bool empty = false;  // issued by the Sequencer because no GNSS came in time
  Solution solution;
  int satellites_used = 0;
  double pdop = 0.0, hdop = 0.0, vdop = 0.0;
  // Receiver clock per system time; NaN where it is not estimated.
  std::array<double, kMaxSystemTimes> clock_m{};
  std::array<double, kMaxSystemTimes> clock_drift_m_s{};
  // The alignment need. It is empty if there is an attitude or the motion model has none. Not on
  // the wire.
  AlignmentNeed alignment;
  // Zenith wet delay beyond the modelled one; NaN: not estimated.
  double wet_delay_m = 0.0, wet_delay_sigma_m = 0.0;
  double nis = 0.0;     // normalized innovation squared over all used measurements
  int nis_degrees = 0;  // degrees of freedom of `nis`: the number of those measurements
  boost::container::static_vector<SatelliteReport, kMaxSatellites> satellites;
  boost::container::static_vector<AidingReport, kMaxMeasurements> aiding;
  LearnedSummary learned_errors;  // not on the wire
  int widened_predictions = 0;    // observables whose prediction was widened; not on the wire
  int orbits_refused = 0;         // satellites seen whose precise orbit is wrong; not on the wire
  int arcs_joined = 0;            // carrier arcs joined to the one before; not on the wire
  // Faults that the protection levels allow for, beside none. Not on the wire.
  FaultHypotheses fault_hypotheses;
  ConstraintInstants constraints;  // instants since the last epoch; not on the wire
  ConstraintReports constraint_reports;
  // Checkpoint for the next run. nullopt: the filter is not initialized, or there is no IMU.
  // Without a heading its heading_sigma is pi. Not on the wire.
  std::optional<Checkpoint> checkpoint;
};

}  // namespace leonav
