// The window's own solver against dense least squares and against the filter.
#include "core/smoother/rts_solver.h"

#include <Eigen/Core>
#include <memory>

#include "core/smoother/smoother.h"
#include "drive_rig.h"
#include "support/catch.h"
#include "window_rig.h"

namespace leonav {
namespace {

using namespace synthetic;

struct Apart {
  double dense = 0.0;              // of all keyframes, the chain's step from the dense one
  double covariance = 0.0;         // of the newest, the chain's from the dense one
  double oldest = 0.0;             // covariance of the oldest pose, in correlations
  double filter = 0.0;             // of the newest, the chain's state from the filter's
  double filter_covariance = 0.0;  // of the newest, the chain's from the filter's
};

// A window over a whole drive.
Apart compare(const DriveOptions& options, int epochs) {
  Drive drive(options);
  Window window(epochs);
  for (int i = 0; i < epochs; ++i) {
    const bool follows_previous = feed(drive.step(), drive.lever_b(), &window);
    REQUIRE(follows_previous == (i > 0));
  }
  RtsSolver chain(epochs);
  const auto corrections = std::make_unique<WindowCorrections>();
  REQUIRE(chain.solve(window, drive.lever_b(), corrections.get()));
  const DenseStep dense = dense_step(window, drive.lever_b());
  Apart apart;
  apart.dense = apart_in_sigmas(*corrections, dense);
  EkfCovariance covariance;
  chain.newest_covariance(&covariance);
  const Eigen::Index n = covariance.rows();
  apart.covariance = apart_in_correlations(covariance, dense.covariance.bottomRightCorner(n, n));
  // Position and velocity, and the attitude where there is one, are its first states.
  PoseCovariance pose;
  chain.oldest_covariance(window, &pose);
  const Eigen::Index poses = options.inertial ? kPoseStates : 6;
  apart.oldest = apart_in_correlations(pose.topLeftCorner(poses, poses),
                                       dense.covariance.topLeftCorner(poses, poses));
  apply(*corrections, &window);
  const Ekf& filter = drive.filter();
  apart.filter = apart_in_sigmas(window.newest().state, filter.filter_state(), filter.covariance());
  const ActiveStates& active = window.newest().active;
  Eigen::MatrixXd of_filter(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    EkfCorrection column =
        filter.covariance().col(i < active.core_size() ? active.core[static_cast<std::size_t>(i)]
                                                       : ekf_index::kSize + i - active.core_size());
    of_filter.col(i) = active_part(active, column);
  }
  apart.filter_covariance = apart_in_correlations(covariance, of_filter);
  return apart;
}

void report(const char* what, const Apart& apart) {
  WARN(what << ": from dense least squares " << apart.dense << " sigma, covariance "
            << apart.covariance << ", oldest " << apart.oldest << "; from the filter "
            << apart.filter << " sigma, covariance " << apart.filter_covariance);
}

}  // namespace

TEST_CASE("a linear window is the batch least squares and the filter") {
  // So noisy that metres are sigmas, and hardly any noise drawn: ranges are straight lines. What is
  // left of their bend turns the covariance first, the state second.
  DriveOptions options;
  options.inertial = false;
  options.carriers = false;
  options.code_sigma = 30.0;
  options.doppler_sigma = 2.0;
  options.noise = GENERATE(1e-3, 1e-5);
  const Apart apart = compare(options, 40);
  report("constant velocity", apart);
  CHECK(apart.dense < 1e-9);
  CHECK(apart.covariance < 1e-9);
  CHECK(apart.oldest < 1e-9);
  CHECK(apart.filter < 1e-9);
  CHECK(apart.filter_covariance < (options.noise < 1e-4 ? 1e-9 : 1e-7));
}

TEST_CASE("an inertial window with carriers is the batch least squares and the filter") {
  // What is not a straight line turns the covariance in proportion to the noise.
  DriveOptions options;
  options.noise = GENERATE(1e-3, 1e-5);
  options.random_walk = GENERATE(0.0, 1e-3, 0.02);
  const int epochs = GENERATE(2, 10, 30);
  const Apart apart = compare(options, epochs);
  CAPTURE(options.noise, options.random_walk, epochs);
  report("inertial with carriers", apart);
  CHECK(apart.dense < 1e-9);
  CHECK(apart.covariance < 3e-8);  // what the dense one's floor under the noise leaves
  CHECK(apart.oldest < 1e-6);      // the floor again, of more keyframes
  CHECK(apart.filter < 1e-6);
  CHECK(apart.filter_covariance < 0.03 * options.noise + 1e-7);
}

TEST_CASE("a window with joined arcs is the batch least squares") {
  DriveOptions options;
  options.noise = 1e-3;
  options.random_walk = GENERATE(0.0, 1e-3);
  options.joined = true;
  const Apart apart = compare(options, 20);
  report("joined arcs", apart);
  CHECK(apart.dense < 1e-9);
  CHECK(apart.covariance < 3e-8);
  CHECK(apart.oldest < 1e-6);
  CHECK(apart.filter_covariance > 0.1);  // the filter knows nothing of the joins
}

}  // namespace leonav
