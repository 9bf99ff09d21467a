// HeadingMonitor on a vehicle in a bend, whose filter is right about its heading or is not.
#include "core/navigator/monitors/heading_monitor.h"

#include "core/base/angle.h"
#include "core/inertial/alignment/synthetic_vehicle.h"
#include "support/catch.h"

namespace leonav {
namespace {

constexpr double kSigma_v = 0.05;
constexpr double kRight = 0.0, kWrong = 40.0 * kDegree;
// Too far off to confirm the heading, too near to contradict it: the filter corrects it by itself.
constexpr double kDoubtful = 8.0 * kDegree;

// Velocities once a second, forward and in reverse alike: velocity matching alone decides.
class Bend {
 public:
  Bend() : vehicle_(test::tactical_imu(), 0.5, 3), monitor_(config(), test::tactical_imu()) {
    for (int i = 0; i < 1000; ++i) (void)vehicle_.step(0.6, 0.0);
    start();
  }
  void start() { monitor_.start(Eigen::Vector3d::Zero(), test::tactical_imu().gyro_bias.sigma); }
  // A second on, with a filter whose heading is `off` less than the true one.
  std::optional<double> step(double off) {
    for (int i = 0; i < 100; ++i) {
      const ImuSample sample = vehicle_.step(0.0, 0.04);
      monitor_.add({&sample, 1});
    }
    HeadingMonitor::Filter filter;
    filter.q_nb = Eigen::Quaterniond(rotation_from_euler({0.0, 0.0, vehicle_.yaw() - off}));
    filter.heading_sigma = 1.0 * kDegree;
    filter.gyro_bias_b.setZero();
    filter.gyro_bias_sigma = test::tactical_imu().gyro_bias.sigma;
    return monitor_.add_velocity(vehicle_.v_n(kSigma_v), kSigma_v, filter);
  }
  // Returns how many velocities at this error it takes until the heading is given up; 0: it is not.
  int given_up_after(double off, int most = 100) {
    for (int i = 1; i <= most; ++i) {
      const auto found = step(off);
      if (!found) continue;
      CHECK(*found == Approx(off).margin(3.0 * kDegree));
      return i;
    }
    return 0;
  }

 private:
  static AlignmentConfig config() {
    AlignmentConfig config;
    config.velocity_matching = config.heading_watch = true;
    return config;
  }
  test::SyntheticVehicle vehicle_;
  HeadingMonitor monitor_;
};

TEST_CASE("a heading that nothing has confirmed is given up at the third velocity against it") {
  Bend bend;
  REQUIRE(bend.given_up_after(kDoubtful, 40) == 0);
  CHECK(bend.given_up_after(kWrong) == 3);
}

TEST_CASE("a confirmed heading is kept through 29 velocities against it and given up at the 30th") {
  Bend bend;
  REQUIRE(bend.given_up_after(kRight, 40) == 0);
  SECTION("at once") { CHECK(bend.given_up_after(kWrong) == 30); }
  SECTION("counted from the last that was not against it") {
    CHECK(bend.given_up_after(kWrong, 29) == 0);
    CHECK(bend.given_up_after(kRight, 1) == 0);
    CHECK(bend.given_up_after(kWrong) == 30);
  }
  SECTION("however long ago it was confirmed") {
    CHECK(bend.given_up_after(kDoubtful, 60) == 0);
    CHECK(bend.given_up_after(kWrong) == 30);
  }
}

TEST_CASE("a new heading is not confirmed because the one before it was") {
  Bend bend;
  REQUIRE(bend.given_up_after(kRight, 40) == 0);
  bend.start();
  REQUIRE(bend.given_up_after(kDoubtful, 40) == 0);
  CHECK(bend.given_up_after(kWrong) == 3);
}

}  // namespace
}  // namespace leonav
