// LogGraph holds the factor graph of a whole log: a keyframe per epoch, the process factors between
// them, their measurements, and the ambiguities of all carrier arcs.
//
// Terms and errors are those of core/smoother/keyframe.h. A log may have 90,000 keyframes, so that
// everything is stored in its exact size; this chapter allocates.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/filter/update/measurement_model.h"
#include "core/smoother/keyframe.h"

namespace leonav {

// The ambiguity of a carrier over a part of its arc. The range errors of orbit, clock and
// ionosphere move it by a random walk: as soon as that may have gone further than a carrier's
// noise, another piece goes on from here, with the variance that has come together.
struct AmbiguityPiece {
  SatelliteId satellite;
  double value_m = 0.0;        // the estimate
  double start_value_m = 0.0;  // where it does not go on from another piece: the first guess
  int previous = -1;           // piece from which it goes on; -1: none
  double step_variance = 0.0;  // m^2, against `previous`, or of the first guess
};

// One measurement of a keyframe; its weight is factor / gain_variance.
struct LogMeasurement {
  MeasuredObservable measurement;   // satellite_index: into the keyframe's satellites
  int piece = -1;                   // of LogGraph::pieces(); -1: no carrier
  double ambiguity_offset_m = 0.0;  // the carrier's ambiguity minus the piece's value
  double variance = 0.0;            // of the measurement alone, for its test
  double gain_variance = 0.0;
  double factor = 1.0;    // IGG-III
  double residual = 0.0;  // at the estimate, m or m/s
};

// Two pieces whose arcs the filter has joined: the value of `to` minus that of `from` is
// difference_m, with the variance given in m^2.
struct PieceJoin {
  int from = 0, to = 0;
  double difference_m = 0.0, variance = 0.0;
};

// The process factor from the keyframe before, as ProcessFactor.
struct LogProcess {
  bool exists = false;  // false: nothing is known between the two
  CoreState from, to;
  ActiveStates rows, columns;  // of F: states of this keyframe and of the one before
  Eigen::MatrixXd F, noise;
  // Empty unless motion constraints between the two keyframes were applied.
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  std::vector<PieceJoin> joins;  // of pieces under way at the keyframe before
};

// One keyframe of the log.
struct LogKeyframe {
  std::uint64_t index = 0;
  GpsTime time;
  bool has_attitude = false;
  bool has_gnss = false;
  bool attitude_replaced = false;  // as KeyframeInput
  ActiveStates active;             // of core states; ambiguities: none
  CoreState state;                 // the estimate
  double filter_sigma_m = 0.0;     // of the filter's position, 3D
  LogProcess process;
  // Where no process leads here: 0.5 d^T information d - gradient^T d, with d the core states and
  // then the pieces minus the values given.
  Eigen::MatrixXd prior_information;
  Eigen::VectorXd prior_gradient;
  CoreState prior_at;
  Eigen::VectorXd prior_pieces_at;
  Eigen::Vector3d measured_rate_b = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d vertical_antenna_offset_e = Eigen::Vector3d::Zero();
  std::vector<SatelliteGeometry> satellites;
  std::vector<LogMeasurement> measurements;
  std::vector<int> pieces;  // ambiguities under way, ascending
  std::vector<ImuSample> block;
  bool block_complete = false;
  ImuSample sample_before_block;
  std::vector<ConstraintInstant> instants;  // motion constraints within the block

  Eigen::Index core_size() const { return active.core_size(); }
  Eigen::Index size() const { return core_size() + static_cast<Eigen::Index>(pieces.size()); }
};

// LogGraph is filled keyframe by keyframe in order of time.
class LogGraph {
 public:
  // `lever_arm_b`: m, from the IMU to the antenna, body axes.
  explicit LogGraph(const Eigen::Vector3d& lever_arm_b) : lever_arm_b_(lever_arm_b) {}

  // Appends an epoch as the filter has treated it; one without a state, or a first one whose
  // covariance is not positive definite, is left out.
  void add(const KeyframeInput& input);
  // Appends a keyframe that is complete, and a piece, whose index it returns.
  void add(LogKeyframe keyframe) { keyframes_.push_back(std::move(keyframe)); }
  int add(const AmbiguityPiece& piece) {
    pieces_.push_back(piece);
    return static_cast<int>(pieces_.size()) - 1;
  }

  int size() const { return static_cast<int>(keyframes_.size()); }
  LogKeyframe& at(int k) { return keyframes_[static_cast<std::size_t>(k)]; }
  const LogKeyframe& at(int k) const { return keyframes_[static_cast<std::size_t>(k)]; }
  std::vector<AmbiguityPiece>& pieces() { return pieces_; }
  const std::vector<AmbiguityPiece>& pieces() const { return pieces_; }
  const AmbiguityPiece& piece(int i) const { return pieces_[static_cast<std::size_t>(i)]; }
  const Eigen::Vector3d& lever_arm_b() const { return lever_arm_b_; }

 private:
  // An arc that the filter follows.
  struct Arc {
    int piece = -1;
    double offset_m = 0.0;          // its ambiguity minus the piece's value
    double pending_variance = 0.0;  // of its random walk since the piece began
  };
  using Arcs = std::map<std::uint32_t, Arc>;

  void add_process(const KeyframeInput& input, const LogKeyframe& before, LogKeyframe* keyframe);
  void follow_arcs(const KeyframeInput& input, bool linked);
  void add_measurements(const KeyframeInput& input, LogKeyframe* keyframe);

  Eigen::Vector3d lever_arm_b_;
  std::vector<LogKeyframe> keyframes_;
  std::vector<AmbiguityPiece> pieces_;
  Arcs arcs_;
  bool left_out_ = false;  // the epoch before, because its covariance was none
};

// Returns position and velocity of the keyframe's antenna, ECEF, at `state`.
AntennaMotion antenna_of(const LogKeyframe& keyframe, const CoreState& state,
                         const Eigen::Vector3d& lever_arm_b);

}  // namespace leonav
