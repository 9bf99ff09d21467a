// Sky computes antenna position, satellite directions, usable satellites and geometry for one
// epoch. It uses the orbits and codes of the log itself.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <memory>

#include "core/gnss/measurement/dop.h"
#include "core/gnss/measurement/gnss_config.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/preprocessing/receiver_code_bias.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// Sky is given epoch after epoch by look().
class Sky {
 public:
  explicit Sky(const GnssConfig& config);

  EphemerisStore* ephemeris_store() { return &ephemeris_store_; }

  // Computes the point solution of the epoch. Without one, directions refer to the last known
  // position: they change by a degree in 100 km.
  void look(const RawEpoch& raw);

  bool is_solved() const { return solved_; }
  bool has_position() const { return !antenna_p_e_.isZero(); }
  // m, ECEF; zero: not known yet
  const Eigen::Vector3d& antenna_p_e() const { return antenna_p_e_; }
  // 1 sigma of the position in every direction, m.
  double position_sigma_m() const { return position_sigma_m_; }
  // Dilution of precision of the usable satellites; all NaN if they determine no position.
  const Dop& dop() const { return dop_; }
  // Returns every satellite of the epoch, in its order, with its reason.
  const MeasurementEpoch& epoch() const { return *epoch_; }
  const SatelliteInView* find(SatelliteId satellite) const;

 private:
  GnssConfig config_;
  EphemerisStore ephemeris_store_;
  ReceiverCodeBiases biases_;
  std::unique_ptr<MeasurementEpoch> epoch_ = std::make_unique<MeasurementEpoch>();
  bool solved_ = false;
  Eigen::Vector3d antenna_p_e_ = Eigen::Vector3d::Zero();
  double position_sigma_m_ = 0.0;
  Dop dop_;
};

// Returns whether a satellite is above the mask, healthy, and has an orbit and a code from which a
// position can be computed, whatever the solution then decides.
bool is_usable(Reason reason);

// Returns whether the direction is known: there is an orbit, and a position to look from.
bool has_direction(const SatelliteInView& satellite, bool has_position);

}  // namespace leonav
