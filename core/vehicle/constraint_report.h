// ConstraintReport states how the filter met one component of a constraint on the motion.
#pragma once
#include <boost/container/static_vector.hpp>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"

namespace leonav {

// Units are m/s, and rad/s for angular rates. The residual is the innovation after the update.
struct ConstraintReport {
  GpsTime time;
  int component = 0;  // as in MotionComponent
  double observation = 0.0;
  double innovation = 0.0;
  double innovation_variance = 0.0;
  double test_ratio = 0.0;
  bool used = false;
  double residual = 0.0;
};
using ConstraintReports = boost::container::static_vector<ConstraintReport, kMaxConstraintReports>;

}  // namespace leonav
