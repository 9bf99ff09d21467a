// Ocean loading and pole tide reach every range, along the direction to its satellite.
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "carrier_scene.h"
#include "core/earth/tides.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "support/catch.h"

using namespace leonav;
using namespace leonav::test;

namespace {

// Waves of an open coast: decimetres upwards, centimetres sideways.
OceanLoading coast() {
  OceanLoading loading;
  for (int wave = 0; wave < OceanLoading::kConstituents; ++wave) {
    loading.amplitude_m.col(wave) = Eigen::Vector3d(0.05, 0.02, 0.01) / (1.0 + wave);
    loading.phase.col(wave) = Eigen::Vector3d(0.3, -1.2, 2.0) * wave;
  }
  return loading;
}

struct StandingScene : CarrierScene {
  std::unique_ptr<MeasurementEpoch> preprocessed(const GnssConfig& config, double t) {
    const RawEpoch raw = at(t, C_en());
    CarrierPreprocessor preprocessor(config.cycle_slips);
    PreprocessAids aids;
    aids.carriers = &preprocessor;
    auto epoch = std::make_unique<MeasurementEpoch>();
    preprocess(raw, sky.ephemeris_store, config, receiver.p_e, epoch.get(), aids);
    return epoch;
  }
};

// Compares with and without; `displacement_e`(time) is where the ground has gone.
template <typename Displacement>
void check_ranges(const GnssConfig& without, const GnssConfig& with, Displacement displacement_e) {
  double largest = 0.0, worst = 0.0;
  int codes = 0, carriers = 0;
  for (const double t : {0.0, 3'000.0, 6'000.0}) {
    StandingScene scene, again;  // new ones: the ambiguities are drawn in order of appearance
    const auto before = scene.preprocessed(without, t);
    const auto after = again.preprocessed(with, t);
    const Eigen::Vector3d d_e = displacement_e(scene.receiver.p_e, kSkyEpoch.plus_seconds(t));
    REQUIRE(before->measurements.size() == after->measurements.size());
    for (std::size_t i = 0; i < before->measurements.size(); ++i) {
      const Measurement& old = before->measurements[i];
      const SatelliteInView& satellite = after->satellites[old.satellite_index];
      const double change = after->measurements[i].value - old.value;
      if (old.observable == Observable::kDoppler) {
        CHECK(change == 0.0);
        continue;
      }
      // The measured range is to the displaced antenna; that to the marker is longer by as much as
      // the ground has moved towards the satellite.
      const double expected = d_e.dot((satellite.p_e - scene.receiver.p_e).normalized());
      worst = std::max(worst, std::abs(change - expected));
      largest = std::max(largest, std::abs(expected));
      ++(old.observable == Observable::kCarrier ? carriers : codes);
    }
  }
  std::printf("ground: %d codes, %d carriers move by up to %.1f mm, off by at most %.2g mm\n",
              codes, carriers, 1e3 * largest, 1e3 * worst);
  CHECK(codes > 30);
  CHECK(carriers > 30);
  CHECK(largest > 5e-3);
  CHECK(worst < 1e-4);
}

}  // namespace

TEST_CASE("ocean loading moves every code and carrier by its projection") {
  const GnssConfig without = default_gnss_config();
  GnssConfig with = without;
  with.ocean_loading = coast();
  check_ranges(without, with, [](const Eigen::Vector3d& p_e, GpsTime time) {
    return ocean_loading_displacement(p_e, time, coast());
  });
}

TEST_CASE("the pole tide moves every code and carrier by its projection") {
  constexpr double kArcsecond = std::numbers::pi / 180.0 / 3600.0;
  const PolarMotion pole{0.45 * kArcsecond, -0.1 * kArcsecond};
  const GnssConfig without = default_gnss_config();
  GnssConfig with = without;
  with.polar_motion = pole;
  check_ranges(without, with, [&](const Eigen::Vector3d& p_e, GpsTime time) {
    return pole_tide(p_e, time, pole);
  });
}

TEST_CASE("ocean loading and pole tide add up") {
  const PolarMotion pole{1e-6, 2e-6};
  GnssConfig both = default_gnss_config();
  both.ocean_loading = coast();
  both.polar_motion = pole;
  check_ranges(default_gnss_config(), both, [&](const Eigen::Vector3d& p_e, GpsTime time) {
    return Eigen::Vector3d(ocean_loading_displacement(p_e, time, coast()) +
                           pole_tide(p_e, time, pole));
  });
}
