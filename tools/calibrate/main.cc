// leonav-calibrate finds lever arm, mounting and time offset of an IMU from a log.
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "daemon/process/one_blas_thread.h"
#include "tools/calibrate/print_calibration.h"
#include "tools/common/arguments.h"
#include "tools/common/configuration_options.h"
#include "tools/common/progress_bar.h"

namespace {

using namespace leonav;

// OpenBLAS would have started its threads by main(): they take time and change the last bits.
__attribute__((section(".preinit_array"), used)) const auto kBeforeLibraries =
    start_with_one_blas_thread;

Arguments declare() {
  Arguments arguments(
      "leonav-calibrate", "--config FILE [options] run.lcmlog",
      "Finds from a recorded drive how the IMU is built in, and prints the lines for the\n"
      "configuration, each with its sigma: the antenna's lever arm (it takes turns; its height\n"
      "takes tilting), on wheels (vehicle.kind car, rail) the mounting (pitch and yaw by the\n"
      "direction of travel, roll as the vehicle's mean lean: half a degree), and how much later\n"
      "than stamped the IMU measures (it takes changes of speed). What the log does not show is\n"
      "named. Runs the filter over the log and smooths the whole, again and again, each time with\n"
      "what it has found, until nothing changes. Good for mounting errors of up to 10 degrees and\n"
      "time offsets of up to 0.1 s. Exit codes: 0 done; 1 a file cannot be used, the filter found\n"
      "no attitude, nothing was observed, or the passes did not settle; 2 command line.");
  add_configuration_options(&arguments);
  arguments.option("--passes", "N", "over the log, at most", "6")
      .option("--json", "FILE", "what was found, for programs");
  return arguments;
}

int run(int argc, char** argv) {
  Arguments arguments = declare();
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() != 1) throw UsageError("expected one log file");
  const double passes = arguments.number("--passes");
  if (!(passes >= 1.0 && passes <= 50.0)) throw UsageError("--passes: must be 1 to 50");
  const DaemonConfig config = load_configuration(arguments);
  CalibrateOptions options;
  options.max_passes = static_cast<int>(passes);
  // The file is opened before the run, so that a missing folder does not cost the run.
  std::ofstream json;
  if (arguments.has("--json")) {
    json.open(arguments.get("--json"));
    if (!json) throw std::runtime_error(arguments.get("--json") + ": cannot be written");
  }
  CalibrationResult found;
  {
    ProgressBar progress(&std::cerr, "leonav-calibrate", is_stderr_terminal());
    options.progress = [&](double share) { progress.show(share); };
    found = calibrate(config, arguments.positional().front(), options);
  }
  print_calibration(found, std::cout);
  if (json.is_open()) {
    json << json_of(found);
    json.close();
    if (!json) throw std::runtime_error(arguments.get("--json") + ": cannot be written");
  }
  if (!found.settled)
    throw std::runtime_error("the passes did not settle: what was found is not to be relied on");
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-calibrate", run, argc, argv); }
