// The recorded data sets through the programs as a user runs them: leonav-import, leonav-replay,
// leonav-eval.
#pragma once
#include <cstdlib>
#include <string>

#include "support/catch.h"
#include "support/program_run.h"
#include "support/shared_data.h"

namespace leonav::test {

struct Errors {
  double answered = 0.0, rmse = 0.0, p95 = 0.0;  // horizontal, m
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
          number_after(text, "horizontal_m", "p95")};
}

inline std::string config(const std::string& name) {
  return "--config " LEONAV_SOURCE_DIR "/config/" + name + ".yaml";
}

inline bool programs() { return have_programs("leonav-import", "leonav-replay", "leonav-eval"); }

}  // namespace leonav::test
