// Which states an inflation changes, and by how much.
#include "core/filter/update/covariance_inflation.h"

#include "support/catch.h"

namespace leonav {

using namespace ekf_index;

TEST_CASE("an inflation touches what is a state, and correlations not at all") {
  EkfCovariance covariance = EkfCovariance::Zero(kSize, kSize);
  covariance.block<3, 3>(kPosition, kPosition).setConstant(0.1);
  covariance.diagonal().segment<3>(kPosition).setConstant(1.0);
  covariance(kClock, kClock) = 4.0;
  const EkfCovariance before = covariance;
  inflate_covariance(Observable::kCode, 2.0, 1.0, &covariance);
  EkfCovariance change = covariance - before;
  for (int i : {kPosition, kPosition + 1, kPosition + 2, kClock}) {
    CHECK(change(i, i) == 2.0);
    change(i, i) = 0.0;
  }
  CHECK(change.isZero(0.0));
  inflate_covariance(Observable::kDoppler, 2.0, 1.0, &covariance);
  CHECK(covariance.diagonal().segment<3>(kVelocity).isZero(0.0));
  CHECK(covariance.diagonal().segment(kClockDrift, kMaxSystemTimes).isZero(0.0));
}

TEST_CASE("a velocity found wrong has taken the position with it") {
  EkfCovariance covariance = EkfCovariance::Identity(kSize, kSize);
  inflate_covariance(Observable::kDoppler, 4.0, 2.0, &covariance);
  // An acceleration a over 2 s that nobody knew of: v = 2 a, p = 2 a.
  CHECK(covariance(kVelocity, kVelocity) == 5.0);
  CHECK(covariance(kPosition, kPosition) == 5.0);
  CHECK(covariance(kClock, kClock) == 5.0);
  CHECK(covariance(kPosition, kVelocity) == 0.0);
}

}  // namespace leonav
