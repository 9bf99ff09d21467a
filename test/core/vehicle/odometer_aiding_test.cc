// What an odometer's increments come to at an instant.
#include "core/vehicle/internal/odometer_aiding.h"

#include <cmath>

#include "support/catch.h"
#include "support/drive/synthetic_drive.h"

namespace leonav::test {
namespace {

constexpr std::int64_t kMs = 1'000'000;

GpsTime at_ms(std::int64_t ms) { return kSkyEpoch.plus_nanoseconds(ms * kMs); }

OdometerIncrement increment(std::int64_t end_ms, double distance_m, std::int64_t interval_ms = 100,
                            bool sign_known = true) {
  return {at_ms(end_ms), interval_ms * kMs, distance_m, sign_known};
}

// Its filter stands at 5 m/s plus 2 m/s^2, in reverse if so, from 0 to `until_ms`.
struct Rig {
  MotionConstraintConfig config;
  OdometerAiding aid;
  explicit Rig(std::int64_t until_ms, double sense = 1.0) : config(make_config()), aid(config) {
    const OdometerIncrement early = increment(-900, 0.0);
    aid.add({&early, 1});
    Ekf ekf(EkfConfig(), ImuErrorModel(), Eigen::Vector3d::Zero());
    FilterState state;
    for (std::int64_t ms = 0; ms <= until_ms; ms += 10) {
      state.nav.time = at_ms(ms);
      state.nav.p_e = to_ecef(SyntheticDriveOptions().start);
      state.nav.v_e.x() = sense * (5.0 + 2.0 * 1e-3 * static_cast<double>(ms));
      if (ms == 0) start(state.nav, &ekf);
      if (ms == 0) speeds = aid.follow(ekf);
      speeds->add(state, Eigen::Vector3d::Zero());
    }
    aid.take(at_ms(0), 0.0);
  }
  // The filter's attitude is that of `nav`, and its antenna is at the IMU.
  static void start(const NavState& nav, Ekf* ekf) {
    PointSolution point;
    point.p_e = nav.p_e;
    point.v_e = nav.v_e;
    point.has_velocity = true;
    ekf->initialize(nav.time, point);
    ekf->set_attitude(nav.q_eb, Eigen::Vector3d::Constant(0.01), Eigen::Vector3d::Zero(), 1e-3);
  }
  static MotionConstraintConfig make_config() {
    MotionConstraintConfig config;
    config.odometer = true;
    config.odometer_resolution = 0.06;
    return config;
  }
  void add(const OdometerIncrement& one) { aid.add({&one, 1}); }
  SpeedHistory* speeds = nullptr;
};

double way(double from, double to) { return 5.0 * (to - from) + to * to - from * from; }

TEST_CASE(
    "increments that end since the instant before are one mean speed, and what changed since") {
  Rig rig(470);
  rig.add(increment(230, 1.0));
  rig.add(increment(330, 2.0));
  rig.add(increment(430, 3.0));
  const OdometerSpeed first = rig.aid.take(at_ms(400), 0.1);
  REQUIRE(first.known);
  CHECK(first.mean_m_s == Approx(3.0 / 0.2));
  CHECK(first.change_m_s == Approx(5.94 - way(0.13, 0.33) / 0.2).margin(1e-6));
  CHECK(first.variance == Approx(std::pow(0.06 / 0.2, 2) / 6.0));  // both share the edge between
  const OdometerSpeed second = rig.aid.take(at_ms(470), 0.1);
  REQUIRE(second.known);
  CHECK(second.mean_m_s == Approx(30.0));
  CHECK_FALSE(rig.aid.take(at_ms(480), 0.1).known);
}

TEST_CASE("what the filter's speeds do not reach back to is left out") {
  Rig rig(300);
  rig.add(increment(50, 1.0));  // begins before them
  rig.add(increment(250, 2.0));
  const OdometerSpeed speed = rig.aid.take(at_ms(300), 0.1);
  REQUIRE(speed.known);
  CHECK(speed.mean_m_s == Approx(20.0));
}

TEST_CASE("a counter without a sign has the filter's, where that is sure of one") {
  for (const double sense : {1.0, -1.0}) {
    Rig rig(300, sense);
    rig.add(increment(200, 0.5, 100, false));
    const OdometerSpeed sure = rig.aid.take(at_ms(300), 1.0);
    REQUIRE(sure.known);
    CHECK(sure.mean_m_s == Approx(sense * 5.0));
    Rig unsure(300, sense);
    unsure.add(increment(200, 0.5, 100, false));
    CHECK_FALSE(unsure.aid.take(at_ms(300), 2.0).known);
    Rig still(300, sense);
    still.add(increment(200, 0.0, 100, false));
    CHECK(still.aid.take(at_ms(300), 2.0).known);  // none has any sign
  }
}

TEST_CASE("a wheel has moved for a second after its last pulse") {
  Rig rig(300);
  CHECK_FALSE(rig.aid.moved(at_ms(300)));
  rig.add(increment(100, 0.02));
  rig.add(increment(200, 0.0));
  rig.aid.take(at_ms(200), 0.1);
  CHECK(rig.aid.moved(at_ms(200)));
  CHECK(rig.aid.moved(at_ms(1090)));
  CHECK_FALSE(rig.aid.moved(at_ms(1100)));
}

TEST_CASE("nobody asks for speeds before the first increment") {
  OdometerAiding aid{MotionConstraintConfig()};
  Ekf ekf(EkfConfig(), ImuErrorModel(), Eigen::Vector3d::Zero());
  CHECK(aid.follow(ekf) == nullptr);
  CHECK_FALSE(aid.received());
  aid.add({});
  CHECK_FALSE(aid.received());
}

}  // namespace
}  // namespace leonav::test
