// leonav-stops measures where the standstill detector was right, wrong, or missed a stop, on a
// recorded run.
#include <iostream>
#include <stdexcept>

#include "daemon/messages/input_dispatch.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_log.h"
#include "tools/common/arguments.h"
#include "tools/common/configuration_options.h"
#include "tools/common/progress_bar.h"
#include "tools/stops/standstill_evaluation.h"

namespace {

using namespace leonav;

constexpr int kFalse = 3;  // exit code

Arguments declare() {
  Arguments arguments(
      "leonav-stops", "--config FILE --truth truth.csv [options] run.lcmlog",
      "Runs the filter over a log and holds the instants at which it took the vehicle for standing "
      "\nagainst the truth: false declarations, missed stops. Exit codes: 0 none was false; 1 a "
      "file\ncannot be used; 2 command line; 3 some were false.");
  add_configuration_options(&arguments);
  arguments
      .option("--truth", "FILE",
              "truth.csv with velocity, ten rows a second: what lies between rows is a guess")
      .option("--still", "M_S", "no declaration below this speed is false", "0.06");
  return arguments;
}

int run(int argc, char** argv) {
  Arguments arguments = declare();
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() != 1) throw UsageError("expected one log file");
  StopsConfig judged;
  judged.still_m_s = arguments.number("--still");
  if (!(judged.still_m_s > 0.0 && judged.still_m_s < judged.creep_m_s))
    throw UsageError("--still: must be above 0 and below 0.3");
  const DaemonConfig config = load_configuration(arguments);
  if (!config.navigator.vehicle.motion.constraints.zero_velocity)
    throw std::runtime_error(
        "vehicle.zero_velocity is off: nothing asks whether it stands; --set vehicle.kind=car");
  const Track truth = load_truth(arguments.required("--truth"));
  StopsRecorder recorder;
  Navigator navigator(config.navigator, &recorder);
  InputDispatch dispatch(&navigator.sequencer());
  EventLogReader log(arguments.positional().front());
  LogEvent event;
  ProgressBar progress(&std::cerr, "leonav-stops", is_stderr_terminal());
  while (log.next(&event)) {
    progress.show(static_cast<double>(log.position_bytes()) /
                  static_cast<double>(log.size_bytes()));
    const auto channel = channel_from_name(event.channel, config.lcm.prefix);
    if (channel && is_input(*channel)) dispatch.dispatch(*channel, event.data);
  }
  const StopsResult result = evaluate_stops(recorder.asked(), truth, judged);
  if (result.asked == 0)
    throw std::runtime_error(
        "the detector was never asked: did the run align, and is the truth of this log, with "
        "velocity?");
  print_stops(result, judged, std::cout);
  return result.wrong.empty() ? 0 : kFalse;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-stops", run, argc, argv); }
