// When a drill is on, and that it is told.
#include "daemon/engine/drill.h"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <sstream>
#include <string>

#include "support/catch.h"

namespace {

using namespace leonav;

struct Drill {
  bool delays;
  std::string log;
};

Drill drill_of(const DaemonConfig& config) {
  std::ostringstream log;
  const auto usual = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "test", std::make_shared<spdlog::sinks::ostream_sink_st>(log)));
  const bool delays = drill_hooks(config).before_iteration != nullptr;
  spdlog::set_default_logger(usual);
  return {delays, log.str()};
}

}  // namespace

TEST_CASE("a drill of the smoother is on, and told, where there is a smoother") {
  DaemonConfig config;
  config.navigator.estimator = Estimator::kSmoother;
  CHECK_FALSE(drill_of(config).delays);
  CHECK(drill_of(config).log.empty());
  config.drill.late_solve_every = 3;
  config.navigator.smoother.drill_failure_every = 5;
  const Drill drill = drill_of(config);
  CHECK(drill.delays);
  CHECK(drill.log.find("at every 3. epoch") != std::string::npos);
  CHECK(drill.log.find("fails at every 5. epoch") != std::string::npos);
  config.navigator.estimator = Estimator::kEkf;
  CHECK_FALSE(drill_of(config).delays);
  CHECK(drill_of(config).log.empty());
}
