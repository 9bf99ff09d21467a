// tools/validate experiments as its users call it, short: rows run, are not run twice, and end in a
// report.
#include <filesystem>
#include <fstream>

#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "python_script.h"
#include "support/catch.h"
#include "support/has.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"

using namespace leonav::test;

namespace {

ProgramRun experiments(const std::string& words) {
  const TemporaryFile place("unused", "");
  const std::string out = place.beside("out"), err = place.beside("err");
  const std::string command = "timeout 300 '" LEONAV_SOURCE_DIR "/tools/scripts/experiments' " +
                              words + " >'" + out + "' 2>'" + err + "' </dev/null";
  const int status = std::system(command.c_str());
  ProgramRun run;
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.out = text_of(out);
  run.err = text_of(err);
  return run;
}

// What a script prints that imports the experiments' modules.
std::string experiments_script(const std::string& script) {
  return python_script("lib/experiments", script);
}

}  // namespace

TEST_CASE("A short run of the experiments writes its report and is not run twice", "[tools]") {
  if (!have_programs("leonav-sim", "leonav-replay", "leonav-smooth", "leonav-eval")) return;
  const TemporaryFile place("unused", "");
  const std::string out = place.beside("experiments");
  const std::string words = "--bin '" LEONAV_BIN_DIR
                            "' --quick --seeds 1 --rows 'code-gps-leo' --rows "
                            "'carrier-gps-*ins' --rows convergence-static-gps-leo640 '" +
                            out + "'";
  const ProgramRun first = experiments(words);
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  CHECK(has(first.err, "4 runs to do, 0 already there"));
  const std::string report = text_of(out + "/report.md");
  CHECK(has(report, "| GPS/LEO/INS | "));
  CHECK(has(report, "1.08 / 1.18 / 0.63 / 1.72"));
  CHECK(has(report, "| GPS/INS → GPS/LEO/INS | "));
  CHECK(has(report, "| GPS/LEO/INS | 1 of 1 | "));
  CHECK(has(report, "| `carrier-gps-ins` → `carrier-gps-leo-ins` | "));
  CHECK(report.find("## What LEO brings: verdicts") < report.find("## Carriers too"));
  CHECK(has(report, "GPS + LEO 640"));
  CHECK_FALSE(has(report, "failed"));
  for (const char* picture : {"code-cdf.png", "carrier-rmse.png", "carrier-sky.png",
                              "convergence-static-convergence.png"}) {
    CHECK(std::filesystem::file_size(out + "/" + picture) > 1000);
  }
  CHECK_FALSE(std::filesystem::exists(std::filesystem::path(out) / "work" / "city-seed1"));

  const ProgramRun second = experiments(words);
  CHECK(second.exit_code == 0);
  CHECK(has(second.err, "0 runs to do, 4 already there"));
}

TEST_CASE("A row's own commands give its numbers", "[tools]") {
  if (!have_programs("leonav-sim", "leonav-replay", "leonav-smooth", "leonav-eval")) return;
  const TemporaryFile place("unused", "");
  const std::string out = place.beside("experiments");
  const ProgramRun run = experiments("--bin '" LEONAV_BIN_DIR
                                     "' --quick --seeds 1 --rows convergence-static-gps-leo160 '" +
                                     out + "'");
  REQUIRE(run.exit_code == 0);
  const std::string report = text_of(out + "/report.md");
  const std::size_t begin = report.find("```sh\n") + 6;
  const std::string commands = report.substr(begin, report.find("```", begin) - begin);
  const std::string elsewhere = place.beside("alone");
  std::filesystem::create_directories(elsewhere);
  const std::string log = place.beside("log");
  // Absolute paths for what lies in the project; written elsewhere.
  const std::string script = "ln -s '" LEONAV_SOURCE_DIR "'/* . 2>/dev/null\nset -e\n" + commands;
  const TemporaryFile file("alone.sh", script);
  const int status = std::system(
      ("cd '" + elsewhere + "' && sh '" + file.path() + "' >'" + log + "' 2>&1").c_str());
  INFO(text_of(log));
  REQUIRE(status == 0);
  const std::string alone = text_of(elsewhere + "/alone/errors.json");
  const std::string rmse = "\"3d_m\": {\"count\": ";
  REQUIRE(has(alone, rmse));
  const std::string result = text_of(out + "/runs/convergence-static-gps-leo160/seed1.json");
  const std::size_t at = alone.find("\"rmse\": ", alone.find(rmse)) + 8;
  CHECK(has(result, alone.substr(at, 6)));
}

TEST_CASE("What fails is reported, and tried again; what is stopped goes on", "[tools]") {
  if (!have_programs("leonav-sim", "leonav-replay", "leonav-smooth", "leonav-eval")) return;
  const TemporaryFile place("unused", "");
  const std::string bin = place.beside("bin"), out = place.beside("experiments");
  const std::string real = LEONAV_BIN_DIR "/";
  std::filesystem::create_directories(bin);
  for (const char* program : {"leonav-sim", "leonav-smooth"})
    std::filesystem::create_symlink(real + program, bin + "/" + program);
  const auto wrap = [&](const std::string& name, const std::string& trouble) {
    std::ofstream(bin + "/" + name)
        << "#!/bin/sh\n[ -e '" << place.beside(name + ".trouble") << "' ] && " << trouble
        << "\nexec '" << real << name << "' \"$@\"\n";
    std::filesystem::permissions(bin + "/" + name, std::filesystem::perms::owner_all);
    std::ofstream(place.beside(name + ".trouble")) << "now\n";
  };
  wrap("leonav-eval", "exit 0");          // and nothing written
  wrap("leonav-replay", "kill -INT $$");  // as a terminal's Ctrl-C does
  const std::string words =
      "--bin '" + bin + "' --quick --seeds 1 --rows convergence-static-gps-leo160 '" + out + "'";
  const ProgramRun stopped = experiments(words);
  CHECK(stopped.exit_code == 130);
  CHECK(has(stopped.err, "the same call goes on"));
  CHECK_FALSE(has(stopped.err, "Traceback"));
  std::filesystem::remove(place.beside("leonav-replay.trouble"));

  const ProgramRun failed = experiments(words);
  CHECK(failed.exit_code == 1);
  CHECK(has(failed.err, "1 runs to do"));
  CHECK(has(failed.err, "1 runs failed"));
  CHECK(has(text_of(out + "/report.md"), "errors.json"));
  std::filesystem::remove(place.beside("leonav-eval.trouble"));

  const ProgramRun good = experiments(words);
  INFO(good.err);
  CHECK(good.exit_code == 0);
  CHECK(has(good.err, "1 runs to do"));
}

TEST_CASE("Wrong words to the experiments are named", "[tools]") {
  const ProgramRun row = experiments("--bin '" LEONAV_BIN_DIR "' --rows nonsense x");
  CHECK(row.exit_code == 2);
  CHECK(has(row.err, "--rows nonsense: no row has such a name"));
  const ProgramRun seeds = experiments("--bin '" LEONAV_BIN_DIR "' --seeds 0 x");
  CHECK(seeds.exit_code == 2);
  CHECK(has(seeds.err, "whole number of 1 or more"));
  const TemporaryFile place("unused", "");
  const ProgramRun bin =
      experiments("--bin /nowhere --quick '" + place.beside("experiments") + "'");
  CHECK(bin.exit_code == 1);
  CHECK(has(bin.err, "/nowhere/leonav-sim: No such file or directory; build it"));
  CHECK_FALSE(has(bin.err, "Traceback"));
  CHECK(experiments("--bin '" LEONAV_BIN_DIR "' --list").exit_code == 0);
}

TEST_CASE("A drive that is not simulated is reported row by row", "[tools]") {
  if (!have_programs("leonav-sim", "leonav-replay", "leonav-smooth", "leonav-eval")) return;
  const TemporaryFile place("unused", "");
  const std::string bin = place.beside("bin"), out = place.beside("experiments");
  const std::string real = LEONAV_BIN_DIR "/";
  std::filesystem::create_directories(bin);
  for (const std::string name : {"leonav-replay", "leonav-smooth", "leonav-eval"}) {
    std::filesystem::create_symlink(real + name, bin + "/" + name);
  }
  std::ofstream(bin + "/leonav-sim") << "#!/bin/sh\necho no sky today >&2\nexit 1\n";
  std::filesystem::permissions(bin + "/leonav-sim", std::filesystem::perms::owner_all);
  const ProgramRun run = experiments(
      "--bin '" + bin + "' --quick --seeds 1 --rows convergence-static-gps-leo160 '" + out + "'");
  CHECK(run.exit_code == 1);
  const std::string report = text_of(out + "/report.md");
  CHECK(has(report, "convergence-static-gps-leo160, seed 1: not simulated: "));
  CHECK(has(report, "no sky today"));
  CHECK_FALSE(has(report, "not run"));
}

TEST_CASE("Results that are none are errors that name the file", "[tools]") {
  const std::string said = experiments_script(R"(import os, tempfile
import judge
folder = tempfile.mkdtemp()
def try_(what, name, text, *arguments):
    path = os.path.join(folder, name)
    with open(path, "w") as file:
        file.write(text)
    try:
        what(path, *arguments)
        print("taken:", text)
    except judge.JudgeError as error:
        print("refused" if path in str(error) else "unnamed", error)
for text in ("[]", "{}", "[{}]", "[3]", "[null]", "3", "[{\"3d_m\": 1}]", "[{\"3d_m\": {}}]", ""):
    try_(judge.numbers_of, "errors.json", text)
one = '{"rmse": %s, "p50": 1, "p95": 1, "worst": 1}'
whole = '[{"north_m": %s, "east_m": %s, "up_m": %s, "3d_m": %s, "epochs": 3, "convergence_s": null, "settled_s": 1, "within_three_sigma": 1}]'
try_(judge.numbers_of, "errors.json", whole % ((one % '"x"',) * 4))
try_(judge.columns, "epochs.csv", "", ("gps_week",))
try_(judge.columns, "epochs.csv", "gps_week\n", ("gps_week",))
try_(judge.columns, "epochs.csv", "gps_week\nx\n", ("gps_week",))
path = os.path.join(folder, "good.json")
open(path, "w").write(whole % ((one % "2.5",) * 4))
print("rmse", judge.numbers_of(path)["rmse"][3])
)");
  INFO(said);
  CHECK_FALSE(has(said, "taken"));
  CHECK_FALSE(has(said, "unnamed"));
  CHECK_FALSE(has(said, "Traceback"));
  CHECK(has(said, "has no row"));
  CHECK(has(said, "rmse 2.5"));
}

TEST_CASE("Verdicts compare the seeds that both have, and name proven causes alone", "[tools]") {
  const std::string said = experiments_script(R"(import matrix, report, spread, verdicts
rows = {row.name: row for row in matrix.all_rows(1100, 120, 150)}
def result(three_d, satellites=6.0, after=None, time=None):
    return {"rmse": [three_d] * 4, "satellites": satellites, "convergence_s": time, "after_convergence": after,
            "p95_3d": 1.0, "availability": 1.0, "pdop": 2.0}
failed = {"failure": "no disk"}
def verdict(without, with_leo, results):
    rows_ = [rows[without], rows[with_leo]]
    lines = [l for l in verdicts.lines(rows_, dict(zip((without, with_leo), results))) if l.startswith("| `")]
    print(lines)
    return lines
# Seed 2 failed with LEO: its 9 m without count for neither.
verdict("carrier-gps-ins", "carrier-gps-leo-ins", [{1: result(2.0), 2: result(9.0)}, {1: result(1.0), 2: failed}])
verdict("code-gps-ins", "code-gps-leo-ins", [{1: result(2.0)}, {1: result(2.1)}])
verdict("carrier-bds-ins", "carrier-bds-leo-ins", [{1: result(2.0, 10.0)}, {1: result(1.9, 14.0)}])
verdict("carrier-bds-ins", "carrier-bds-leo-ins", [{1: result(2.0, 10.0)}, {1: result(1.9, 17.0)}])
verdict("code-gps-ins-plain", "code-gps-leo-ins-plain", [{1: result(2.0)}, {1: failed}])
for prefix in ("", "fgo-"):  # published is the factor graph's improvement
    verdict(prefix + "sets-gps-ins", prefix + "sets-gps-leo-ins", [{1: result(1, after=4.0), 2: result(1)}, {1: result(1, after=1.0), 2: result(1, after=2.0)}])
print("smoother, not published:", verdict("fgo-code-gps", "fgo-code-gps-leo", [{1: result(2.0)}, {1: result(1.0)}]))
names = ["open-low-gps-ins", "open-low-gps-leo-ins", "fgo-low-gps-ins", "fgo-low-gps-leo-ins"]
low = dict(zip(names, [{1: result(2.0)}, {1: result(0.5)}, {1: result(2.0)}, {1: result(1.9, 7.0)}]))
print([l for l in verdicts.lines([rows[n] for n in names], low) if l.startswith("| `fgo-low")])
print(report.gain_lines([rows[n] for n in names[:2]], low)[-1])
three = {s: result(0, time=t) for s, t in ((1, 100.0), (2, 300.0), (3, None))}
verdict("convergence-static-gps-leo0", "convergence-static-gps-leo160", [three, {s: result(0, time=90.0) for s in three}])
# Without houses the published +34 % is reached: that is the cause with them.
names = [p + "carrier-bds" + q for p in ("", "open-") for q in ("-ins", "-leo-ins")]
both = dict(zip(names, [{1: result(2.0)}, {1: result(1.9, 20.0)}, {1: result(2.0)}, {1: result(1.0)}]))
print([l for l in verdicts.lines([rows[n] for n in names], both) if l.startswith("| `carrier")])
both["open-carrier-bds-leo-ins"] = {1: result(1.8)}
print("not reached:", [l for l in verdicts.lines([rows[n] for n in names], both) if l.startswith("| `carrier")])
names = [row.name for _, row in verdicts.pairs(list(rows.values()))]
print(len(names), "pairs", "code-gps-leo-ins-leo3" in names, "convergence-static-gps-leo320" in names, "code-leo" in names)
print("median", spread.median_time({1: result(0, time=10.0), 2: failed, 3: None}), spread.median_time({1: result(0, time=10.0), 2: failed, 3: result(0, time=20.0)}))
lines = []
report.rmse_table([rows["code-gps-ins"]], {"code-gps-ins": {1: result(1.0), 2: failed}}, lines, [])
print(lines[-1])
pair = [rows["code-gps-ins"], rows["code-gps-leo-ins"]]
print(report.gain_lines(pair, {pair[0].name: {1: result(2.0), 2: result(9.0)}, pair[1].name: {1: result(1.0), 2: failed}})[-1])
)");
  INFO(said);
  CHECK(has(said,
            "| `carrier-gps-ins` → `carrier-gps-leo-ins` | 2.00 m | 1.00 m | 1 | 1 | improves "
            "(+50 %) | +11 %: reached | - |"));
  CHECK(
      has(said,
          "| 2.00 m | 2.10 m | 1 | 0 | DOES NOT IMPROVE (-5 %) | +12 %: MISSED | cause not known"));
  CHECK(has(said,
            "improves (+5 %) | +34 %: MISSED (from N, E and U +12 %: MISSED) | LEO adds 4.0 "
            "satellites here, 6.8 in the paper"));
  CHECK(has(said,
            "improves (+5 %) | +34 %: MISSED (from N, E and U +12 %: MISSED) | cause not known"));
  CHECK(has(said,
            "+12 %: MISSED) | LEO stands behind our houses; without them, as in the paper, and "
            "masked at 5 degrees, +50 % (`open-carrier-bds-leo-ins`) |"));
  CHECK(has(said,
            "not reached: ['| `carrier-bds-ins` → `carrier-bds-leo-ins` | 2.00 m | 1.90 m | "
            "1 | 1 | improves (+5 %) | +34 %: MISSED (from N, E and U +12 %: MISSED) | cause not "
            "known |']"));
  CHECK(has(said, "| - | - | 0 | 0 | no seed of both | "));
  // A filter is not judged by what LEO brings a factor graph, the smoother is.
  CHECK(has(said,
            "`sets-gps-leo-ins` | 4.00 m | 1.00 m | 2 | 2 | improves (+75 %) | +34 % by the "
            "factor graph: not judged | - |"));
  CHECK(has(said,
            "`fgo-sets-gps-leo-ins` | 4.00 m | 1.00 m | 2 | 2 | improves (+75 %) | +34 %: "
            "reached | - |"));
  CHECK(has(said, "smoother, not published: []"));
  CHECK(has(said,
            "improves (+5 %) | +47 %: MISSED | LEO stands behind our houses; without them, as in "
            "the paper, and masked at 5 degrees, +75 % by the filter "
            "(`open-low-gps-leo-ins`); LEO adds 1.0 satellites here, 7.5 in the paper"));
  CHECK(has(said, "| 49 % / 59 % / 13 % / - by the factor graph |"));
  CHECK(has(said, "| 300 s | 90 s | 3 | 3 | improves (+70 %) | - | - |"));
  CHECK(has(said, "pairs True False False"));
  CHECK(has(said, "median (None, 1, 3) (20.0, 2, 3)"));
  CHECK(has(said, "| GPS/INS | 1 of 2 | "));
  CHECK(has(said, "| 50 % / 50 % / 50 % / 50 % | 1 of 1 | "));
}

TEST_CASE(
    "The smoother's gain on the filter stands beside the factor graph's on the EKF, no metres",
    "[tools]") {
  const std::string said = experiments_script(R"(import matrix, published, smoother_verdicts
rows = {row.name: row for row in matrix.all_rows(1100, 120, 150)}
def result(three_d):
    return {"rmse": [three_d] * 4, "after_convergence": three_d, "within_three_sigma": 0.9}
def lines(errors):
    names = list(errors)
    results = {}
    for name, (filter_, smoother) in errors.items():
        results[rows[name].filter.name], results[name] = {1: result(filter_)}, {1: result(smoother)}
        if "carrier" in name:
            results[rows[name].whole_log.name] = {1: result(0.5)}
    print("\n".join(smoother_verdicts.lines([rows[name] for name in names], results)))
modes = ("gps-ins", "gps-leo-ins", "bds-ins", "bds-leo-ins")
lines({**{f"fgo-carrier-{mode}": (1.0, 0.8) for mode in modes}, **{f"fgo-carrier-{mode}-plain": (9.0, 9.0) for mode in modes},
       "fgo-low-gps-ins": (2.0, 1.0), "fgo-sets-bds-ins": (2.0, 1.0), "fgo-code-gps-ins": (2.0, 1.0)})
print("only", end=" ")
lines({"fgo-code-gps-ins": (2.0, 1.0)})
)");
  INFO(said);
  CHECK(has(said,
            "| `fgo-carrier-gps-ins` | 1.00 ± 0.00 | 0.80 ± 0.00 | 0.50 ± 0.00 | 1 of 1 | +20 % | "
            "+21 % |"));
  CHECK(has(said, "| +20 % | +26 % |"));
  // The printed 3D error of BDS/INS is not the root of its components.
  CHECK(has(said, "| +20 % | +35 % (from N, E and U +13 %) |"));
  CHECK(has(said, "| +20 % | +11 % |"));
  CHECK(has(
      said,
      "| `fgo-low-gps-ins` | 2.00 ± 0.00 | 1.00 ± 0.00 | - | 1 of 1 | +50 % | no EKF printed |"));
  CHECK(has(said, "| 1 of 1 | +50 % | - |"));
  CHECK(has(said,
            "with robust weights: reached in 1 of 4 rows, 20 % on the mean beside 23 % (from N, E "
            "and U: 2 of 4, 18 %); without robust weights, as theirs: reached in 0 of 4 rows, 0 % "
            "on the mean beside 23 % (from N, E and U: 0 of 4, 18 %)."));
  CHECK(has(said, "errors in metres are those of other drives"));
  CHECK_FALSE(has(said, "times ours"));
  CHECK_FALSE(has(said.substr(said.find("only ")), "The published gain of"));
}

TEST_CASE("Rows of constraints are judged seed by seed, and not where epochs lack an answer",
          "[tools]") {
  const std::string said = experiments_script(R"(import matrix, motion, numpy as np, plots
row = {row.name: row for row in matrix.all_rows(1100, 120, 150)}["motion-tactical-car-ekf"]
def series(error, without=None, few=4):
    epochs = np.arange(3003.0)
    used = np.full(3003, 8.0)
    used[2501:2801] = few
    t = epochs if without is None else epochs[(epochs <= without[0]) | (epochs > without[1])]
    return {"t": t, "t_epoch": epochs, "satellites": used, "error": np.array([0.6 * np.ones(len(t)), 0.8 * np.ones(len(t)), np.ones(len(t))]) * error}
print("whole", [round(v, 3) for v in motion.numbers_of(row, series(0.5))])
print("holes", [round(v, 3) for v in motion.numbers_of(row, series(0.5, (2040, 2060)))])
def lines(every):
    plots.all_series = lambda row, results, runner: every
    out = []
    results = {row.name: {s + 1: {} for s in range(len(every))}}
    motion.table([row], results, None, out)
    print("\n".join(out + motion.verdict_lines([row], results, None)))
lines([series(0.5), series(0.7)])
lines([series(0.5), series(1.2)])
lines([series(0.5), series(0.5, (2040, 2060), 5)])
)");
  INFO(said);
  CHECK(has(said, "whole [0.3, 0.4, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5]"));
  CHECK(has(said, "holes [0.3, 0.4, 0.5, 0.5, 0.5, 0.5, nan, nan, 0.5, 0.5]"));
  CHECK(has(said, "0.70 m | 1 m: met | 0.60 ± 0.14 | 0.70 m | 2 m: met |"));
  CHECK(has(said, "1.20 m | 1 m: MISSED in 1 of 2 |"));
  CHECK(has(said, "2 m: MISSED in 1 of 2 |"));
  CHECK(has(said, "0.50 ± 0.00 (1 of 2)"));
  CHECK(has(said,
            "4 to 4 satellites used at an epoch of these minutes, 4.0 on the mean, none at 0.0 %"));
  CHECK(has(said,
            "4 to 5 satellites used at an epoch of these minutes, 4.5 on the mean, none at 0.0 % "
            "of the epochs: MORE THAN FOUR."));
}

TEST_CASE("Rows of mismatched drives are those of the matched ones, of other logs", "[tools]") {
  const std::string said = experiments_script(R"(import matrix, report
rows = {row.name: row for row in matrix.all_rows(1100, 120, 150)}
found = [row for row in rows.values() if row.group == "mismatch"]
for row in found:
    matched = rows[row.matched]
    same = (row.settings, row.settle_epochs, row.by_time) == (matched.settings, matched.settle_epochs, matched.by_time)
    more = [s for s in row.scene.settings(3) if s not in matched.scene.settings(3)]
    lacks = [s for s in matched.scene.settings(3) if s not in row.scene.settings(3)]
    print(row.name, same, row.scene.name != matched.scene.name, lacks, more)
lines = []
report.mismatch_table(found, {row.name: {1: None} for row in found}, lines)
print(len(lines) - 4, "lines")
)");
  INFO(said);
  CHECK(has(said,
            "mismatch-multipath-static-gps-leo160 True True [] ['receiver.multipath.time_s=200']"));
  CHECK(has(said, "mismatch-multipath-static-gps-gal-bds-leo160 True True [] "));
  CHECK(has(said, "mismatch-imu-carrier-gps-leo-ins True True [] ['imu.angle"));
  CHECK(has(said, "4 lines"));
  // Twice what the estimator is told.
  const std::string config = leonav::effective_text(leonav::load_preset("urban").source);
  for (const char* key : {"angle_random_walk_deg_per_sqrt_h: 0.05 ", "gyro_bias_deg_per_h: 1 ",
                          "velocity_random_walk_m_s_per_sqrt_h: 0.1 ", "accel_bias_mgal: 25 ",
                          "gyro_scale_ppm: 300 ", "accel_scale_ppm: 300 "}) {
    CHECK(has(config, key));
  }
}
