// Is the smoother's covariance true? Normalized estimation errors squared over 100 runs, as for the
// filter, also after an outage.
#include <cmath>

#include "core/earth/rotation.h"
#include "core/filter/nees.h"
#include "smoother_rig.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;
using namespace ekf_index;

// As kLeastNees3 and kMostNees3, for nine means to be in together: 99.4 % each.
constexpr double kLeastOfNine = 2.36, kMostOfNine = 3.73;

using Errors = Eigen::Matrix<double, 9, 1>;  // position, velocity, attitude

Errors errors_of(const NavState& estimate, const NavState& truth) {
  Errors errors;
  errors << truth.p_e - estimate.p_e, truth.v_e - estimate.v_e,
      rotation_vector_from_quaternion(truth.q_eb * estimate.q_eb.conjugate());
  return errors;
}

// NEES of position, velocity and attitude.
template <typename Covariance>
Eigen::Vector3d nees_of(const Errors& errors, const Covariance& covariance) {
  Eigen::Vector3d each;
  for (int i = 0; i < 3; ++i)
    each(i) = nees(errors.segment<3>(3 * i), covariance.template block<3, 3>(3 * i, 3 * i));
  return each;
}

struct Consistency {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();       // NEES at the end
  Eigen::Vector3d of_filter = Eigen::Vector3d::Zero();  // NEES of the filter there
  double within = 0.0;  // share of the smoother's errors within 3 sigma
  double joined = 0.0;  // arcs by the filter, a drive
};

// `few`: whether an epoch may have too few satellites.
Consistency run(const DriveOptions& base, int window, int epochs, bool few = false) {
  Consistency sum;
  int count = 0;
  for (int i = 0; i < kRuns; ++i) {
    DriveOptions options = base;
    options.seed = 7000u + static_cast<std::uint64_t>(i);
    Drive drive(options);
    const auto smoother = smoother_of(drive, window);
    for (int epoch = 1; epoch <= epochs; ++epoch) {
      const SmootherResult result = solve(drive.step(), smoother.get());
      const bool answered = result.status == SmootherStatus::kOk ||
                            (few && result.status == SmootherStatus::kFewSatellites);
      REQUIRE((epoch == 1 ? result.status == SmootherStatus::kStarted : answered));
      sum.joined += static_cast<double>(drive.result().arcs_joined) / kRuns;
      const Errors errors = errors_of(result.state, drive.truth());
      for (int axis = 0; axis < 9; ++axis) {
        sum.within +=
            std::abs(errors(axis)) <= 3.0 * std::sqrt(result.covariance(axis, axis)) ? 1.0 : 0.0;
        ++count;
      }
      if (epoch < epochs) continue;
      sum.mean += nees_of(errors, result.covariance) / kRuns;
      sum.of_filter +=
          nees_of(errors_of(drive.filter().state(), drive.truth()), drive.filter().covariance()) /
          kRuns;
    }
  }
  sum.within /= count;
  return sum;
}

void report(const char* what, const Consistency& consistency) {
  WARN(what << ": NEES of position, velocity, attitude " << consistency.mean.transpose()
            << " of 3 (the filter's: " << consistency.of_filter.transpose() << "); within 3 sigma "
            << 100.0 * consistency.within << " %");
}

void check(const char* what, const Consistency& consistency, double least = kLeastNees3,
           double most = kMostNees3) {
  report(what, consistency);
  CHECK(consistency.mean.minCoeff() > least);
  CHECK(consistency.mean.maxCoeff() < most);
  CHECK(consistency.within > 0.98);
}

}  // namespace

TEST_CASE("the smoother's errors are as large as its covariance says") {
  DriveOptions options;
  options.arc_epochs = 20;
  options.carriers = GENERATE(false, true);
  options.random_walk = options.carriers ? 0.005 : 0.0;
  check(options.carriers ? "with carriers" : "without carriers", run(options, 10, 30));
}

TEST_CASE("the smoother's errors are as large as its covariance says with LEO satellites") {
  DriveOptions options;
  options.leo = true;
  options.arc_epochs = 20;
  options.carriers = GENERATE(false, true);
  options.random_walk = options.carriers ? 0.005 : 0.0;
  check(options.carriers ? "LEO, with carriers" : "LEO, without carriers", run(options, 10, 30));
}

TEST_CASE("the smoother's errors are as large as its covariance says with joined arcs") {
  DriveOptions options;
  options.arc_epochs = 15;
  options.random_walk = 0.001;
  options.whole_cycles = true;
  // A join allows for the noise of the carriers at both ends, which these ambiguities do not have:
  // sigmas are a little too large.
  const double least = 0.95 * kLeastNees3;
  const Consistency joined = run(options, 10, 40);
  check("with joined arcs", joined, least);
  CHECK(joined.of_filter.minCoeff() > least);
  CHECK(joined.of_filter.maxCoeff() < kMostNees3);
  // Eight satellites have two or three arcs more each.
  WARN(joined.joined << " arcs joined in a drive");
  CHECK(joined.joined > 12.0);
}

TEST_CASE("weights cost the smoother no more than they cost the filter") {
  DriveOptions options;
  options.robust = true;
  check("weighted", run(options, 10, 30), kLeastNees3, 1.085 * kMostNees3);  // as in ekf_nees_test
}

// A heading off by five degrees at the start bends what the first epochs tell of the other states,
// in the filter and in links that are not integrated anew; carriers across an outage show it.
TEST_CASE("the smoother's errors are as large as its covariance says after an outage") {
  DriveOptions options;
  const bool aligned = GENERATE(true, false);
  if (aligned) options.sigma_rpy = {0.005, 0.005, 0.01};
  options.edit = [](int epoch, MeasurementEpoch* measured) {
    if (epoch > 12 && epoch <= 24) remove_satellites([](SatelliteId) { return true; }, measured);
  };
  const int epochs = GENERATE(24, 25, 32);
  // The outage is longer than the window: at its end nothing in that tells a position.
  const Consistency consistency = run(options, 10, epochs, true);
  if (aligned)
    return check(epochs == 24 ? "in an outage" : "after an outage", consistency, kLeastOfNine,
                 kMostOfNine);
  report(epochs == 24 ? "in an outage, badly aligned" : "after an outage, badly aligned",
         consistency);
  for (int i = 0; i < 3; ++i) CHECK(consistency.mean(i) < 1.02 * consistency.of_filter(i));
  CHECK(consistency.within > 0.98);
}

}  // namespace leonav
