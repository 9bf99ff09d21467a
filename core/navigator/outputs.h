// What the navigator tells the world, as plain values; drivers/lcm puts them on the wire.
#pragma once
#include <Eigen/Core>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/capacity.h"
#include "core/ekf/motion_constraint.h"
#include "core/gnss/measurement.h"
#include "core/ins/alignment_need.h"
#include "core/ins/nav_state.h"
#include "core/navigator/checkpoint.h"
#include "core/smoother/smoother_status.h"

namespace leonav {

// Who gives the answer. On the wire: append only.
enum class Source : std::uint8_t {
  kNone = 0,
  kAligning = 1,
  kInsOnly = 2,
  kEkf = 3,
  kSmoother = 4
};
std::string_view to_string(Source source);  // "none", "aligning", "ins", "ekf", "smoother"

// Position, velocity, attitude of the IMU centre at one instant, with 1 sigma in north, east, down.
struct Solution {
  std::uint64_t sequence = 0;  // of this output, from 1
  GpsTime time;
  Source source = Source::kNone;
  bool has_attitude = false;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
  double latitude = 0.0, longitude = 0.0, height = 0.0;  // rad, rad, m
  Eigen::Vector3d v_n = Eigen::Vector3d::Zero();         // m/s, north east down
  double roll = 0.0, pitch = 0.0, yaw = 0.0;             // rad
  Eigen::Vector3d sigma_p_n = Eigen::Vector3d::Zero();   // m
  Eigen::Vector3d sigma_v_n = Eigen::Vector3d::Zero();   // m/s
  Eigen::Vector3d sigma_rpy = Eigen::Vector3d::Zero();   // rad
  ImuErrors errors;                                      // of the anchor in use
  std::uint64_t anchor_epoch = 0;                        // k of the anchor it was propagated from
  double jump_m = 0.0;  // how far the newest anchor moved the answer; 0 between commits
};

// One aiding measurement, in the same five fields whatever it is.
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

// One component of a constraint on the motion, likewise; in m/s, angular rates in rad/s.
struct ConstraintReport {
  GpsTime time;
  int component = 0;  // as in MotionComponent
  double observation = 0.0;
  double innovation = 0.0;
  double innovation_variance = 0.0;
  double test_ratio = 0.0;
  bool used = false;
  double residual = 0.0;
};
using ConstraintReports = boost::container::static_vector<ConstraintReport, kMaxConstraintReports>;

struct SatelliteReport {
  SatelliteId satellite;
  Reason reason = Reason::kUsed;          // kUsed if any of its measurements counted
  double elevation = 0.0, azimuth = 0.0;  // rad
  double cn0_dbhz = 0.0;
  double ephemeris_age_s = 0.0;
  OrbitSource source = OrbitSource::kNone;
  bool clock_of_file = false;  // precise: its clock is of a clock file
  std::uint32_t arc = 0;       // identity of its uninterrupted carrier; 0: not used
  bool arc_started = false;    // here
  SlipCauses arc_causes;       // why the arc before it ended; none at a satellite's first
};

// One GNSS epoch as the estimator left it. `solution` is its estimate at the epoch itself.
struct EpochReport {
  std::uint64_t sequence = 0;
  std::uint64_t index = 0;  // k
  GpsTime time;
  bool empty = false;  // issued by the Sequencer because no GNSS came
  Solution solution;
  int satellites_used = 0;
  double pdop = 0.0, hdop = 0.0, vdop = 0.0;
  std::array<double, kMaxTimeBases> clock_m{};  // NaN where not estimated
  std::array<double, kMaxTimeBases> clock_drift_m_s{};
  AlignmentNeed alignment;  // nothing: there is an attitude, or never will be; not on the wire
  double wet_delay_m = 0.0, wet_delay_sigma_m = 0.0;  // at zenith, beyond the model's; NaN: none
  double nis = 0.0;  // normalized innovation squared over all used measurements
  int nis_degrees = 0;
  boost::container::static_vector<SatelliteReport, kMaxSatellites> satellites;
  boost::container::static_vector<AidingReport, kMaxMeasurements> aiding;
  ConstraintInstants constraints;  // since the last epoch; not on the wire
  ConstraintReports constraint_reports;
  // For the next run; nullopt: there is no filter. Not on the wire, and its heading's sigma is pi
  // where there is none.
  std::optional<Checkpoint> checkpoint;
};

// The smoother's answer at a keyframe, if it was in time.
struct SmootherReport {
  std::uint64_t sequence = 0;
  std::uint64_t index = 0;  // k
  SmootherStatus status = SmootherStatus::kNoFilter;
  int iterations = 0;
  bool converged = false;
  int keyframes = 0;  // in the window
  int used = 0;       // measurements of this keyframe with a weight
  Solution solution;  // source kSmoother if the answer is its own, else kNone
};

// On the wire: append only.
enum class EventKind : std::uint8_t {
  kRejectedInput = 0,  // code: InputFault
  kDeadlineMiss = 1,   // code: 0 ekf, 1 smoother; value: epoch
  kFilterReset = 2,
  kAligned = 3,
  kImuGap = 4,     // value: seconds
  kLateEpoch = 5,  // value: seconds late
  kEmptyEpoch = 6,
  kSolutionJump = 7,    // value: metres
  kCapacity = 8,        // a fixed table was full; code says which
  kImprobable = 9,      // code: 0 codes, 1 Dopplers; value: innovations over their sigmas
  kOrbitFallback = 10,  // precise state lost, broadcast serves; code: system, value: number
  kOrbitReturn = 11,    // a precise state serves where broadcast did; likewise
  kClockStep = 12,      // of a clock, beyond its noise; code: ClockStep, value: metres
  kNoneUsable = 13,  // all satellites left out, epoch after epoch; code: Reason, value: satellites
  kClockFallback = 14,   // precise: no clock file's clock, the orbit's serves; code, value: as 10
  kClockReturn = 15,     // a clock file's serves again, or for the first time; likewise
  kSmootherFailed = 16,  // its window starts over; code: SmootherStatus, value: epoch
  kSourceChange = 17,    // of the answer's anchor; code: Source it now comes from, value: epoch
  // On the motion, they contradict the filter; value: share of the instants; code, a sum of those
  // left out: side 1, vertical 2, standing's velocity 4 and rate 8, odometer 16.
  kConstraintsLeftOut = 18,
  kConventionSuspect = 19,  // an input does not follow leonav's; code: Convention, value: by it
  // Satellites are back after 5 s or more; value: seconds without; code: by how many tenths of its
  // 3D sigma the filter's position stepped.
  kOutageOver = 20,
  kReconverged = 21,  // its sigma is again at most 1.5 times that of before; value: seconds since
  kCheckpoint = 22,   // an earlier run's has been judged; code: CheckpointUse, value: by it
};
std::string_view to_string(EventKind kind);

// Codes of EventKind::kClockStep. On the wire: append only.
enum class ClockStep : std::uint8_t {
  kReceiver = 0,     // of all codes and carriers
  kCodes = 1,        // of all codes against the carriers
  kFirstSystem = 16  // and on, by System: of that system's codes against the others'
};

// Codes of EventKind::kFilterReset: of the Sequencer's (kTimeBase), the GNSS stage's (any), and the
// inertial stage's (kNotFinite: it waits for the next anchor).
enum class ResetCause : std::uint8_t {
  kCommand = 0,
  kTimeBase = 1,
  kPrediction = 2,
  kOutage = 3,
  kNotFinite = 4,
  kLockedOut = 5,  // value: m, the new sigma or, where it starts anew, what it was off by
  kHeading = 6     // value: rad, what the heading was off by; it is aligned anew
};

// Why an input message was not used. On the wire: append only.
enum class InputFault : std::uint8_t {
  kNone = 0,
  kUndecodable = 1,
  kUnknownSchema = 2,
  kNotFinite = 3,
  kOutOfRange = 4,
  kTimeBackwards = 5,
  kDuplicate = 6,
  kTooMany = 7,
  kNotSane = 8,
  kTooFarAhead = 9,
  kOverlap = 10,  // of an interval with the one before
};
std::string_view to_string(InputFault fault);

// Who reports. On the wire: append only. Event sequences count per stage, so that their order does
// not depend on how threads interleave.
enum class Stage : std::uint8_t { kSequencer = 0, kInertial = 1, kGnss = 2, kSmoother = 3 };

struct Event {
  std::uint64_t sequence = 0;
  Stage stage = Stage::kSequencer;
  GpsTime time;  // data time
  EventKind kind = EventKind::kRejectedInput;
  std::uint8_t code = 0;
  double value = 0.0;
};

// What became of one epoch's result: part of the journal.
struct Decision {
  std::uint64_t sequence = 0;
  std::uint64_t epoch = 0;
  GpsTime time;              // IMU data time at which it was decided
  std::uint8_t mailbox = 0;  // 0 ekf, 1 smoother, 2 keyframe (never committed: it had no room)
  bool committed = false;
  std::int32_t iterations = 0;
};

// What an answer of the smoother says of its epoch's decision: of the last ones of a run none is
// recorded yet.
Decision decision_of(const SmootherReport& report);

// Receives outputs in order. Called by the stages; must not block for long and must not throw.
class OutputSink {
 public:
  virtual ~OutputSink() = default;
  virtual void on_solution(const Solution& solution) = 0;
  virtual void on_epoch(const EpochReport& report) = 0;
  virtual void on_event(const Event& event) = 0;
  virtual void on_decision(const Decision& decision) = 0;
  virtual void on_smoother(const SmootherReport& report) = 0;
};

}  // namespace leonav
