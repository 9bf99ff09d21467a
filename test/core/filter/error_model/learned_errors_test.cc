// What LearnedErrors says before it has learned anything, and where nothing is to be learned.
#include "core/filter/error_model/learned_errors.h"

#include "error_model/code_class.h"
#include "support/catch.h"

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
  CHECK(moving.code.correlation_time_s == 7.0);
  CHECK(standing.code.correlation_time_s == errors.correlation(code_class(0, kStanding)).time_s);
  CHECK(moving.doppler.correlation_time_s > 0.0);
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

}  // namespace
}  // namespace leonav
