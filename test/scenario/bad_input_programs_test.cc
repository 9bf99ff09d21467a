// Every program, asked for what cannot be: says so, names it, and does not succeed.
#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/programs/program_run.h"

namespace leonav::test {
namespace {

using Catch::Contains;
const std::string kPreset = "--preset phone_imu";

void check_refused(const std::string& program, const std::string& arguments,
                   const std::string& named) {
  CAPTURE(program, arguments);
  if (!have_programs(program)) return;
  const ProgramRun run = run_program(program, arguments);
  CAPTURE(run.out, run.err);
  CHECK(run.exit_code != 0);
  CHECK(run.exit_code < 124);  // neither hung nor crashed
  CHECK_THAT(run.err, Contains(named));
}

// A log with one whole input, so that nothing but what is asked for is wrong.
void write_log(const std::string& path) {
  EventLogWriter log(path);
  Encoder encoder;
  RawEpoch raw;
  raw.time = GpsTime::from_week_and_tow(2300, 1000.0);
  REQUIRE(log.write(1, "LEONAV_GNSS_EPOCH", encoder.encode(raw, 1)));
  REQUIRE(log.flush());
}

TEST_CASE("an absent file is named by each program, and none succeeds") {
  const TemporaryFile place("empty", "");
  const std::string out = place.beside("result"), absent = place.beside("absent.file"),
                    log = place.beside("log");
  write_log(log);
  check_refused("leonav-import", absent + " -o " + out, "absent.file");
  check_refused("leonav-replay", kPreset + " --out " + out + " " + absent, "absent.file");
  check_refused("leonav-replay", "--config " + absent + " --out " + out + " " + log, "absent.file");
  check_refused("leonavd", "--config " + absent, "absent.file");
  check_refused("leonav-eval", "--truth " + absent + " " + absent, "absent.file");
  check_refused("leonav-report", "--out " + out + " " + absent, "absent.file");
  check_refused("leonav-imu-from-truth", "--truth " + absent + " --out " + out, "absent.file");
  check_refused("leonav-bench", kPreset + " " + absent, "absent.file");
  CHECK_FALSE(std::filesystem::exists(out + "/solution.csv"));
}

TEST_CASE("an unknown key is refused with file, line and the nearest known key") {
  const TemporaryFile yaml("car.yaml", "# a comment\ngnss:\n  elevation_mask_dge: 10\n");
  const TemporaryFile dataset("set.yaml", "name: s\nobservatoins: a.obs\n");
  const std::string out = yaml.beside("result"), log = yaml.beside("run.lcmlog");
  write_log(log);
  const std::string where = "car.yaml:3", nearest = "'elevation_mask_deg'";
  for (const std::string& named : {where, nearest}) {
    check_refused("leonavd", "--config " + yaml.path(), named);
    check_refused("leonav-replay", "--config " + yaml.path() + " --out " + out + " " + log, named);
    check_refused("leonav-bench", "--config " + yaml.path() + " " + log, named);
  }
  check_refused("leonav-import", dataset.path() + " -o " + out, "set.yaml:2");
  check_refused("leonav-import", dataset.path() + " -o " + out, "'observations'");
}

TEST_CASE("an evaluation says which rows it could not use") {
  if (!have_programs("leonav-eval")) return;
  const std::string header = "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m\n";
  std::string truth_text = header, text = header, pos = "% RTKLIB\n";
  for (int i = 0; i < 40; ++i) {
    const std::string tow = std::to_string(1000 + i);
    truth_text += "2300," + tow + (i == 7 ? ",x,9,100\n" : ",45,9,100\n");
    text += "2300," + tow + (i % 2 == 1 ? ",,9,100\n" : ",45,9,100\n");
    pos += "2300 " + tow + (i == 3 ? " damaged\n" : " 45.0 9.0 100.0 5 8 1 1 1\n");
  }
  const TemporaryFile truth("truth.csv", truth_text), solution("half.csv", text),
      rtklib("run.pos", pos);
  const ProgramRun run = run_program(
      "leonav-eval", "--truth " + truth.path() + " half=" + solution.path() + " " + rtklib.path());
  CAPTURE(run.out, run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Contains("1 of 40 rows were skipped, the first: ") &&
                          Contains("truth.csv:9: latitude_deg: 'x'"));
  CHECK_THAT(run.out, Contains("20 of 40 rows were skipped") && Contains("half.csv:3: position"));
  CHECK_THAT(run.out, Contains("run.pos:5: "));
}

TEST_CASE("a bench that navigated nothing is no success") {
  if (!have_programs("leonav-bench")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("log");
  write_log(log);
  check_refused("leonav-bench", "--preset station " + log, "nothing was navigated");
}

TEST_CASE("a log with no input that could be used does not replay as a success") {
  if (!have_programs("leonav-replay")) return;
  const TemporaryFile place("empty.lcmlog", "");
  const std::string replay = kPreset + " --out " + place.beside("out") + " ";
  check_refused("leonav-replay", replay + place.path(), "empty.lcmlog");

  const TemporaryFile text("text.lcmlog", "this is not an event log, but long enough to be one\n");
  check_refused("leonav-replay", replay + text.path(), "text.lcmlog");

  const std::string foreign = place.beside("foreign.lcmlog");
  {
    EventLogWriter log(foreign);
    const std::uint8_t bytes[] = {1, 2, 3, 4};
    REQUIRE(log.write(1, "CAMERA", bytes));
    REQUIRE(log.flush());
  }
  check_refused("leonav-replay", replay + foreign, "no inputs on channels LEONAV_");

  const std::string damaged = place.beside("damaged.lcmlog");  // our channels, no message of ours
  {
    EventLogWriter log(damaged);
    const std::uint8_t bytes[] = {1, 2, 3, 4};
    for (int i = 1; i <= 100; ++i) REQUIRE(log.write(i, "LEONAV_GNSS_EPOCH", bytes));
    for (int i = 1; i <= 100; ++i) REQUIRE(log.write(100 + i, "LEONAV_IMU", bytes));
    REQUIRE(log.flush());
  }
  check_refused("leonav-replay", replay + damaged, "no solution and no epoch");
  check_refused("leonav-replay", replay + damaged,
                "WARNING: 100 of 100 IMU messages were not used");
  check_refused("leonav-replay", replay + damaged, "undecodable 200");
}

TEST_CASE("epochs without an ephemeris give no position: said with the satellites' reasons") {
  if (!have_programs("leonav-replay")) return;
  const TemporaryFile place("unused", "");
  const std::string path = place.beside("deaf.lcmlog");
  {
    EventLogWriter log(path);
    Encoder encoder;
    for (int k = 0; k < 20; ++k) {
      RawEpoch raw;
      raw.time = GpsTime::from_week_and_tow(2300, 1000.0 + k);
      for (std::uint16_t number = 1; number <= 8; ++number) {
        SignalObservation o;
        o.satellite = {System::kGps, number};
        o.code = {'1', 'C'};
        o.pseudorange_m = 2.2e7;
        raw.observations.push_back(o);
      }
      REQUIRE(log.write(k + 1, "LEONAV_GNSS_EPOCH",
                        encoder.encode(raw, static_cast<std::uint64_t>(k + 1))));
    }
    REQUIRE(log.flush());
  }
  const ProgramRun run =
      run_program("leonav-replay", "--preset station --out " + place.beside("out") + " " + path);
  CAPTURE(run.err);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.err, Contains("no position was found"));
  CHECK_THAT(run.err, Contains("of 20 epochs gave no position") || Contains("epochs gave no"));
  CHECK_THAT(run.err, Contains("no_ephemeris 1"));
  CHECK_THAT(text_of(place.beside("out") + "/summary.txt"), Contains("failure: "));

  // What the tables have in their first lines, whatever came of the run, --columns prints.
  const ProgramRun columns = run_program("leonav-replay", "--columns");
  CHECK(columns.exit_code == 0);
  for (const std::string name : {"solution", "epochs", "satellites", "measurements", "events"}) {
    const std::string table = text_of(place.beside("out") + "/" + name + ".csv");
    REQUIRE(table.find('\n') != std::string::npos);
    CHECK_THAT(columns.out, Contains(": " + table.substr(0, table.find('\n') + 1)));
    CHECK_THAT(columns.out, Contains(name + ".csv"));
  }
}

}  // namespace
}  // namespace leonav::test
