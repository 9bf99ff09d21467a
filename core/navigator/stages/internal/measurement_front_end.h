// MeasurementFrontEnd turns a raw epoch into the measurements of the filter, and computes point
// solutions beside it.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>

#include "core/filter/ekf.h"
#include "core/gnss/cycle_slips/range_change.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/preprocessing/carrier_preprocessor.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "core/gnss/preprocessing/receiver_code_bias.h"
#include "core/gnss/propagation/antenna_pattern_store.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/monitors/independent_solution.h"
#include "core/vehicle/carrier_speed.h"

namespace leonav {

// Holds what belongs to satellites and receiver: orbits, antenna patterns, the receiver's code
// biases, and what carriers need from one epoch to the next. The filter's measurements and those of
// a point solution have a buffer each. Reads the filter, never changes it. Positions are the
// antenna's, ECEF, m. Allocates when constructed, not after.
class MeasurementFrontEnd {
 public:
  explicit MeasurementFrontEnd(const NavigatorConfig& config);

  void add(const Ephemeris& ephemeris) { ephemeris_store_.add(ephemeris); }
  void add(const PreciseStates& states);
  void add(const KlobucharModel& klobuchar) { ephemeris_store_.set_klobuchar(klobuchar); }
  void add(const AntennaPattern& antenna) { antennas_.add(antenna); }

  // Preprocesses the epoch where `filter` is predicted to be (or, where that is too uncertain to
  // correct carriers, where the codes alone are) and tests the carriers against the prediction.
  void measure(const EpochWork& work, const Ekf& filter);
  // Of the last measure().
  const MeasurementEpoch& measurements() const { return *measurements_; }
  // Horizontal speed of the antenna, m/s, from time-differenced carriers; nullopt: not known.
  // Between measure() and store_update(), at most once an epoch.
  std::optional<double> update_carrier_speed();
  // After the filter's update with measurements(): what the next epoch's carriers are compared
  // with. Ends the arcs that the update found to have slipped.
  void store_update(const EkfUpdateResult& result, const Ekf& filter);

  // The epoch's point solution; fills a buffer of its own.
  IndependentSolution solve(const EpochWork& work, const Eigen::Vector3d& approximate_p_e);
  // The same with code biases of this epoch alone: those of the receiver stay as they are.
  IndependentSolution solve_without_biases(const EpochWork& work,
                                           const Eigen::Vector3d& approximate_p_e);

  void reset_carriers() { carriers_.reset(); }
  // The position of the last epoch is unknown: the next epoch's carriers are not tested against it.
  void reset_position() { carriers_.reset_position(); }

  const EphemerisStore& ephemeris_store() const { return ephemeris_store_; }
  const AntennaPatternStore& antennas() const { return antennas_; }

 private:
  PreprocessAids aids(const Ekf& filter);
  RangeChangePrior change_prior(const Ekf& filter, bool predicted) const;
  Eigen::Vector3d approximate_position(const EpochWork& work, const Ekf& filter);
  IndependentSolution solve(const EpochWork& work, const Eigen::Vector3d& approximate_p_e,
                            ReceiverCodeBiases* biases);

  GnssConfig gnss_;
  RobustConfig robust_;
  bool use_carrier_, inertial_;
  Eigen::Vector3d lever_arm_b_;
  EphemerisStore ephemeris_store_;
  AntennaPatternStore antennas_;
  ReceiverCodeBiases code_biases_;
  CarrierPreprocessor carriers_;
  CarrierSpeed carrier_speed_;
  Eigen::Matrix3d C_er_ = Eigen::Matrix3d::Identity();                  // of the last measure()
  Eigen::Matrix3d last_position_covariance_ = Eigen::Matrix3d::Zero();  // after the last update
  RangeChangePrior change_prior_;                                       // of the last measure()
  std::unique_ptr<MeasurementEpoch> measurements_;
  std::unique_ptr<MeasurementEpoch> point_measurements_;  // of the last point solution
};

// The point solutions of one epoch, for a monitor.
class EpochSolver : public IndependentSolver {
 public:
  EpochSolver(MeasurementFrontEnd* front_end, const EpochWork& work)
      : front_end_(front_end), work_(work) {}
  IndependentSolution solve(const Eigen::Vector3d& approximate_p_e) override {
    return front_end_->solve(work_, approximate_p_e);
  }

 private:
  MeasurementFrontEnd* front_end_;
  const EpochWork& work_;
};

}  // namespace leonav
