// Outliers, clock jumps, late systems and wrong predictions, without an IMU.
#include <cmath>
#include <vector>

#include "core/filter/ekf.h"
#include "support/catch.h"
#include "support/drive/white_errors.h"
#include "synthetic.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;
using synthetic::Generator;

constexpr double kMillisecond = 299'792.458;

class Walk {
 public:
  explicit Walk(std::uint64_t seed, const EkfConfig& config = EkfConfig())
      : noise_(seed), config_(config), filter_(config, ImuErrorModel{}, Vector3d::Zero()) {
    truth_.p_antenna_e = synthetic::start_position();
    truth_.v_antenna_e = synthetic::C_en_at(truth_.p_antenna_e) * Vector3d{5.0, -3.0, 0.0};
    truth_.clocks.offset_m.setConstant(2e4);
    truth_.clocks.drift_m_s.setConstant(30.0);
    sky_ = synthetic::eight_satellites();
    filter_.initialize(time_, synthetic::point_near(truth_, 3.0, 0.2, &noise_));
  }

  MeasurementEpoch next(double dt = 1.0) {
    time_ = time_.plus_seconds(dt);
    truth_.p_antenna_e += dt * truth_.v_antenna_e;
    synthetic::advance_clocks(config_.clock, dt, &truth_.clocks, &noise_);
    filter_.predict({}, time_);
    return synthetic::measure(time_, sky_, truth_, 3.0, 0.2, &noise_);
  }
  void run(int epochs) {
    for (int k = 0; k < epochs; ++k) filter_.update(next());
  }
  double error() const { return (filter_.state().p_e - truth_.p_antenna_e).norm(); }

  Generator& noise() { return noise_; }
  Ekf& filter() { return filter_; }
  synthetic::Truth& truth() { return truth_; }
  std::vector<SatelliteInView>& sky() { return sky_; }

 private:
  Generator noise_;
  EkfConfig config_;
  Ekf filter_;
  synthetic::Truth truth_;
  std::vector<SatelliteInView> sky_;
  GpsTime time_ = synthetic::kStart;
};

// Measurement index of the code (or Doppler) of a satellite as synthetic::measure lays them out.
std::size_t code_of(std::size_t satellite) { return 2 * satellite; }

}  // namespace

TEST_CASE("two code outliers and a Doppler outlier are reported and left out") {
  Walk walk(21);
  walk.run(10);
  MeasurementEpoch epoch = walk.next();
  epoch.measurements[code_of(1)].value += 80.0;
  epoch.measurements[code_of(6)].value -= 150.0;
  epoch.measurements[code_of(3) + 1].value += 9.0;
  epoch.measurements[code_of(4)].reason = Reason::kLowElevation;
  const EkfUpdateResult result = walk.filter().update(epoch);
  CHECK(result.innovations.size() == epoch.measurements.size());
  CHECK(result.innovations[code_of(1)].reason == Reason::kOutlier);
  CHECK(result.innovations[code_of(6)].reason == Reason::kOutlier);
  CHECK(result.innovations[code_of(3) + 1].reason == Reason::kOutlier);
  CHECK(result.innovations[code_of(4)].reason == Reason::kLowElevation);
  CHECK(result.innovations[code_of(4)].weight_factor == 0.0);
  CHECK(result.innovations[code_of(1)].test_ratio > 5.0);
  CHECK(result.offered[0] == 7);
  CHECK(result.rejected[0] == 2);
  CHECK(result.used == 12);
  CHECK_FALSE(result.prediction_suspect);
  CHECK(walk.error() < 6.0);
}

TEST_CASE("a jump of the receiver clock goes to the clock, not to the position") {
  for (const double jump : {kMillisecond, -2.0 * kMillisecond, 137.0}) {
    Walk walk(22);
    walk.run(15);
    const Vector3d before = walk.filter().state().p_e;
    walk.truth().clocks.offset_m.array() += jump;
    const EkfUpdateResult result = walk.filter().update(walk.next());
    INFO("jump " << jump);
    CHECK(result.clock_jump_m == Approx(jump).margin(10.0));
    CHECK(result.rejected[0] == 0);
    CHECK((walk.filter().state().p_e - before).norm() < 15.0);
    CHECK(walk.error() < 10.0);
    CHECK(walk.filter().filter_state().clocks.offset_m(0) ==
          Approx(walk.truth().clocks.offset_m(0)).margin(10.0));
    walk.run(5);
    CHECK(walk.error() < 8.0);
  }
}

TEST_CASE("a system that appears late is started from most of its satellites") {
  Walk walk(23);
  walk.truth().clocks.offset_m(2) = -7.3e5;
  walk.run(10);
  CHECK_FALSE(walk.filter().estimate().known_clocks().offset[2]);
  for (std::uint16_t i = 0; i < 4; ++i)
    walk.sky().push_back(
        synthetic::satellite_at(System::kBeidou, static_cast<std::uint16_t>(20 + i), 1.6 * i, 0.6));
  MeasurementEpoch epoch = walk.next();
  epoch.measurements[code_of(9)].value += 400.0;
  const EkfUpdateResult result = walk.filter().update(epoch);
  CHECK(walk.filter().estimate().known_clocks().offset[2]);
  CHECK(result.innovations[code_of(9)].reason == Reason::kOutlier);
  for (const std::size_t satellite : {8U, 10U, 11U})
    CHECK(result.innovations[code_of(satellite)].weight_factor > 0.0);
  const double error =
      walk.filter().filter_state().clocks.offset_m(2) - walk.truth().clocks.offset_m(2);
  CHECK(std::abs(error) < 10.0);
  CHECK(std::abs(error) < 4.0 * std::sqrt(walk.filter().covariance()(kClock + 2, kClock + 2)));
  CHECK(walk.filter().filter_state().clocks.drift_m_s(2) ==
        Approx(walk.truth().clocks.drift_m_s(2)).margin(1.0));
  CHECK(walk.error() < 8.0);
}

TEST_CASE("an epoch that contradicts the prediction is left out; a second one is believed") {
  Walk walk(24);
  walk.run(20);
  walk.truth().p_antenna_e += Vector3d{200.0, -150.0, 170.0};
  const EkfUpdateResult first = walk.filter().update(walk.next());
  CHECK(first.prediction_suspect);
  CHECK(first.prediction_widened[0] == 0.0);
  CHECK(first.offered[0] == 0);
  CHECK(walk.error() > 290.0);
  const EkfUpdateResult result = walk.filter().update(walk.next());
  CHECK(result.prediction_suspect);
  CHECK(result.prediction_widened[0] > 100.0);  // 300 m over three axes
  CHECK(result.rejected[0] <= 1);
  CHECK(walk.error() < 20.0);
  walk.run(5);
  CHECK(walk.error() < 10.0);
}

TEST_CASE("one epoch whose ranges are all wrong leaves no trace") {
  Walk walk(24), undisturbed(24);
  walk.run(20);
  undisturbed.run(20);
  MeasurementEpoch epoch = walk.next();
  undisturbed.filter().update(undisturbed.next());
  // As of a wrong time stamp: by the satellites' own range rates.
  for (Measurement& m : epoch.measurements)
    if (m.observable == Observable::kCode)
      m.value += 0.3 * epoch.satellites[m.satellite_index].v_e.dot(
                           (epoch.satellites[m.satellite_index].p_e - walk.truth().p_antenna_e)
                               .normalized()) +
                 100.0 * std::sin(3.0 * m.satellite_index);
  walk.filter().update(epoch);
  for (int k = 0; k < 5; ++k) {
    walk.filter().update(walk.next());
    undisturbed.filter().update(undisturbed.next());
  }
  CHECK(walk.error() < undisturbed.error() + 2.0);
}

TEST_CASE("a jump of the receiver clock goes to the clock without robust weights, too") {
  EkfConfig config = white_error_config();
  config.robust.enabled = false;
  Walk walk(22, config);
  walk.run(15);
  walk.truth().clocks.offset_m.array() += kMillisecond;
  const EkfUpdateResult result = walk.filter().update(walk.next());
  CHECK(result.clock_jump_m == Approx(kMillisecond).margin(10.0));
  CHECK(walk.error() < 10.0);
}

TEST_CASE("a prediction 300 m off is corrected with six codes, too") {
  Walk walk(24);
  while (walk.sky().size() > 6) walk.sky().pop_back();
  for (SatelliteInView& view : walk.sky()) view.satellite.system = System::kGps;
  walk.run(20);
  walk.truth().p_antenna_e += Vector3d{200.0, -150.0, 170.0};
  walk.filter().update(walk.next());
  const EkfUpdateResult result = walk.filter().update(walk.next());
  CHECK(result.prediction_suspect);
  CHECK(walk.error() < 30.0);
  walk.run(5);
  CHECK(walk.error() < 12.0);
}

TEST_CASE("faults among six codes do not pass for a wrong prediction") {
  for (const double fault : {60.0, 500.0, 20'000.0}) {
    for (std::size_t bad = 3; bad <= 5; ++bad) {
      CAPTURE(fault, bad);
      Walk walk(26);
      while (walk.sky().size() > 6) walk.sky().pop_back();
      for (SatelliteInView& view : walk.sky()) view.satellite.system = System::kGps;
      walk.run(20);
      MeasurementEpoch epoch = walk.next();
      for (std::size_t satellite = 0; satellite < bad; ++satellite)
        epoch.measurements[code_of(satellite)].value +=
            fault * (satellite % 2 == 0 ? 1.0 : -1.3) * (1.0 + static_cast<double>(satellite));
      const EkfUpdateResult result = walk.filter().update(epoch);
      CHECK_FALSE(result.prediction_suspect);
      CHECK(walk.error() < 12.0);
    }
  }
}

TEST_CASE("most codes bad in different ways do not carry the filter away") {
  Walk walk(25);
  walk.run(20);
  MeasurementEpoch epoch = walk.next();
  for (const std::size_t satellite : {0U, 2U, 3U, 5U, 7U})
    epoch.measurements[code_of(satellite)].value +=
        500.0 * (satellite % 2 == 0 ? 1.0 : -1.3) * (1.0 + static_cast<double>(satellite));
  const EkfUpdateResult result = walk.filter().update(epoch);
  CHECK_FALSE(result.prediction_suspect);
  CHECK(result.rejected[0] == 5);
  CHECK(walk.error() < 10.0);
}

TEST_CASE("robust weights cost little where nothing is wrong, and save the day where it is") {
  EkfConfig robust = white_error_config(), plain = robust;
  plain.robust.enabled = false;
  for (const bool contaminated : {false, true}) {
    double square[2] = {0.0, 0.0};
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      for (int kind = 0; kind < 2; ++kind) {
        Walk walk(seed + 300, kind == 0 ? robust : plain);
        Generator faults(seed + 900);
        for (int k = 0; k < 30; ++k) {
          MeasurementEpoch epoch = walk.next();
          for (std::size_t satellite = 0; satellite < 8 && contaminated; ++satellite)
            if (faults.uniform() < 0.15)
              epoch.measurements[code_of(satellite)].value += 30.0 + 70.0 * faults.uniform();
          walk.filter().update(epoch);
        }
        square[kind] += walk.error() * walk.error();
      }
    }
    const double robust_rms = std::sqrt(square[0] / 20.0), plain_rms = std::sqrt(square[1] / 20.0);
    WARN((contaminated ? "15 % outliers" : "clean")
         << ": robust " << robust_rms << " m, plain " << plain_rms << " m");
    if (contaminated)
      CHECK(robust_rms < 0.4 * plain_rms);
    else
      CHECK(robust_rms < 1.1 * plain_rms);
  }
}

TEST_CASE("codes whose errors stay alike do not make the filter overconfident") {
  // Multipath of 3 m, correlated over 10 s: the real error against the variance the filter states.
  for (const double correlation_time : {0.0, 10.0}) {
    EkfConfig config = white_error_config();
    config.robust.enabled = false;
    config.code_correlation_time_s = correlation_time;
    double ratio = 0.0;
    constexpr int kRuns = 40;
    for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
      Walk walk(seed + 700, config);
      std::vector<double> multipath(8);
      for (double& value : multipath) value = 3.0 * walk.noise().normal();
      for (int k = 0; k < 120; ++k) {
        MeasurementEpoch epoch = walk.next();
        const double r = std::exp(-0.1);
        for (std::size_t i = 0; i < 8; ++i) {
          multipath[i] = r * multipath[i] + 3.0 * std::sqrt(1.0 - r * r) * walk.noise().normal();
          Measurement& code = epoch.measurements[code_of(i)];
          const double clean =
              predict_range(epoch.satellites[i], walk.truth().p_antenna_e).range_m +
              walk.truth().clocks.offset_m(
                  static_cast<Eigen::Index>(index_of(epoch.satellites[i].satellite.system)));
          code.value = clean + multipath[i];
        }
        walk.filter().update(epoch);
      }
      const Eigen::Matrix3d P = walk.filter().covariance().block<3, 3>(0, 0);
      const Vector3d e = walk.truth().p_antenna_e - walk.filter().state().p_e;
      ratio += e.squaredNorm() / P.trace() / kRuns;
    }
    WARN("correlation time told " << correlation_time << " s: squared error over stated variance "
                                  << ratio);
    if (correlation_time > 0.0)
      CHECK(ratio < 1.3);
    else
      CHECK(ratio > 1.5);
  }
}

TEST_CASE("hostile measurements and intervals leave the filter finite") {
  Walk walk(26);
  walk.run(5);
  MeasurementEpoch epoch = walk.next();
  epoch.measurements[0].value = std::nan("");
  epoch.measurements[2].value = HUGE_VAL;
  epoch.measurements[4].sigma = 0.0;
  epoch.measurements[6].satellite_index = 5000;
  epoch.measurements[8].value = 1e300;
  const EkfUpdateResult result = walk.filter().update(epoch);
  CHECK(walk.filter().state().p_e.allFinite());
  CHECK(walk.filter().covariance().allFinite());
  CHECK(result.innovations[0].weight_factor == 0.0);
  CHECK(walk.error() < 10.0);
  // Every gap from 0.1 s to a day, and an epoch without anything.
  for (const double dt : {0.1, 30.0, 3600.0, 86'400.0}) {
    walk.filter().update(walk.next(dt));
    CHECK(walk.filter().covariance().allFinite());
  }
  CHECK(walk.error() < 30.0);
  walk.filter().update(MeasurementEpoch{});
  CHECK(walk.filter().state().p_e.allFinite());
  // Nothing initialized: nothing happens.
  Ekf blank(EkfConfig{}, ImuErrorModel{}, Vector3d::Zero());
  blank.predict({}, synthetic::kStart);
  CHECK(blank.update(epoch).used == 0);
  CHECK_FALSE(blank.initialized());
}

}  // namespace leonav
