#include "core/vehicle/constraint_monitor.h"

#include <cmath>

namespace leonav {
namespace {

constexpr double kTimeConstant_s = 10.0;  // of the sums
constexpr double kContradicted = 0.5, kAgain = 0.25;

}  // namespace

void ConstraintMonitor::reset() {
  offered_ = left_out_ = 0.0;
  contradicted_ = false;
}

void ConstraintMonitor::add(const MotionMeasurements& measurements, MotionComponents used) {
  const double keep = std::exp(-interval_s_ / kTimeConstant_s);
  unsigned left_out = 0;
  for (const MotionMeasurement& m : measurements) left_out |= 1u << m.component;
  left_out &= ~static_cast<unsigned>(used);
  offered_ = keep * offered_ + 1.0;
  left_out_ = keep * left_out_ + (left_out != 0 ? 1.0 : 0.0);
  if (left_out != 0) last_left_out_ = static_cast<MotionComponents>(left_out);
}

std::optional<ConstraintMonitor::Contradiction> ConstraintMonitor::contradiction() {
  const double enough = 0.5 * kTimeConstant_s / interval_s_;
  const double share = offered_ > enough ? left_out_ / offered_ : 0.0;
  if (share < kAgain) contradicted_ = false;
  if (contradicted_ || share < kContradicted) return std::nullopt;
  contradicted_ = true;
  return Contradiction{share, last_left_out_};
}

}  // namespace leonav
