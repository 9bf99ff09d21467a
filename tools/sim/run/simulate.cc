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
#include "tools/sim/run/antennas.h"
#include "tools/sim/scenario/random_streams.h"
#include "tools/sim/signals/receiver.h"
#include "tools/sim/sky/broadcast.h"
#include "tools/sim/sky/products.h"

namespace leonav::sim {
namespace {

void tell_fits(const BroadcastMessages& messages, std::ostream* progress) {
  for (const System system : kSystems) {
    const FitStatistics& fits = messages.residuals[index_of(system)];
    if (progress == nullptr || fits.count == 0) continue;
    *progress << "leonav-sim: " << to_string(system) << ": " << fits.count
              << " broadcast issues, fitted to their orbits within " << fits.rms_m()
              << " m rms, worst " << fits.worst_m << " m\n";
  }
}

}  // namespace

ImportReport simulate(const Scenario& scenario, const std::string& log_path,
                      const std::string& truth_path, std::ostream* progress,
                      const std::optional<ExportOptions>& export_options) {
  ImportReport report;
  LogOutput log(log_path, &report);
  const SplineMotion motion = drive(scenario);
  const TrueSky sky = build_sky(scenario);
  const std::vector<AntennaPattern> antennas = ideal_antennas(sky);
  for (const AntennaPattern& pattern : antennas) log.write(scenario.start, pattern);
  const BroadcastMessages messages = make_broadcast(scenario, sky);
  tell_fits(messages, progress);
  const auto ephemerides = schedule_ephemerides(messages.ephemerides, scenario.start).items;
  Products products = make_products(scenario, sky);
  std::optional<Export> exported;
  if (export_options) {
    exported.emplace(scenario, sky, *export_options);
    exported->write(products, messages, antennas);
  }
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
  std::size_t next_orbit = 0, next_ephemeris = 0;
  double next_tag = scenario.receiver.interval_s;
  std::vector<TruthPoint> truth;
  while (imu_time < end) {
    const GpsTime next_imu = imu_time.plus_nanoseconds(interval_ns);
    while (next_ephemeris < ephemerides.size() && ephemerides[next_ephemeris].arrival <= next_imu) {
      log.write(ephemerides[next_ephemeris].arrival, ephemerides[next_ephemeris].ephemeris);
      ++next_ephemeris;
    }
    while (next_orbit < orbits.size() && orbits[next_orbit].arrival <= next_imu) {
      log.write(orbits[next_orbit].arrival,
                std::span<const PreciseState>(orbits[next_orbit].epoch.states));
      ++next_orbit;
    }
    const GpsTime arrival =
        scenario.start.plus_seconds(next_tag + scenario.receiver.gnss_latency_s);
    if (arrival <= next_imu && next_tag < end_s) {
      const RawEpoch epoch = receiver.epoch(next_tag);
      log.write(arrival, epoch);
      if (exported) exported->write(epoch);
      truth.push_back(motion.point(scenario.start.plus_seconds(next_tag)));
      next_tag += scenario.receiver.interval_s;
    }
    if (scenario.imu.enabled) {
      const ImuSample ideal = ideal_sample(motion, imu_time, interval_ns);
      const double speed = sensor.needs_speed()
                               ? motion.at(seconds_between(imu_time, scenario.start)).v_e.norm()
                               : 0.0;
      const ImuSample sample = scenario.imu.ideal ? ideal : sensor.measure(ideal, speed);
      log.write(next_imu, sample);
      if (exported) exported->write(sample);
    }
    imu_time = next_imu;
    if (progress != nullptr && imu_time.nanoseconds() % (60 * kNanosecondsPerSecond) == 0)
      *progress << "\rleonav-sim: " << seconds_between(imu_time, scenario.start) << " s"
                << std::flush;
  }
  log.commit();
  write_truth_csv(truth_path, truth);
  if (exported) exported->finish(truth);
  return report;
}

}  // namespace leonav::sim
