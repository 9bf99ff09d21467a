// Strapdown mechanization in ECEF.
#pragma once
#include <Eigen/Core>

#include "core/ins/imu.h"
#include "core/ins/nav_state.h"

namespace leonav {

// Removes bias and scale factor: (increment - bias * dt) / (1 + scale), componentwise.
ImuSample correct(const ImuSample& sample, const ImuErrors& errors);

// Advances a state sample by sample, with the two-sample coning and sculling terms (Savage 1998;
// Groves 2013, 5.3-5.4, in ECEF), Earth rotation, Coriolis and gravity.
class Mechanization {
 public:
  // Starts at `state`; `state.errors` are removed from every sample.
  void reset(const NavState& state);
  // Likewise, where the motion until then is known: `previous` (errors not removed) ends at `state`
  // and counts for coning and sculling.
  void reset(const NavState& state, const ImuSample& previous);
  // Goes on from a corrected state: at the same time the motion behind it still counts for coning
  // and sculling, which a correction of the state does not interrupt. Otherwise as reset().
  void restate(const NavState& state);

  // `sample.start()` must equal state().time. Integrates to sample.time.
  void advance(const ImuSample& sample);

  const NavState& state() const { return state_; }
  // Of the last sample, errors removed: mean specific force (m/s^2) and rate against i (rad/s),
  // body.
  const Eigen::Vector3d& specific_force_b() const { return specific_force_b_; }
  const Eigen::Vector3d& omega_ib_b() const { return omega_ib_b_; }

 private:
  NavState state_;
  Eigen::Vector3d specific_force_b_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_ib_b_ = Eigen::Vector3d::Zero();
  // Previous sample's increments, for coning and sculling; interval 0 after reset.
  ImuSample previous_;
};

}  // namespace leonav
