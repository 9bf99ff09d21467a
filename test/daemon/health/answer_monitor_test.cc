// When the watchdog is told that the answer stands still.
#include "daemon/health/answer_monitor.h"

#include "discard.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"

namespace {

using namespace leonav;
using test::Discard;

// An engine that is not started: the test sets its counters, a second at each look.
class Looks {
 public:
  Looks() : engine_(test::drive_config(), &target_), monitor_(&engine_) {
    engine_.counters().satellites_used[0].set(8);
    look(true, true);  // the first answer
  }
  bool look(bool has_input, bool has_answer) {
    EngineCounters& counters = engine_.counters();
    if (has_input) {
      counters.accepted_imu.add(200);
      counters.accepted_epochs.add(1);
    }
    if (has_answer) counters.solution_time_ns.add(1'000'000'000);
    return monitor_.stands_still(true);
  }
  EngineCounters& counters() { return engine_.counters(); }

 private:
  Discard target_;
  Engine engine_;
  AnswerMonitor monitor_;
};

}  // namespace

TEST_CASE("an answer that stands still for a minute while inputs come is found, and not before") {
  Looks looks;
  for (int second = 1; second < 60; ++second) CHECK_FALSE(looks.look(true, false));
  CHECK(looks.look(true, false));
  CHECK_FALSE(looks.look(true, true));  // it goes on
}

TEST_CASE("no answer without inputs or satellites is nothing that a restart mends") {
  Looks silent, blind;
  blind.counters().satellites_used[0].set(0);
  for (int second = 0; second < 200; ++second) {
    CHECK_FALSE(silent.look(false, false));
    CHECK_FALSE(blind.look(true, false));
  }
}
