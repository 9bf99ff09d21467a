// What of HEALTH the log has.
#include "daemon/supervision/health_log.h"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <sstream>
#include <string>

#include "discard.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"

namespace {

using namespace leonav;

// What is logged while the object lives.
class CaughtLog {
 public:
  explicit CaughtLog(spdlog::level::level_enum level) : usual_(spdlog::default_logger()) {
    const auto logger = std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_st>(text_));
    logger->set_level(level);
    spdlog::set_default_logger(logger);
  }
  ~CaughtLog() { spdlog::set_default_logger(usual_); }
  CaughtLog(const CaughtLog&) = delete;
  CaughtLog& operator=(const CaughtLog&) = delete;

  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::shared_ptr<spdlog::logger> usual_;
};

}  // namespace

TEST_CASE("a fault of HEALTH is logged where reports of normal operation are not") {
  test::Discard target;
  const DaemonConfig config = test::drive_config();
  Engine engine(config, &target);
  HealthMonitor health(&engine, config.navigator);
  health.next("");
  const CaughtLog log(spdlog::level::err);
  HealthLog().look(&health, "", false);
  CHECK(log.text().find("FAULT: no solution yet (no GNSS has come") != std::string::npos);
}
