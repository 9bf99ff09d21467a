// leonav-smooth estimates a whole log at once: every epoch from all measurements before and after.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "core/smoother/batch/batch_smoother.h"
#include "core/smoother/ceres/log_ceres.h"
#include "daemon/config/effective_config.h"
#include "daemon/process/one_blas_thread.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_log.h"
#include "tools/common/configuration_options.h"
#include "tools/common/progress_bar.h"
#include "tools/replay/configuration.h"
#include "tools/replay/journal_scan.h"
#include "tools/smooth/keyframe_collector.h"
#include "tools/smooth/result_tables.h"
#include "tools/smooth/smooth_report.h"
#include "tools/smooth/solver_choice.h"

namespace {

using namespace leonav;

// OpenBLAS would have started its threads by main(): they take time and change the last bits.
__attribute__((section(".preinit_array"), used)) const auto kBeforeLibraries =
    start_with_one_blas_thread;

constexpr double kPassShare = 0.3;  // of the work, roughly: the pass of the filter

Arguments declare() {
  Arguments arguments(
      "leonav-smooth", "[--config FILE | --preset NAME] --out DIR [options] run.lcmlog",
      "Estimates a whole log at once: every epoch from all measurements before and after it. It is "
      "for\npost-processing, and the reference where a log has no truth. The filter runs over the "
      "log once; then\nall its epochs are one least-squares problem, with robust weights decided "
      "anew at every iteration. With\nan IMU also epochs before the alignment get an attitude, and "
      "outages and restarts of the filter are\nbridged from both sides. A journal holds its own "
      "configuration, which is the default.\nWrites solution.csv (smoothed, with sigmas), "
      "forward.csv (from what came before each epoch alone),\nresiduals.csv, summary.txt and "
      "configuration.yaml; `leonav-eval` and `leonav-report` read them.\nExit codes: 0 done; 1 a "
      "file or the configuration cannot be used, or the log has no solution; 2 command\nline.");
  add_configuration_options(&arguments);
  arguments.option("--out", "DIR", "folder for the tables")
      .option("--rate", "HZ",
              "rows of solution.csv at this rate instead of one per epoch; at most the IMU's")
      .option("--interval", "SECONDS",
              "smallest interval of the epochs used; 0: all. For long logs at high rates", "0")
      .option(
          "--solver", "NAME",
          "ceres; chain: forward and backward passes, faster, in less memory; or auto: ceres where "
          "half of the free memory\n                   is enough for it and the log has at most "
          "three million measurements, else chain",
          "auto")
      .option("--iterations", "N", "at most", "20");
  return arguments;
}

double number_within(const Arguments& arguments, const std::string& name, double least,
                     double most) {
  const double value = arguments.number(name);
  if (value >= least && value <= most) return value;
  std::ostringstream text;
  text << name << ": must be " << least << " to " << most;
  throw UsageError(text.str());
}

int whole_number_within(const Arguments& arguments, const std::string& name, int least, int most) {
  const double value = number_within(arguments, name, least, most);
  if (value != std::floor(value)) throw UsageError(name + ": must be a whole number");
  return static_cast<int>(value);
}

std::string solver_name(const Arguments& arguments) {
  std::string name = arguments.get("--solver");
  if (name != "ceres" && name != "chain" && name != "auto")
    throw UsageError("--solver: must be auto, ceres or chain");
  return name;
}

LogSolver solver_of(const std::string& name) {
  if (name == "chain") return nullptr;
  return [](const LogGraph& graph, LogCorrections* corrections) {
    LogCeresSummary summary;
    if (solve_by_ceres(graph, {}, corrections, &summary)) return true;
    std::cerr << "leonav-smooth: Ceres: " << summary.message << "\n";
    return false;
  };
}

// Feeds the log to the filter, which leaves its keyframes in the graph. Returns what it has met.
PassCounts collect(const std::string& log, const DaemonConfig& config, ProgressBar* bar,
                   LogGraph* graph) {
  KeyframeCollector collector(config.navigator, graph);
  EventLogReader reader(log);
  LogEvent event;
  while (reader.next(&event)) {
    const auto channel = channel_from_name(event.channel, config.lcm.prefix);
    if (channel && is_input(*channel)) collector.dispatch(*channel, event.data);
    bar->show(kPassShare * static_cast<double>(reader.position_bytes()) /
              static_cast<double>(reader.size_bytes()));
  }
  return collector.counts();
}

void require_inputs(const JournalScan& scan, const std::string& log, const std::string& prefix) {
  if (scan.messages[index_of(Channel::kGnssEpoch)] > 0) return;
  throw std::runtime_error(log + ": no " + prefix + "GNSS_EPOCH (" + scan.describe() + "; " +
                           std::to_string(scan.other_messages) +
                           " messages on other channels); is lcm.prefix right?");
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

int run(int argc, char** argv) {
  Arguments arguments = declare();
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() != 1) throw UsageError("expected one log file");
  const std::string log = arguments.positional().front(), out = arguments.required("--out");
  std::optional<double> rate_hz;
  if (arguments.has("--rate")) rate_hz = number_within(arguments, "--rate", 0.001, 1000.0);
  BatchConfig batch;
  batch.max_iterations = whole_number_within(arguments, "--iterations", 1, 1000);
  const double interval_s = number_within(arguments, "--interval", 0.0, 3600.0);
  SolverChoice solver{solver_name(arguments), "as asked for"};
  auto [config, origin, other_run] = choose_configuration(log, arguments);
  NavigatorConfig& navigator = config.navigator;
  navigator.smoother.keyframe_interval_s = interval_s;
  batch.robust = navigator.ekf.robust;

  const JournalScan scan = scan_journal(log, config.lcm.prefix);
  require_inputs(scan, log, config.lcm.prefix);
  std::filesystem::create_directories(out);
  // Nothing is written before the result is there: tables of an earlier run keep their
  // configuration if this one fails.
  if (::access(out.c_str(), W_OK) != 0) throw std::runtime_error(out + ": cannot be written");
  LogGraph graph(navigator.vehicle.lever_arm_b);
  BatchResult result;
  PassCounts pass;
  {
    ProgressBar bar(&std::cerr, "leonav-smooth", is_stderr_terminal());
    pass = collect(log, config, &bar, &graph);
    if (graph.size() < 2)
      throw std::runtime_error(log + ": the filter found no position in the log (" +
                               scan.describe() + "); leonav-replay tells why");
    LogProcesses processes({navigator.ekf, navigator.imu, navigator.vehicle.motion.constraints});
    const bool inertial = navigator.motion == MotionModel::kInertial;
    const auto progress = [&](int iteration, double share) {
      // Most logs need half a dozen iterations; what is left shrinks with each.
      bar.show(1.0 - (1.0 - kPassShare) * std::pow(0.7, iteration + share));
    };
    if (solver.name == "auto") solver = choose_solver(measurements_of(graph), available_memory());
    result =
        smooth(batch, solver_of(solver.name), inertial ? &processes : nullptr, progress, &graph);
  }
  if (!result.solved) throw std::runtime_error(log + ": the epochs have no unique solution");

  std::ostringstream summary;
  summary << "configuration: " << origin << "\nsolver: " << solver.name << " (" << solver.reason
          << ")\n";
  if (!other_run.empty()) summary << "note: " << other_run << "\n";
  summary << "epochs of the log: " << pass.epochs << "\nrestarts of the filter: " << pass.resets
          << "\n";
  print_smoothed(graph, result, summary);
  write_text(out + "/configuration.yaml", effective_text(config.source));
  const long rows = write_solution(out + "/solution.csv", graph, result, rate_hz);
  write_forward(out + "/forward.csv", graph, result);
  write_residuals(out + "/residuals.csv", graph);
  summary << "solution.csv rows: " << rows << "\n";
  std::vector<std::string> warnings = smoothing_warnings(graph, result);
  if (scan.truncated) warnings.push_back(log + ": its last message is cut short");
  for (const std::string& warning : warnings) {
    summary << "warning: " << warning << "\n";
    std::cerr << "leonav-smooth: WARNING: " << warning << "\n";
  }
  std::cout << summary.str();
  write_text(out + "/summary.txt", summary.str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-smooth", run, argc, argv); }
