// leonav-sim turns a scenario into measurements as a vehicle would have recorded them.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/angle.h"
#include "tools/common/arguments.h"
#include "tools/common/format.h"
#include "tools/import/log_output.h"
#include "tools/sim/overlay/overlay.h"
#include "tools/sim/run/simulate.h"
#include "tools/sim/run/sky_statistics.h"
#include "tools/sim/scenario/scenario_yaml.h"

namespace {

using leonav::Arguments;
using leonav::kDegree;
using leonav::UsageError;

Arguments declare() {
  Arguments arguments(
      "leonav-sim",
      "scenario.yaml -o run.lcmlog [options]\n       leonav-sim --sky-statistics scenario.yaml",
      "Simulates a drive: IMU, GNSS and LEO satellites, products and truth, as a vehicle would\n"
      "have recorded them. The same scenario and seed give the same files. With --overlay the\n"
      "drive is a recorded one, of which the scenario's LEO satellites are received too and the\n"
      "satellites of its outages are not.");
  arguments.option("--out", "FILE", "the log to write; -o for short")
      .option("--truth", "FILE", "truth.csv to write; default: beside the log")
      .option("--overlay", "LOG", "the recorded log; --truth is then its truth, to be read")
      .option("--export", "DIR", "the run as RINEX, SP3, clock, ANTEX and CSV files too")
      .flag("--leo-as-gps", "with --export: low satellites in the files, under names of GPS")
      .option("--seed", "N", "instead of the scenario's")
      .flag("--sky-statistics", "only print how many satellites are seen, and their PDOP")
      .option("--mask", "DEG", "with --sky-statistics: the elevation they count from", "15")
      .option("--step", "S", "with --sky-statistics: the interval of its epochs", "10")
      .option("--set", "KEY=VALUE", "a key of the scenario, may be repeated");
  return arguments;
}

// Refuses options that have no meaning because of another option.
void refuse_ignored_options(const Arguments& arguments) {
  using Names = std::initializer_list<const char*>;
  const auto refuse = [&arguments](Names options, const std::string& why) {
    for (const char* option : options) {
      if (arguments.has(option)) throw UsageError(option + why);
    }
  };
  const bool only_counts = arguments.has("--sky-statistics");
  if (arguments.has("--overlay")) {
    refuse({"--export", "--leo-as-gps", "--sky-statistics"},
           " is for whole simulations, not for --overlay");
  }
  if (only_counts) {
    refuse({"--out", "--truth", "--export", "--leo-as-gps"},
           " writes a run; --sky-statistics makes none");
  } else {
    refuse({"--mask", "--step"}, " is for --sky-statistics");
  }
  if (!arguments.has("--export")) refuse({"--leo-as-gps"}, " is for --export");
}

std::vector<std::string> inputs_of(const std::string& file, const leonav::sim::Scenario& scenario) {
  std::vector<std::string> inputs{file};
  if (!scenario.route.file.empty()) inputs.push_back(scenario.route.file);
  if (!scenario.street_errors.file.empty()) inputs.push_back(scenario.street_errors.file);
  for (const auto& constellation : scenario.constellations) {
    if (!constellation.file.empty()) inputs.push_back(constellation.file);
  }
  return inputs;
}

void warn_of_rows(const leonav::sim::RouteConfig& route) {
  const std::string missing = leonav::sim::left_out(route.file_report);
  if (!missing.empty()) std::cerr << "leonav-sim: " << route.file << ": " << missing << "\n";
}

int overlay(const Arguments& arguments, const std::vector<std::string>& overrides) {
  const std::string out = arguments.required("--out"), truth = arguments.required("--truth");
  const std::string recorded = arguments.get("--overlay");
  leonav::check_output(out, {arguments.positional()[0], truth, recorded});
  auto scenario = leonav::sim::load_scenario(arguments.positional()[0], overrides);
  leonav::sim::set_track(truth, &scenario.route);
  warn_of_rows(scenario.route);
  leonav::ProgressBar progress(&std::cerr, "leonav-sim", leonav::is_stderr_terminal());
  std::cout << to_string(leonav::sim::overlay(scenario, recorded, out, &progress));
  return 0;
}

int sky_statistics(const Arguments& arguments, const leonav::sim::Scenario& scenario) {
  const double step_s = arguments.number("--step");
  if (!(step_s > 0.0)) throw UsageError("--step must be above zero");
  const double mask_deg = arguments.number("--mask");
  if (!(mask_deg >= 0.0 && mask_deg < 90.0)) {
    throw UsageError("--mask must be from 0 to below 90 degrees");
  }
  const double mask = mask_deg * kDegree;
  if (scenario.duration_s / step_s > 1e6) throw UsageError("--step makes over a million epochs");
  leonav::sim::print(leonav::sim::sky_statistics(scenario, mask, step_s), std::cout);
  return 0;
}

int body(int argc, char** argv) {
  Arguments arguments = declare();
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() != 1) {
    throw UsageError("give one scenario.yaml (--help tells more)");
  }
  std::vector<std::string> overrides = arguments.all("--set");
  if (arguments.has("--seed")) overrides.push_back("seed=" + arguments.get("--seed"));
  refuse_ignored_options(arguments);
  if (arguments.has("--overlay")) return overlay(arguments, overrides);
  const auto scenario = leonav::sim::load_scenario(arguments.positional()[0], overrides);
  warn_of_rows(scenario.route);
  if (arguments.has("--sky-statistics")) return sky_statistics(arguments, scenario);
  const std::filesystem::path out = arguments.required("--out");
  leonav::sim::RunOutputs outputs;
  outputs.log = out.string();
  outputs.truth = arguments.has("--truth") ? arguments.get("--truth")
                                           : (out.parent_path() / "truth.csv").string();
  if (outputs.truth == outputs.log) throw UsageError("--out and --truth name the same file");
  const std::vector<std::string> inputs = inputs_of(arguments.positional()[0], scenario);
  leonav::check_output(outputs.log, inputs);
  leonav::check_output(outputs.truth, inputs);
  if (arguments.has("--export")) {
    outputs.files = {arguments.get("--export"), arguments.has("--leo-as-gps")};
    for (const std::string& file : leonav::sim::export_files(*outputs.files)) {
      leonav::check_output(file, inputs);
    }
  }
  leonav::ProgressBar progress(&std::cerr, "leonav-sim", leonav::is_stderr_terminal());
  const auto begun = std::chrono::steady_clock::now();
  std::cout << to_string(leonav::sim::simulate(scenario, outputs, &progress));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  std::cout << leonav::format("%.0f s simulated in %.1f s\n", scenario.duration_s, took.count());
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-sim", body, argc, argv); }
