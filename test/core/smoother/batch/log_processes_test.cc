// Inertial factors that the log integrates itself: against the filter's, against the bare
// mechanization, and against the truth where they reach further than the filter has.
#include "core/smoother/batch/log_processes.h"

#include <algorithm>

#include "core/base/square.h"
#include "core/earth/rotation.h"
#include "core/inertial/strapdown/mechanization.h"
#include "core/smoother/batch/batch_smoother.h"
#include "core/smoother/drive_rig.h"
#include "drive_graph.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;
using namespace ekf_index;
using Eigen::Index;
using Eigen::Vector3d;

// A drive as a graph, with its truth.
struct Log {
  Log(const DriveOptions& options, int epochs, const Edit& edit = nullptr)
      : drive(options),
        graph(drive.lever_b()),
        processes({drive.config(), mems(), Drive::motion()}) {
    const auto input = std::make_unique<KeyframeInput>();
    for (int i = 0; i < epochs; ++i) {
      *input = drive.step();
      input->block_complete = true;  // the rig's is, at every epoch
      if (edit) edit(input.get());
      graph.add(*input);
      truth.push_back(drive.truth());
    }
  }

  BatchResult smoothed() {
    BatchConfig config;
    config.robust.enabled = false;
    const BatchResult result = smooth(
        config, nullptr, &processes, [](int, double) {}, &graph);
    REQUIRE(result.solved);
    CHECK(result.converged);
    return result;
  }
  NavState& true_at(int k) { return truth[static_cast<std::size_t>(k)]; }
  double error_m(int k) { return (graph.at(k).state.nav.p_e - true_at(k).p_e).norm(); }
  Vector3d attitude_error(int k) {
    return rotation_vector_from_quaternion(true_at(k).q_eb *
                                           graph.at(k).state.nav.q_eb.conjugate());
  }

  Drive drive;
  LogGraph graph;
  LogProcesses processes;
  std::vector<NavState> truth;
};

Edit parted_at(std::uint64_t index) {
  return [index](KeyframeInput* input) {
    if (input->index == index) input->follows_previous = false;
  };
}

// Errors over sigmas of the smoothed states `first` to `first + 2` at a keyframe, in ECEF.
double normalized(const Log& log, const BatchResult& result, int k, int first,
                  const Vector3d& error) {
  const ActiveStates& active = log.graph.at(k).active;
  const auto found = std::find(active.core.begin(), active.core.end(), first);
  REQUIRE(found != active.core.end());
  const Index at = found - active.core.begin();
  const Eigen::Matrix3d P = result.last.covariance[static_cast<std::size_t>(k)].block<3, 3>(at, at);
  return nees(error, P);
}

}  // namespace

TEST_CASE("a gap is joined where the IMU's samples reach back to the epoch before it") {
  constexpr std::uint64_t kGap = 6;
  const bool reaches = GENERATE(true, false);
  Log log({}, 10, [reaches](KeyframeInput* input) {
    if (input->index != kGap) return;
    input->follows_previous = false;
    input->sample_before_block.interval_ns = 5'000'000;
    input->sample_before_block.time =
        reaches ? input->from.nav.time : input->time.plus_seconds(-0.5);
  });
  REQUIRE(segments(log.graph) == 2);
  const LogProcesses::Extension extension = log.processes.extend(&log.graph);
  CAPTURE(reaches);
  CHECK(extension.joined == (reaches ? 1 : 0));
  CHECK(segments(log.graph) == (reaches ? 1 : 2));
}

TEST_CASE("factors integrated from the filter's estimates are the filter's") {
  DriveOptions options;
  const int kind = GENERATE(0, 1, 2);
  options.constrained = kind == 1;
  options.calibrating = kind == 2;
  options.noise = options.constrained ? 1e-3 : 1.0;
  Log log(options, 8);
  std::vector<LogProcess> of_filter;
  for (int k = 0; k < log.graph.size(); ++k) of_filter.push_back(log.graph.at(k).process);
  const LogProcesses::Extension extension = log.processes.extend(&log.graph);
  CHECK(extension.attitudes == 0);
  CHECK(extension.joined == 0);
  double F = 0.0, noise = 0.0, to = 0.0, information = 0.0;
  for (int k = 1; k < log.graph.size(); ++k) {
    const LogProcess& anew = log.graph.at(k).process;
    const LogProcess& old = of_filter[static_cast<std::size_t>(k)];
    REQUIRE(anew.exists);
    REQUIRE(anew.rows.core == old.rows.core);
    REQUIRE(anew.columns.core == old.columns.core);
    const Eigen::VectorXd sigma = old.noise.diagonal().cwiseSqrt().cwiseMax(1e-9);
    F = std::max(F, (anew.F - old.F).cwiseAbs().maxCoeff());
    noise = std::max(noise, apart_in_correlations(anew.noise, old.noise));
    const Eigen::VectorXd ends =
        active_part(log.graph.at(k).active, difference(anew.to, old.to)) -
        old.F * active_part(log.graph.at(k - 1).active, difference(anew.from, old.from));
    to = std::max(to, ends.cwiseQuotient(sigma).cwiseAbs().maxCoeff());
    CHECK(anew.information.size() == old.information.size());
    if (old.information.size() > 0)
      information = std::max(information,
                             (anew.information - old.information).norm() / old.information.norm());
  }
  WARN((options.constrained   ? "constrained"
        : options.calibrating ? "calibrating"
                              : "free")
       << ": F " << F << ", noise " << noise << ", ends " << to << " sigma, information "
       << information);
  // Constraints correct the filter on the way, which changes where it is linearized. Ends have the
  // rounding of a position, 1e-9 m, over a noise of micrometres.
  CHECK(F < (options.constrained ? 1e-4 : 1e-9));
  CHECK(noise < (options.constrained ? 1e-4 : 1e-9));
  CHECK(to < 1e-3);
  CHECK(information < 1e-4);
}

TEST_CASE("a factor that begins far from the estimate is integrated anew from there, no other") {
  Log log({}, 4);
  CHECK(log.processes.reintegrate(&log.graph) == 0);
  EkfCorrection error = EkfCorrection::Zero(kSize);
  error.segment<3>(kAttitude) << 0.1, 0.0, 0.1;
  LogKeyframe& turned = log.graph.at(1);
  add(error, true, &turned.state);
  const LogProcess before = log.graph.at(2).process;
  CHECK(log.processes.reintegrate(&log.graph) == 1);
  const LogProcess& after = log.graph.at(2).process;
  Mechanization mechanization;
  mechanization.reset(turned.state.nav, log.graph.at(2).sample_before_block);
  for (const ImuSample& sample : log.graph.at(2).block) mechanization.advance(sample);
  const NavState& end = mechanization.state();
  CHECK((after.to.nav.p_e - end.p_e).norm() < 1e-5);
  CHECK((after.to.nav.v_e - end.v_e).norm() < 1e-5);
  CHECK(after.to.nav.q_eb.angularDistance(end.q_eb) < 1e-6);
  // What is no motion follows the process that was there.
  CHECK(after.to.clocks.offset_m.isApprox(before.to.clocks.offset_m, 1e-12));
  for (Index i = 0; i < after.F.rows(); ++i) {
    const int state = after.rows.core[static_cast<std::size_t>(i)];
    if (state < kInsSize || state >= kSize) continue;
    CHECK(after.F.row(i) == before.F.row(i));
    CHECK(after.noise(i, i) == before.noise(i, i));
  }
  CHECK(log.processes.reintegrate(&log.graph) == 0);
}

TEST_CASE("clocks follow their process from where the estimate has moved") {
  Log log({}, 4);
  EkfCorrection error = EkfCorrection::Zero(kSize);
  error(kAttitude) = 0.01;  // far, so that it is integrated anew
  error(kClock) = 5.0;
  error(kClockDrift) = 0.5;
  const double before = log.graph.at(2).process.to.clocks.offset_m(0);
  add(error, true, &log.graph.at(1).state);
  REQUIRE(log.processes.reintegrate(&log.graph) == 1);
  const CoreState& to = log.graph.at(2).process.to;
  CHECK(to.clocks.offset_m(0) - before == Approx(5.5).epsilon(1e-6));  // a second later
  CHECK(log.graph.at(2).process.from.clocks.offset_m(0) ==
        log.graph.at(1).state.clocks.offset_m(0));
}

TEST_CASE("epochs before the alignment get the true attitude, within its sigmas") {
  constexpr int kSeeds = 20, kAlignedAt = 12;
  double sum = 0.0, of_position = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    DriveOptions options;
    options.seed = 300 + seed;
    options.aligned_at = kAlignedAt;
    options.carriers = seed % 2 == 0;
    Log log(options, 30);
    REQUIRE_FALSE(log.graph.at(kAlignedAt - 2).has_attitude);
    REQUIRE(log.graph.at(kAlignedAt - 1).has_attitude);
    REQUIRE(segments(log.graph) == 2);
    const BatchResult result = log.smoothed();
    CHECK(result.extension.attitudes == kAlignedAt - 1);
    CHECK(result.extension.joined == 0);
    REQUIRE(segments(log.graph) == 1);
    for (const int k : {0, 5, 10}) {
      REQUIRE(log.graph.at(k).has_attitude);
      CHECK(log.attitude_error(k).norm() < 0.05);
      sum += normalized(log, result, k, kAttitude, log.attitude_error(k));
      of_position +=
          normalized(log, result, k, kPosition, log.true_at(k).p_e - log.graph.at(k).state.nav.p_e);
      ++count;
    }
  }
  WARN("before the alignment: NEES of attitude " << sum / count << ", of position "
                                                 << of_position / count << " of 3");
  // 20 runs with three epochs each, which are nearly one error of the attitude: 60 degrees over 20,
  // within 99.9 %.
  CHECK(sum / count > 1.5);
  CHECK(sum / count < 5.1);
  CHECK(of_position / count > 1.5);
  CHECK(of_position / count < 5.1);
}

// What is known of the start stays what it was: the filter's point solution. Only the state is now
// that of the IMU, and no longer that of the antenna.
TEST_CASE("an attitude given to the first epoch leaves its prior where it was") {
  DriveOptions options;
  options.aligned_at = 6;
  Log log(options, 8);
  LogKeyframe& first = log.graph.at(0);
  EkfCorrection moved = EkfCorrection::Zero(first.state.size());
  moved.segment<3>(kPosition) << 3.0, -2.0, 1.0;
  moved.segment<3>(kVelocity) << 0.3, 0.2, -0.1;
  moved(kClock) = 4.0;
  add(moved, false, &first.state);
  log.graph.at(5).state.nav.errors.gyro_bias_b << 1e-4, -1e-4, 2e-4;  // found by the whole log
  REQUIRE(log.processes.extend(&log.graph).attitudes == 5);
  REQUIRE(first.has_attitude);
  const EkfCorrection error = difference(first.state, first.prior_at);
  CHECK((error - moved).head<6>().norm() < 1e-6);
  CHECK(error(kClock) == Approx(4.0));
  // Of the IMU's errors the prior knows no more than the configuration.
  CHECK(first.prior_at.nav.errors.gyro_bias_b.norm() == 0.0);
  CHECK(first.prior_at.nav.errors.accel_bias_b.norm() == 0.0);
  for (Index i = 0; i < first.core_size(); ++i)
    if (first.active.core[static_cast<std::size_t>(i)] == kAccelBias)
      CHECK(first.prior_information(i, i) == Approx(1.0 / square(mems().accel_bias.sigma)));
}

TEST_CASE("a filter that has started over in mid-drive costs the log nearly nothing") {
  constexpr int kParted = 15, kEpochs = 30;
  double whole = 0.0, joined = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DriveOptions options;
    options.seed = 400 + seed;
    Log unbroken(options, kEpochs), broken(options, kEpochs, parted_at(kParted));
    REQUIRE(segments(broken.graph) == 2);
    const BatchResult one = unbroken.smoothed(), two = broken.smoothed();
    CHECK(one.extension.joined == 0);
    CHECK(two.extension.joined == 1);
    REQUIRE(segments(broken.graph) == 1);
    CHECK(broken.graph.at(kParted - 1).prior_information.size() == 0);
    for (int k = 0; k < kEpochs; ++k) {
      whole += square(unbroken.error_m(k)) / (10 * kEpochs);
      joined += square(broken.error_m(k)) / (10 * kEpochs);
      const auto i = static_cast<std::size_t>(k);
      // Its ambiguities and clocks begin anew, and an epoch has no measurements.
      const Eigen::VectorXd more = two.last.covariance[i].diagonal().head(9).cwiseQuotient(
          one.last.covariance[i].diagonal().head(9));
      CHECK(more.minCoeff() > 0.95);
    }
  }
  WARN("rms of positions: unbroken " << std::sqrt(whole) << " m, joined " << std::sqrt(joined)
                                     << " m");
  CHECK(std::sqrt(joined) < 1.3 * std::sqrt(whole));
}

TEST_CASE("a filter that has lost its attitude gets it back from before") {
  // The drive twice: aligned from the start, and never; the second takes over at an epoch.
  constexpr int kLost = 10;
  DriveOptions options;
  options.carriers = false;  // the pieces of one graph are not those of the other
  Log aligned(options, 20);
  options.aligned_at = 1000;
  Log log(options, 20, parted_at(kLost));
  for (int k = 0; k < kLost - 1; ++k) log.graph.at(k) = aligned.graph.at(k);
  const BatchResult result = log.smoothed();
  CHECK(result.extension.attitudes == 20 - (kLost - 1));
  CHECK(result.extension.joined == 1);
  for (int k = 0; k < 20; ++k) {
    CAPTURE(k);
    REQUIRE(log.graph.at(k).has_attitude);
    CHECK(normalized(log, result, k, kAttitude, log.attitude_error(k)) < 16.3);  // 99.9 %
  }
}

TEST_CASE("a block that is not complete joins nothing") {
  const Edit lacks_samples = [](KeyframeInput* input) {
    if (input->index != 6) return;
    input->follows_previous = false;
    input->block_complete = false;
    input->block.clear();
  };
  SECTION("where the filter started over") {
    Log log({}, 12, lacks_samples);
    const BatchResult result = log.smoothed();
    CHECK(result.extension.joined == 0);
    CHECK(segments(log.graph) == 2);
    CHECK(log.graph.at(5).prior_information.size() > 0);
  }
  SECTION("before the alignment, where the filter went on") {
    DriveOptions options;
    options.aligned_at = 9;
    options.carriers = GENERATE(false, true);
    Log log(options, 14, [](KeyframeInput* input) {
      if (input->index == 6) input->block_complete = false;
    });
    const LogProcess old = log.graph.at(5).process;
    const BatchResult result = log.smoothed();
    CHECK(result.extension.attitudes == 3);
    CHECK(segments(log.graph) == 1);
    CHECK_FALSE(log.graph.at(4).has_attitude);
    CHECK(log.graph.at(5).has_attitude);
    for (int k = 5; k < 14; ++k)
      CHECK(normalized(log, result, k, kAttitude, log.attitude_error(k)) < 16.3);
    for (int k = 0; k < 5; ++k) {
      const Vector3d error = log.true_at(k).p_e + log.true_at(k).q_eb * log.drive.lever_b() -
                             log.graph.at(k).state.nav.p_e -
                             log.graph.at(k).vertical_antenna_offset_e;
      CHECK(normalized(log, result, k, kPosition, error) < 16.3);
    }
    // Between the two the filter's process goes on.
    const LogProcess& process = log.graph.at(5).process;
    CHECK(process.F.topLeftCorner(6, 6) == old.F.topLeftCorner(6, 6));
  }
  SECTION("where the two are far apart in time") {
    Log log({}, 20, [](KeyframeInput* input) {
      input->valid = input->index < 4 || input->index >= 16;
      if (input->index == 16) input->follows_previous = false;
    });
    REQUIRE(log.graph.size() == 8);
    CHECK(log.processes.extend(&log.graph).joined == 0);
    CHECK(segments(log.graph) == 2);
  }
}

TEST_CASE("however few the iterations, covariances are of the states that the log has") {
  DriveOptions options;
  options.aligned_at = 6;
  Log log(options, 10);
  BatchConfig config;
  config.max_iterations = GENERATE(1, 2, 3);
  const BatchResult result = smooth(
      config, nullptr, &log.processes, [](int, double) {}, &log.graph);
  REQUIRE(result.solved);
  CHECK_FALSE(result.converged);
  CHECK(result.extension.attitudes == (config.max_iterations > 2 ? 5 : 0));
  for (int k = 0; k < log.graph.size(); ++k)
    CHECK(result.last.covariance[static_cast<std::size_t>(k)].rows() ==
          log.graph.at(k).core_size());
}

}  // namespace leonav
