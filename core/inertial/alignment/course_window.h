// CourseWindow tests whether courses over ground agree with the heading of the gyros over the last
// seconds.
//
//   offset = arg(sum w_i exp(j (course_i - yaw_i))),  sigma^2 = -2 ln R + n / sum w_i,  w_i = 1 /
//   sigma_i^2
//
// R is the weighted mean resultant length (Mardia and Jupp, Directional Statistics, 2000, 2.3).
#pragma once
#include <boost/container/static_vector.hpp>
#include <optional>

namespace leonav {

// The course equals the heading only where the body moves in the direction it points. It does not
// while a device is picked up, swung or turned, so a single course proves nothing. Course minus
// gyro heading is constant over a stretch of motion if, and only if, both turn by the same angles.
class CourseWindow {
 public:
  // The window is `length_s` and at least three courses long, whichever is longer.
  explicit CourseWindow(double length_s) : length_s_(length_s) {}

  // One course over ground with the gyros' heading at the same instant.
  struct Course {
    double time_s = 0.0;        // time on any steady clock, not decreasing
    double course = 0.0;        // rad, clockwise from north
    double relative_yaw = 0.0;  // rad, by the gyros, from an arbitrary zero
    double sigma = 0.0;         // rad, 1 sigma of course minus heading; positive
  };
  // Adds a course; one that follows the last too closely for the window's capacity is left out.
  void add(const Course& course);
  void clear() { entries_.clear(); }
  // Returns the time from the first course to the last; 0 if there is none.
  double seconds() const {
    return entries_.empty() ? 0.0 : entries_.back().time_s - entries_.front().time_s;
  }

  // Difference between heading and gyro yaw over the whole window.
  struct Agreement {
    double yaw_offset = 0.0;  // rad: heading = relative yaw + this
    double sigma = 0.0;       // rad
  };
  // Returns the weighted mean offset, or nullopt while the window is not full or nothing agrees.
  //
  // Its sigma is not divided by the square root of the number of courses: the causes of a
  // difference between course and heading (sideslip, gait, the velocity filter) last as long as the
  // window.
  std::optional<Agreement> agreement() const;

 private:
  static constexpr std::size_t kMinCourses = 3;
  static constexpr std::size_t kCapacity = 40;
  struct Entry {
    double time_s, difference, weight;
  };
  double length_s_;
  boost::container::static_vector<Entry, kCapacity> entries_;
};

}  // namespace leonav
