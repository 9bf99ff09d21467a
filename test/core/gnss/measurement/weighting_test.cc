#include "core/gnss/measurement/weighting.h"

#include <limits>

#include "core/base/angle.h"
#include "support/catch.h"

using namespace leonav;

TEST_CASE("elevation law: sigma0 above 30 degrees, sigma0 / (2 sin E) below") {
  CHECK(elevation_factor(90.0 * kDegree) == 1.0);
  CHECK(elevation_factor(30.0 * kDegree) == Approx(1.0));
  CHECK(elevation_factor(29.999 * kDegree) == Approx(1.0).epsilon(1e-4));
  CHECK(elevation_factor(10.0 * kDegree) == Approx(0.5 / 0.17364817766693));
  CHECK(elevation_factor(0.0) == elevation_factor(1.0 * kDegree));
  CHECK(elevation_factor(-0.5) == elevation_factor(0.0));
}

TEST_CASE("sine law: sigma0 / sin E up to the zenith") {
  GnssConfig config;
  config.weight_model = WeightModel::kSine;
  CHECK(noise_factor(config, 90.0 * kDegree, 20.0) == Approx(1.0));
  CHECK(noise_factor(config, 30.0 * kDegree, 20.0) == Approx(2.0));
  CHECK(noise_factor(config, 10.0 * kDegree, 20.0) == Approx(1.0 / 0.17364817766693));
  CHECK(noise_factor(config, -0.5, 20.0) == noise_factor(config, 1.0 * kDegree, 20.0));
}

TEST_CASE("C/N0 law: 20 dB less is ten times the sigma, never below the elevation's") {
  GnssConfig config;
  config.weight_model = WeightModel::kCn0;
  config.cn0_reference_dbhz = 45.0;
  CHECK(noise_factor(config, 1.0, 45.0) == Approx(1.0));
  CHECK(noise_factor(config, 1.0, 25.0) == Approx(10.0));
  CHECK(noise_factor(config, 1.0, 55.0) == Approx(1.0));
  CHECK(noise_factor(config, 10.0 * kDegree, 45.0) == Approx(elevation_factor(10.0 * kDegree)));
  CHECK(noise_factor(config, 1.0, std::numeric_limits<double>::quiet_NaN()) == 1.0);
  config.weight_model = WeightModel::kElevation;
  CHECK(noise_factor(config, 1.0, 10.0) == 1.0);
}

TEST_CASE("ionosphere-free combination cancels 1/f^2 and amplifies the noise as published") {
  const IonosphereFree pair = ionosphere_free(1575.42e6, 1227.60e6);
  CHECK(pair.gamma1 == Approx(2.545727780).epsilon(1e-9));  // 77^2 / (77^2 - 60^2)
  CHECK(pair.gamma2 == Approx(-1.545727780).epsilon(1e-9));
  CHECK(combined_sigma(pair, 1.0, 1.0) == Approx(2.978).epsilon(1e-3));
  const double delay_l1 = 5.0, delay_l2 = 5.0 * (77.0 * 77.0) / (60.0 * 60.0);
  CHECK(pair.gamma1 * (100.0 + delay_l1) + pair.gamma2 * (100.0 + delay_l2) == Approx(100.0));
}
