// FilterMonitor's verdicts on constructed evidence: an update's counts, and a solver that answers
// what the test wants.
#include "core/navigator/monitors/filter_monitor.h"

#include <limits>

#include "begin_of_week.h"
#include "core/earth/ellipsoid.h"
#include "support/catch.h"

namespace leonav {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kCodes = 10;

Vector3d place() { return to_ecef({0.9, 0.2, 100.0}); }

PointSolution point_at(const Vector3d& p_e, double sigma_m = 2.0) {
  PointSolution point;
  point.status = PointStatus::kOk;
  point.p_e = p_e;
  point.has_velocity = true;
  point.covariance_p_e = sigma_m * sigma_m * Matrix3d::Identity();
  point.covariance_v_e = 0.01 * Matrix3d::Identity();
  point.clock_m.fill(std::numeric_limits<double>::quiet_NaN());
  point.clock_drift_m_s.fill(std::numeric_limits<double>::quiet_NaN());
  point.clock_m[0] = point.clock_drift_m_s[0] = 0.0;
  point.satellites = kCodes;
  return point;
}

Ekf filter_at(const Vector3d& p_e, double sigma_m = 2.0) {
  Ekf filter(EkfConfig(), ImuErrorModel(), Vector3d::Zero());
  PointSolution start = point_at(p_e, sigma_m);
  start.satellites = 0;  // its sigma is the filter's, whatever codes it came from
  filter.initialize(test::kBeginOfWeek, start);
  return filter;
}

MeasurementEpoch codes_all_used() {
  MeasurementEpoch epoch;
  epoch.measurements.resize(kCodes);
  for (Measurement& code : epoch.measurements) {
    code.observable = Observable::kCode;
    code.reason = Reason::kUsed;
  }
  return epoch;
}

// Answers with one solution and counts how often it is asked.
struct FakeSolver : IndependentSolver {
  IndependentSolution solve(const Vector3d&) override {
    ++calls;
    return {point, accepted, &measurements};
  }
  PointSolution point;
  bool accepted = true;
  MeasurementEpoch measurements = codes_all_used();
  int calls = 0;
};

EkfUpdateResult update_with(int rejected_codes) {
  EkfUpdateResult update;
  update.offered[static_cast<std::size_t>(Observable::kCode)] = kCodes;
  update.rejected[static_cast<std::size_t>(Observable::kCode)] = rejected_codes;
  return update;
}

// The verdicts of `epochs` epochs, a second apart, in which so many codes were rejected.
FilterVerdict after(int epochs, int rejected_codes, const Ekf& filter, FilterMonitor* monitor,
                    FakeSolver* solver, double first_s = 1.0) {
  const MeasurementEpoch measurements = codes_all_used();
  const EkfUpdateResult update = update_with(rejected_codes);
  FilterVerdict verdict;
  for (int i = 0; i < epochs; ++i)
    verdict = monitor->test_prediction(
        {test::kBeginOfWeek.plus_seconds(first_s + i), update, measurements, filter}, solver);
  return verdict;
}

TEST_CASE(
    "a filter that rejects most codes three times in a row restarts where a checked solution "
    "contradicts it") {
  const Ekf filter = filter_at(place());
  FilterMonitor monitor{NavigatorConfig()};
  FakeSolver solver;
  solver.point = point_at(place() + Vector3d(1000.0, 0.0, 0.0));
  CHECK(after(2, 9, filter, &monitor, &solver).action == FilterAction::kKeep);
  const FilterVerdict verdict = after(1, 9, filter, &monitor, &solver, 3.0);
  CHECK(verdict.action == FilterAction::kRestart);
  CHECK(verdict.cause == ResetCause::kPrediction);
  CHECK(verdict.value == Approx(1000.0));
  CHECK(verdict.start.p_e == solver.point.p_e);
  CHECK(verdict.keeps_vehicle_constants);
  CHECK_FALSE(verdict.keeps_attitude);  // there is none
}

TEST_CASE("an epoch between that accepts its codes begins the count anew") {
  const Ekf filter = filter_at(place());
  FilterMonitor monitor{NavigatorConfig()};
  FakeSolver solver;
  solver.point = point_at(place() + Vector3d(1000.0, 0.0, 0.0));
  after(2, 9, filter, &monitor, &solver);
  after(1, 0, filter, &monitor, &solver, 3.0);
  CHECK(after(2, 9, filter, &monitor, &solver, 4.0).action == FilterAction::kKeep);
}

TEST_CASE(
    "a filter stays where the solution agrees with it, is not accepted, or most of its codes "
    "disagree") {
  const Ekf filter = filter_at(place());
  FakeSolver solver;
  SECTION("agrees") { solver.point = point_at(place() + Vector3d(1.0, 0.0, 0.0)); }
  SECTION("not accepted") {
    solver.point = point_at(place() + Vector3d(1000.0, 0.0, 0.0));
    solver.accepted = false;
  }
  SECTION("not redundant") {
    solver.point = point_at(place() + Vector3d(1000.0, 0.0, 0.0));
    solver.point.satellites = 5;
  }
  SECTION("its codes disagree") {
    solver.point = point_at(place() + Vector3d(1000.0, 0.0, 0.0));
    for (int i = 0; i < 5; ++i)
      solver.measurements.measurements[static_cast<std::size_t>(i)].reason = Reason::kOutlier;
  }
  FilterMonitor monitor{NavigatorConfig()};
  CHECK(after(6, 9, filter, &monitor, &solver).action == FilterAction::kKeep);
  CHECK(solver.calls > 0);
}

TEST_CASE("a solution is computed only where a verdict depends on it") {
  const Ekf filter = filter_at(place());
  FilterMonitor monitor{NavigatorConfig()};
  FakeSolver solver;
  after(10, 3, filter, &monitor, &solver);
  CHECK(solver.calls == 0);
}

TEST_CASE("a second restart soon after the first gives up attitude and vehicle constants") {
  Ekf filter = filter_at(place());
  filter.set_attitude(Eigen::Quaterniond::Identity(), Vector3d::Constant(0.01), Vector3d::Zero(),
                      1e-4);
  FilterMonitor monitor{NavigatorConfig()};
  const PointSolution point = point_at(place());
  const FilterVerdict first = monitor.restart_after_outage(point, filter, test::kBeginOfWeek);
  CHECK(first.cause == ResetCause::kOutage);
  CHECK(first.keeps_attitude);
  CHECK(first.keeps_vehicle_constants);
  monitor.filter_restarted(test::kBeginOfWeek);
  const FilterVerdict second =
      monitor.restart_after_outage(point, filter, test::kBeginOfWeek.plus_seconds(1.0));
  CHECK_FALSE(second.keeps_attitude);
  CHECK_FALSE(second.keeps_vehicle_constants);
  const FilterVerdict later =
      monitor.restart_after_outage(point, filter, test::kBeginOfWeek.plus_seconds(3600.0));
  CHECK(later.keeps_attitude);
}

TEST_CASE("a restart soon after evidence was cleared for another cause is the first one") {
  Ekf filter = filter_at(place());
  filter.set_attitude(Eigen::Quaterniond::Identity(), Vector3d::Constant(0.01), Vector3d::Zero(),
                      1e-4);
  FilterMonitor monitor{NavigatorConfig()};
  monitor.clear_evidence();
  const FilterVerdict verdict =
      monitor.restart_after_outage(point_at(place()), filter, test::kBeginOfWeek.plus_seconds(1.0));
  CHECK(verdict.keeps_attitude);
  CHECK(verdict.keeps_vehicle_constants);
}

TEST_CASE("a filter 15 m off where its carriers hold it restarts at what all codes agree on") {
  const Vector3d up = place().normalized();
  const Ekf filter = filter_at(place(), 0.5);
  FilterMonitor monitor{NavigatorConfig()};
  FakeSolver solver;
  solver.point = point_at(place() + 15.0 * up);
  const MeasurementEpoch measurements = codes_all_used();
  const EkfUpdateResult update = update_with(2);
  const EkfUpdateResult agreeing = update_with(0);
  FilterVerdict verdict =
      monitor.test_position({test::kBeginOfWeek, agreeing, measurements, filter}, &solver);
  int epochs = 0;
  while (verdict.action == FilterAction::kKeep && epochs < 120)
    verdict = monitor.test_position(
        {test::kBeginOfWeek.plus_seconds(++epochs), update, measurements, filter}, &solver);
  CHECK(verdict.action == FilterAction::kRestart);
  CHECK(verdict.cause == ResetCause::kPrediction);
  CHECK(verdict.value == Approx(15.0).margin(0.1));
  // The mean exceeds the limit after 10 s; then it takes twenty more seconds, and those that
  // counted for the filter before.
  CHECK(epochs > 20);
  CHECK(epochs < 60);
}

TEST_CASE("a filter whose codes agree with it stays, however many of them are rejected") {
  const Ekf filter = filter_at(place(), 0.5);
  FilterMonitor monitor{NavigatorConfig()};
  FakeSolver solver;
  solver.point = point_at(place());
  const MeasurementEpoch measurements = codes_all_used();
  const EkfUpdateResult update = update_with(2);
  for (int i = 1; i < 300; ++i)
    CHECK(monitor
              .test_position({test::kBeginOfWeek.plus_seconds(i), update, measurements, filter},
                             &solver)
              .action == FilterAction::kKeep);
}

TEST_CASE("a filter with a number that is not finite is dropped, and another one is not") {
  const FilterMonitor monitor{NavigatorConfig()};
  CHECK(monitor.test_finite(filter_at(place())).action == FilterAction::kKeep);
  const Ekf broken = filter_at(Vector3d::Constant(std::numeric_limits<double>::infinity()));
  const FilterVerdict verdict = monitor.test_finite(broken);
  CHECK(verdict.action == FilterAction::kDrop);
  CHECK(verdict.cause == ResetCause::kNotFinite);
  CHECK(monitor.test_finite(Ekf(EkfConfig(), ImuErrorModel(), Vector3d::Zero())).action ==
        FilterAction::kKeep);  // not initialized: there is nothing to drop
}

TEST_CASE("a prediction too uncertain for codes is good enough while carrier arcs go on") {
  NavigatorConfig config;
  config.ekf.use_carrier = true;
  const FilterMonitor monitor{config};
  const GpsTime now = test::kBeginOfWeek.plus_seconds(10.0);
  const Ekf sharp = filter_at(place()), vague = filter_at(place(), 1e3);
  const Ekf lost = filter_at(place(), 1e6);
  CHECK_FALSE(monitor.prediction_is_too_uncertain(sharp, now, GpsTime()));
  CHECK(monitor.prediction_is_too_uncertain(vague, now, GpsTime()));  // no arc goes on
  CHECK_FALSE(monitor.prediction_is_too_uncertain(vague, now, test::kBeginOfWeek));
  CHECK(monitor.prediction_is_too_uncertain(lost, now, test::kBeginOfWeek));
}

}  // namespace
}  // namespace leonav
