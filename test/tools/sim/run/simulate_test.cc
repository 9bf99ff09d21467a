// Whole runs: the log, the truth, faults of streams, and what cannot be written.
#include "tools/sim/run/simulate.h"

#include <filesystem>
#include <fstream>

#include "drivers/csv/truth_csv.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/sky/simulated_receiver.h"

using namespace leonav;
using namespace leonav::test;

namespace {

template <typename T>
struct Arrived {
  std::int64_t at_us;
  T message;
};
struct Content {
  std::vector<Arrived<ImuSample>> imu;
  std::vector<Arrived<RawEpoch>> epochs;
  std::vector<Arrived<PreciseStates>> states;
};

const std::string kShort = "duration_s: 30\nroute: {standing_s: 5}\nimu: {rate_hz: 50}\n";

Content run(const std::string& yaml) {
  const TemporaryFile place("unused", "");
  ProgressBar quiet(nullptr, "", false);
  sim::RunOutputs outputs;
  outputs.log = place.beside("run.lcmlog");
  outputs.truth = place.beside("truth.csv");
  sim::simulate(sim::load_scenario_text(yaml, "test.yaml"), outputs, &quiet);
  Content content;
  EventLogReader log(place.beside("run.lcmlog"));
  LogEvent event;
  Decoder decoder;
  auto epoch = std::make_unique<RawEpoch>();
  auto states = std::make_unique<PreciseStates>();
  std::int64_t last_us = 0;
  while (log.next(&event)) {
    REQUIRE(event.timestamp_us > last_us);
    last_us = event.timestamp_us;
    const auto channel = channel_from_name(event.channel);
    REQUIRE(channel.has_value());
    if (*channel == Channel::kImu) {
      ImuSample sample;
      REQUIRE(decoder.decode(event.data, &sample).fault == InputFault::kNone);
      content.imu.push_back({event.timestamp_us, sample});
    } else if (*channel == Channel::kGnssEpoch) {
      const DecodeResult result = decoder.decode(event.data, epoch.get());
      REQUIRE(result.fault == InputFault::kNone);
      REQUIRE(result.element_faults == 0);
      content.epochs.push_back({event.timestamp_us, *epoch});
    } else if (*channel == Channel::kOrbitClock) {
      REQUIRE(decoder.decode(event.data, states.get()).fault == InputFault::kNone);
      content.states.push_back({event.timestamp_us, *states});
    }
  }
  return content;
}

const Content& clean_run() {
  static const Content content = run(kShort);
  return content;
}

bool same_sample(const ImuSample& a, const ImuSample& b) {
  return a.time == b.time && a.interval_ns == b.interval_ns && a.delta_theta_b == b.delta_theta_b &&
         a.delta_velocity_b == b.delta_velocity_b;
}

double seconds(GpsTime time) {
  static const GpsTime start = sim::load_scenario_text(kShort, "test.yaml").start;
  return seconds_between(time, start);
}

void require_same_imu(const Content& with) {
  REQUIRE(with.imu.size() == clean_run().imu.size());
  for (std::size_t i = 0; i < with.imu.size(); ++i)
    REQUIRE(same_sample(with.imu[i].message, clean_run().imu[i].message));
}

void require_same_epochs(const Content& with) {
  REQUIRE(with.epochs.size() == clean_run().epochs.size());
  for (std::size_t i = 0; i < with.epochs.size(); ++i)
    REQUIRE(same(with.epochs[i].message, clean_run().epochs[i].message));
}

}  // namespace

TEST_CASE("IMU gap: samples of the gap are missing, the others as they were", "[sim][faults]") {
  const Content with = run(kShort + "faults: [{kind: imu_gap, from_s: 10, to_s: 12.5}]");
  require_same_epochs(with);
  std::size_t i = 0;
  for (const auto& plain : clean_run().imu) {
    const double t = seconds(plain.message.time);
    if (t >= 10.0 && t < 12.5) continue;
    REQUIRE(i < with.imu.size());
    REQUIRE(same_sample(with.imu[i++].message, plain.message));
  }
  REQUIRE(i == with.imu.size());
  REQUIRE(clean_run().imu.size() - i == 125);
}

TEST_CASE("IMU saturation: clipped where it is beyond, untouched elsewhere", "[sim][faults]") {
  const Content with =
      run(kShort + "faults: [{kind: imu_saturation, from_s: 5, to_s: 25, accel_limit_m_s2: 9.8}]");
  require_same_epochs(with);
  REQUIRE(with.imu.size() == clean_run().imu.size());
  int clipped = 0;
  for (std::size_t i = 0; i < with.imu.size(); ++i) {
    const ImuSample& a = with.imu[i].message;
    const ImuSample& plain = clean_run().imu[i].message;
    const double t = seconds(plain.time), limit = 9.8 * plain.interval_s();
    for (int axis = 0; axis < 3; ++axis) {
      const double v = plain.delta_velocity_b[axis];
      const bool is_beyond = t >= 5.0 && t < 25.0 && std::abs(v) > limit;
      REQUIRE(a.delta_velocity_b[axis] == (is_beyond ? std::copysign(limit, v) : v));
      clipped += is_beyond ? 1 : 0;
    }
    REQUIRE(a.delta_theta_b == plain.delta_theta_b);
  }
  REQUIRE(clipped > 100);
}

TEST_CASE("Late messages are the same, but later; others keep their place", "[sim][faults]") {
  const Content with = run(kShort + "faults: [{kind: late, from_s: 10, to_s: 15, delay_s: 1.4}]");
  require_same_imu(with);
  REQUIRE(with.epochs.size() == clean_run().epochs.size());
  int late = 0;
  for (const auto& plain : clean_run().epochs) {
    const auto found = std::ranges::find_if(
        with.epochs, [&](const auto& e) { return e.message.time == plain.message.time; });
    REQUIRE(found != with.epochs.end());
    REQUIRE(same(found->message, plain.message));
    const double t = seconds(plain.message.time);
    const double by_s = 1e-6 * static_cast<double>(found->at_us - plain.at_us);
    REQUIRE(by_s == Approx(t >= 10.0 && t < 15.0 ? 1.4 : 0.0).margin(1e-4));
    late += by_s > 1.0 ? 1 : 0;
  }
  REQUIRE(late == 5);
}

TEST_CASE("Duplicates come twice and alike", "[sim][faults]") {
  const Content with =
      run(kShort + "faults: [{kind: duplicate, from_s: 10, to_s: 15, stream: imu}]");
  require_same_epochs(with);
  REQUIRE(with.imu.size() == clean_run().imu.size() + 250);
  std::size_t i = 0;
  for (const auto& plain : clean_run().imu) {
    const double t = seconds(plain.message.time);
    REQUIRE(same_sample(with.imu[i++].message, plain.message));
    if (t >= 10.0 && t < 15.0) REQUIRE(same_sample(with.imu[i++].message, plain.message));
  }
}

TEST_CASE("A bad orbit is sent, by as much as scripted and only then", "[sim][faults]") {
  const Content with =
      run(kShort +
          "faults: [{kind: bad_orbit, to_s: 20, satellites: [L05], along_m: 3, radial_m: -4}]");
  require_same_epochs(with);
  require_same_imu(with);
  REQUIRE(with.states.size() == clean_run().states.size());
  int bad = 0;
  for (std::size_t i = 0; i < with.states.size(); ++i) {
    const PreciseStates& a = with.states[i].message;
    const PreciseStates& plain = clean_run().states[i].message;
    REQUIRE(a.size() == plain.size());
    for (std::size_t j = 0; j < a.size(); ++j) {
      REQUIRE(a[j].clock_s == plain[j].clock_s);
      if (plain[j].is_clock_only()) continue;
      const double t = seconds(a[j].time);
      const bool meets = a[j].satellite == SatelliteId{System::kLeo, 5} && t >= 0.0 && t < 20.0;
      REQUIRE((a[j].p_e - plain[j].p_e).norm() == Approx(meets ? 5.0 : 0.0).margin(1e-6));
      if (!meets) continue;
      REQUIRE(a[j].p_e.norm() - plain[j].p_e.norm() == Approx(-4.0).margin(1e-4));
      ++bad;
    }
  }
  REQUIRE(bad >= 1);
}

TEST_CASE("A receiver that is reset is silent, then starts anew", "[sim][faults]") {
  const Content with = run(kShort + "faults: [{kind: receiver_reset, from_s: 10, to_s: 13}]");
  require_same_imu(with);
  REQUIRE(with.epochs.size() == clean_run().epochs.size() - 3);
  for (const auto& epoch : with.epochs) {
    const double t = seconds(epoch.message.time);
    REQUIRE((t < 9.5 || t > 12.5));
    const auto plain = std::ranges::find_if(
        clean_run().epochs, [&](const auto& e) { return e.message.time == epoch.message.time; });
    if (t < 10.0) REQUIRE(same(epoch.message, plain->message));
    for (const SignalObservation& o : epoch.message.observations) {
      if (t > 12.5 && !std::isnan(o.lock_time_s)) REQUIRE(o.lock_time_s <= t - 13.0);
    }
    if (t > 14.5) REQUIRE(epoch.message.observations.size() > 40);
  }
}

TEST_CASE("The same scenario gives the same bytes", "[sim]") {
  if (!have_programs("leonav-sim")) return;
  const TemporaryFile scenario("s.yaml", kShort + "places: city");
  for (const std::string name : {"a", "b"}) {
    const ProgramRun sim =
        run_program("leonav-sim", scenario.path() + " -o " + scenario.beside(name) + " --truth " +
                                      scenario.beside(name + ".csv"));
    REQUIRE(sim.exit_code == 0);
    REQUIRE(sim.err.empty());  // no bar in a file
  }
  REQUIRE(text_of(scenario.beside("a")) == text_of(scenario.beside("b")));
  REQUIRE(text_of(scenario.beside("a.csv")) == text_of(scenario.beside("b.csv")));
  REQUIRE(read_truth_csv(scenario.beside("a.csv")).points.size() == 28);
}

TEST_CASE("What leonav-sim cannot do it says, and leaves nothing behind", "[sim]") {
  if (!have_programs("leonav-sim")) return;
  const TemporaryFile scenario("s.yaml", kShort);
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    INFO(arguments);
    const ProgramRun sim = run_program("leonav-sim", arguments);
    REQUIRE(sim.exit_code != 0);
    REQUIRE_THAT(sim.err, Catch::Contains(why));
    int files = 0;
    for ([[maybe_unused]] const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(scenario.path()).parent_path()))
      ++files;
    REQUIRE(files == 1);
  };
  const std::string s = scenario.path(), out = " -o " + scenario.beside("run.lcmlog");
  refused(s + out + " --set receiver.interval_s=60", "too short");
  refused(s + out + " --truth " + scenario.beside("run.lcmlog"), "same file");
  refused(s + " -o " + s, "is an input");
  refused(s + out + " --truth " + s, "is an input");
  refused(s + " -o /nonexistent/run.lcmlog", "/nonexistent");
  refused(s + out + " --truth /nonexistent/truth.csv", "/nonexistent");
  refused(s + out + " --set recever.interval_s=1", "receiver");
  refused(s + out + " --set seed=1.5", "whole number");
  refused(s + out + " --set start_gps_week=2136.5", "whole number");
  refused(s + out + " --leo-as-gps", "--export");
  refused("--sky-statistics --step 100 " + s, "shorter than a step");
  refused("--sky-statistics --step 1e-6 " + s, "million");
  for (const std::string mask : {"90", "100", "-1000", "-1"}) {
    refused("--sky-statistics --mask=" + mask + " " + s, "--mask must be from 0 to below 90");
  }
  // A line of the file is named for what the file says, --set for what that says.
  refused(s + out + " --set 'route.waypoints=[{}, {north_m: 0.5}]'",
          "--set route.waypoints[1]: is less than a metre");
  refused(s + out + " --set 'faults=[{kind: outage, from_s: 3, from_s: 4}]'",
          "--set faults[0].from_s: given twice");
  refused(s + out + " --set 'faults=&a [*a]'", "--set faults[0]");
  // What would be ignored.
  refused("--sky-statistics " + s + out, "--out writes a run");
  refused(s + out + " --mask 20", "--sky-statistics");
  const std::string over = s + out + " --overlay x.lcmlog --truth x.csv";
  refused(over + " --sky-statistics", "--sky-statistics is for whole");
  refused(over + " --leo-as-gps", "--leo-as-gps is for whole");
  // A log without a signal is no result.
  const std::string nothing = "no signal of any satellite";
  refused(s + out + " --set receiver.elevation_mask_deg=90", nothing);
  refused(s + out + " --set 'places=[{from_s: 0, place: tunnel}]'", nothing);
  refused(s + out + " --set 'faults=[{kind: outage}]'", nothing);
  refused(s + out + " --set duration_s=10 --set receiver.latency_s=10", nothing);
}

TEST_CASE("A recorded route is not written over by the run that follows it", "[sim]") {
  if (!have_programs("leonav-sim")) return;
  const TemporaryFile scenario("s.yaml", kShort);
  const std::string truth = scenario.beside("truth.csv");
  const ProgramRun first =
      run_program("leonav-sim", scenario.path() + " -o " + scenario.beside("first"));
  REQUIRE(first.exit_code == 0);
  const std::string before = text_of(truth);
  const std::string along = scenario.path() + " --set route.file=" + truth + " -o ";
  // The truth goes beside the log unless something else is said, and into the folder of an export.
  const std::string folder = std::filesystem::path(truth).parent_path().string();
  for (const std::string& words : {along + scenario.beside("second"),
                                   along + scenario.beside("second") + " --truth " +
                                       scenario.beside("other.csv") + " --export " + folder}) {
    INFO(words);
    const ProgramRun second = run_program("leonav-sim", words);
    REQUIRE(second.exit_code == 1);
    REQUIRE_THAT(second.err, Catch::Contains("is an input"));
    REQUIRE(text_of(truth) == before);
    REQUIRE_FALSE(std::filesystem::exists(scenario.beside("second")));
  }
}
