#include "tools/sim/run/simulate.h"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "drivers/csv/truth_csv.h"
#include "tools/dataset/log_output.h"
#include "tools/dataset/product_schedule.h"
#include "tools/motion/ideal_imu.h"
#include "tools/motion/inertial_sensor.h"
#include "tools/sim/route/drive.h"
#include "tools/sim/scenario/random_streams.h"
#include "tools/sim/signals/receiver.h"
#include "tools/sim/signals/signal_plan.h"
#include "tools/sim/sky/products.h"

namespace leonav::sim {
namespace {

void write_antennas(const Scenario& scenario, const TrueSky& sky, LogOutput* log) {
  for (const TrueSatellite& satellite : sky.satellites) {
    for (const SignalCode code : signals_of(satellite.id.system)) {
      AntennaPattern pattern;
      pattern.satellite = satellite.id;
      pattern.band = code.band;
      log->write(scenario.start, pattern);
    }
  }
}

}  // namespace

ImportReport simulate(const Scenario& scenario, const std::string& log_path,
                      const std::string& truth_path, std::ostream* progress) {
  ImportReport report;
  LogOutput log(log_path, &report);
  const SplineMotion motion = drive(scenario);
  const TrueSky sky = build_sky(scenario);
  write_antennas(scenario, sky, &log);
  Products products = make_products(scenario, sky);
  auto orbits = schedule_orbits(std::move(products.orbits), scenario.start, kOrbitNodesAhead);
  auto clocks = schedule_orbits(std::move(products.clocks), scenario.start, kClockNodesAhead);
  orbits.insert(orbits.end(), clocks.begin(), clocks.end());
  std::stable_sort(orbits.begin(), orbits.end(),
                   [](const auto& a, const auto& b) { return a.arrival < b.arrival; });

  Receiver receiver(scenario, motion, sky);
  InertialSensor sensor(scenario.imu.errors, scenario.imu.imperfections, scenario.imu.rate_hz,
                        scenario.seed, random_stream(scenario.seed, "sensor"));
  const auto interval_ns = static_cast<std::int64_t>(std::llround(1e9 / scenario.imu.rate_hz));
  const double end_s = motion.duration_s() - 1.0;
  const GpsTime end = scenario.start.plus_seconds(end_s);
  GpsTime imu_time = scenario.start;
  std::size_t next_orbit = 0;
  double next_tag = scenario.receiver.interval_s;
  std::vector<TruthPoint> truth;
  while (imu_time < end) {
    const GpsTime next_imu = imu_time.plus_nanoseconds(interval_ns);
    while (next_orbit < orbits.size() && orbits[next_orbit].arrival <= next_imu) {
      log.write(orbits[next_orbit].arrival,
                std::span<const PreciseState>(orbits[next_orbit].epoch.states));
      ++next_orbit;
    }
    const GpsTime arrival =
        scenario.start.plus_seconds(next_tag + scenario.receiver.gnss_latency_s);
    if (arrival <= next_imu && next_tag < end_s) {
      log.write(arrival, receiver.epoch(next_tag));
      truth.push_back(motion.point(scenario.start.plus_seconds(next_tag)));
      next_tag += scenario.receiver.interval_s;
    }
    if (scenario.imu.enabled) {
      const ImuSample ideal = ideal_sample(motion, imu_time, interval_ns);
      const double speed = sensor.needs_speed()
                               ? motion.at(seconds_between(imu_time, scenario.start)).v_e.norm()
                               : 0.0;
      log.write(next_imu, scenario.imu.ideal ? ideal : sensor.measure(ideal, speed));
    }
    imu_time = next_imu;
    if (progress != nullptr && imu_time.nanoseconds() % (60 * kNanosecondsPerSecond) == 0)
      *progress << "\rleonav-sim: " << seconds_between(imu_time, scenario.start) << " s"
                << std::flush;
  }
  log.commit();
  write_truth_csv(truth_path, truth);
  return report;
}

}  // namespace leonav::sim
