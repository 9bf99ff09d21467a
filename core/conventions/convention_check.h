// Does what is handed in follow leonav's conventions? Asks it of the first minutes of motion.
#pragma once
#include "core/conventions/code_order_check.h"
#include "core/conventions/convention.h"
#include "core/conventions/force_check.h"
#include "core/conventions/lever_arm_check.h"
#include "core/conventions/lone_point.h"
#include "core/conventions/motion_record.h"
#include "core/conventions/range_rate_check.h"
#include "core/conventions/turn_check.h"

namespace leonav {

enum class Posture : unsigned char { kUpright, kInFlight, kInHand };

// Compares what the IMU feels with what the receiver alone says of the motion, second by second.
// Of the filter it reads the attitude, for the lever arm alone; it changes nothing. It tells the
// first mistake that it is sure of, once: what else is odd then may follow from that one. Where all
// turns out to be right, or after an hour, it rests.
class ConventionCheck {
 public:
  // Up to `max_reverse_speed_m_s` the vehicle may be going in reverse; where that is as fast as any
  // (a train has a cab at either end) backwards is as right as forwards. `posture`: what stays
  // upright shows where down is at any time, what a hand holds may lie on its side, what flies may
  // hover on its tail.
  ConventionCheck(const GnssConfig& gnss, const RobustConfig& robust,
                  const Eigen::Vector3d& lever_arm_b, double max_reverse_speed_m_s,
                  Posture posture);
  void clear();  // everything starts anew
  void add(const ImuSample& sample);
  // Whether end_second() wants an epoch of this time.
  bool is_due(GpsTime time) const { return !rests_ && record_.is_due(time); }
  // To be called with each epoch that is due. `q_eb`: the filter's attitude then; nullptr: none.
  ConventionFinding end_second(const RawEpoch& raw, const SatelliteCatalog& catalog,
                               const Eigen::Quaterniond* q_eb);

 private:
  ConventionFinding judge();
  ConventionFinding judge_course(const MeanForce& force);
  ConventionFinding judge_straight(const MeanForce& force, const TurnFit& turns);
  ConventionFinding judge_axes(const MeanForce& force, const TurnFit& turns);

  MotionRecord record_;
  LonePoint point_;
  RangeRateCheck range_rates_;
  CodeOrderCheck code_order_;
  LeverArmCheck lever_arm_;
  double max_reverse_speed_m_s_;
  Posture posture_;
  bool rests_ = false;
  int seconds_ = 0;
};

}  // namespace leonav
