// Are the covariances of a smoothed log true? Normalized estimation errors squared over many
// drives, as for the filter and the window.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/earth/rotation.h"
#include "core/filter/nees.h"
#include "core/smoother/batch/batch_smoother.h"
#include "core/smoother/drive_rig.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;
using namespace ekf_index;
using Eigen::Index;
using Eigen::Vector3d;

constexpr int kDrives = 40, kEpochs = 30;
// 120 degrees over 40, for nine means to be in together: 99.4 % each (Wilson-Hilferty).
constexpr double kLeast = 2.03, kMost = 4.19;

struct Consistency {
  // Rows: near the start, in the middle, at the end; columns: position, velocity, attitude.
  Eigen::Matrix3d nees = Eigen::Matrix3d::Zero();
  double within = 0.0;                    // share of the errors within 3 sigma
  double rms_m = 0.0, of_filter_m = 0.0;  // of positions, all epochs
};

Consistency run(const DriveOptions& base, bool inertial_factors) {
  constexpr std::array<int, 3> kLooked = {3, 15, kEpochs - 1};
  const Index parts = base.inertial ? 3 : 2;
  Consistency sum;
  sum.nees.setConstant(base.inertial ? 0.0 : 3.0);  // where there is no attitude
  sum.nees.leftCols(parts).setZero();
  for (int i = 0; i < kDrives; ++i) {
    DriveOptions options = base;
    options.seed = 9000u + static_cast<std::uint64_t>(i);
    Drive drive(options);
    LogGraph graph(drive.lever_b());
    std::vector<NavState> truth;
    for (int k = 0; k < kEpochs; ++k) {
      graph.add(drive.step());
      truth.push_back(drive.truth());
      if (!options.inertial) {
        truth.back().p_e = drive.antenna().p_antenna_e;
        truth.back().v_e = drive.antenna().v_antenna_e;
      }
      sum.of_filter_m += (drive.filter().state().p_e - truth.back().p_e).squaredNorm();
    }
    LogProcesses processes({drive.config(), mems(), Drive::motion()});
    BatchConfig config;
    config.robust.enabled = options.robust;
    const BatchResult result = smooth(
        config, nullptr, inertial_factors ? &processes : nullptr, [](int, double) {}, &graph);
    REQUIRE(result.converged);
    for (int k = 0; k < kEpochs; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const NavState& estimate = graph.at(k).state.nav;
      Eigen::Matrix<double, 9, 1> error;
      error << truth[at].p_e - estimate.p_e, truth[at].v_e - estimate.v_e,
          rotation_vector_from_quaternion(truth[at].q_eb * estimate.q_eb.conjugate());
      const Eigen::MatrixXd& P = result.last.covariance[at];
      sum.rms_m += error.head<3>().squaredNorm();
      for (Index axis = 0; axis < 3 * parts; ++axis)
        sum.within += std::abs(error(axis)) <= 3.0 * std::sqrt(P(axis, axis)) ? 1.0 : 0.0;
      const auto looked = std::find(kLooked.begin(), kLooked.end(), k);
      if (looked == kLooked.end()) continue;
      for (Index part = 0; part < parts; ++part)
        sum.nees(looked - kLooked.begin(), part) +=
            nees(error.segment<3>(3 * part), P.block<3, 3>(3 * part, 3 * part)) / kDrives;
    }
  }
  constexpr int kEach = kDrives * kEpochs;
  sum.within /= static_cast<double>(3 * parts * kEach);
  sum.rms_m = std::sqrt(sum.rms_m / kEach);
  sum.of_filter_m = std::sqrt(sum.of_filter_m / kEach);
  return sum;
}

void check(const char* what, const Consistency& consistency) {
  WARN(what << ": NEES of position, velocity, attitude near the start, in the middle, at the end:\n"
            << consistency.nees << "\nof 3; within 3 sigma " << 100.0 * consistency.within
            << " %; rms of positions " << consistency.rms_m << " m, of the filter's "
            << consistency.of_filter_m << " m");
  CHECK(consistency.nees.minCoeff() > kLeast);
  CHECK(consistency.nees.maxCoeff() < kMost);
  CHECK(consistency.within > 0.99);
  CHECK(consistency.rms_m < 0.8 * consistency.of_filter_m);
}

}  // namespace

TEST_CASE("the errors of a smoothed log are as large as its covariances say") {
  DriveOptions options;
  options.arc_epochs = 20;
  options.carriers = GENERATE(false, true);
  options.random_walk = options.carriers ? 0.005 : 0.0;
  check(options.carriers ? "with carriers" : "without carriers", run(options, true));
}

TEST_CASE("the errors of a smoothed log are as large as its covariances say, in an outage too") {
  DriveOptions options;
  options.sigma_rpy = {0.005, 0.005, 0.01};
  options.edit = [](int epoch, MeasurementEpoch* measured) {
    if (epoch > 11 && epoch <= 21) remove_satellites([](SatelliteId) { return true; }, measured);
  };
  check("in an outage", run(options, true));
}

TEST_CASE("the errors of a log without an IMU are as large as its covariances say") {
  DriveOptions options;
  options.inertial = false;
  options.carriers = false;
  check("constant velocity", run(options, false));
}

}  // namespace leonav
