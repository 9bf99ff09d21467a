// Does what is handed in follow leonav's conventions? Asks it of the first minutes of motion.
#pragma once
#include "core/conventions/convention.h"
#include "core/conventions/force_check.h"
#include "core/conventions/motion_record.h"
#include "core/conventions/turn_check.h"

namespace leonav {

// Compares what the IMU feels with what the receiver alone says of the motion, second by second.
// Nothing here reads or changes the filter. It tells the first mistake that it is sure of, once:
// what else is odd then may follow from that one.
class ConventionCheck {
 public:
  void clear();  // everything starts anew, with another mistake to tell
  void add(const ImuSample& sample);
  // Whether end_second() wants a point solution of this epoch.
  bool is_due(GpsTime time) const;
  // To be called at each epoch that is due, with the solution of its codes and Dopplers alone;
  // nullptr: there was none.
  ConventionFinding end_second(GpsTime time, const PointSolution* point);

 private:
  ConventionFinding judge() const;
  ConventionFinding check_axes(const MeanForce& force, const TurnFit& turns) const;

  MotionRecord record_;
  bool told_ = false;
};

}  // namespace leonav
