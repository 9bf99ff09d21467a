// A step of the chain that would raise the cost of the window is shortened.
#include "core/smoother/internal/descending_step.h"

#include <cmath>
#include <memory>
#include <numbers>

#include "core/smoother/internal/window_cost.h"
#include "smoother_rig.h"
#include "support/catch.h"
#include "window_rig.h"

namespace leonav {
namespace {

using namespace synthetic;

constexpr int kKeyframes = 12;

std::unique_ptr<FilterState[]> states_of(const Window& window) {
  auto states = std::make_unique<FilterState[]>(static_cast<std::size_t>(window.size()));
  for (int k = 0; k < window.size(); ++k) states[static_cast<std::size_t>(k)] = window.at(k).state;
  return states;
}

// Straight ahead with a heading that is 60 degrees off, which nothing contradicts before the first
// turn: the antenna is where it is, and the IMU's position is off by the turned lever arm. In its
// last second the window learns the heading.
DriveOptions misaligned() {
  DriveOptions options;
  options.noise = 0.1;
  options.sigma_rpy = {0.02, 0.02, 1.0};
  options.misaligned_rpy = {0.0, 0.0, std::numbers::pi / 3.0};
  options.straight_epochs = kKeyframes - 1;
  options.lever_b = {10.0, 3.0, -1.2};
  return options;
}

void fill(Drive* drive, Window* window) {
  for (int i = 0; i < kKeyframes; ++i) feed(drive->step(), drive->lever_b(), window);
  REQUIRE(window->size() == kKeyframes);
}

double cost_of(const Window& window, const Eigen::Vector3d& lever_b) {
  return dense_step(window, lever_b).cost;
}

}  // namespace

TEST_CASE("what the cost rises by is what the whitened residuals of the whole window say") {
  DriveOptions options;
  options.random_walk = GENERATE(0.0, 0.01);
  options.arc_epochs = GENERATE(1'000'000, 5);
  options.joined = GENERATE(false, true);
  options.inertial = GENERATE(false, true);
  options.constrained = options.inertial && GENERATE(false, true);
  Drive drive(options);
  Window window(kKeyframes);
  fill(&drive, &window);
  REQUIRE(window.newest().process_factor.has_information == options.constrained);
  // Those that have left the window stand in the prior, whose gradient then counts too.
  const int left = GENERATE(0, 3);
  for (int i = 0; i < left; ++i) feed(drive.step(), drive.lever_b(), &window);
  const auto before = states_of(window);
  const double cost = cost_of(window, drive.lever_b());
  Generator noise(5);
  for (int k = 0; k < window.size(); ++k) {
    Keyframe& keyframe = window.at(k);
    EkfCorrection part = EkfCorrection::Zero(keyframe.active.size());
    for (Eigen::Index i = 0; i < keyframe.active.core_size(); ++i) {
      const int state = keyframe.active.core[static_cast<std::size_t>(i)];
      const bool small = state >= ekf_index::kAttitude && state < ekf_index::kClock;
      part(i) = (small ? 1e-3 : 0.1) * noise.normal();
    }
    add(full_error(keyframe.active, part), keyframe.has_attitude, &keyframe.state);
  }
  const double rise = cost_of(window, drive.lever_b()) - cost;
  CAPTURE(cost, rise);
  REQUIRE(rise > 10.0);
  CHECK(cost_rise(window, before.get(), drive.lever_b()) == Approx(rise).epsilon(1e-6));
}

TEST_CASE("an ordinary step is taken whole, and lowers the cost") {
  Drive drive{DriveOptions{}};
  Window window(kKeyframes);
  fill(&drive, &window);
  RtsSolver chain(kKeyframes);
  DescendingStep step(kKeyframes);
  WindowCorrections corrections;
  for (int i = 0; i < 4; ++i) {
    CAPTURE(i);
    const auto before = states_of(window);
    REQUIRE(chain.solve(window, drive.lever_b(), &corrections));
    REQUIRE(step.take(corrections, drive.lever_b(), &window));
    CHECK(step.share() == 1.0);
    CHECK(cost_rise(window, before.get(), drive.lever_b()) < 1e-4);
  }
}

TEST_CASE("from an attitude 60 degrees off a whole step raises the cost, and a part is taken") {
  Drive drive(misaligned());
  Window window(kKeyframes);
  fill(&drive, &window);
  const auto start = states_of(window);
  RtsSolver chain(kKeyframes);
  WindowCorrections corrections;
  REQUIRE(chain.solve(window, drive.lever_b(), &corrections));
  double moved_m = 0.0;
  REQUIRE(move_states(corrections, 1.0, &window, &moved_m));
  const double whole = cost_rise(window, start.get(), drive.lever_b());
  WARN("cost of the whole step: " << whole << " more");
  CHECK(whole > 0.0);
  for (int k = 0; k < window.size(); ++k) window.at(k).state = start[static_cast<std::size_t>(k)];

  DescendingStep step(kKeyframes);
  REQUIRE(step.take(corrections, drive.lever_b(), &window));
  WARN("share taken: " << step.share());
  CHECK(step.share() < 1.0);
  CHECK(step.share() > 0.0);
  CHECK(cost_rise(window, start.get(), drive.lever_b()) < 1e-3);
}

TEST_CASE("the smoother says how many of its steps were shortened") {
  Drive drive(misaligned());
  const auto smoother = smoother_of(drive, kKeyframes);
  for (int epoch = 1; epoch < kKeyframes; ++epoch)
    CHECK(solve(drive.step(), smoother.get()).shortened == 0);
  CHECK(solve(drive.step(), smoother.get()).shortened > 0);
}

TEST_CASE("a step that raises the cost even where it is short is left out") {
  Drive drive{DriveOptions{}};
  Window window(kKeyframes);
  fill(&drive, &window);
  const auto before = states_of(window);
  WindowCorrections wrong;
  for (int k = 0; k < window.size(); ++k) {
    wrong.push_back(EkfCorrection::Zero(window.at(k).active.size()));
    wrong.back()(0) = k % 2 == 0 ? 1e3 : -1e3;  // m
  }
  DescendingStep step(kKeyframes);
  REQUIRE(step.take(wrong, drive.lever_b(), &window));
  CHECK(step.share() == 0.0);
  CHECK(step.moved_m() == 0.0);
  for (int k = 0; k < window.size(); ++k)
    CHECK(difference(window.at(k).state, before[static_cast<std::size_t>(k)]).norm() == 0.0);
}

TEST_CASE("where a process's noise is not definite the cost is not known, and the step is taken") {
  Drive drive{DriveOptions{}};
  Window window(kKeyframes);
  fill(&drive, &window);
  RtsSolver chain(kKeyframes);
  WindowCorrections corrections;
  REQUIRE(chain.solve(window, drive.lever_b(), &corrections));
  // Position and velocity are certain of each other.
  EkfCovariance& noise = window.newest().process_factor.noise;
  noise(0, 3) = noise(3, 0) = 2.0 * std::sqrt(noise(0, 0) * noise(3, 3));
  const auto before = states_of(window);
  DescendingStep step(kKeyframes);
  REQUIRE(step.take(corrections, drive.lever_b(), &window));
  CHECK(step.share() == 1.0);
  CHECK(std::isnan(cost_rise(window, before.get(), drive.lever_b())));
}

namespace {

// Never finds a step.
class Helpless final : public WindowSolver {
 public:
  bool solve(const Window&, const Eigen::Vector3d&, WindowCorrections*) override { return false; }
};

}  // namespace

TEST_CASE("a solve that the minimizer leaves to the chain says so") {
  Drive drive{DriveOptions{}};
  SmootherConfig config;
  config.window = 5;
  ProcessPropagationConfig repropagation;
  repropagation.ekf = drive.config();
  repropagation.imu = mems();
  repropagation.motion = Drive::motion();
  Smoother helpless(config, drive.config().robust, drive.lever_b(), repropagation,
                    std::make_unique<Helpless>());
  const auto chain = smoother_of(drive, config);
  for (int epoch = 1; epoch <= 8; ++epoch) {
    const KeyframeInput& input = drive.step();
    const SmootherResult result = solve(input, &helpless);
    CHECK(result.left_to_chain);
    if (epoch > 1) CHECK(result.status == SmootherStatus::kOk);
    CHECK_FALSE(solve(input, chain.get()).left_to_chain);
  }
}

}  // namespace leonav
