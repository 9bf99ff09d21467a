// leonav-calibrate: its geometry, and a short simulated drive from end to end.
#include <cmath>
#include <sstream>

#include "core/base/angle.h"
#include "core/earth/rotation.h"
#include "support/catch.h"
#include "support/programs/program_run.h"
#include "tools/calibrate/data_halves.h"
#include "tools/calibrate/print_calibration.h"

namespace leonav::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d rotation_of(const Vector3d& rpy) {
  return rotation_from_euler({rpy.x(), rpy.y(), rpy.z()});
}

double value_of(const std::string& json, const std::string& name, const std::string& key) {
  const std::size_t at = json.find("\"" + key + "\":", json.find("\"" + name + "\""));
  REQUIRE(at != std::string::npos);
  return std::strtod(json.c_str() + at + key.size() + 3, nullptr);
}

}  // namespace

TEST_CASE("what a filter finds beyond an installation makes it the true one") {
  Installation truth;
  truth.lever_arm_b = {0.8, -0.6, -1.2};
  truth.mounting_rpy = Vector3d(3.0, -4.0, 95.0) * kDegree;
  truth.time_offset_s = 0.04;
  Installation told;
  told.lever_arm_b = {0.4, -0.2, -1.0};
  told.mounting_rpy = Vector3d(0.0, 1.0, 90.0) * kDegree;
  // The true axes in those that the filter takes for the body's.
  const Matrix3d C_told_true =
      rotation_of(told.mounting_rpy) * rotation_of(truth.mounting_rpy).transpose();
  const EulerAngles travel = euler_from_rotation(C_told_true);
  const Vector3d arm = C_told_true * truth.lever_arm_b - told.lever_arm_b;
  Finding finding;
  finding.change = {arm.x(), arm.y(), arm.z(), travel.roll, travel.pitch, travel.yaw, 0.04};
  finding.observed.fill(true);
  const Installation found = improved(told, finding);
  CHECK((found.lever_arm_b - truth.lever_arm_b).norm() < 1e-12);
  CHECK((rotation_of(found.mounting_rpy) - rotation_of(truth.mounting_rpy)).norm() < 1e-12);
  CHECK(found.time_offset_s == Approx(truth.time_offset_s));
  finding.observed.fill(false);
  const Installation unchanged = improved(told, finding);
  CHECK((unchanged.lever_arm_b - told.lever_arm_b).norm() < 1e-12);
  CHECK((unchanged.mounting_rpy - told.mounting_rpy).norm() < 1e-12);
  CHECK(unchanged.time_offset_s == 0.0);
}

TEST_CASE("halves that disagree withdraw a mounting angle as they do an arm") {
  const InstallationPrior prior;
  Installation configured, found;
  configured.lever_arm_b = {0.4, -0.2, -1.0};
  configured.mounting_rpy = Vector3d(0.0, 1.0, 90.0) * kDegree;
  Finding turns;  // of the body's axes
  turns.change = {0.1, 0.2, 0.3, 1.0 * kDegree, -4.0 * kDegree, 5.0 * kDegree, 0.04};
  turns.observed.fill(true);
  found = improved(configured, turns);
  for (std::size_t i = 0; i < kQuantities; ++i) {
    Finding whole = turns, first = turns, second = turns;
    whole.sigma.fill(1e-3);
    const double prior_sigma = i < 3 ? prior.lever_arm_m : i < 6 ? prior.travel_rad : 0.1;
    first.change[i] += 0.5 * prior_sigma;
    CHECK(compare_halves(first, second, &whole)[i]);
    CHECK(whole.sigma[i] == Approx(0.25 * prior_sigma));
    Installation left = found;
    revert_unobserved(prior, configured, &whole, &left);
    for (std::size_t k = 0; k < kQuantities; ++k) CHECK(whole.observed[k] == (k != i));
    // As if it had never been found.
    Finding others = turns;
    others.observed[i] = false;
    const Installation without = improved(configured, others);
    CHECK((rotation_of(left.mounting_rpy) - rotation_of(without.mounting_rpy)).norm() < 1e-12);
    CHECK(left.time_offset_s == Approx(without.time_offset_s).margin(1e-15));
    if (i >= 3 && i < 6) CHECK((left.lever_arm_b - without.lever_arm_b).norm() < 1e-12);
    if (i < 3)
      CHECK(left.lever_arm_b(static_cast<int>(i)) == configured.lever_arm_b(static_cast<int>(i)));
  }
}

TEST_CASE("what only one half has observed is not compared, and the table says so") {
  Finding whole, half;
  whole.observed.fill(true);
  whole.sigma.fill(1e-3);
  half = whole;
  Finding other = whole;
  other.observed[0] = false;
  half.change[0] = 1.0;
  CalibrationResult calibration;
  calibration.last = whole;
  calibration.compared = compare_halves(half, other, &calibration.last);
  CHECK_FALSE(calibration.compared[0]);
  CHECK(calibration.compared[1]);
  CHECK(calibration.last.sigma[0] == 1e-3);
  std::ostringstream out;
  print_calibration(calibration, out);
  CAPTURE(out.str());
  CHECK(out.str().find("could not be compared, the sigma is the whole log's alone: "
                       "lever_arm_forward_m\n") != std::string::npos);
}

TEST_CASE("what was learned about errors is printed by class, as text and as JSON") {
  CalibrationResult calibration;
  std::ostringstream without;
  print_calibration(calibration, without);
  CHECK(without.str().find("learned") == std::string::npos);
  calibration.learned.learned = true;
  calibration.learned.code.all = {2.5, 0.9, 12.0};
  calibration.learned.code.classes[4] = {4.0, 0.8, 17.0};
  std::ostringstream out;
  print_calibration(calibration, out);
  CAPTURE(out.str());
  CHECK(out.str().find("codes: 2.50 times the configured sigma, 90 % of the variance correlated "
                       "over 12.0 s\n  GPS 1.00, Galileo 1.00, BeiDou 1.00, LEO 1.00\n  below 20 "
                       "deg 4.00 (80 % over 17.0 s), 20 to 35 deg 1.00,") != std::string::npos);
  const std::string json = json_of(calibration);
  CHECK(value_of(json, "learned codes", "sigma_factor") == 2.5);
  CHECK(value_of(json, "learned codes, below 20 deg", "correlation_time_s") == 17.0);
  CHECK(value_of(json, "learned Dopplers, LEO", "sigma_factor") == 1.0);
}

TEST_CASE("a simulated drive shows how the IMU is built in, and a hand does not") {
  if (!have_programs("leonav-sim", "leonav-calibrate")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("run.lcmlog"), json = place.beside("found.json");
  const ProgramRun sim = run_program(
      "leonav-sim",
      LEONAV_SOURCE_DIR
          "/config/scenario/open_sky.yaml --set duration_s=440 --set route.standing_s=60 --set "
          "'imu.mounting_rpy_deg=[5, -5, 5]'"
          " --set imu.time_offset_ms=40 --set 'receiver.lever_arm_b_m=[0.8, -0.6, -0.8]' -o " +
          log);
  CAPTURE(sim.err);
  REQUIRE(sim.exit_code == 0);
  const std::string config = "--preset urban --set 'vehicle.lever_arm_b_m=[0.4, -0.2, -1.2]' ";
  const ProgramRun car =
      run_program("leonav-calibrate", config + "--set vehicle.kind=car --json " + json + " " + log);
  CAPTURE(car.out, car.err);
  REQUIRE(car.exit_code == 0);
  const std::string found = text_of(json);
  CHECK(value_of(found, "lever_arm_forward_m", "found") == Approx(0.8).margin(0.05));
  CHECK(value_of(found, "lever_arm_right_m", "found") == Approx(-0.6).margin(0.05));
  CHECK(value_of(found, "mounting_roll_deg", "found") == Approx(5.0).margin(0.3));
  CHECK(value_of(found, "mounting_pitch_deg", "found") == Approx(-5.0).margin(0.3));
  CHECK(value_of(found, "mounting_yaw_deg", "found") == Approx(5.0).margin(0.3));
  CHECK(value_of(found, "time_offset_ms", "found") == Approx(40.0).margin(3.0));
  CHECK(value_of(found, "passes", "used s") >
        0.95 * value_of(found, "passes", "with an attitude s"));
  CHECK(car.out.find("started over") == std::string::npos);
  // Nor does the half that begins parked, its heading told by gyros at best, contradict the other.
  CHECK(value_of(found, "lever_arm_right_m", "sigma") < 0.02);
  CHECK(value_of(found, "mounting_yaw_deg", "sigma") < 0.2);
  const ProgramRun hand =
      run_program("leonav-calibrate", config + "--passes 1 --set vehicle.kind=handheld " + log);
  CHECK(hand.exit_code == 1);  // one pass does not settle
  CHECK(hand.out.find("mounting_yaw_deg: nothing tells how the vehicle goes") != std::string::npos);
}

TEST_CASE("where the filter has started over, the result says which part of the log it is of") {
  CalibrationResult calibration;
  calibration.length_s = 300.0;
  calibration.used_s = 290.0;
  std::ostringstream whole;
  print_calibration(calibration, whole);
  CHECK(whole.str().find("started over") == std::string::npos);
  calibration.used_s = 120.0;
  std::ostringstream part;
  print_calibration(calibration, part);
  CHECK(
      part.str().find("has started over in this log: what was found is of the last 120 of 300 s") !=
      std::string::npos);
  CHECK(value_of(json_of(calibration), "passes", "used s") == 120.0);
}

TEST_CASE("a log of a parked vehicle shows nothing of the installation: an error") {
  if (!have_programs("leonav-sim", "leonav-calibrate")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("run.lcmlog");
  const ProgramRun sim =
      run_program("leonav-sim", LEONAV_SOURCE_DIR
                                    "/config/scenario/open_sky.yaml --set duration_s=100 --set "
                                    "route.standing_s=100 -o " +
                                    log);
  CAPTURE(sim.err);
  REQUIRE(sim.exit_code == 0);
  const ProgramRun stands =
      run_program("leonav-calibrate", "--preset urban --set vehicle.kind=car " + log);
  CAPTURE(stands.out);
  CHECK(stands.exit_code == 1);
  CHECK(stands.err.find("has found no attitude") != std::string::npos);
  CHECK(stands.err.find("does the vehicle drive?") != std::string::npos);
}

TEST_CASE("a log without any epoch has no installation: an error") {
  if (!have_programs("leonav-sim", "leonav-calibrate")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("run.lcmlog");
  REQUIRE(
      run_program("leonav-sim",
                  LEONAV_SOURCE_DIR "/config/scenario/open_sky.yaml --set duration_s=60 -o " + log)
          .exit_code == 0);
  const ProgramRun empty = run_program(
      "leonav-calibrate", "--preset urban --set vehicle.kind=car --set lcm.prefix=ELSE_ " + log);
  CAPTURE(empty.err);
  CHECK(empty.exit_code == 1);
  CHECK(empty.err.find("has found no attitude") != std::string::npos);
}

TEST_CASE("leonav-calibrate refuses what it cannot use") {
  if (!have_programs("leonav-calibrate")) return;
  CHECK(run_program("leonav-calibrate", "").exit_code == 2);
  const ProgramRun fixed = run_program("leonav-calibrate", "--preset station nowhere.lcmlog");
  CHECK(fixed.exit_code == 1);
  CHECK(fixed.err.find("no IMU") != std::string::npos);
}

}  // namespace leonav::test
