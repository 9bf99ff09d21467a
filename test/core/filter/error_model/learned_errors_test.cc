// What LearnedErrors says before it has learned anything, where nothing is to be learned, and what
// it learns from errors of known size and correlation.
#include "core/filter/error_model/learned_errors.h"

#include <Eigen/Core>
#include <random>

#include "error_model/code_class.h"
#include "error_model/code_epoch.h"
#include "support/catch.h"
#include "support/dense/dense_algebra.h"
#include "support/start_time.h"

namespace leonav {
namespace {

using test::code_class;

constexpr std::size_t kMoving = 0, kStanding = 1;

TEST_CASE(
    "a configured correlation time is kept, and lasts longer in front of a standing vehicle") {
  EkfConfig config;
  config.code_correlation_time_s = 7.0;
  const LearnedErrors errors(config);
  CHECK(errors.correlation(code_class(0, kMoving)).time_s == 7.0);
  CHECK(errors.correlation(code_class(0, kStanding)).time_s > 7.0);
  const LearnedSummary moving = errors.summary(false), standing = errors.summary(true);
  CHECK(moving.learned);
  CHECK(moving.code.all.correlation_time_s == 7.0);
  CHECK(standing.code.all.correlation_time_s ==
        errors.correlation(code_class(0, kStanding)).time_s);
  CHECK(moving.doppler.all.correlation_time_s > 0.0);
}

TEST_CASE("nothing configured, errors still last for some seconds and are not taken as small") {
  const LearnedErrors errors((EkfConfig()));
  CHECK(errors.correlation(code_class(0, kMoving)).time_s > 1.0);
  CHECK(errors.sigma_scale(code_class(0, kMoving)) > 1.0);
  CHECK(errors.carrier_correlation(0.0).time_s > errors.carrier_correlation(20.0).time_s);
  CHECK(errors.carrier_correlation(20.0).time_s > 0.0);
}

TEST_CASE("without learning errors are as configured") {
  EkfConfig config;
  config.learn_errors = false;
  const LearnedErrors errors(config);
  CHECK_FALSE(errors.summary(false).learned);
  CHECK(errors.sigma_scale(code_class(0, kMoving)) == 1.0);
  CHECK(errors.correlation(code_class(0, kMoving)).time_s == 0.0);
  CHECK(errors.carrier_correlation(0.0).share == 0.0);
}

// Errors of codes, once a second: white noise plus Gauss-Markov processes, `times` their sigmas.
class CodeErrors {
 public:
  CodeErrors(int satellites, double times, double share, double time_s)
      : times_(times), share_(share), keep_(std::exp(-1.0 / time_s)), lasting_(satellites) {
    for (double& error : lasting_) error = normal_(bits_);
  }
  const Eigen::VectorXd& next() {
    errors_.resize(lasting_.size());
    for (Eigen::Index i = 0; i < errors_.size(); ++i) {
      lasting_(i) = keep_ * lasting_(i) + std::sqrt(1.0 - keep_ * keep_) * normal_(bits_);
      const double error =
          std::sqrt(share_) * lasting_(i) + std::sqrt(1.0 - share_) * normal_(bits_);
      errors_(i) = times_ * error;
    }
    return errors_;
  }

 private:
  double times_, share_, keep_;
  std::mt19937_64 bits_{11};
  std::normal_distribution<double> normal_;
  Eigen::VectorXd lasting_, errors_;
};

// Where the filter is, from the rows of codes and their errors.
using Position = std::function<Eigen::Vector3d(const Eigen::MatrixXd&, const Eigen::VectorXd&)>;

Position fixed(const Eigen::Vector3d& off) {
  return [off](const Eigen::MatrixXd&, const Eigen::VectorXd&) { return off; };
}

// Follows the codes: less the position that fits them best, so that innovations show nothing of it.
Eigen::Vector3d followed(const Eigen::MatrixXd& rows, const Eigen::VectorXd& errors) {
  return -dense::least_squares(rows, errors).solution.head<3>();
}

// Drives `errors` by minutes of codes; the filter takes its position as known to `position_sigma`.
void drive(int seconds, CodeErrors* from, const Position& position, double position_sigma,
           LearnedErrors* errors, int satellites = 16) {
  const MeasurementEpoch epoch = test::sky_of(satellites);
  const auto scaled_sigma = [&](std::size_t i) {
    return errors->sigma_scale(errors->class_of(epoch.measurements[i], epoch.satellites[i], false));
  };
  const FilterMeasurements plain = test::codes_of(
      epoch, [](std::size_t) { return 0.0; }, [](std::size_t) { return 1.0; });
  Eigen::MatrixXd rows(satellites, 5);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    rows.row(i)
        << plain[static_cast<std::size_t>(i)].row.segment<3>(ekf_index::kPosition).transpose(),
        plain[static_cast<std::size_t>(i)].row.segment<2>(ekf_index::kClock).transpose();
  const Eigen::Matrix4d covariance = test::known_of(position_sigma);
  for (int t = 0; t < seconds; ++t) {
    MeasurementEpoch now = epoch;
    now.time = test::kAnyTime.plus_seconds(t);
    const Eigen::VectorXd& drawn = from->next();
    const FilterMeasurements codes = test::codes_of(
        now, [&](std::size_t i) { return drawn(static_cast<Eigen::Index>(i)); }, scaled_sigma,
        position(rows, drawn));
    errors->add_codes(now, codes, covariance, {}, true);
    errors->end_epoch(now.time, true);
  }
}

TEST_CASE("the size of codes' errors is learned although the filter's position is wrong") {
  for (const double times : {1.5, 3.0, 6.0}) {
    LearnedErrors errors((EkfConfig()));
    CodeErrors drawn(16, times, 0.0, 1.0);
    drive(240, &drawn, fixed({12.0, -9.6, 12.8}), 4.0, &errors);
    CAPTURE(times);
    for (std::size_t elevation = 0; elevation < kElevationClasses; ++elevation)
      CHECK(errors.sigma_scale(code_class(elevation)) == Approx(times).epsilon(0.2));
  }
}

TEST_CASE("the size of codes' errors is learned although the filter has followed them") {
  for (const double sigma : {0.5, 4.0}) {
    LearnedErrors errors((EkfConfig()));
    CodeErrors drawn(16, 4.0, 0.9, 20.0);
    drive(240, &drawn, followed, sigma, &errors);
    CAPTURE(sigma);
    for (std::size_t elevation = 0; elevation < kElevationClasses; ++elevation)
      CHECK(errors.sigma_scale(code_class(elevation)) == Approx(4.0).epsilon(0.2));
  }
}

TEST_CASE("how long errors of codes last is learned, be the position wrong or following them") {
  struct Case {
    const char* name;
    Position position;
  };
  for (const Case& of : {Case{"right", fixed(Eigen::Vector3d::Zero())},
                         {"wrong", fixed({12.0, -9.6, 12.8})},
                         {"following", followed}}) {
    for (const double time_s : {8.0, 24.0}) {
      EkfConfig config;
      config.code_correlation_time_s = 1.0;
      LearnedErrors errors(config);
      CodeErrors drawn(16, 3.0, 0.9, time_s);
      drive(480, &drawn, of.position, 4.0, &errors);
      const double expected = variance_inflation({0.9, time_s}, 1.0);
      const CorrelationModel& model = errors.correlation(code_class(1));
      CAPTURE(of.name, time_s, model.share, model.time_s, expected);
      CHECK(variance_inflation(model, 1.0) < 1.5 * expected);
      CHECK(variance_inflation(model, 1.0) > 0.6 * expected);
    }
  }
}

TEST_CASE("what the position is off is no lasting error of codes") {
  EkfConfig config;
  config.code_correlation_time_s = 1.0;
  LearnedErrors errors(config);
  CodeErrors drawn(16, 2.0, 0.0, 1.0);
  drive(240, &drawn, fixed({12.0, -9.6, 12.8}), 4.0, &errors);
  CHECK(variance_inflation(errors.correlation(code_class(1)), 1.0) <
        1.2 * variance_inflation({0.9, 1.0}, 1.0));
}

TEST_CASE("four satellites teach nothing") {
  LearnedErrors errors((EkfConfig()));
  const double before = errors.sigma_scale(code_class(1));
  CodeErrors drawn(4, 10.0, 0.0, 1.0);
  drive(60, &drawn, fixed(Eigen::Vector3d::Zero()), 1.0, &errors, 4);
  CHECK(errors.sigma_scale(code_class(1)) == before);
}

// Its velocity then contains the errors that are to be seen.
TEST_CASE("a filter that is still uncertain of its velocity learns no correlation of Dopplers") {
  const auto learned = [](double predicted_variance, bool any = true) {
    LearnedErrors errors((EkfConfig()));
    MeasurementEpoch epoch = test::sky_of(16);
    for (Measurement& doppler : epoch.measurements) doppler.observable = Observable::kDoppler;
    const FilterMeasurements dopplers = test::codes_of(
        epoch, [](std::size_t) { return 0.0; }, [](std::size_t) { return 1.0; });
    for (int t = 0; t < 240; ++t) {
      ClockRemovedInnovations innovations;
      for (std::size_t i = 0; any && i < dopplers.size(); ++i)
        innovations.push_back({i, i % 2 == 0 ? 1.0 : -1.0, 1.0 + predicted_variance, 1.0});
      epoch.time = test::kAnyTime.plus_seconds(t);
      errors.add_dopplers(epoch, dopplers, innovations, false);
      errors.end_epoch(epoch.time, true);
    }
    ErrorClass of = code_class(1);
    of.observable = static_cast<std::size_t>(Observable::kDoppler);
    return errors.correlation(of).time_s;
  };
  const double of_nothing_s = learned(0.0, false);
  CHECK(learned(0.5) == of_nothing_s);
  CHECK(learned(0.05) > 10.0 * of_nothing_s);
}

}  // namespace
}  // namespace leonav
