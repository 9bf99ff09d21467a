// Mechanization integrates IMU increments to position, velocity and attitude in the ECEF frame.
//
//   dp/dt = v_e,  dv/dt = C_eb f_b + gravity_e(p) - 2 omega_ie x v_e,  dC_eb/dt = C_eb [omega_ib_b
//   x] - [omega_ie x] C_eb
//
// Two-sample coning and sculling terms (Savage, J. Guidance 21, 1998) allow for unequal intervals;
// the rest follows Groves 2013, 5.3-5.4.
#pragma once
#include <Eigen/Core>

#include "core/inertial/strapdown/imu.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

// Returns the sample without bias and scale factor: (increment - bias * dt) / (1 + scale),
// componentwise.
ImuSample correct(const ImuSample& sample, const ImuErrors& errors);

// Mechanization advances a NavState sample by sample, with coning, sculling, Earth rotation,
// Coriolis and gravity.
class Mechanization {
 public:
  // Starts at `state`, without coning and sculling at the first sample. `state.errors` are removed
  // from every sample.
  void reset(const NavState& state);
  // Starts at `state` after known motion: `previous` (errors not removed), if it ends at
  // `state.time`, counts for coning and sculling.
  void reset(const NavState& state, const ImuSample& previous);
  // Continues from a corrected state. At an unchanged time the previous sample still counts for
  // coning and sculling, which a correction does not interrupt; at another time this is
  // reset(state).
  void continue_from(const NavState& state);

  // Integrates to sample.time. Precondition: `sample.start()` equals state().time.
  void advance(const ImuSample& sample);

  const NavState& state() const { return state_; }
  // Mean specific force (m/s^2) and angular rate against i (rad/s) over the last sample, body axes,
  // sensor errors removed.
  const Eigen::Vector3d& specific_force_b() const { return specific_force_b_; }
  const Eigen::Vector3d& omega_ib_b() const { return omega_ib_b_; }

 private:
  NavState state_;
  Eigen::Vector3d specific_force_b_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_ib_b_ = Eigen::Vector3d::Zero();
  // Increments of the previous sample, for coning and sculling; interval 0 after reset.
  ImuSample previous_;
};

}  // namespace leonav
