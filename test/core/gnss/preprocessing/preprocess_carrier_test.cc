// Carriers through the preprocessing: what is taken out of code and carrier is the same, so that
// their difference is the arc's constant.
#include <cmath>
#include <map>
#include <memory>

#include "carrier_scene.h"
#include "core/gnss/preprocessing/carrier_preprocessor.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "support/catch.h"

using namespace leonav;
using namespace leonav::test;

namespace {

// An antenna that turns about the vertical.
struct TurningScene : CarrierScene {
  TurningScene() {
    receiver.clock_s = 3e-4;
    receiver.clock_drift = 1e-8;
  }
  Eigen::Matrix3d C_er(double t) const {
    return C_en() * Eigen::AngleAxisd(0.01 * t, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
  RawEpoch at(double t) { return CarrierScene::at(t, C_er(t)); }
};

struct Differences {
  double first = 0.0, worst = 0.0;
  int count = 0;
};

// Carrier minus code, per arc, less what it was at first.
std::map<std::uint32_t, Differences> run(TurningScene* scene, const GnssConfig& config,
                                         int epochs) {
  CarrierPreprocessor preprocessor(config.cycle_slips);
  ReceiverCodeBiases biases;
  std::map<std::uint32_t, Differences> arcs;
  const auto epoch = std::make_unique<MeasurementEpoch>();
  for (int k = 0; k < epochs; ++k) {
    const double t = kStep_s * k;
    const Eigen::Matrix3d C_er = scene->C_er(t);
    PreprocessAids aids;
    aids.biases = &biases;
    aids.carriers = &preprocessor;
    aids.C_er = &C_er;
    const RawEpoch raw = scene->at(t);  // the preprocessor looks at it until the ranges are checked
    preprocess(raw, scene->sky.ephemeris_store, config, scene->receiver.p_e, epoch.get(), aids);
    RangeChangePrior stands;
    stands.change_is_free = false;
    preprocessor.check_range_changes(scene->receiver.p_e, stands, epoch.get());
    for (const Measurement& carrier : epoch->measurements) {
      if (carrier.observable != Observable::kCarrier) continue;
      for (const Measurement& code : epoch->measurements) {
        if (code.observable != Observable::kCode || !(code.code == carrier.code) ||
            !(code.second_code == carrier.second_code) ||
            code.satellite_index != carrier.satellite_index)
          continue;
        Differences& d = arcs[carrier.arc];
        const double difference = carrier.value - code.value;
        if (d.count++ == 0) d.first = difference;
        d.worst = std::max(d.worst, std::abs(difference - d.first));
      }
    }
    preprocessor.store_epoch(*epoch, scene->receiver.p_e);
  }
  return arcs;
}

GnssConfig config_of(CodeCombination combination) {
  GnssConfig config = default_gnss_config();
  for (SystemConfig& system : config.systems) system.enabled = true;
  config.code_combination = combination;
  return config;
}

}  // namespace

TEST_CASE("carrier minus code is one constant per arc, in pairs and on one frequency") {
  for (const auto combination :
       {CodeCombination::kIonosphereFree, CodeCombination::kSingleFrequency}) {
    TurningScene scene;
    if (combination == CodeCombination::kSingleFrequency)
      scene.receiver.signals = {{{'1', 'C'}, 45.0}};
    int long_arcs = 0;
    double worst = 0.0;
    const auto arcs = run(&scene, config_of(combination), 40);
    for (const auto& [arc, d] : arcs) {
      CAPTURE(arc, d.count, d.worst);
      CHECK(arc != 0);
      worst = std::max(worst, d.worst);
      long_arcs += d.count > 30 ? 1 : 0;
    }
    std::printf("carrier minus code over 20 min, %zu arcs: worst change %.2g m\n", arcs.size(),
                worst);
    CHECK(long_arcs >= 10);
    CHECK(worst < 1e-3);
    CHECK(arcs.size() < 40);  // none ends without cause
  }
}

TEST_CASE("without the antenna's turns in the wind-up, carriers drift by wavelengths") {
  TurningScene scene;
  const GnssConfig config = config_of(CodeCombination::kIonosphereFree);
  CarrierPreprocessor preprocessor(config.cycle_slips);
  const auto epoch = std::make_unique<MeasurementEpoch>();
  std::map<std::uint16_t, double> first;
  double least = 1e9;
  for (const double t : {0.0, 100.0}) {
    PreprocessAids aids;
    aids.carriers = &preprocessor;  // C_er not given: north, east, down
    preprocess(scene.at(t), scene.sky.ephemeris_store, config, scene.receiver.p_e, epoch.get(),
               aids);
    for (const Measurement& m : epoch->measurements) {
      if (m.observable == Observable::kDoppler) continue;
      const double sign = m.observable == Observable::kCarrier ? 1.0 : -1.0;
      first[m.satellite_index] += (t > 0.0 ? 1.0 : -1.0) * sign * m.value;
    }
  }
  for (const auto& [index, change] : first) least = std::min(least, std::abs(change));
  // A radian is 0.16 cycles of 10.7 cm.
  CHECK(least > 0.01);
}
