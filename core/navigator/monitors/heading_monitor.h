// Notices a filter whose heading is wrong, by velocities that it has had no part in.
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

// A heading that was told wrongly, or taken from reflected signals, does not show in one epoch's
// innovations: weights hide them, and the filter drags the error along. Over a window it does: the
// innovation here is what velocity matching, or for a vehicle that goes where it points the course
// over ground, makes of point solutions' velocities and the gyros, less the filter's heading.
class HeadingMonitor {
 public:
  HeadingMonitor(const AlignmentConfig& config, const ImuErrorModel& imu);

  // A filter has just got its attitude, with this gyro bias (rad/s) and its sigma per axis.
  void start(const Eigen::Vector3d& gyro_bias_b, double gyro_bias_sigma);
  bool started() const { return started_; }
  void stop() { started_ = false; }
  // In order of time; after a hole the windows start anew.
  void add(std::span<const ImuSample> block);

  struct Filter {
    Eigen::Quaterniond q_nb;  // body to north-east-down
    double heading_sigma;     // rad
    Eigen::Vector3d gyro_bias_b;
    double gyro_bias_sigma;
  };
  // At the last sample: the antenna's velocity by a point solution, north and east, with its sigma
  // per component (m/s), and what the filter says. Returns by how much its heading is off (rad),
  // when that has been beyond chance for three velocities in a row, of those that the matching's
  // window takes.
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
  bool forward_ = false;                // faster, since it last stopped, than it goes in reverse
  int consecutive_contradictions_ = 0;  // velocities in a row
};

}  // namespace leonav
