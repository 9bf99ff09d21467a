// Low satellites over a log: against the run that had them from the start.
#include "tools/sim/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/signal.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/sky/simulated_receiver.h"
#include "support/temporary_file.h"
#include "tools/sim/overlay/recorded_clock.h"
#include "tools/sim/run/simulate.h"

using namespace leonav;
using namespace leonav::test;

namespace {

// The truth has ten points a second; the clock strays.
const std::string kYaml =
    "duration_s: 60\nideal: true\nroute: {standing_s: 10}\nimu: {rate_hz: 50}\n"
    "receiver: {interval_s: 0.5, lever_arm_b_m: [0, 0, 0], clock: {offset_us: 700, drift_ppb: "
    "2000}}\n"
    "atmosphere: {tecu: 0, gradient_north_tecu_per_100km: 0, wet_offset_m: 0, "
    "wet_walk_m_per_sqrt_h: 0}\n";

std::vector<LogEvent> events(const std::string& path) {
  std::vector<LogEvent> all;
  EventLogReader log(path);
  LogEvent event;
  while (log.next(&event)) all.push_back(event);
  return all;
}

bool is_epoch(const LogEvent& event) {
  return channel_from_name(event.channel) == Channel::kGnssEpoch;
}

RawEpoch decoded(const LogEvent& event) {
  Decoder decoder;
  auto epoch = std::make_unique<RawEpoch>();
  REQUIRE(decoder.decode(event.data, epoch.get()).fault == InputFault::kNone);
  return *epoch;
}

std::vector<RawEpoch> epochs(const std::string& path) {
  std::vector<RawEpoch> all;
  for (const LogEvent& event : events(path)) {
    if (is_epoch(event)) all.push_back(decoded(event));
  }
  return all;
}

struct Runs {
  Runs() : place("unused", "") {
    write(kYaml, "whole");
    write(kYaml + "satellites: {leo: {enabled: false}}\n", "recorded");
  }
  void write(const std::string& yaml, const std::string& name) const {
    ProgressBar quiet(nullptr, "", false);
    sim::RunOutputs outputs;
    outputs.log = path(name);
    outputs.truth = path(name + ".csv");
    sim::simulate(sim::load_scenario_text(yaml, "test.yaml"), outputs, &quiet);
  }
  sim::OverlayReport lay(const std::string& faults, const std::string& name,
                         const Keys& keys = {}) const {
    ProgressBar quiet(nullptr, "", false);
    Keys all = keys;
    all.push_back("route.file=" + path("whole.csv"));
    all.emplace_back("satellites.advance_s=0.5");  // the truth's first point
    const auto scenario = sim::load_scenario_text(kYaml + "faults: " + faults, "test.yaml", all);
    return sim::overlay(scenario, path("recorded"), path(name), &quiet);
  }
  std::string path(const std::string& name) const { return place.beside(name); }
  TemporaryFile place;
};

}  // namespace

TEST_CASE("Added low satellites are as the same receiver would have had them", "[sim][overlay]") {
  const Runs runs;
  const sim::OverlayReport report = runs.lay("[]", "laid");
  REQUIRE(report.without_clock == 0);
  const auto whole = epochs(runs.path("whole")), laid = epochs(runs.path("laid"));
  REQUIRE(whole.size() == laid.size());
  int compared = 0;
  std::map<std::pair<SatelliteId, SignalCode>, double> before;
  for (std::size_t k = 4; k + 4 < whole.size(); ++k) {
    const BySignal reference = by_signal(whole[k]);
    for (const SignalObservation& o : laid[k].observations) {
      if (o.satellite.system != System::kLeo) continue;
      const auto found = reference.find({o.satellite, o.code});
      if (found == reference.end()) continue;  // rises or sets
      const double wavelength = BandPlan().wavelength_m(o.satellite.system, o.code.band);
      const double code = o.pseudorange_m - found->second.pseudorange_m;
      // The time base that the clock was read by is off by 5 m, 1 sigma, and half a second of an
      // orbit around a point instead of the Earth is 4 m; of these little changes from epoch to
      // epoch. A clock that was wrong by 1 us would be 300 m, and 7 mm of the satellite's way.
      REQUIRE(std::abs(code) < 30.0);
      REQUIRE(std::abs(wavelength * (o.doppler_hz - found->second.doppler_hz)) < 0.05);
      const auto [last, is_first] = before.try_emplace({o.satellite, o.code}, code);
      if (!is_first) REQUIRE(std::abs(code - last->second) < 0.05);
      last->second = code;
      ++compared;
    }
  }
  REQUIRE(compared > 300);
}

TEST_CASE("All else of the recording is there, byte by byte", "[sim][overlay]") {
  const Runs runs;
  runs.lay("[]", "laid");
  std::vector<LogEvent> laid = events(runs.path("laid"));
  std::size_t next = 0;
  Decoder decoder;
  for (const LogEvent& event : events(runs.path("recorded"))) {
    // What was added stands in between.
    while (next < laid.size() &&
           !(laid[next].channel == event.channel && laid[next].timestamp_us == event.timestamp_us &&
             (is_epoch(event) || laid[next].data == event.data))) {
      const auto channel = channel_from_name(laid[next].channel);
      REQUIRE((channel == Channel::kAntenna || channel == Channel::kOrbitClock));
      ++next;
    }
    REQUIRE(next < laid.size());
    if (is_epoch(event)) {
      RawEpoch with = decoded(laid[next]);
      const RawEpoch before = decoded(event);
      with.observations.erase(
          std::remove_if(with.observations.begin(), with.observations.end(),
                         [](const auto& o) { return o.satellite.system == System::kLeo; }),
          with.observations.end());
      REQUIRE(same(with, before));
    }
    ++next;
  }
  REQUIRE(next == laid.size());
}

TEST_CASE("Outages take recorded satellites away, in their time", "[sim][overlay]") {
  const Runs runs;
  const sim::OverlayReport report =
      runs.lay("[{kind: outage, from_s: 20, to_s: 30, systems: [galileo, leo]}]", "laid");
  REQUIRE(report.removed > 100);
  const auto recorded = epochs(runs.path("recorded")), laid = epochs(runs.path("laid"));
  const GpsTime start = recorded.front().time;  // the truth's first point too
  for (std::size_t k = 0; k < recorded.size(); ++k) {
    const double t = seconds_between(recorded[k].time, start);
    const bool is_out = t >= 20.0 && t < 30.0;
    const BySignal there = by_signal(laid[k]);
    for (const SignalObservation& o : recorded[k].observations) {
      const bool gone = is_out && o.satellite.system == System::kGalileo;
      REQUIRE(there.contains({o.satellite, o.code}) != gone);
    }
    for (const SignalObservation& o : laid[k].observations) {
      if (o.satellite.system == System::kLeo) REQUIRE_FALSE(is_out);
    }
  }
}

TEST_CASE("An overlay that changes nothing is an error, and leaves no file", "[sim][overlay]") {
  const Runs runs;
  REQUIRE_THROWS_WITH(runs.lay("[]", "laid", {"satellites.leo.enabled=false"}),
                      Catch::Contains("nothing to add"));
  REQUIRE_FALSE(std::filesystem::exists(runs.path("laid")));
  REQUIRE_FALSE(std::filesystem::exists(runs.path("laid.part")));
}

TEST_CASE("The recording's time is the truth's, whatever the scenario says", "[sim][overlay]") {
  const Runs runs;
  runs.lay("[]", "laid");
  runs.lay("[]", "other", {"start_gps_week=2000", "start_gps_tow_s=17"});
  REQUIRE(text_of(runs.path("laid")) == text_of(runs.path("other")));
}

TEST_CASE("A truth of another place is refused: codes contradict it", "[sim][overlay]") {
  const Runs runs;
  auto truth = read_truth_csv(runs.path("whole.csv")).points;
  for (TruthPoint& point : truth) point.position.latitude += 0.001;  // 6 km
  write_truth_csv(runs.path("elsewhere.csv"), truth);
  std::filesystem::copy_file(runs.path("elsewhere.csv"), runs.path("whole.csv"),
                             std::filesystem::copy_options::overwrite_existing);
  REQUIRE_THROWS_WITH(runs.lay("[]", "laid"), Catch::Contains("nor at its place"));
}

TEST_CASE("A recording that is cut short says so, also with a truth named oddly",
          "[sim][overlay]") {
  if (!have_programs("leonav-sim")) return;
  const Runs runs;
  std::filesystem::resize_file(runs.path("recorded"),
                               std::filesystem::file_size(runs.path("recorded")) / 2);
  const std::string truth = runs.path("drive #1: a.csv");
  std::filesystem::copy_file(runs.path("whole.csv"), truth);
  const TemporaryFile scenario("s.yaml", kYaml);
  const ProgramRun sim =
      run_program("leonav-sim", scenario.path() + " --overlay " + runs.path("recorded") +
                                    " --truth '" + truth + "' -o " + runs.path("laid"));
  INFO(sim.err);
  REQUIRE(sim.exit_code == 0);
  REQUIRE_THAT(sim.out, Catch::Contains("cut short"));
}

TEST_CASE("What an overlay cannot do it says: faults, keys, names of channels", "[sim][overlay]") {
  const Runs runs;
  for (const std::string kind :
       {"imu_gap", "imu_saturation", "late", "duplicate", "receiver_reset"}) {
    INFO(kind);
    REQUIRE_THROWS_WITH(runs.lay("[{kind: " + kind + "}]", "laid"),
                        Catch::Contains("test.yaml:7: faults[0].kind: has no effect"));
  }
  REQUIRE_THROWS_WITH(runs.lay("[{kind: outage, below_elevation_deg: 40}]", "laid"),
                      Catch::Contains("below_elevation_deg has no effect with --overlay"));
  for (const std::string kind : {"satellite_clock", "bad_orbit", "spoofing"}) {
    INFO(kind);
    REQUIRE_THROWS_WITH(runs.lay("[{kind: " + kind + ", satellites: [L03, G05]}]", "laid"),
                        Catch::Contains("only outages meet satellites of the recording"));
    REQUIRE(runs.lay("[{kind: " + kind + ", systems: [leo]}]", "laid").added > 0);
    REQUIRE(runs.lay("[{kind: " + kind + "}]", "laid").added > 0);
  }
  const std::string told =
      to_string(runs.lay("[]", "laid",
                         {"satellites.gps.along_error_m=3", "receiver.noise.gps.code_m=1",
                          "odometer.rate_hz=10", "truth_interval_s=0.1"}));
  INFO(told);
  REQUIRE_THAT(told, Catch::Contains("not used, as the recording says it: "));
  for (const char* key : {"duration_s", "route.standing_s", "imu.rate_hz", "receiver.interval_s",
                          "receiver.clock.drift_ppb", "satellites.gps.along_error_m",
                          "receiver.noise.gps.code_m", "odometer.rate_hz", "truth_interval_s"}) {
    REQUIRE_THAT(told, Catch::Contains(key));
  }
  for (const char* key : {"lever_arm", "atmosphere", "advance_s", "faults", "ideal"}) {
    REQUIRE_THAT(told, !Catch::Contains(key));
  }
  EventLogWriter renamed(runs.path("renamed"));
  for (const LogEvent& event : events(runs.path("recorded"))) {
    renamed.write(event.timestamp_us, "OTHER_" + event.channel.substr(7), event.data);
  }
  REQUIRE(renamed.flush(true));
  std::filesystem::rename(runs.path("renamed"), runs.path("recorded"));
  REQUIRE_THROWS_WITH(runs.lay("[]", "laid"), Catch::Contains("it has OTHER_GNSS_EPOCH"));
}

TEST_CASE("A fast oscillator's drift is read as it is", "[sim][overlay]") {
  const Runs runs;
  const std::string fast =
      "duration_s: 60\nideal: true\nroute: {standing_s: 100}\nreceiver: {interval_s: 0.5, "
      "lever_arm_b_m: [0, 0, 0], clock: {oscillator: ideal, drift_ppb: 10000}}\n";
  runs.write(fast, "fast");
  const auto scenario =
      sim::load_scenario_text(fast, "test.yaml", {"route.file=" + runs.path("fast.csv")});
  const sim::RecordedClock clock =
      sim::recorded_clock(runs.path("fast"), scenario, sim::drive(scenario));
  // Dopplers taken for metres in a second of GPS time: wrong by 1e-5 of range rate and drift, 3
  // cm/s and more.
  double worst_m_s = 0.0;
  int count = 0;
  for (const auto& [stamp, reading] : clock.readings) {
    if (reading.t < 2.0 || reading.t > 56.0) continue;
    worst_m_s = std::max(worst_m_s, kSpeedOfLight * std::abs(reading.drift - 1e-5));
    ++count;
  }
  std::cout << "drift of a recorded clock: off by " << worst_m_s << " m/s at most\n";
  REQUIRE(count > 100);
  REQUIRE(worst_m_s < 2e-3);
}
