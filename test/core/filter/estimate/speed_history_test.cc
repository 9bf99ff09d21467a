// The way over an interval, from speeds at samples, and what an update makes of those before it.
#include "core/filter/estimate/speed_history.h"

#include "core/filter/update/motion_constraint.h"
#include "support/catch.h"
#include "synthetic.h"

namespace leonav {
namespace {

using Eigen::Vector3d;

const Vector3d kSpeedPoint_b{-1.0, 0.5, 0.0};

GpsTime at(double t) { return synthetic::kStart.plus_seconds(t); }

FilterState state_at(double t, double speed) {
  FilterState state;
  state.nav.time = at(t);
  state.nav.p_e = synthetic::start_position();
  state.nav.q_eb = Eigen::Quaterniond(synthetic::C_en_at(state.nav.p_e));
  state.nav.v_e = state.nav.q_eb * Vector3d{speed, 0.0, 0.0};
  return state;
}

// 5 + 2 t m/s, at 100 Hz.
SpeedHistory speeding_up(double until) {
  SpeedHistory history(Vector3d::Zero());
  for (int i = 0; 0.01 * i <= until + 1e-9; ++i)
    history.add(state_at(0.01 * i, 5.0 + 0.02 * i), Vector3d::Zero());
  return history;
}

double way(double from, double to) { return 5.0 * (to - from) + to * to - from * from; }

}  // namespace

TEST_CASE("the way over an interval, wherever it begins and ends between samples") {
  const SpeedHistory history = speeding_up(1.0);
  for (const auto& [from, to] :
       {std::pair(0.0, 1.0), {0.2, 0.4}, {0.213, 0.4071}, {0.501, 0.5095}, {0.503, 0.507}}) {
    CAPTURE(from, to);
    const auto found = history.distance(at(from), at(to));
    REQUIRE(found.has_value());
    CHECK(*found == Approx(way(from, to)).margin(1e-9));
  }
  CHECK(history.distance(at(0.3), at(0.3)).value() == 0.0);
  CHECK_FALSE(history.distance(at(-0.01), at(0.5)).has_value());
  CHECK_FALSE(history.distance(at(0.5), at(1.01)).has_value());
  CHECK_FALSE(SpeedHistory(Vector3d::Zero()).distance(at(0.0), at(0.1)).has_value());
}

TEST_CASE("an update corrects all speeds alike; at another time the history begins anew") {
  SpeedHistory history = speeding_up(1.0);
  history.correct(state_at(1.0, 7.5), Vector3d::Zero());
  CHECK(history.last() == Approx(7.5));
  CHECK(history.distance(at(0.2), at(0.4)).value() == Approx(way(0.2, 0.4) + 0.2 * 0.5));
  history.correct(state_at(1.2, 7.5), Vector3d::Zero());
  CHECK_FALSE(history.distance(at(0.9), at(1.2)).has_value());
  history.add(state_at(1.25, 7.5), Vector3d::Zero());
  CHECK(history.distance(at(1.2), at(1.25)).has_value());
  history.add(state_at(1.45, 7.5), Vector3d::Zero());  // a hole
  CHECK_FALSE(history.distance(at(1.2), at(1.45)).has_value());
}

TEST_CASE("the speed is that of the point, along the direction of travel") {
  FilterState state = state_at(0.0, 10.0);
  state.vehicle = {0.1, 0.0};
  const Vector3d rate_b{0.0, 0.0, 0.4};
  SpeedHistory history(kSpeedPoint_b);
  history.add(state, rate_b);
  // (10 - 0.4 * 0.5, -0.4, 0) m/s of the point
  CHECK(history.last() == Approx(9.8 * std::cos(0.1) - 0.4 * std::sin(0.1)).margin(1e-3));
  CHECK(history.last() == forward_speed(state, rate_b, kSpeedPoint_b));
}

}  // namespace leonav
