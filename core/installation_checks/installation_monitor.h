// InstallationMonitor tests over the first minutes of motion whether the inputs follow leonav's
// conventions.
#pragma once
#include "core/installation_checks/convention.h"
#include "core/installation_checks/internal/code_order_monitor.h"
#include "core/installation_checks/internal/lever_arm_monitor.h"
#include "core/installation_checks/internal/mean_force.h"
#include "core/installation_checks/internal/motion_record.h"
#include "core/installation_checks/internal/range_rate_monitor.h"
#include "core/installation_checks/internal/single_epoch_solver.h"
#include "core/installation_checks/internal/yaw_rate_fit.h"

namespace leonav {

// Posture states how the vehicle holds its vertical axis.
enum class Posture : unsigned char { kUpright, kInFlight, kInHand };

// InstallationMonitor compares the IMU with the receiver's own velocities, second by second.
//
// From the filter it reads the attitude only, for the lever arm; it changes nothing. It reports the
// first certain mistake, once, because other anomalies may follow from that one. It ends when all
// tests have passed, or after an hour.
class InstallationMonitor {
 public:
  // Up to `max_reverse_speed_m_s` the vehicle may be going in reverse. If that is as fast as any
  // speed (a train has a cab at either end), an IMU mounted backwards is right too.
  //
  // A vehicle that stays upright (kUpright) shows at any time where down is; one in the hand may
  // lie on its side, and one in flight may hover on its tail. `lever_arm_b`: m, body axes.
  InstallationMonitor(const GnssConfig& gnss, const RobustConfig& robust,
                      const Eigen::Vector3d& lever_arm_b, double max_reverse_speed_m_s,
                      Posture posture);
  void clear();  // Removes all data and starts anew.
  // Adds a sample in body axes, as the navigator uses it.
  void add(const ImuSample& sample);
  // Returns whether end_second() expects an epoch of this time.
  bool is_due(GpsTime time) const { return !finished_ && record_.is_due(time); }
  // Ends the current second; call it with each epoch that is due. `q_eb` is the filter's attitude
  // (body to ECEF) at that epoch, nullptr if there is none.
  ConventionFinding end_second(const RawEpoch& raw, const EphemerisStore& ephemeris_store,
                               const Eigen::Quaterniond* q_eb);

 private:
  ConventionFinding evaluate();
  ConventionFinding evaluate_course(const MeanForce& force);
  ConventionFinding evaluate_straight(const MeanForce& force, const YawRateFit& turns);
  ConventionFinding evaluate_axes(const MeanForce& force, const YawRateFit& turns);

  MotionRecord record_;
  SingleEpochSolver point_;
  RangeRateMonitor range_rates_;
  CodeOrderMonitor code_order_;
  LeverArmMonitor lever_arm_;
  double max_reverse_speed_m_s_;
  Posture posture_;
  bool finished_ = false;
  int seconds_ = 0;
};

}  // namespace leonav
