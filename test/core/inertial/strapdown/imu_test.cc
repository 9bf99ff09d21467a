#include "core/inertial/strapdown/imu.h"

#include "support/catch.h"

using namespace leonav;

TEST_CASE("The parts of a cut sample add up to it", "[ins]") {
  ImuSample sample;
  sample.time = GpsTime::from_week_and_tow(2400, 100.0);
  sample.interval_ns = 5'000'001;
  sample.delta_theta_b << 1e-3, -0.3, 1.0 / 3.0;
  sample.delta_velocity_b << 0.1, 0.2, -0.049;
  for (const std::int64_t at : {1, 2, 1'666'667, 2'500'000, 5'000'000}) {
    const GpsTime cut = sample.start().plus_nanoseconds(at);
    const ImuSplit parts = split(sample, cut);
    CHECK(parts.before.time == cut);
    CHECK(parts.before.start() == sample.start());
    CHECK(parts.after.start() == cut);
    CHECK(parts.after.time == sample.time);
    CHECK(parts.before.interval_ns == at);
    CHECK(parts.before.interval_ns + parts.after.interval_ns == sample.interval_ns);
    const Eigen::Vector3d angle = parts.before.delta_theta_b + parts.after.delta_theta_b;
    const Eigen::Vector3d velocity = parts.before.delta_velocity_b + parts.after.delta_velocity_b;
    CHECK((angle - sample.delta_theta_b).norm() <= 1e-16);
    CHECK((velocity - sample.delta_velocity_b).norm() <= 1e-16);
    CHECK(parts.before.delta_theta_b.z() ==
          Approx(sample.delta_theta_b.z() * static_cast<double>(at) / 5'000'001.0));
  }
}
