#include "daemon/text/convention_text.h"

#include <cmath>
#include <cstdio>
#include <string_view>

namespace leonav {
namespace {

// With the value in the place of the `#`.
std::string_view pattern(Convention convention, double value) {
  switch (convention) {
    case Convention::kNone:
      break;
    case Convention::kForceInG:
      return "the accelerometers measure # of gravity: accelerations in g, multiply them by "
             "9.80665";
    case Convention::kForceUnit:
      return "the accelerometers measure # times gravity: another unit than m/s (increments) or "
             "m/s2 "
             "(imu.csv), or a wrong scale factor (gravity must come out as 9.8 m/s2)";
    case Convention::kGravityMissing:
      return "the accelerometers measure # of gravity: it has been taken out, hand in what they "
             "feel, gravity included (9.8 m/s2 upwards at rest)";
    case Convention::kIncrementsTimesInterval:
      return "the accelerometers measure # of gravity, as much as the interval has of a second: "
             "increments taken for rates and multiplied by the interval once more, hand in "
             "increments as they are";
    case Convention::kRatesAsIncrements:
      return "the accelerometers measure # times gravity, as often as the interval fits into a "
             "second: rates handed in as increments, multiply rates and accelerations by the "
             "interval";
    case Convention::kGyrosInDegrees:
      return "the gyros measure # times the turn of the course: degrees handed in as radians, "
             "multiply by pi/180";
    case Convention::kGyroUnit:
      return "the gyros measure # times the turn of the course: another unit than rad (increments) "
             "or "
             "rad/s (imu.csv), or a wrong scale factor";
    case Convention::kForceSign:
      return "the accelerometers point down at rest while the gyros turn as they should (# times "
             "the "
             "course): accelerations have the wrong sign, multiply them by -1 (at rest the third "
             "axis, down, must show -9.8 m/s2)";
    case Convention::kGyroSign:
      return "the gyros measure # times the turn of the course: their sign about the vertical is "
             "wrong, as a turn to the right must be positive about the third axis, down";
    case Convention::kGyroAxes:
      return "the gyro of axis # turns as the course does, and not that about the vertical the "
             "accelerometers show: the gyros' axes are in another order than the accelerometers', "
             "give both as forward, right, down";
    case Convention::kThirdAxisUp:
      return "the third axis points # degrees away from down: axes such as forward-left-up, or "
             "accelerations of the wrong sign, while leonav's are forward, right, down (at rest "
             "the "
             "third "
             "shows -9.8 m/s2): convert, or set vehicle.mounting_rpy_deg";
    case Convention::kTilted:
      return "the third axis points # degrees away from down: axes in another order, or an IMU "
             "mounted "
             "on its side, give axes forward, right, down, or set vehicle.mounting_rpy_deg";
    case Convention::kForwardLeftUp:
      return "the third axis points # degrees away from down, the first one forward: axes "
             "forward-left-up, change the sign of the second and third of gyros and "
             "accelerometers, or set vehicle.mounting_rpy_deg: [180, 0, 0]";
    case Convention::kRightForwardUp:
      return "the third axis points # degrees away from down, the second one forward: axes "
             "right-forward-up (as east-north-up), exchange the first two and change the sign of "
             "the third of gyros and accelerometers";
    case Convention::kForwardRightExchanged:
      return "braking shows on the second axis and bends on the first: the axes forward and right "
             "are exchanged, exchange the first two of gyros and accelerometers";
    case Convention::kMirrored:
      return "forward and right axes make a mirrored frame (# degrees): one of the horizontal axes "
             "has "
             "the wrong sign, as axes must be forward, right, down";
    case Convention::kBackwards:
      return "the IMU's first axis points # degrees away from where the vehicle goes: it is "
             "mounted backwards, or driven in reverse, set vehicle.mounting_rpy_deg: [0, 0, 180]";
    case Convention::kTurned:
      return "the IMU is turned by # degrees about the vertical against where the vehicle goes, "
             "add "
             "that to the yaw of vehicle.mounting_rpy_deg";
    case Convention::kLeapSeconds:
      return value < 0.0
                 ? "the IMU's stamps are # s off the GNSS stamps: the leap seconds (the IMU is "
                   "in UTC), stamp it in GPS time (add them)"
                 : "the IMU's stamps are # s off the GNSS stamps: the leap seconds (the GNSS "
                   "epochs are in UTC), stamp them in GPS time (add them)";
    case Convention::kStampOffset:
      return "the IMU's stamps are # s off the GNSS stamps: stamp both in GPS time, the end of the "
             "IMU's interval and the receiver's epoch";
    case Convention::kLeverArmSign:
      return "in turns the antenna moves as if it were # m from where vehicle.lever_arm_b_m says, "
             "at "
             "the opposite side: its sign is wrong, as it goes from the IMU to the antenna, "
             "forward, right, down";
    case Convention::kLeverArm:
      return "in turns the antenna moves as if it were # m from where vehicle.lever_arm_b_m says, "
             "measure it from the IMU to the antenna, forward, right, down, in metres";
    case Convention::kDopplerSign:
      return "the codes change # times as the Dopplers say: Dopplers have the wrong sign, as they "
             "are "
             "positive while the satellite comes nearer (RINEX)";
    case Convention::kDopplerUnit:
      return "the codes change # times as the Dopplers say: Dopplers are in another unit, give "
             "them in Hz of their own carrier";
    case Convention::kSignalsExchanged:
      return "the codes change # times as the Dopplers say, as the frequencies of two bands "
             "differ: the "
             "signals of two bands have each other's names, name each by its own band (1C, 2W, "
             "...)";
    case Convention::kCodesExchanged:
      return "exchanged, the pseudoranges of the two bands would show the ionosphere (# m at the "
             "zenith), but as they are they show it upside down: the codes of two bands are "
             "exchanged, "
             "hand in each under its own signal";
    case Convention::kGyroRange:
      return "samples are refused: the gyros measure # rad/s, more than any IMU does, while "
             "gravity is "
             "right: degrees handed in as radians (multiply by pi/180), or rates as increments "
             "(multiply by the interval)";
    case Convention::kOrbits:
      return "the codes of a system's satellites have been # m off its orbits and clocks for "
             "minutes: orbits or clocks of another day, of another product, or spoofed, hand in "
             "those of this time";
  }
  return "an input does not follow leonav's conventions (#)";
}

std::string digits(Convention convention, double value) {
  char text[32];
  const bool axis = convention == Convention::kGyroAxes;
  std::snprintf(text, sizeof text, axis ? "%.0f" : std::abs(value) < 0.1 ? "%.4f" : "%.3g", value);
  return text;
}

}  // namespace

std::string convention_text(Convention convention, double value) {
  std::string text(pattern(convention, value));
  if (const std::size_t at = text.find('#'); at != std::string::npos)
    text.replace(at, 1, digits(convention, value));
  return text;
}

}  // namespace leonav
