// MotionRecord holds the mean IMU measurements and the antenna's motion over the same stretches of
// time.
#pragma once
#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <optional>

#include "core/gnss/positioning/point_solution.h"
#include "core/inertial/strapdown/imu.h"

namespace leonav {

// A stretch of about one second between two velocities of the antenna.
struct MotionSecond {
  GpsTime time;          // end
  double seconds = 0.0;  // between the two velocities
  bool has_imu = false;  // covers most of the time; else the next three are zero
  Eigen::Vector3d force_b = Eigen::Vector3d::Zero();  // mean specific force, m/s^2
  Eigen::Vector3d rate_b = Eigen::Vector3d::Zero();   // mean, rad/s
  double force_mean_square = 0.0;                     // mean of |specific force|^2, (m/s^2)^2
  bool has_course = false;           // the antenna moved throughout, in a well known direction
  double speed = 0.0;                // horizontal, the lower of the two velocities, m/s
  double course_rate = 0.0;          // rad/s, clockwise from above
  double along = 0.0, across = 0.0;  // horizontal acceleration: forward, to the right, m/s^2
};

// Limits from which on a velocity's direction shows how the body turns.
struct CourseLimits {
  double min_speed_m_s, max_sigma;  // of the direction, rad
};
// Below these limits a vehicle may stand, or a reflected signal may change the direction.
inline constexpr CourseLimits kInVehicle{2.0, 0.1};
inline constexpr CourseLimits kOnFoot{0.7, 0.2};

// MotionRecord keeps the last 256 such seconds.
class MotionRecord {
 public:
  static constexpr std::size_t kCapacity = 256;
  static constexpr double kShortest_s = 0.9;  // least duration of an entry

  explicit MotionRecord(CourseLimits limits = kInVehicle) : limits_(limits), seconds_(kCapacity) {}
  void clear();
  // Adds a sample in body axes.
  void add(const ImuSample& sample);
  // Returns whether a velocity at `time` would end a second.
  bool is_due(GpsTime time) const;
  // Ends a second and returns it, or nullptr if nothing ends here. Call it at every epoch that is
  // due. Without a solution, or without a velocity in it, the second has no course.
  const MotionSecond* end_second(GpsTime time, const PointSolution* point);

  const boost::circular_buffer<MotionSecond>& seconds() const { return seconds_; }
  double imu_interval_s() const { return imu_interval_s_; }  // of the last sample

 private:
  struct Velocity {
    Eigen::Vector2d north_east = Eigen::Vector2d::Zero();
    double sigma = 0.0;
  };
  void set_course(const Velocity& from, const Velocity& to, MotionSecond* second) const;

  CourseLimits limits_;
  boost::circular_buffer<MotionSecond> seconds_;
  GpsTime last_time_;  // start of the current second
  std::optional<Velocity> last_velocity_;
  Eigen::Vector3d angle_b_ = Eigen::Vector3d::Zero(), velocity_b_ = Eigen::Vector3d::Zero();
  double force_squared_ = 0.0, imu_s_ = 0.0, imu_interval_s_ = 0.0;
};

}  // namespace leonav
