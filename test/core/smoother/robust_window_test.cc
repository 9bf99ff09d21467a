// Weights that later keyframes change: what one epoch cannot tell, a window can.
#include <map>
#include <vector>

#include "smoother_rig.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;

constexpr int kFaulty = 10;  // the epoch

// Of the measurement of a kind of the faulty epoch's first satellite in the window; -1: none.
double factor_of(const Smoother& smoother, Observable observable) {
  const Window& window = smoother.window();
  for (int k = 0; k < window.size(); ++k)
    for (const KeyframeMeasurement& m : window.at(k).measurements)
      if (window.at(k).index == kFaulty && m.measurement.observable == observable &&
          m.measurement.satellite_index == 0)
        return m.factor;
  return -1.0;
}

}  // namespace

TEST_CASE("an outlier that the filter took for good is found out by what comes later") {
  // After an outage no more satellites than it takes: nothing contradicts the first one's code.
  DriveOptions options;
  options.robust = true;
  options.inertial = false;
  options.carriers = false;
  options.code_sigma = 0.5;
  options.edit = [](int epoch, MeasurementEpoch* measured) {
    const bool outage = epoch >= kFaulty - 8 && epoch < kFaulty;
    const auto missing = [&](SatelliteId id) {
      return outage || (epoch == kFaulty && id.number > 1 && id.number < 6);
    };
    remove_satellites(missing, measured);
    if (epoch == kFaulty) measured->measurements[0].value += 5.0;
  };
  Drive drive(options);
  const auto smoother = smoother_of(drive, 20);
  double by_filter = -1.0, then = -1.0, now = -1.0;
  for (int epoch = 1; epoch <= kFaulty + 6; ++epoch) {
    const KeyframeInput& input = drive.step();
    if (epoch == kFaulty)
      for (const KeyframeMeasurement& m : input.measurements)
        if (m.measurement.observable == Observable::kCode && m.measurement.satellite_index == 0)
          by_filter = m.factor;
    solve(input, smoother.get());
    if (epoch == kFaulty) then = factor_of(*smoother, Observable::kCode);
    now = factor_of(*smoother, Observable::kCode);
  }
  WARN("outlier: factor by the filter " << by_filter << ", by the window then " << then << ", now "
                                        << now);
  CHECK(by_filter > 0.8);
  CHECK(then > 0.8);
  CHECK(now == 0.0);
}

TEST_CASE("a measurement wrongly thrown out comes back") {
  DriveOptions options;
  options.robust = true;
  options.carriers = false;
  Drive drive(options);
  const auto smoother = smoother_of(drive, 20, 1);  // a new keyframe's first weights are given
  double now = -1.0;
  for (int epoch = 1; epoch <= kFaulty + 6; ++epoch) {
    KeyframeInput input = drive.step();
    // As a filter would that was wrong.
    if (epoch == kFaulty)
      for (KeyframeMeasurement& m : input.measurements)
        if (m.measurement.satellite_index == 0) m.factor = 0.0;
    solve(input, smoother.get());
    if (epoch == kFaulty) CHECK(factor_of(*smoother, Observable::kCode) == 0.0);
    now = factor_of(*smoother, Observable::kCode);
  }
  CHECK(now > 0.5);
}

TEST_CASE("a code that is a little too long for many seconds weighs less") {
  const auto last_factor = [](double alike_s, double lasting_sigma) {
    DriveOptions options;
    options.robust = true;
    options.carriers = false;
    options.code_sigma = 0.5;
    options.edit = [=](int, MeasurementEpoch* measured) {
      measured->measurements[0].value += 1.25 * 0.5;
      measured->measurements[0].correlated_sigma = lasting_sigma;
    };
    Drive drive(options);
    SmootherConfig config;
    config.reweigh_s = 20.0;
    config.code_alike_s = alike_s;
    config.max_iterations = 4;  // the newest keyframe's weights are the window's from the second on
    config.converged_sigmas = 0.01;
    const auto smoother = smoother_of(drive, config);
    double sum = 0.0;
    for (int epoch = 1; epoch <= 40; ++epoch) {
      solve(drive.step(), smoother.get());
      if (epoch <= 20) continue;
      const Keyframe& newest = smoother->window().newest();
      for (const KeyframeMeasurement& m : newest.measurements)
        if (m.measurement.observable == Observable::kCode && m.measurement.satellite_index == 0)
          sum += m.factor / 20.0;
    }
    return sum;
  };
  const double judged = last_factor(5.0, 0.0), alone = last_factor(0.0, 0.0);
  const double lasting = last_factor(5.0, 0.5);  // an error that the model says may stay
  WARN("mean factor: means judged " << judged << ", each by itself " << alone
                                    << ", of a lasting error " << lasting);
  CHECK(alone > 0.7);
  CHECK(judged < 0.5 * alone);
  CHECK(lasting > 0.7);
}

TEST_CASE("a weight changes for as long after its epoch as configured, and then stays") {
  DriveOptions options;
  options.robust = true;
  options.carriers = false;
  Drive drive(options);
  SmootherConfig config;
  config.reweigh_s = 3.0;
  const auto smoother = smoother_of(drive, config);
  const auto factors_of = [](const Keyframe& keyframe) {
    std::vector<double> factors;
    for (const KeyframeMeasurement& m : keyframe.measurements) factors.push_back(m.factor);
    return factors;
  };
  std::map<std::uint64_t, std::vector<double>> before;  // by keyframe
  int changed = 0;
  for (int epoch = 1; epoch <= 40; ++epoch) {
    solve(drive.step(), smoother.get());
    const Window& window = smoother->window();
    for (int k = 0; k < window.size(); ++k) {
      const Keyframe& keyframe = window.at(k);
      const std::vector<double> now = factors_of(keyframe);
      const bool same = before.contains(keyframe.index) && before[keyframe.index] == now;
      const double age_s = seconds_between(window.newest().time, keyframe.time);
      CAPTURE(epoch, age_s);
      if (age_s > 3.5)
        CHECK(same);
      else if (age_s > 0.5 && !same)
        ++changed;
      before[keyframe.index] = now;
    }
  }
  CHECK(changed > 50);
}

TEST_CASE("where the position is vague the filter's weights stay") {
  const bool vague = GENERATE(true, false);
  DriveOptions options;
  options.robust = true;
  options.carriers = false;
  if (vague) options.code_sigma = 60.0;
  Drive drive(options);
  const auto smoother = smoother_of(drive, 20);
  double most = 0.0;
  for (int epoch = 1; epoch <= 12; ++epoch) {
    KeyframeInput input = drive.step();
    if (vague) input.covariance.topLeftCorner<3, 3>() += 2500.0 * Eigen::Matrix3d::Identity();
    for (KeyframeMeasurement& m : input.measurements) m.factor = 0.3;
    solve(input, smoother.get());
    for (int k = 0; k < smoother->window().size(); ++k)
      for (const KeyframeMeasurement& m : smoother->window().at(k).measurements)
        most = std::max(most, std::abs(m.factor - 0.3));
  }
  if (vague)
    CHECK(most == 0.0);
  else
    CHECK(most > 0.5);
}

}  // namespace leonav
