// HeadingMonitor detects a wrong heading of the filter from velocities that are independent of it.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "core/inertial/alignment/alignment.h"
#include "core/inertial/alignment/course_window.h"
#include "core/inertial/alignment/velocity_matching.h"
#include "core/inertial/strapdown/imu.h"

namespace leonav {

// A heading that was given wrongly, or derived from reflected signals, does not show in the
// innovations of one epoch: weights hide them, and the error stays. Over a window it does. The
// innovation here is a heading from the velocities of point solutions and the gyros (velocity
// matching, or for a vehicle that goes where it points the course over ground) minus the filter's.
class HeadingMonitor {
 public:
  HeadingMonitor(const AlignmentConfig& config, const ImuErrorModel& imu);

  // Starts when the filter has received its attitude, with this gyro bias (rad/s) and its sigma per
  // axis.
  void start(const Eigen::Vector3d& gyro_bias_b, double gyro_bias_sigma);
  bool started() const { return started_; }
  void stop() { started_ = false; }
  // Adds samples in order of time; after a gap the windows start anew.
  void add(std::span<const ImuSample> block);

  struct Filter {
    Eigen::Quaterniond q_nb;  // body to north-east-down
    double heading_sigma;     // rad
    Eigen::Vector3d gyro_bias_b;
    double gyro_bias_sigma;
  };
  // Adds the antenna's velocity at the last sample by a point solution, north and east, with its
  // sigma per component, m/s, and the filter's heading. Returns the heading error, rad, once it has
  // been beyond chance for three velocities in a row among those that the matching window accepts.
  std::optional<double> add_velocity(const Eigen::Vector2d& v_n, double sigma_v,
                                     const Filter& filter);

 private:
  void clear_windows();
  void level(const Eigen::Quaterniond& q_nb);
  void add_course(const Eigen::Vector2d& v_n, double sigma_v);
  std::optional<double> course_innovation(double heading) const;

  AlignmentConfig config_;
  VelocityMatching matching_;
  CourseWindow courses_;
  bool started_ = false;
  Eigen::Vector3d gyro_bias_b_ = Eigen::Vector3d::Zero();
  double gyro_bias_sigma_ = 0.0;
  GpsTime last_time_;
  // Heading by the gyros from an arbitrary zero, roll and pitch of the filter.
  Eigen::Quaterniond q_lb_ = Eigen::Quaterniond::Identity();
  double seconds_ = 0.0;  // of samples, ever
  struct Course {
    double yaw, seconds;
  };
  std::optional<Course> last_course_;
  bool forward_ = false;                // since the last stop faster than it ever goes in reverse
  int consecutive_contradictions_ = 0;  // velocities in a row
};

}  // namespace leonav
