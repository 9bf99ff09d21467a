// The time that products of files go by is one, whatever the times of several streams are.
#include "tools/connect/formats/outputs/product_pace.h"

#include "support/catch.h"

namespace leonav {
namespace {

const GpsTime kPaceBegin = GpsTime::from_week_and_tow(2136, 345'600.0);
GpsTime paced(double s) { return kPaceBegin.plus_seconds(s); }

}  // namespace

TEST_CASE("Steps of time are told once they are long enough", "[connect]") {
  ProductPace pace;
  CHECK_FALSE(pace.time().is_set());
  CHECK(pace.advance(paced(0.0)) == ProductPace::kStep_s);
  CHECK_FALSE(pace.advance(paced(0.05)));
  CHECK(*pace.advance(paced(0.1)) == Approx(0.1));
  CHECK(*pace.advance(paced(200.0)) == Approx(199.9));
  CHECK_FALSE(pace.advance(paced(195.0)));  // of an epoch that came late
  CHECK(pace.time() == paced(200.0));
}

TEST_CASE("Of two times that alternate the one that was there goes on", "[connect]") {
  const double wrong_s = GENERATE(-86'400.0, 86'400.0, -100.0);
  ProductPace pace;
  double sum_s = 0.0;
  for (int i = 0; i < 100; ++i) {
    sum_s += pace.advance(paced(i)).value_or(0.0);
    CHECK_FALSE(pace.advance(paced(i + wrong_s)));
  }
  CHECK(sum_s == Approx(99.1));
  CHECK(pace.time() == paced(99.0));
}

TEST_CASE("A time that was set counts after some seconds without another one", "[connect]") {
  const double set_s = GENERATE(-1e6, 1e6, -20.0);
  ProductPace pace;
  pace.advance(paced(0.0));
  for (double at = 1.0; at < 6.0; at += 1.0) CHECK_FALSE(pace.advance(paced(set_s + at)));
  CHECK(pace.advance(paced(set_s + 6.0)) == ProductPace::kStep_s);
  CHECK(*pace.advance(paced(set_s + 7.0)) == Approx(1.0));
}

TEST_CASE("A service alone that comes once in two minutes still counts", "[connect]") {
  ProductPace pace;
  for (double at = 0.0; at < 3600.0; at += 120.0) CHECK(pace.advance(paced(at)));
}

}  // namespace leonav
