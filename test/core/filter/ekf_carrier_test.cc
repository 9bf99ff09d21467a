// Carrier phase in the filter: ambiguities against a batch solution, and their coming and going.
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "carrier_receiver.h"
#include "core/filter/ekf.h"
#include "core/filter/error_model/reflection.h"
#include "core/filter/state/ambiguities.h"
#include "support/catch.h"
#include "support/dense/dense_algebra.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;
using namespace synthetic;

TEST_CASE("a static filter with ambiguities is the batch least squares of all epochs") {
  Receiver receiver(1);
  const PointSolution start = receiver.point();
  Ekf filter(static_config(), ImuErrorModel(), Vector3d::Zero());
  filter.initialize(synthetic::kStart, start);
  constexpr int kEpochs = 40, kUnknowns = 3 + 8 + 2 * kEpochs;
  const Vector3d p0 = receiver.truth().p_antenna_e;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kUnknowns);
  normal.topLeftCorner<3, 3>() = start.covariance_p_e.inverse();
  right.head<3>() = start.covariance_p_e.inverse() * (start.p_e - p0);
  for (int k = 0; k < kEpochs; ++k) {
    const MeasurementEpoch epoch = receiver.measure(kStep_s * (k + 1));
    step(&filter, epoch);
    for (const Measurement& measurement : epoch.measurements) {
      const SatelliteInView& view = epoch.satellites[measurement.satellite_index];
      const RangePrediction range = predict_range(view, p0);
      Eigen::VectorXd row = Eigen::VectorXd::Zero(kUnknowns);
      row.head<3>() = range.d_range_d_p.transpose();
      if (measurement.observable == Observable::kCarrier)
        row(3 + measurement.satellite_index) = 1.0;
      row(11 + 2 * k + static_cast<int>(index_of(view.satellite.system))) = 1.0;
      const double weight = 1.0 / (measurement.sigma * measurement.sigma);
      normal += weight * row * row.transpose();
      right += weight * row * (measurement.value - range.range_m);
    }
  }
  const Eigen::MatrixXd covariance = dense::inverse(normal);
  const Eigen::VectorXd solution = covariance * right;
  const Vector3d difference = filter.state().p_e - (p0 + solution.head<3>());
  CHECK(difference.norm() < 2e-4);
  for (int i = 0; i < 3; ++i)
    CHECK(std::sqrt(filter.covariance()(i, i)) ==
          Approx(std::sqrt(covariance(i, i))).epsilon(2e-3));
  REQUIRE(filter.filter_state().ambiguities.size() == 8);
  for (int i = 0; i < 8; ++i) {
    CHECK(filter.filter_state().ambiguities[static_cast<std::size_t>(i)].value_m ==
          Approx(solution(3 + i)).margin(2e-3));
    CHECK(std::sqrt(filter.covariance()(kSize + i, kSize + i)) ==
          Approx(std::sqrt(covariance(3 + i, 3 + i))).epsilon(2e-3));
  }
  CHECK((filter.state().p_e - p0).norm() < 0.05);
}

TEST_CASE("an arc that ends takes its ambiguity along; one unseen for long goes, a gap does not") {
  Receiver receiver(2);
  EkfConfig config = static_config();
  Ekf filter = static_filter(&receiver, config);
  for (int k = 1; k <= 3; ++k) step(&filter, receiver.measure(kStep_s * k));
  REQUIRE(filter.filter_state().ambiguities.size() == 8);
  MeasurementEpoch epoch = receiver.measure(120.0);
  for (Measurement& m : epoch.measurements)
    if (m.arc == 3) m.arc = 30;
  step(&filter, epoch);
  CHECK(filter.filter_state().ambiguities.size() == 8);
  CHECK(find_ambiguity(filter.filter_state().ambiguities, 3) == kNoAmbiguity);
  const int place = find_ambiguity(filter.filter_state().ambiguities, 30);
  REQUIRE(place != kNoAmbiguity);
  // The others stand as they were, and in their places.
  CHECK(find_ambiguity(filter.filter_state().ambiguities, 4) == 2);
  CHECK(filter.covariance().rows() == kSize + 8);
  // One satellite without carrier for 90 s, then for 150 s.
  const auto without_first = [&](double t) {
    MeasurementEpoch e = receiver.measure(t);
    for (Measurement& m : e.measurements) {
      if (m.arc == 3) m.arc = 30;
      if (m.arc == 1) m.reason = Reason::kLowCn0;
    }
    return e;
  };
  for (double t = 150.0; t <= 210.0; t += 30.0) step(&filter, without_first(t));
  CHECK(find_ambiguity(filter.filter_state().ambiguities, 1) != kNoAmbiguity);
  for (double t = 240.0; t <= 300.0; t += 30.0) step(&filter, without_first(t));
  CHECK(find_ambiguity(filter.filter_state().ambiguities, 1) == kNoAmbiguity);
  CHECK(filter.covariance().rows() == kSize + 7);
}

TEST_CASE("a step in what the measurements mean opens the position by as much") {
  Receiver receiver(5);
  Ekf filter = static_filter(&receiver);
  for (int k = 1; k <= 20; ++k) step(&filter, receiver.measure(kStep_s * k));
  const double before = filter.covariance()(kPosition, kPosition);
  MeasurementEpoch other = receiver.measure(21 * kStep_s);
  other.position_disturbance_m = 0.5;
  for (Measurement& m : other.measurements)
    if (m.observable == Observable::kCarrier) m.disturbance_m = 1.0;
  step(&filter, other);
  const double after = filter.covariance()(kPosition, kPosition);
  CAPTURE(before, after);
  CHECK(after > 1.5 * before);
  CHECK(after < 0.25 + before);
}

TEST_CASE("an arc that its checks took for whole is thrown out and begins anew") {
  Receiver receiver(3);
  EkfConfig config = static_config();
  config.robust.enabled = true;
  Ekf filter = static_filter(&receiver, config);
  for (int k = 1; k <= 10; ++k) step(&filter, receiver.measure(kStep_s * k));
  int restarted = 0, used_again = 0;
  for (int k = 11; k <= 14; ++k) {
    MeasurementEpoch epoch = receiver.measure(kStep_s * k);
    for (Measurement& m : epoch.measurements)
      if (m.arc == 5) m.value += 2.4;
    const EkfUpdateResult result = step(&filter, epoch);
    restarted += static_cast<int>(result.slipped.size());
    for (std::size_t i = 0; i < epoch.measurements.size(); ++i) {
      if (epoch.measurements[i].arc != 5) continue;
      if (k <= 12) CHECK(result.innovations[i].reason == Reason::kOutlier);
      if (k >= 13) used_again += result.innovations[i].weight_factor > 0.0 ? 1 : 0;
    }
    CHECK((filter.state().p_e - receiver.truth().p_antenna_e).norm() < 0.2);
  }
  CHECK(restarted == 1);
  CHECK(used_again >= 1);
}

TEST_CASE("an antenna that is moved by 50 m is followed, and no sigma shrinks for it") {
  for (const double clock_noise : {1.0, 10.0}) {
    Receiver receiver(8);
    EkfConfig config = static_config();
    config.robust.enabled = true;
    config.clock = ClockModel();
    config.clock.offset_noise = clock_noise;
    Ekf filter = static_filter(&receiver, config);
    for (int k = 1; k <= 40; ++k) step(&filter, receiver.measure(kStep_s * k));
    const double before = std::sqrt(filter.covariance().topLeftCorner<3, 3>().trace());
    receiver.truth().p_antenna_e += Vector3d(30.0, -30.0, 26.0);
    for (int k = 41; k <= 44; ++k) step(&filter, receiver.measure(kStep_s * k));
    const double sigma = std::sqrt(filter.covariance().topLeftCorner<3, 3>().trace());
    const double error = (filter.state().p_e - receiver.truth().p_antenna_e).norm();
    CAPTURE(clock_noise, before, sigma, error);
    CHECK(sigma > 0.9 * before);
    CHECK(error < 3.5 * sigma);
    CHECK(error < 0.5);
  }
}

TEST_CASE("a clock that steps by a millisecond in the codes alone costs no arc and no centimetre") {
  Receiver receiver(4);
  EkfConfig config = static_config();
  config.robust.enabled = true;
  config.clock = ClockModel();
  Ekf filter = static_filter(&receiver, config);
  for (int k = 1; k <= 30; ++k) step(&filter, receiver.measure(kStep_s * k));
  const Vector3d before = filter.state().p_e;
  const double sigma_before = std::sqrt(filter.covariance().topLeftCorner<3, 3>().trace());
  MeasurementEpoch epoch = receiver.measure(kStep_s * 31);
  for (Measurement& m : epoch.measurements)
    if (m.observable == Observable::kCode) m.value += 299'792.458;
  const EkfUpdateResult result = step(&filter, epoch);
  CHECK(result.clock_jump_m == Approx(299'792.458).margin(30.0));
  CHECK(result.slipped.empty());
  CHECK(result.prediction_widened[0] == 0.0);
  CHECK(filter.filter_state().ambiguities.size() == 8);
  CHECK((filter.state().p_e - before).norm() < 0.01);
  CHECK(std::sqrt(filter.covariance().topLeftCorner<3, 3>().trace()) < 1.01 * sigma_before);
  CHECK(filter.filter_state().ambiguities[0].value_m ==
        Approx(ambiguity_of(0) - 299'792.458).margin(0.3));
}

TEST_CASE("more arcs than there are places: the first keep theirs, the others are counted") {
  Receiver receiver(5);
  Ekf filter = static_filter(&receiver);
  MeasurementEpoch epoch = receiver.measure(30.0);
  const auto satellites = epoch.satellites;
  const auto measurements = epoch.measurements;
  for (std::uint16_t copy = 1; copy < 10; ++copy) {
    for (SatelliteInView view : satellites) {
      view.satellite.number = static_cast<std::uint16_t>(view.satellite.number + 10 * copy);
      epoch.satellites.push_back(view);
    }
    for (Measurement m : measurements) {
      m.satellite_index = static_cast<std::uint16_t>(m.satellite_index + 8 * copy);
      if (m.observable == Observable::kCarrier) m.arc += 100u * copy;
      epoch.measurements.push_back(m);
    }
  }
  const EkfUpdateResult result = step(&filter, epoch);
  CHECK(filter.filter_state().ambiguities.size() == kMaxArcs);
  CHECK(result.arcs_without_capacity == 80 - static_cast<int>(kMaxArcs));
  CHECK(find_ambiguity(filter.filter_state().ambiguities, 8) != kNoAmbiguity);
}

TEST_CASE("new arcs take the places of those out of sight, longest unseen first") {
  Receiver receiver(6);
  Ekf filter = static_filter(&receiver);
  MeasurementEpoch epoch = receiver.measure(30.0);
  const auto satellites = epoch.satellites;
  const auto measurements = epoch.measurements;
  step(&filter, epoch);
  // 60 arcs of other satellites, which leave four of the eight places behind them.
  epoch = MeasurementEpoch();
  epoch.time = synthetic::kStart.plus_seconds(60.0);
  for (std::uint16_t copy = 1; epoch.satellites.size() < 60; ++copy) {
    for (std::size_t i = 0; i < 8 && epoch.satellites.size() < 60; ++i) {
      const auto index = static_cast<std::uint16_t>(epoch.satellites.size());
      SatelliteInView view = satellites[i];
      view.satellite.number = static_cast<std::uint16_t>(view.satellite.number + 10 * copy);
      epoch.satellites.push_back(view);
      for (Measurement m : measurements) {
        if (m.satellite_index != i) continue;
        m.satellite_index = index;
        if (m.observable == Observable::kCarrier) m.arc += 100u * copy;
        epoch.measurements.push_back(m);
      }
    }
  }
  const EkfUpdateResult result = step(&filter, epoch);
  CHECK(result.arcs_without_capacity == 0);
  CHECK(filter.filter_state().ambiguities.size() == kMaxArcs);
  for (std::uint32_t arc = 1; arc <= 8; ++arc)
    CHECK((find_ambiguity(filter.filter_state().ambiguities, arc) != kNoAmbiguity) == (arc > 4));
}

TEST_CASE(
    "clocks are forgotten at an epoch that has carriers alone, and start with the next code") {
  Receiver receiver(5);
  Ekf filter(static_config(), ImuErrorModel(), Vector3d::Zero());
  filter.initialize(synthetic::kStart, receiver.point());
  for (int k = 1; k <= 20; ++k) step(&filter, receiver.measure(kStep_s * k));
  REQUIRE(filter.filter_state().ambiguities.size() == 8);
  filter.restart_clock_offsets();
  MeasurementEpoch carriers = receiver.measure(kStep_s * 21);
  for (Measurement& measurement : carriers.measurements)
    if (measurement.observable == Observable::kCode) measurement.reason = Reason::kOutlier;
  CHECK(step(&filter, carriers).used == 0);
  CHECK(filter.filter_state().ambiguities.empty());
  receiver.truth().clocks.offset_m.array() += 5'000.0;
  for (int k = 22; k <= 24; ++k) step(&filter, receiver.measure(kStep_s * k));
  CHECK(filter.filter_state().ambiguities.size() == 8);
  CHECK((filter.state().p_e - receiver.truth().p_antenna_e).norm() < 0.3);
}

TEST_CASE("a prediction kilometres off is linearized where the codes say") {
  EkfConfig config = static_config();
  config.static_point = false;
  config.acceleration_noise_horizontal = config.acceleration_noise_vertical = 30.0;
  for (const bool told : {true, false}) {
    Receiver mover(7);
    Ekf filter = static_filter(&mover, config);
    double t = 0.0;
    for (int k = 1; k <= 60; ++k) {
      MeasurementEpoch epoch = mover.measure(t += kStep_s);
      epoch.approximate_p_e = mover.truth().p_antenna_e + Vector3d(1.0, -2.0, 1.0);
      step(&filter, epoch);
    }
    const double before = (filter.state().p_e - mover.truth().p_antenna_e).norm();
    // Up and away: ranges turn most for the height.
    mover.truth().p_antenna_e *= 1.0 + 8000.0 / mover.truth().p_antenna_e.norm();
    MeasurementEpoch epoch = mover.measure(t += kStep_s);
    if (told) epoch.approximate_p_e = mover.truth().p_antenna_e + Vector3d(1.0, -2.0, 1.0);
    step(&filter, epoch);
    const double after = (filter.state().p_e - mover.truth().p_antenna_e).norm();
    CAPTURE(told, before, after);
    if (told) {
      CHECK(after < before + 0.03);
    } else {
      CHECK(after > before + 0.3);
    }
  }
}

TEST_CASE("a carrier that has lost strength may drift as a reflection does, others may not") {
  Receiver receiver(3);
  EkfConfig config = static_config();
  config.learn_errors = true;
  Ekf filter(config, ImuErrorModel(), Vector3d::Zero());
  filter.start_errors(5.0, 1.0, 1.0);
  filter.initialize(synthetic::kStart, receiver.point());
  const auto measured = [&](double t, double first_cn0_dbhz) {
    MeasurementEpoch epoch = receiver.measure(t);
    for (SatelliteInView& view : epoch.satellites) view.cn0_dbhz = 45.0;
    epoch.satellites[0].cn0_dbhz = first_cn0_dbhz;
    return epoch;
  };
  step(&filter, measured(kStep_s, 45.0));
  for (const Ambiguity& ambiguity : filter.filter_state().ambiguities)
    CHECK(ambiguity.random_walk == 0.0);
  const MeasurementEpoch weak = measured(2.0 * kStep_s, 37.0);
  step(&filter, weak);
  const SatelliteInView& view = weak.satellites[0];
  const double rate = line_of_sight_rate(view, filter.state().p_e);
  ErrorClass of = error_class(weak.measurements[0], view, 8.0, true);
  const double scale = filter.learned_errors().sigma_scale(of);
  const auto& ambiguities = filter.filter_state().ambiguities;
  REQUIRE(ambiguities.size() == 8);
  CHECK(scale > 2.0);
  CHECK(ambiguities[0].random_walk ==
        Approx(reflected_random_walk(std::sqrt(scale * scale - 1.0) * kCode, rate,
                                     filter.learned_errors().correlation(of).time_s))
            .epsilon(0.3));  // what is learned has gone on since
  for (std::size_t i = 1; i < 8; ++i) CHECK(ambiguities[i].random_walk == 0.0);
}

}  // namespace
}  // namespace leonav
