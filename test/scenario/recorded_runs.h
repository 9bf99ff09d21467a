// The recorded data sets through the programs as a user runs them: leonav-import, leonav-replay,
// leonav-eval.
#pragma once
#include <cstdlib>
#include <fstream>
#include <string>

#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/recorded/shared_data.h"

namespace leonav::test {

struct Errors {
  double answered = 0.0, rmse = 0.0, p95 = 0.0;  // horizontal, m
  double within = 0.0;                           // share within three stated sigma
};

// The number after `key` in `object` of a JSON text of leonav-eval.
inline double number_after(const std::string& json, const std::string& object,
                           const std::string& key) {
  std::size_t at = object.empty() ? 0 : json.find("\"" + object + "\"");
  REQUIRE(at != std::string::npos);
  at = json.find("\"" + key + "\":", at);
  REQUIRE(at != std::string::npos);
  return std::strtod(json.c_str() + at + key.size() + 3, nullptr);
}

// The log that leonav-import makes of a dataset.yaml.
inline std::string imported_from(const TemporaryFile& place, const std::string& dataset) {
  const std::string log = place.beside("imported.lcmlog");
  const ProgramRun run = run_program("leonav-import", dataset + " -o " + log);
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  return log;
}

inline std::string imported(const TemporaryFile& place, const std::string& set) {
  return imported_from(place, shared_data(set + "/dataset.yaml"));
}

// The drive with an IMU synthesised from its truth, as tools/validate rtklib makes it.
inline std::string semi_real_log(const TemporaryFile& place, const std::string& truth) {
  const std::string imu = place.beside("imu.csv"), dataset = place.beside("dataset.yaml");
  const ProgramRun run =
      run_program("leonav-imu-from-truth", "--truth " + shared_data("drive/truth.csv") + " --out " +
                                               imu + " --truth-out " + truth);
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  std::ofstream(dataset) << "observations: " << shared_data("drive/gnss.obs")
                         << "\nnavigation: " << shared_data("drive/gps.nav")
                         << "\norbits: " << shared_data("drive/COD0MGXFIN_20211180000_05M_ORB.SP3")
                         << "\nimu: " << imu << "\ntruth: " << truth << "\n";
  return imported_from(place, dataset);
}

// Replays `log` with `options` and judges the solution with leonav-eval's options `judge`.
inline Errors errors_of(const TemporaryFile& place, const std::string& log,
                        const std::string& options, const std::string& judge) {
  const std::string out = place.beside("result"), json = place.beside("errors.json");
  const ProgramRun replay = run_program("leonav-replay", options + " --out " + out + " " + log);
  CAPTURE(replay.err);
  REQUIRE(replay.exit_code == 0);
  const ProgramRun eval =
      run_program("leonav-eval", judge + " --json " + json + " " + out + "/solution.csv");
  CAPTURE(eval.err);
  REQUIRE(eval.exit_code == 0);
  const std::string text = text_of(json);
  return {number_after(text, "", "answered"), number_after(text, "horizontal_m", "rmse"),
          number_after(text, "horizontal_m", "p95"), number_after(text, "", "within_three_sigma")};
}

inline std::string config(const std::string& preset) { return "--preset " + preset; }

// The station does not move.
inline std::string station_truth() {
  return "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m\n"
         "2111,345600,55.4935676124,8.4568295850,59.4606\n"
         "2111,432000,55.4935676124,8.4568295850,59.4606\n";
}

// Its position may be another at every epoch.
inline std::string free_to_move() {
  return " --set ekf.motion=constant_velocity"
         " --set ekf.acceleration_noise_horizontal_m_s2_per_sqrt_hz=100"
         " --set ekf.acceleration_noise_vertical_m_s2_per_sqrt_hz=100";
}

inline bool programs() { return have_programs("leonav-import", "leonav-replay", "leonav-eval"); }

}  // namespace leonav::test
