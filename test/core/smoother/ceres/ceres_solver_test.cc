// The chain's steps, taken until they are nothing, lead where Ceres leads.
#include "core/smoother/ceres/ceres_solver.h"

#include <chrono>

#include "core/smoother/drive_rig.h"
#include "core/smoother/window_rig.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;

constexpr double kRangeRounding_m = 4e-9;  // of 2e7 m in a double: a millionth of 4 mm
constexpr int kSteps = 10;                 // of Gauss and Newton, far more than it takes

// All states of all keyframes, in the sigmas of a dense solution.
double apart(const Window& a, const Window& b, const DenseStep& dense) {
  double most = 0.0;
  for (int k = 0; k < a.size(); ++k) {
    const EkfCorrection error =
        active_part(a.at(k).active, difference(a.at(k).state, b.at(k).state));
    const Eigen::Index first = dense.first[static_cast<std::size_t>(k)];
    for (Eigen::Index i = 0; i < error.size(); ++i)
      most = std::max(most, std::abs(error(i)) / std::sqrt(dense.covariance(first + i, first + i)));
  }
  return most;
}

// The estimates some sigmas off, each its own way, so that the minimum has to be found.
void scatter(const DenseStep& dense, Window* window) {
  Generator noise(11);
  for (int k = 0; k < window->size(); ++k) {
    Keyframe& keyframe = window->at(k);
    const Eigen::Index first = dense.first[static_cast<std::size_t>(k)];
    EkfCorrection error(keyframe.active.size());
    for (Eigen::Index i = 0; i < error.size(); ++i)
      error(i) = 3.0 * noise.normal() * std::sqrt(dense.covariance(first + i, first + i));
    add(full_error(keyframe.active, error), keyframe.has_attitude, &keyframe.state);
  }
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

void compare(const DriveOptions& options, int capacity, int epochs) {
  Drive drive(options);
  Window by_chain(capacity), by_ceres(capacity);
  RtsSolver chain(capacity);
  LogCeresOptions precise;
  precise.max_iterations = 50;
  precise.last_steps = 3;
  CeresSolver ceres(precise);
  for (int i = 0; i < epochs; ++i) {
    const KeyframeInput& input = drive.step();
    feed(input, drive.lever_b(), &by_chain);
    feed(input, drive.lever_b(), &by_ceres);
    if (i + 1 == epochs) break;
    // The same estimates when the last ones come: what leaves is linearized there.
    REQUIRE(iterate(&chain, drive.lever_b(), 2, &by_chain));
    for (int k = 0; k < by_chain.size(); ++k) by_ceres.at(k).state = by_chain.at(k).state;
  }
  REQUIRE(iterate(&chain, drive.lever_b(), kSteps, &by_chain));
  const DenseStep dense = dense_step(by_chain, drive.lever_b());
  scatter(dense, &by_ceres);
  const auto start = std::chrono::steady_clock::now();
  REQUIRE(iterate(&ceres, drive.lever_b(), 1, &by_ceres));
  const double took_ms = milliseconds_since(start);
  const double difference = apart(by_ceres, by_chain, dense);
  WARN("window of " << by_chain.size() << ", wander " << options.random_walk << ", carriers "
                    << options.carriers << ": Ceres and chain apart " << difference
                    << " sigma; Ceres took " << ceres.iterations() << " iterations, " << took_ms
                    << " ms");
  CHECK(difference < std::max(1e-6, 3.0 * kRangeRounding_m / options.carrier_sigma));
}

}  // namespace

TEST_CASE("inertial windows with carriers: the chain leads where Ceres leads") {
  DriveOptions options;
  options.random_walk = GENERATE(0.0, 1e-3, 0.02);
  options.arc_epochs = GENERATE(1'000'000, 15);
  options.carrier_sigma = GENERATE(0.005, 0.05);
  const int capacity = GENERATE(3, 10, 20);
  compare(options, capacity, 25);
}

TEST_CASE("windows without an IMU or without carriers: the chain leads where Ceres leads") {
  DriveOptions options;
  options.inertial = GENERATE(false, true);
  options.carriers = !options.inertial;
  compare(options, 10, 25);
}

TEST_CASE("constraints on the motion between keyframes: the chain leads where Ceres leads") {
  DriveOptions options;
  options.constrained = true;
  options.carrier_sigma = 0.05;
  compare(options, GENERATE(3, 10, 20), 25);
}

TEST_CASE("joined arcs: the chain leads where Ceres leads") {
  DriveOptions options;
  options.joined = true;
  options.random_walk = GENERATE(0.0, 1e-3);
  options.arc_epochs = GENERATE(1'000'000, 15);
  compare(options, 10, 25);
}

TEST_CASE("Ceres refuses a window without information") {
  DriveOptions options;
  Drive drive(options);
  Window window(5);
  for (int i = 0; i < 3; ++i) feed(drive.step(), drive.lever_b(), &window);
  CeresSolver ceres;
  WindowCorrections corrections;
  REQUIRE(ceres.solve(window, drive.lever_b(), &corrections));
  SECTION("not a number") {
    window.at(1).measurements[0].measurement.value = std::nan("");
    CHECK_FALSE(ceres.solve(window, drive.lever_b(), &corrections));
  }
  SECTION("noise that is none") {
    window.at(1).process_factor.noise(0, 0) = -1.0;
    CHECK_FALSE(ceres.solve(window, drive.lever_b(), &corrections));
  }
}

}  // namespace leonav
