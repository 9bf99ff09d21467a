#include "tools/import/import.h"

#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

#include "core/gnss/orbits/ephemeris_store.h"
#include "drivers/csv/imu_csv.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/event_log.h"
#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"
#include "tools/import/log_output.h"
#include "tools/import/product_schedule.h"

using namespace leonav;
using namespace leonav::test;

namespace {

struct LogCounts {
  std::map<std::string, long> events;
  long faults = 0, epochs_before_time = 0, receiver_bands = 0;
  std::set<SatelliteId> antennas;
  bool stamps_increase = true;
};

// Reads the log back through the decoder the daemon uses.
LogCounts read_log(const std::string& path) {
  LogCounts counts;
  EventLogReader reader(path);
  Decoder decoder;
  LogEvent event;
  std::int64_t last_stamp_us = 0;
  RawEpoch epoch;
  ImuSample sample;
  Ephemeris ephemeris;
  KlobucharModel model;
  PreciseStates states;
  AntennaPattern antenna;
  SignalBiases biases;
  while (reader.next(&event)) {
    ++counts.events[event.channel];
    if (event.timestamp_us <= last_stamp_us) counts.stamps_increase = false;
    last_stamp_us = event.timestamp_us;
    const ByteSpan bytes(event.data);
    DecodeResult result;
    if (event.channel == "LEONAV_GNSS_EPOCH") {
      result = decoder.decode(bytes, &epoch);
      const std::int64_t late_us = event.timestamp_us - epoch.time.nanoseconds() / 1000;
      if (late_us < 49'990 || late_us > 60'000) ++counts.epochs_before_time;
    } else if (event.channel == "LEONAV_IMU") {
      result = decoder.decode(bytes, &sample);
    } else if (event.channel == "LEONAV_EPHEMERIS") {
      result = decoder.decode(bytes, &ephemeris);
    } else if (event.channel == "LEONAV_IONOSPHERE") {
      result = decoder.decode(bytes, &model);
    } else if (event.channel == "LEONAV_ANTENNA") {
      result = decoder.decode(bytes, &antenna);
      if (antenna.is_receiver) ++counts.receiver_bands;
      if (!antenna.is_receiver) counts.antennas.insert(antenna.satellite);
    } else if (event.channel == "LEONAV_BIASES") {
      result = decoder.decode(bytes, &biases);
    } else {
      REQUIRE(event.channel == "LEONAV_ORBIT_CLOCK");
      result = decoder.decode(bytes, &states);
    }
    if (result.fault != InputFault::kNone || result.element_faults != 0) ++counts.faults;
  }
  return counts;
}

const std::string kObservationHeader =
    "     3.05           OBSERVATION DATA    M                   RINEX VERSION / TYPE\n"
    "G    1 C1C                                                  SYS / # / OBS TYPES\n"
    "                                                            END OF HEADER\n";
const std::string kEpochLines =
    "> 2024 05 06 07 08  1.0000000  0  1\nG01  20000000.000\n"
    "> 2024 05 06 07 08  2.0000000  0  1\nG01  20000000.000\n"
    "> 2024 05 06 07 08  3.0000000  0  1\nG01  20000000.000\n";

ImportReport import_text(const TemporaryFile& yaml, const ImportOptions& options = {}) {
  return import_dataset(load_dataset(yaml.path()), options, yaml.beside("out.lcmlog"), nullptr);
}

}  // namespace

TEST_CASE("the recordings become logs with every epoch and sample", "[import][recorded]") {
  struct Expected {
    const char* name;
    long epochs, imu, gps, galileo, beidou;
  };
  // Counted in the files' text. The IMU of walk has 20456 lines: a header and the samples.
  const Expected sets[] = {{"walk", 536, 20455, 9, 8, 11},
                           {"drive", 1985, 0, 10, 7, 0},
                           {"station", 721, 0, 28, 18, 22}};
  for (const Expected& expected : sets) {
    const std::string yaml = std::string(expected.name) + "/dataset.yaml";
    if (!have_shared_data(yaml)) continue;
    INFO(expected.name);
    const TemporaryFile place("unused", "");
    const std::string output = place.beside("run.lcmlog");
    ImportReport report = import_dataset(load_dataset(shared_data(yaml)), {}, output, nullptr);
    CHECK(report.epochs == expected.epochs);
    CHECK(report.imu_samples == expected.imu);
    CHECK(report.satellites[System::kGps] == expected.gps);
    CHECK(report.satellites[System::kGalileo] == expected.galileo);
    CHECK(report.satellites[System::kBeidou] == expected.beidou);
    CHECK_FALSE(std::filesystem::exists(output + ".part"));
    LogCounts log = read_log(output);
    CHECK(log.events["LEONAV_GNSS_EPOCH"] == expected.epochs);
    CHECK(log.events["LEONAV_IMU"] == expected.imu);
    CHECK(log.events["LEONAV_EPHEMERIS"] == report.ephemerides);
    CHECK(log.events["LEONAV_ORBIT_CLOCK"] == report.orbit_epochs + report.clock_epochs);
    CHECK(report.ephemerides > 0);
    const bool with_antennas = std::string(expected.name) == "station";
    CHECK(log.antennas.size() == (with_antennas ? 107U : 0U));
    CHECK(log.receiver_bands == (with_antennas ? 2 : 0));
    CHECK(log.faults == 0);
    CHECK(log.epochs_before_time == 0);
    CHECK(log.stamps_increase);
  }
}

TEST_CASE("precise orbits and clocks of the station are there at every epoch",
          "[import][recorded]") {
  if (!have_shared_data("station/dataset.yaml")) return;
  const TemporaryFile place("unused", "");
  const std::string output = place.beside("run.lcmlog");
  const Dataset dataset = load_dataset(shared_data("station/dataset.yaml"));
  const ImportReport report = import_dataset(dataset, {}, output, nullptr);
  CHECK(report.orbit_epochs > 24);
  // 721 epochs from 00:00:00 to 06:00:00 and a few nodes ahead; the file has 782.
  CHECK(report.clock_epochs >= 721 + 2);

  EphemerisConfig options;
  EphemerisStore ephemeris_store(options);
  EventLogReader reader(output);
  Decoder decoder;
  LogEvent event;
  PreciseStates states;
  RawEpoch epoch;
  std::set<SatelliteId> covered;
  long looked_up = 0, precise = 0, fine = 0;
  while (reader.next(&event)) {
    if (event.channel == "LEONAV_ORBIT_CLOCK") {
      REQUIRE(decoder.decode(ByteSpan(event.data), &states).fault == InputFault::kNone);
      for (const PreciseState& state : states) {
        CHECK(state.time == states.front().time);
        CHECK(state.is_clock_only() == states.front().is_clock_only());
        if (!state.is_clock_only()) covered.insert(state.satellite);
        REQUIRE(ephemeris_store.add(state));
      }
    } else if (event.channel == "LEONAV_GNSS_EPOCH") {
      REQUIRE(decoder.decode(ByteSpan(event.data), &epoch).fault == InputFault::kNone);
      std::set<SatelliteId> seen;
      for (const SignalObservation& observation : epoch.observations) {
        if (!covered.contains(observation.satellite)) continue;
        if (!seen.insert(observation.satellite).second) continue;
        SatelliteState state;
        ++looked_up;
        const GpsTime sent = epoch.time.plus_seconds(-0.08);
        if (ephemeris_store.state_at(observation.satellite, sent, &state) != LookupStatus::kOk)
          continue;
        ++precise;
        if (state.sigma_change_m < 2e-3) ++fine;  // 80 ms from a clock's node
      }
    }
  }
  std::cout << "station: " << looked_up << " satellites looked up, " << precise << " precise, "
            << fine << " by 30 s clocks\n";
  CHECK(covered.size() == 54);
  CHECK(looked_up > 10'000);
  CHECK(precise == looked_up);
  CHECK(static_cast<double>(fine) > 0.999 * static_cast<double>(looked_up));
}

TEST_CASE("a span of time, and a truncated file", "[import]") {
  const TemporaryFile yaml("set.yaml", "name: s\nobservations: a.obs\n");
  std::ofstream(yaml.beside("a.obs"))
      << kObservationHeader << kEpochLines << "> 2024 05 06 07 08  4.00";
  const ImportReport all = import_text(yaml);
  CHECK(all.epochs == 3);
  REQUIRE(all.skipped.size() == 1);
  CHECK(all.skipped[0].where == yaml.beside("a.obs") + ":10");
  CHECK(all.warnings.size() == 3);  // navigation and orbits, orbits, imu
  ImportOptions options;
  options.from = options.to = all.first.plus_seconds(1.0);
  CHECK(import_text(yaml, options).epochs == 1);
  options.from = options.to = all.first.plus_seconds(100.0);
  CHECK_THROWS_WITH(import_text(yaml, options), Catch::Contains("nothing to write"));
}

TEST_CASE("an epoch with a wrong time costs itself, also before the next file", "[import]") {
  const auto epochs_from = [](int first, int count, int wrong) {
    std::string text = kObservationHeader;
    for (int i = first; i < first + count; ++i) {
      char line[80];  // an hour ahead where it is wrong, and a loss of lock told there
      std::snprintf(line, sizeof line, "> 2024 05 06 %02d %02d %2d.0000000  0  1\n",
                    i == wrong ? 8 : 7, i / 60, i % 60);
      text += line + std::string("G01  20000000.000  ") + (i == wrong ? " 100000000.0001" : "") +
              (i == wrong ? "" : " 100000000.000") + "\n";
    }
    return text;
  };
  const std::string two_types = "G    2 C1C L1C";
  for (const int wrong : {0, 1, 60, 98, 99, 100, 198}) {
    CAPTURE(wrong);
    const TemporaryFile yaml("set.yaml", "observations: [a.obs, b.obs]\n");
    std::string a = epochs_from(0, 100, wrong), b = epochs_from(100, 100, wrong);
    for (std::string* text : {&a, &b}) text->replace(text->find("G    1 C1C    "), 14, two_types);
    std::ofstream(yaml.beside("a.obs")) << a;
    std::ofstream(yaml.beside("b.obs")) << b;
    const ImportReport report = import_text(yaml);
    CHECK(report.epochs == 199);
    REQUIRE(report.skipped.size() == 1);
    CHECK(report.skipped[0].count == 1);
    const std::string line = std::to_string(4 + 2 * (wrong % 100));
    CHECK(report.skipped[0].where == yaml.beside(wrong < 100 ? "a.obs:" : "b.obs:") + line);
    CHECK_THAT(report.skipped[0].reason, Catch::Contains("time does not fit"));
    CHECK(report.warnings.size() == 3);
    CHECK(seconds_between(report.last, report.first) == Approx(wrong == 0 ? 198.0 : 199.0));

    EventLogReader reader(yaml.beside("out.lcmlog"));
    LogEvent event;
    Decoder decoder;
    RawEpoch epoch;
    std::vector<int> interrupted;  // epochs in the log
    for (int i = 0; reader.next(&event); ++i) {
      REQUIRE(decoder.decode(ByteSpan(event.data), &epoch).fault == InputFault::kNone);
      REQUIRE(epoch.observations.size() == 1);
      if (epoch.observations[0].loss_of_lock) interrupted.push_back(i);
    }
    CHECK(interrupted == std::vector<int>{wrong});
  }
}

TEST_CASE("what costs most of a stream is a warning that nobody overlooks", "[import]") {
  const TemporaryFile yaml("set.yaml", "observations: a.obs\nimu: imu.csv\n");
  std::ofstream(yaml.beside("a.obs"))
      << kObservationHeader << kEpochLines << kEpochLines << kEpochLines << kEpochLines;
  std::ofstream imu(yaml.beside("imu.csv"));
  imu << kImuCsvHeader << "\n2313,112028.0,0,0,0,0,0,-9.8\n2313,112028.1,0,0,0,0,0,-9.8\n";
  for (int i = 0; i < 3; ++i) imu << "2313,112028." << i << ",nan,0,0,0,0,-9.8\n";
  imu.close();
  const ImportReport report = import_text(yaml);
  CHECK(report.epochs == 3);
  CHECK(report.imu_samples == 2);
  CHECK_THAT(to_string(report), Catch::Contains("a.obs: MORE THAN HALF of the epochs were left") &&
                                    Catch::Contains("9 of 12") &&
                                    Catch::Contains("imu.csv: MORE THAN HALF of the rows") &&
                                    Catch::Contains("3 of 5"));
}

TEST_CASE("damaged inputs stop the import and leave no file", "[import]") {
  const auto message = [](const std::string& yaml_text, const std::string& observations) {
    const TemporaryFile yaml("set.yaml", yaml_text);
    std::ofstream(yaml.beside("a.obs")) << observations;
    std::string what;
    try {
      import_text(yaml);
    } catch (const std::exception& error) {
      what = error.what();
    }
    CHECK_FALSE(std::filesystem::exists(yaml.beside("out.lcmlog")));
    CHECK_FALSE(std::filesystem::exists(yaml.beside("out.lcmlog.part")));
    return what;
  };
  using Catch::Contains;
  const std::string good = kObservationHeader + kEpochLines;
  CHECK_THAT(message("name: s\nobservatons: a.obs\n", good),
             Contains("set.yaml:2") && Contains("'observations'"));
  CHECK_THAT(message("imu: [\n", good), Contains("set.yaml"));
  CHECK_THAT(message("- a\n- b\n", good), Contains("set.yaml:1"));
  CHECK_THAT(message("imu: {a: b}\n", good), Contains("set.yaml:1"));
  CHECK_THAT(message("name: s\nname: t\n", good), Contains("set.yaml:2") && Contains("twice"));
  CHECK_THAT(message("name: s\n---\nobservations: a.obs\n", good),
             Contains("set.yaml:2") && Contains("second document"));
  CHECK_THAT(message("observations: b.obs\n", good), Contains("b.obs"));
  CHECK_THAT(message("observations: a.obs\n", kObservationHeader), Contains("no usable epoch"));
  CHECK_THAT(message("observations: [a.obs, a.obs]\nnavigation: a.obs\n", good),
             Contains("a.obs:1") && Contains("not a navigation file"));
  CHECK_THAT(message("observations: a.obs\norbits: a.obs\n", good), Contains("a.obs"));
  CHECK_THAT(message("name: nothing\n", good), Contains("nothing to write"));
}

TEST_CASE("an import writes over no input and nothing but a regular file", "[import]") {
  const TemporaryFile yaml("set.yaml", "observations: [a.obs, b.obs.part]\ntruth: truth.csv\n");
  const auto text_of = [](const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  for (const char* name : {"a.obs", "b.obs.part"}) {
    std::ofstream(yaml.beside(name)) << kObservationHeader << kEpochLines;
  }
  std::ofstream(yaml.beside("truth.csv")) << "the truth\n";
  const Dataset dataset = load_dataset(yaml.path());
  const auto write_to = [&](const std::string& name) {
    import_dataset(dataset, {}, yaml.beside(name), nullptr);
  };
  using Catch::Contains;
  CHECK_THROWS_WITH(write_to("a.obs"), Contains("is an input"));
  CHECK_THROWS_WITH(write_to("b.obs"), Contains("b.obs.part: is an input"));
  CHECK_THROWS_WITH(write_to("truth.csv"), Contains("is an input"));
  CHECK_THROWS_WITH(write_to("set.yaml"), Contains("is an input"));
  std::filesystem::create_hard_link(yaml.beside("a.obs"), yaml.beside("link"));
  CHECK_THROWS_WITH(write_to("link"), Contains("is an input"));
  CHECK(text_of(yaml.beside("a.obs")) == kObservationHeader + kEpochLines);
  CHECK(text_of(yaml.beside("truth.csv")) == "the truth\n");

  const std::string pipe = yaml.beside("pipe");
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(write_to("pipe"), Contains("no regular file"));
  CHECK(std::filesystem::is_fifo(pipe));
  std::filesystem::create_directory(yaml.beside("folder"));
  CHECK_THROWS_WITH(write_to("folder"), Contains("no regular file"));
  for (const char* name : {"pipe.part", "folder.part", "a.obs.part"}) {
    CHECK_FALSE(std::filesystem::exists(yaml.beside(name)));
  }
  write_to("run.lcmlog");
  write_to("run.lcmlog");  // a log of ours may be written again
  CHECK(std::filesystem::exists(yaml.beside("run.lcmlog")));
}

TEST_CASE("a log that cannot be given its name leaves nothing behind", "[import]") {
  const TemporaryFile place("unused", "");
  const std::string path = place.beside("run.lcmlog");
  ImportReport report;
  LogOutput log(path, &report);
  std::filesystem::create_directories(path + "/full");
  CHECK_THROWS_WITH(log.commit(), Catch::Contains("cannot be given its name"));
  CHECK_FALSE(std::filesystem::exists(path + ".part"));
}

TEST_CASE("a truth that is not there is a warning", "[import]") {
  const TemporaryFile marked("set.yaml", "---\nobservations: a.obs\n");
  CHECK(load_dataset(marked.path()).observations.size() == 1);
  const TemporaryFile yaml("set.yaml", "observations: a.obs\ntruth: truth.csv\n");
  std::ofstream(yaml.beside("a.obs")) << kObservationHeader << kEpochLines;
  CHECK_THAT(to_string(import_text(yaml)), Catch::Contains("truth.csv is not there"));
  std::ofstream(yaml.beside("truth.csv")) << "the truth\n";
  CHECK_THAT(to_string(import_text(yaml)), !Catch::Contains("truth.csv"));
}

TEST_CASE("ephemerides arrive when they were sent", "[import]") {
  const GpsTime start = GpsTime::from_week_and_tow(2300, 100'000.0);
  const auto make = [&](int number, double toe_s, double sent_s) {
    Ephemeris e;
    e.satellite = {System::kGps, static_cast<std::uint16_t>(number)};
    e.toe = start.plus_seconds(toe_s);
    e.transmission_time = start.plus_seconds(sent_s);
    return e;
  };
  const auto schedule = schedule_ephemerides(
      {make(1, 3600, 600), make(1, -3600, -9000), make(1, -1800, -3600), make(1, 0, -60),
       make(1, 0, -30), make(2, 3600, 40), make(2, 5400, 900), make(3, -10'000, -17'000)},
      start);
  CHECK(schedule.repeated == 1);
  CHECK(schedule.expired == 1);
  CHECK(schedule.superseded == 1);
  REQUIRE(schedule.items.size() == 5);
  const auto item = [&](std::size_t i) {
    return std::pair(int{schedule.items[i].ephemeris.satellite.number},
                     seconds_between(schedule.items[i].arrival, start));
  };
  CHECK(item(0) == std::pair(1, 0.0));
  CHECK(item(1) == std::pair(1, 0.0));
  CHECK(item(2) == std::pair(2, 0.0));  // sent later, but valid and the first of its satellite
  CHECK(item(3) == std::pair(1, 600.0));
  CHECK(item(4) == std::pair(2, 900.0));
  Ephemeris unknown = make(4, 7200, 0);
  unknown.transmission_time = {};
  CHECK(transmission_time(unknown) == start);
}

TEST_CASE("orbit nodes arrive ahead of their time", "[import]") {
  const GpsTime start = GpsTime::from_week_and_tow(2300, 100'000.0);
  std::vector<OrbitEpoch> epochs;
  for (int i = -20; i <= 20; ++i) {
    PreciseState state;
    state.satellite = {System::kGps, 1};
    state.time = start.plus_seconds(300.0 * i);
    epochs.push_back({state.time, {state}});
  }
  epochs.push_back(epochs[3]);  // a second file begins where the first ends
  const auto schedule = schedule_orbits(epochs, start, 6);
  REQUIRE(schedule.size() == 26);  // from -5 to 20
  CHECK(schedule.front().epoch.time == start.plus_seconds(-1500.0));
  CHECK(schedule[11].arrival == start);
  CHECK(schedule[12].epoch.time == start.plus_seconds(2100.0));
  CHECK(schedule[12].arrival == start.plus_seconds(300.0));
}
