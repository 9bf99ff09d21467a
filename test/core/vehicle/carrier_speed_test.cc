#include "core/vehicle/carrier_speed.h"

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "support/catch.h"

namespace leonav {
namespace {

const GpsTime kStart = GpsTime::from_week_and_tow(2200, 1000.0);
const Geodetic kPlace = {0.7, 0.2, 100.0};

AntennaChange change(double from_s, double to_s, const Eigen::Vector3d& way_n) {
  return {kStart.plus_seconds(from_s), kStart.plus_seconds(to_s),
          rotation_ecef_to_ned(kPlace).transpose() * way_n};
}

}  // namespace

TEST_CASE("a speed by carriers is the horizontal way of the last four seconds") {
  const Eigen::Vector3d p_e = to_ecef(kPlace);
  const double interval_s = GENERATE(0.05, 0.1, 0.5, 1.0);
  CarrierSpeed speed;
  const int epochs = static_cast<int>(4.0 / interval_s + 0.5);
  for (int i = 0; i < epochs; ++i) {
    CHECK_FALSE(speed.horizontal(p_e));
    speed.add(change(i * interval_s, (i + 1) * interval_s, {0.06 * interval_s, 0.0, 0.3}));
  }
  REQUIRE(speed.horizontal(p_e));
  CHECK(*speed.horizontal(p_e) == Approx(0.06));
  // Four seconds later the north is forgotten.
  for (int i = epochs; i < 2 * epochs + 4; ++i)
    speed.add(change(i * interval_s, (i + 1) * interval_s, {0.0, 0.1 * interval_s, 0.0}));
  CHECK(*speed.horizontal(p_e) == Approx(0.1).epsilon(0.01));
}

TEST_CASE("a speed by carriers starts anew after an epoch that tells nothing, and after a hole") {
  const Eigen::Vector3d p_e = to_ecef(kPlace);
  CarrierSpeed speed;
  const auto add = [&](double begin_s, int epochs) {
    for (int i = 0; i < epochs; ++i)
      speed.add(change(begin_s + i, begin_s + i + 1, Eigen::Vector3d::Zero()));
    return speed.horizontal(p_e).has_value();
  };
  CHECK(add(0.0, 5));
  speed.add(std::nullopt);
  CHECK_FALSE(speed.horizontal(p_e));
  CHECK_FALSE(add(6.0, 3));
  CHECK(add(9.0, 1));
  CHECK_FALSE(add(12.0, 3));
  CHECK(add(15.0, 1));
}

}  // namespace leonav
