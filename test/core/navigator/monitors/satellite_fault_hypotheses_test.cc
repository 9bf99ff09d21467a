// The hypotheses of satellites and systems, against a least-squares fit of drawn carriers.
#include "core/navigator/monitors/satellite_fault_hypotheses.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "support/catch.h"
#include "support/dense/dense_algebra.h"

namespace leonav {
namespace {

using namespace ekf_index;

constexpr int kGps = 6, kGalileo = 5, kCarriers = kGps + kGalileo;
constexpr double kSigma_m = 0.003;

SatelliteId satellite(int i, System second) {
  return i < kGps ? SatelliteId{System::kGps, static_cast<std::uint16_t>(i + 1)}
                  : SatelliteId{second, static_cast<std::uint16_t>(i - kGps + 1)};
}

// One update: every satellite with one carrier, and what the filter has followed of them.
struct Update {
  std::unique_ptr<MeasurementEpoch> epoch = std::make_unique<MeasurementEpoch>();
  FilterMeasurements measurements;
  SatelliteFaultMonitor monitor;
  Ambiguities ambiguities;
  PositionEstimate estimate;
  System second;  // beside GPS

  // `drift_m`: of carriers that the filter follows, in each of the last hundred seconds.
  explicit Update(const std::vector<double>& drift_m, System other = System::kGalileo)
      : second(other) {
    for (int i = 0; i < kCarriers; ++i) add_carrier(i);
    std::mt19937_64 generator(3);
    std::normal_distribution<double> normal(0.0, kSigma_m);
    for (int t = 0; t < 160; ++t) {
      CarrierInnovations carriers;
      for (int i = 0; i < kCarriers; ++i) {
        const double drift = t >= 60 ? drift_m[static_cast<std::size_t>(i)] : 0.0;
        carriers.push_back(
            {satellite(i, second), SignalCode(), normal(generator) + drift, 0.0, kSigma_m});
      }
      REQUIRE_FALSE(monitor.add(carriers, GpsTime::from_week_and_tow(2300, t)));
    }
    estimate.p_e = to_ecef({0.7, 0.2, 100.0});
    estimate.covariance_e = square(0.005) * Eigen::Matrix3d::Identity();
  }

  void add_carrier(int i) {
    SatelliteInView view;
    view.satellite = satellite(i, second);
    epoch->satellites.push_back(view);
    Measurement measurement;
    measurement.observable = Observable::kCarrier;
    measurement.satellite_index = static_cast<std::uint16_t>(i);
    epoch->measurements.push_back(measurement);
    FilterMeasurement m;
    m.index = static_cast<std::size_t>(i);
    m.observable = Observable::kCarrier;
    const double azimuth = 2.1 * i, elevation = 0.2 + 0.11 * i;
    m.row.segment<3>(kPosition) << std::cos(azimuth) * std::cos(elevation),
        std::sin(azimuth) * std::cos(elevation), std::sin(elevation);
    m.row(kClock + (i < kGps ? 0 : 1)) = 1.0;
    m.variance = square(kSigma_m);
    m.ambiguity = kSize + i;
    measurements.push_back(m);
  }

  double followed(int i) const {
    return monitor.followed_range(satellite(i, second), SignalCode())->range_m;
  }
  // The change of a fit of position and two clocks where carrier i is `range_m` longer.
  Eigen::Vector3d moved_n(int i, double range_m) const {
    Eigen::MatrixXd H(kCarriers, 5);
    for (int k = 0; k < kCarriers; ++k) {
      const auto& row = measurements[static_cast<std::size_t>(k)].row;
      H.row(k) << row.segment<3>(kPosition).transpose().eval(), row(kClock), row(kClock + 1);
    }
    Eigen::VectorXd z = Eigen::VectorXd::Zero(kCarriers);
    z(i) = range_m;
    return rotation_ecef_to_ned(to_geodetic(estimate.p_e)) *
           dense::least_squares(H, z).solution.head<3>();
  }
  FaultHypotheses hypotheses(const IntegrityConfig& config = {}) const {
    return satellite_fault_hypotheses(monitor, *epoch, measurements, ambiguities, estimate, config);
  }
};

std::vector<double> drifting(int i) {
  std::vector<double> drift(kCarriers, 0.0);
  drift[static_cast<std::size_t>(i)] = 0.002;
  return drift;
}

const FaultHypothesis* find(const FaultHypotheses& faults, const Eigen::Vector3d& separation_n) {
  const auto found = std::find_if(faults.begin(), faults.end(), [&](const FaultHypothesis& fault) {
    return (fault.separation_n - separation_n).norm() < 1e-3 * separation_n.norm();
  });
  return found == faults.end() ? nullptr : &*found;
}

TEST_CASE("an arc that was joined may have a wrong join, by its length and probability") {
  Update update(std::vector<double>(kCarriers, 0.0));
  update.epoch->measurements[3].arc = 17;
  Ambiguity joined;
  joined.arc = 17;
  joined.wrong_join_probability = 0.02;
  joined.wrong_join_m = 0.8;
  const FaultHypotheses before = update.hypotheses();
  update.ambiguities.push_back(joined);
  const FaultHypotheses after = update.hypotheses();
  CHECK(find(before, update.moved_n(3, 0.8)) == nullptr);
  const FaultHypothesis* wrong = find(after, update.moved_n(3, 0.8));
  REQUIRE(wrong != nullptr);
  CHECK(wrong->probability >= 0.02);
  CHECK(wrong->probability < 0.0225);  // with that of a missed slip
}

TEST_CASE("the separation of a drifting satellite is what its carrier moves a fit by") {
  const Update update(drifting(2));
  CHECK(std::abs(update.followed(2)) > 0.08);
  const Eigen::Vector3d expected = update.moved_n(2, update.followed(2));
  const FaultHypotheses faults = update.hypotheses();
  const FaultHypothesis* fault = find(faults, expected);
  REQUIRE(fault != nullptr);
  CHECK(fault->probability == Approx(1e-4 * 600.0 / 3600.0));
  CHECK(fault->separation_covariance_n.trace() > 0.0);
  CHECK(fault->separation_covariance_n.trace() < 0.5 * expected.squaredNorm());
}

TEST_CASE("a system's separation is the sum of its satellites'") {
  const Update update(drifting(8));
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();
  for (int i = kGps; i < kCarriers; ++i) expected += update.moved_n(i, update.followed(i));
  IntegrityConfig config;
  config.satellite_faults_per_hour = 0.0;
  const FaultHypotheses faults = update.hypotheses(config);
  CHECK(find(faults, expected) != nullptr);
  CHECK(faults.size() <= 2);
}

TEST_CASE("a missed slip moves a fit by one cycle, of a pair by one on both frequencies") {
  Update update(drifting(2));
  const auto slip = [&](std::size_t i, double rate_per_hour) {
    IntegrityConfig config;
    config.satellite_faults_per_hour = config.system_faults_per_hour = 0.0;
    config.missed_slips_per_hour = rate_per_hour;
    const double one_m = wavelength_m(System::kGps, '1');
    const double both_m = 1.0 / (1.0 / one_m + 1.0 / wavelength_m(System::kGps, '2'));
    const bool pair = update.epoch->measurements[i].second_code != SignalCode();
    const FaultHypotheses faults = update.hypotheses(config);
    const FaultHypothesis* found =
        find(faults, update.moved_n(static_cast<int>(i), pair ? both_m : one_m));
    return found != nullptr ? found->probability : 0.0;
  };
  CHECK(slip(1, 1e-2) == 0.0);  // of no known signal
  update.epoch->measurements[1].code = {'1', 'C'};
  update.epoch->measurements[3].code = {'1', 'C'};
  update.epoch->measurements[3].second_code = {'2', 'W'};
  CHECK(slip(1, 1e-2) == Approx(1e-2 * 600.0 / 3600.0));
  CHECK(slip(3, 1e-2) == Approx(1e-2 * 600.0 / 3600.0));
  CHECK(slip(1, 0.0) == 0.0);
}

TEST_CASE("low orbits have a rate of faults of their own, for one and for all") {
  const Update update(drifting(8), System::kLeo);
  IntegrityConfig config;
  config.leo_faults_per_hour = 2e-3;
  const FaultHypotheses faults = update.hypotheses(config);
  const FaultHypothesis* one = find(faults, update.moved_n(8, update.followed(8)));
  REQUIRE(one != nullptr);
  CHECK(one->probability == Approx(2e-3 * 600.0 / 3600.0));
  Eigen::Vector3d all = Eigen::Vector3d::Zero();
  for (int i = kGps; i < kCarriers; ++i) all += update.moved_n(i, update.followed(i));
  const FaultHypothesis* system = find(faults, all);
  REQUIRE(system != nullptr);
  CHECK(system->probability == Approx(2e-3 * 600.0 / 3600.0));
}

TEST_CASE("no hypotheses: rates of zero, an uncertain position, a filter that has just restarted") {
  Update update(drifting(2));
  REQUIRE_FALSE(update.hypotheses().empty());
  IntegrityConfig config;
  config.satellite_faults_per_hour = config.system_faults_per_hour = 0.0;
  config.missed_slips_per_hour = 0.0;
  CHECK(update.hypotheses(config).empty());
  update.estimate.covariance_e *= 1e6;
  CHECK(update.hypotheses().empty());
  update.estimate.covariance_e /= 1e6;
  update.monitor.filter_restarted(false);
  CHECK(update.hypotheses().empty());
}

}  // namespace
}  // namespace leonav
