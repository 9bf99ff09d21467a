// MeasurementFrontEnd turns a raw epoch into the filter's measurements and computes point solutions
// of the same epoch.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <memory>
#include <optional>

#include "core/filter/ekf.h"
#include "core/gnss/cycle_slips/range_change.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/preprocessing/carrier_preprocessor.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "core/gnss/preprocessing/receiver_code_bias.h"
#include "core/gnss/propagation/antenna_pattern_store.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/monitors/independent_solution.h"
#include "core/navigator/monitors/satellite_fault_monitor.h"
#include "core/vehicle/carrier_speed.h"

namespace leonav {

using RefusedOrbits = boost::container::static_vector<SatelliteId, kMaxSatellites>;

// MeasurementFrontEnd holds the orbits, the antenna patterns, the receiver's code biases, and the
// state of the carriers from epoch to epoch. The filter's measurements and those of a point
// solution have separate buffers. It only reads the filter. Positions are the antenna's, ECEF, m.
// Allocates when constructed, not after.
class MeasurementFrontEnd {
 public:
  explicit MeasurementFrontEnd(const NavigatorConfig& config);

  void add(const Ephemeris& ephemeris) { ephemeris_store_.add(ephemeris); }
  void add(const PreciseStates& states);
  void add(const CorrectedStates& states);
  void add(const SignalBiases& biases);
  void add(const KlobucharModel& klobuchar);
  void add(const AntennaPattern& antenna) { antennas_.add(antenna); }
  // Sets the satellites that neither measure() nor solve() uses from now on.
  void exclude(const ExcludedSatellites& satellites) { excluded_ = satellites; }
  // Sets how measure() and solve() use codes of two frequencies from now on.
  void combine_codes(CodeCombination combination) { gnss_.code_combination = combination; }

  // Compares the precise orbits of the satellites seen, of the systems that are used, with the
  // broadcast ones, before either is used. Returns how many are refused, and appends those that are
  // refused from now on.
  int compare_orbits(const RawEpoch& raw, RefusedOrbits* begun);

  // Preprocesses the epoch at the filter's predicted position and tests the carriers against the
  // prediction. If the prediction is too uncertain to correct carriers, the position of a point
  // solution takes its place.
  void measure(const EpochWork& work, const Ekf& filter);
  // Returns the result of the last measure().
  const MeasurementEpoch& measurements() const { return *measurements_; }
  // Returns the horizontal speed of the antenna, m/s, from time-differenced carriers; nullopt:
  // unknown. Call it where carriers are used, between measure() and store_update(), at most once
  // per epoch.
  std::optional<double> update_carrier_speed();
  // Keeps what the carriers of the next epoch are compared with, and ends the arcs that the update
  // found to have slipped. Call it after the filter's update with measurements().
  void store_update(const EkfUpdateResult& result, const Ekf& filter);

  // Returns the epoch's point solution; it fills a buffer of its own and may update the receiver's
  // code biases.
  IndependentSolution solve(const EpochWork& work, const Eigen::Vector3d& approximate_p_e);
  // Returns the epoch's point solution with code biases of this epoch alone; those of the receiver
  // do not change.
  IndependentSolution solve_without_biases(const EpochWork& work,
                                           const Eigen::Vector3d& approximate_p_e);

  // Ends all carrier arcs.
  void reset_carriers() { carriers_.reset(); }
  // Marks the position of the last epoch as unknown: the next epoch's carriers are not tested
  // against it.
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
  ExcludedSatellites excluded_;
  EphemerisStore ephemeris_store_;
  AntennaPatternStore antennas_;
  SignalBiasStore signal_biases_;
  ReceiverCodeBiases code_biases_;
  CarrierPreprocessor carriers_;
  CarrierSpeed carrier_speed_;
  // Receiver's body axes to ECEF at the last measure().
  Eigen::Matrix3d C_er_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d last_position_covariance_ = Eigen::Matrix3d::Zero();  // after the last update
  double ionosphere_step_m_ = 0.0;  // of the modelled zenith delay since the last measure()
  RangeChangePrior change_prior_;   // used by the last measure()
  std::unique_ptr<MeasurementEpoch> measurements_;
  std::unique_ptr<MeasurementEpoch> point_measurements_;  // used by the last point solution
};

// EpochSolver computes the point solutions of one epoch for a monitor.
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
