// leonav-bench says what was measured, and fails where a limit is not kept.
#include "support/catch.h"
#include "support/programs/program_run.h"

using namespace leonav::test;
using Catch::Contains;

TEST_CASE("a full sky is measured, and a limit that is not kept is no success") {
  if (!have_programs("leonav-bench", "leonav-synthetic-drive")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("run.lcmlog");
  REQUIRE(run_program("leonav-synthetic-drive",
                      "--full-sky --carriers --slips 0.1 --duration 60 --out '" + log +
                          "' --truth '" + place.beside("truth.csv") + "'")
              .exit_code == 0);
  const auto bench = [&](const std::string& limits) {
    return run_program("leonav-bench", "--preset demo --set ekf.carrier=true --repeat 1 " + limits +
                                           " '" + log + "'");
  };
  const ProgramRun kept = bench("--min-satellites 30 --max-imu-us 1e6 --max-epoch-ms 1e4");
  CHECK(kept.exit_code == 0);
  CHECK_THAT(kept.out, Contains("satellites used: median 32") && Contains("processor time"));
  CHECK(bench("--max-imu-us 1e-6").exit_code == 1);
  CHECK(bench("--min-satellites 33").exit_code == 1);
  const ProgramRun slow = bench("--max-epoch-ms 1e-6");
  CHECK(slow.exit_code == 1);
  CHECK_THAT(slow.err, Contains("99 % of the GNSS epochs") && Contains("--max-epoch-ms"));
  CHECK(bench("--max-epoch-ms soon").exit_code == 2);
  CHECK_THAT(kept.out, !Contains("solve"));
  const std::string smoother = "--set estimator=smoother --set smoother.window=5 ";
  const ProgramRun solves = bench(smoother + "--max-solve-ms 1e4");
  CHECK(solves.exit_code == 0);
  CHECK_THAT(solves.out, Contains("keyframes at most 5; allocations per solve 0.000"));
  CHECK(bench(smoother + "--max-solve-ms 1e-6").exit_code == 1);
  CHECK(bench(smoother + "--max-solve-ratio 1e3").exit_code == 0);
  const ProgramRun uneven = bench(smoother + "--max-solve-ratio 0.5");
  CHECK(uneven.exit_code == 1);
  CHECK_THAT(uneven.err, Contains("over their median") && Contains("--max-solve-ratio"));
  CHECK_THAT(bench("--max-solve-ratio 2").err, Contains("nothing was solved"));
}

TEST_CASE("a synthetic drive refuses slips without carriers") {
  if (!have_programs("leonav-synthetic-drive")) return;
  const ProgramRun run = run_program("leonav-synthetic-drive", "--slips 0.1 --out o --truth t");
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.err, Contains("--carriers"));
}
