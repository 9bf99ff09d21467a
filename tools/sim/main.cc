// leonav-sim: a scenario -> measurements as a vehicle would have recorded them.
#include <iostream>

#include "tools/common/arguments.h"
#include "tools/sim/run/simulate.h"
#include "tools/sim/sky/true_sky.h"

namespace {

int body(int argc, char** argv) {
  leonav::Arguments arguments("leonav-sim", "scenario.yaml -o run.lcmlog [options]", "");
  arguments.option("--out", "FILE", "the log to write; -o for short")
      .option("--truth", "FILE", "truth.csv to write")
      .option("--seed", "N", "instead of the scenario's");
  if (!arguments.parse(argc, argv)) return 0;
  leonav::sim::Scenario scenario;
  scenario.start = leonav::GpsTime::from_week_and_tow(2136, 345600.0);
  using leonav::System;
  for (const System system : leonav::kSystems)
    scenario.constellations.push_back(leonav::sim::nominal_constellation(system));
  for (auto& noise : scenario.receiver.noise) noise = {0.3, 0.002, 0.03};
  constexpr double kDegree = 0.017453292519943295;
  scenario.imu.errors.angle_random_walk = 0.05 * kDegree / 60.0;
  scenario.imu.errors.velocity_random_walk = 0.1 / 60.0;
  scenario.imu.errors.gyro_bias.sigma = 0.5 * kDegree / 3600.0;
  scenario.imu.errors.accel_bias.sigma = 25e-5;
  const auto report = leonav::sim::simulate(scenario, arguments.required("--out"),
                                            arguments.required("--truth"), &std::cerr);
  std::cout << leonav::to_string(report);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-sim", body, argc, argv); }
