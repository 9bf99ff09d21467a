// Bias-SINEX files in an import: what is written when, and what is left out.
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/calendar.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "drivers/bias_sinex/bias_sinex_reader.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/event_log.h"
#include "drivers/text/parse.h"
#include "import_outcome.h"
#include "support/catch.h"
#include "support/temporary_file.h"
#include "tools/import/import.h"

using namespace leonav;
using namespace leonav::test;
using Catch::Contains;

namespace {

const GpsTime kFirstEpoch = from_calendar({2024, 5, 6, 7, 0, 0.0});  // day 127, second 25200

std::string observation_file() {
  std::string text =
      "     3.05           OBSERVATION DATA    M                   RINEX VERSION / TYPE\n"
      "G    1 C1C                                                  SYS / # / OBS TYPES\n"
      "                                                            END OF HEADER\n";
  for (int minute = 0; minute < 10; ++minute)
    text += "> 2024 05 06 07 0" + std::to_string(minute) + "  0.0000000  0  1\nG01  20000000.000\n";
  return text;
}

std::string record(const char* prn, const char* code, int from_s, int until_s, double value_ns) {
  char text[160];
  std::snprintf(
      text, sizeof text,
      " OSB       %-3s           %-4s      2024:127:%05d 2024:127:%05d ns   %21.4f %11.4f\n", prn,
      code, from_s, until_s, value_ns, 0.01);
  return text;
}

std::string bias_file(const std::string& records) {
  return "%=BIA 1.00 TST 2024:127:00000 TST 2024:127:00000 2024:128:00000 A 00000005\n"
         "+BIAS/DESCRIPTION\n TIME_SYSTEM  G\n-BIAS/DESCRIPTION\n+BIAS/SOLUTION\n" +
         records + "-BIAS/SOLUTION\n%=ENDBIA\n";
}

struct Sent {
  GpsTime arrival;
  SignalBias bias;
};

struct Run {
  ImportReport report;
  std::vector<Sent> biases;
  GpsTime first_epoch;  // arrival
};

Run import_with(const std::string& biases, const ImportOptions& options = {}) {
  const TemporaryFile yaml("set.yaml", "observations: a.obs\nbiases: a.BIA\n");
  std::ofstream(yaml.beside("a.obs")) << observation_file();
  std::ofstream(yaml.beside("a.BIA")) << biases;
  Run run;
  run.report =
      import_dataset(load_dataset(yaml.path()), options, yaml.beside("out.lcmlog"), nullptr);
  EventLogReader reader(yaml.beside("out.lcmlog"));
  Decoder decoder;
  for (LogEvent event; reader.next(&event);) {
    const GpsTime arrival = GpsTime::from_nanoseconds(event.timestamp_us * 1000);
    if (event.channel == "LEONAV_GNSS_EPOCH" && !run.first_epoch.is_set())
      run.first_epoch = arrival;
    if (event.channel != "LEONAV_BIASES") continue;
    SignalBiases read;
    const DecodeResult result = decoder.decode(ByteSpan(event.data), &read);
    REQUIRE(result.fault == InputFault::kNone);
    REQUIRE(result.element_faults == 0);
    for (const SignalBias& bias : read) run.biases.push_back({arrival, bias});
  }
  return run;
}

}  // namespace

TEST_CASE("biases arrive ahead of their validity, those that hold at the start first", "[import]") {
  const Run run = import_with(
      bias_file(record("G01", "C1C", 0, 25'500, 1.0) + record("G01", "C1C", 25'500, 30'000, 2.0) +
                record("G02", "C2W", 0, 86'400, 3.0) + record("G03", "C1C", 0, 25'200, 4.0) +
                record("E01", "C1C", 70'000, 80'000, 5.0)));
  CHECK(run.report.signal_biases == 3);
  REQUIRE(run.biases.size() == 3);
  CHECK(run.biases[0].arrival < run.first_epoch);
  CHECK(run.biases[1].arrival < run.first_epoch);
  CHECK(seconds_between(run.biases[2].arrival, kFirstEpoch) == Approx(300.0 - 60.0).margin(1e-3));
  CHECK(run.biases[2].bias.valid_from == kFirstEpoch.plus_seconds(300.0));
  CHECK(left_out(run.report, "does not hold during the recording") == 1);
  CHECK(left_out(run.report, "comes after the end") == 1);

  // The estimator's store, fed as the log comes, has at each instant the one that holds.
  SignalBiasStore store;
  for (const Sent& sent : run.biases) REQUIRE(store.add(sent.bias));
  const double metre = kSpeedOfLight * 1e-9;
  const auto at = [&](double seconds) {
    return store.code_delay({System::kGps, 1}, kFirstEpoch.plus_seconds(seconds), {'1', 'C'});
  };
  CHECK(at(299.0)->delay_m == Approx(1.0 * metre));
  CHECK(at(301.0)->delay_m == Approx(2.0 * metre));
  CHECK_FALSE(at(4'900.0));
}

TEST_CASE("a part of a recording gets the biases that hold in it", "[import]") {
  ImportOptions options;
  options.to = kFirstEpoch.plus_seconds(120.0);
  const Run run = import_with(
      bias_file(record("G01", "C1C", 0, 25'500, 1.0) + record("G01", "C1C", 25'500, 30'000, 2.0)),
      options);
  CHECK(run.biases.size() == 1);
  CHECK(left_out(run.report, "does not hold during the recording") == 1);
}

TEST_CASE("what a bias file leaves out, and a file that is none, are told", "[import]") {
  const Run run = import_with(
      bias_file(record("G01", "C1C", 0, 30'000, 1.0) + record("G01", "L1C", 0, 30'000, 1.0) +
                record("R01", "C1C", 0, 30'000, 1.0) + record("G01", "C9C", 0, 30'000, 1.0)));
  CHECK(left_out(run.report, "bias of a carrier") == 1);
  CHECK(left_out(run.report, "bias of a satellite not used") == 1);
  bool has_line = false;
  for (const ImportReport::Skip& skip : run.report.skipped)
    has_line = has_line || skip.where.ends_with("a.BIA:9");
  CHECK(has_line);
  CHECK(to_string(run.report).find("biases without orbits") != std::string::npos);
  CHECK_THROWS_WITH(import_with("no bias file\n"), Contains("a.BIA:1") && Contains("%=BIA 1.00"));
}

TEST_CASE("biases beyond what is read of a file are told with the limits", "[import]") {
  std::string records = record("G01", "C1C", 0, 30'000, 1.0);
  char difference[160];
  std::snprintf(difference, sizeof difference,
                " DSB       G01           C1C  C2W  2024:127:00000 2024:127:30000 ns   %21.4f "
                "%11.4f\n",
                1.0, 0.01);
  for (std::size_t i = 0; i <= BiasSinexFile::kMaxDifferences; ++i) records += difference;
  const Run run = import_with(bias_file(records));
  CHECK(left_out(run.report, "difference of a satellite that has biases of single codes too") ==
        2'000);
  CHECK(left_out(run.report,
                 "bias beyond the 500000 that are read of a file, or beyond 2000 "
                 "differences of one satellite") == 1);
}
