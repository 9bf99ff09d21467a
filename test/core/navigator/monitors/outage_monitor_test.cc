// An outage's end: the step against the sigma, and the time until all is as before.
#include "core/navigator/monitors/outage_monitor.h"

#include "support/catch.h"

namespace leonav {
namespace {

const GpsTime kBegin = GpsTime::from_week_and_tow(2400, 1000.0);

OutageMonitor::Position at(double x_m, double sigma_m) {
  OutageMonitor::Position position;
  position.p_e.x() = x_m;
  position.covariance.diagonal().setConstant(sigma_m * sigma_m / 3.0);
  return position;
}

}  // namespace

TEST_CASE("an outage's end is told with its step, and when all is as before") {
  OutageMonitor watch;
  for (int i = 0; i < 5; ++i) {
    CHECK_FALSE(watch.add(kBegin.plus_seconds(i), at(0.0, 0.2), at(0.0, 0.1)));
    CHECK_FALSE(watch.reconverged());
  }
  const auto over = watch.add(kBegin.plus_seconds(34.0), at(0.0, 4.0), at(3.0, 1.0));
  REQUIRE(over);
  CHECK(over->lasted_s == Approx(30.0));
  CHECK(over->step_m == Approx(3.0));
  CHECK(over->step_sigmas == Approx(0.75));
  CHECK_FALSE(watch.reconverged());
  CHECK_FALSE(watch.add(kBegin.plus_seconds(35.0), at(3.0, 1.0), at(3.0, 0.2)));
  CHECK_FALSE(watch.reconverged());
  CHECK_FALSE(watch.add(kBegin.plus_seconds(36.0), at(3.0, 0.2), at(3.0, 0.14)));
  const auto after_s = watch.reconverged();
  REQUIRE(after_s);
  CHECK(*after_s == Approx(2.0));
  CHECK_FALSE(watch.reconverged());
}

TEST_CASE("a second outage before all is as before is measured by what was before the first") {
  OutageMonitor watch;
  for (int i = -2; i <= 0; ++i)
    CHECK_FALSE(watch.add(kBegin.plus_seconds(i), at(0.0, 0.1), at(0.0, 0.1)));
  CHECK(watch.add(kBegin.plus_seconds(20.0), at(0.0, 2.0), at(0.0, 1.0)));
  CHECK_FALSE(watch.reconverged());
  CHECK(watch.add(kBegin.plus_seconds(40.0), at(0.0, 2.0), at(0.0, 1.0)));
  CHECK_FALSE(watch.reconverged());
  watch.add(kBegin.plus_seconds(41.0), at(0.0, 1.0), at(0.0, 0.1));
  CHECK(watch.reconverged());
}

TEST_CASE("epochs every half a minute are no outages, a longer interval is") {
  OutageMonitor watch;
  int told = 0;
  for (int i = 0; i <= 100; ++i)
    told += watch.add(kBegin.plus_seconds(30.0 * i), at(0.0, 0.2), at(0.0, 0.1)) ? 1 : 0;
  CHECK(told == 0);
  CHECK(watch.add(kBegin.plus_seconds(3090.0), at(0.0, 0.2), at(0.0, 0.1)));
}

}  // namespace leonav
