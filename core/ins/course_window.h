// Courses over ground against the gyros' heading over the last seconds: do they agree?
#pragma once
#include <boost/container/static_vector.hpp>
#include <optional>

namespace leonav {

// A course tells the heading only where the body goes where it points. It does not while a device
// is picked up, swung or turned, so one course proves nothing: what a stretch of motion agrees on
// does. Course minus gyro heading is the same all through it if, and only if, both turn alike.
class CourseWindow {
 public:
  // The window is `length_s` and at least three courses long, whichever is longer.
  explicit CourseWindow(double length_s) : length_s_(length_s) {}

  struct Course {
    double time_s = 0.0;        // of any steady clock, not decreasing
    double course = 0.0;        // rad, clockwise from north
    double relative_yaw = 0.0;  // rad, by the gyros, from an arbitrary zero
    double sigma = 0.0;         // rad, of what course and heading differ by; positive
  };
  void add(const Course& course);
  void clear() { entries_.clear(); }
  // How much of the window's length there is; 0: nothing.
  double seconds() const {
    return entries_.empty() ? 0.0 : entries_.back().time_s - entries_.front().time_s;
  }

  struct Agreement {
    double yaw_offset = 0.0;  // rad: heading = relative yaw + this
    double sigma = 0.0;       // rad
  };
  // The weighted mean. Its sigma is not divided by the number of courses: what makes a course
  // differ from the heading (sideslip, gait, the velocity filter) lasts as long as the window.
  // nullopt while the window is not full or nothing agrees at all.
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
