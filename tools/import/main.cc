// leonav-import converts a recording in files to an LCM event log.
#include <iostream>

#include "drivers/csv/imu_csv.h"
#include "drivers/csv/truth_csv.h"
#include "tools/common/arguments.h"
#include "tools/import/import.h"

namespace {

int body(int argc, char** argv) {
  leonav::Arguments arguments(
      "leonav-import", "dataset.yaml -o run.lcmlog [options]",
      "Turns a recording in files into an LCM event log, in the order and at the times a live\n"
      "system would have received it. Keys of dataset.yaml, each a path or a list of paths,\n"
      "relative to the file: observations (RINEX 2 or 3, .ubx, .rtcm3, .rtcm,\n"
      "NovAtel's .oem7 or .gps, Septentrio's .sbf), navigation (RINEX 2 to 4, .rtcm3, .rtcm),\n"
      "leo_elements (a table), orbits (SP3), clocks, biases (Bias-SINEX 1.00: code biases of the\n"
      "satellites, of the same provider as the clocks), corrections (SSR in .rtcm3, .rtcm; pages\n"
      "of Galileo HAS in .has, .ubx or .sbf, of PPP-B2b in .b2b or .sbf), antenna_models (ANTEX),\n"
      "imu (imu.csv; .oem7 or .gps with\n"
      "RAWIMUSX or its relatives; .sbf with ExtSensorMeas; .ubx with UBX-ESF-RAW), truth;\n"
      "imu_scale ([rad, m/s] of a count, for a NovAtel IMU whose type has no documented scale);\n"
      "corrections_latency_s (of SSR, from a correction's time to its arrival; 10 where not "
      "given);\n"
      "corrections_point (antenna or mass_centre, the point of a satellite that corrected orbits\n"
      "are of; antenna);\n"
      "and as text name, receiver_antenna (type and radome, where the observations' header is\n"
      "wrong), and date (YYYY-MM-DD, of the recording: RTCM 3 messages do\n"
      "not say the week; up to three days off will do). The shortest one:\n"
      "\n"
      "  observations: rover.ubx   # brings its ephemerides; beside RINEX add navigation: "
      "brdc.nav\n"
      "  imu: imu.csv\n"
      "\n"
      "imu.csv has the columns " +
          std::string(leonav::kImuCsvHeader) + ",\ntruth.csv " +
          std::string(leonav::kTruthCsvHeader) +
          ";\nthe end of a name is the unit. docs/design.md (Files) has the conventions.");
  arguments.option("--out", "FILE", "the log to write; -o for short")
      .option("--from", "TIME",
              "leave out data before this GPS time: WEEK:SECONDS or YYYY-MM-DDThh:mm:ss")
      .option("--to", "TIME", "leave out data after this GPS time")
      .option("--gnss-latency-ms", "MS", "a GNSS epoch arrives this long after its time", "50");
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() != 1) {
    throw leonav::UsageError("give one dataset.yaml (--help tells more)");
  }
  leonav::ImportOptions options;
  options.from = arguments.time("--from");
  options.to = arguments.time("--to");
  if (options.from.is_set() && options.to.is_set() && options.to < options.from) {
    throw leonav::UsageError("--to is before --from");
  }
  options.gnss_latency_s = arguments.number("--gnss-latency-ms") * 1e-3;
  if (!(options.gnss_latency_s >= 0.0 && options.gnss_latency_s <= 10.0)) {
    throw leonav::UsageError("--gnss-latency-ms must be within 0 and 10000");
  }
  const std::string output = arguments.required("--out");
  const leonav::Dataset dataset = leonav::load_dataset(arguments.positional()[0]);
  const leonav::ImportReport report = leonav::import_dataset(dataset, options, output, &std::cerr);
  std::cout << output << (dataset.name.empty() ? "" : ": " + dataset.name) << "\n"
            << leonav::to_string(report);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-import", body, argc, argv); }
