// leonav-fleet --matrix and tools/validate streets: scenes, estimators and limits.
#include "tools/fleet/fleet_run.h"

using namespace leonav::test;

namespace {

constexpr const char* kMatrix = R"(title: Small
preset: urban
seeds: 2
per_seed: {satellites.advance_s: 7001, atmosphere.tecu: [10, 45]}
duration_s: 60
settle_s: 20
scenes:
  open:
    scenario: SOURCE/config/scenario/urban.yaml
    set: [places=none]
    limits: [share >= 0]
  city:
    scenario: SOURCE/config/scenario/urban.yaml
    set: [places=city]
  later:
    scenario: absent.yaml
    optional: true
axes:
  systems:
    GPS: {set: ["gnss.systems=[gps]"]}
    all: {}
limits: ["rmse_3d <= 0.0001", available >= 50]
)";

std::string matrix_text() {
  std::string text = kMatrix;
  for (std::size_t at; (at = text.find("SOURCE")) != std::string::npos;)
    text.replace(at, 6, LEONAV_SOURCE_DIR);
  return text;
}

std::string matrix_words(const std::string& file, const std::string& bin, const std::string& out,
                         const std::string& more = "") {
  return "--matrix '" + file + "' --bin '" + bin + "' --out '" + out + "' " + more;
}

}  // namespace

TEST_CASE("A matrix has a row a scene and estimator, with its verdict; logs do not stay",
          "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile file("small.yaml", matrix_text());
  const std::string one = file.beside("one"), two = file.beside("two");
  const ProgramRun first = fleet(matrix_words(file.path(), LEONAV_BIN_DIR, one, "--workers 1"));
  INFO(first.err);
  CHECK(first.exit_code == 1);
  CHECK(has(first.err, "8 runs to do, 0 already there"));
  CHECK(has(first.err, "later is skipped: "));
  CHECK(has(first.err, "2 of 4 rows miss a limit"));
  const std::string report = text_of(one + "/report.md");
  INFO(report);
  CHECK(has(report, "2 of 4 rows keep to every limit."));
  CHECK(has(report, "| rmse_3d <= 0.0001 | 0 of 2 |"));
  CHECK(has(report, "| available >= 50 | 2 of 2 |"));
  CHECK(has(report, "| open | GPS | 2 of 2 | "));
  CHECK(has(report, "--set satellites.advance_s=7001 --set atmosphere.tecu=10 "));
  CHECK(has(report, "| city | all | 2 of 2 | "));
  CHECK(has(report, "MISSED: rmse_3d <= 0.0001: "));
  CHECK_FALSE(std::filesystem::exists(one + "/work"));
  CHECK_FALSE(std::filesystem::exists(one + "/logs"));

  const ProgramRun second =
      fleet(matrix_words(file.path(), LEONAV_BIN_DIR, two, "--workers 2 --keep"));
  CHECK(second.exit_code == 1);
  CHECK(text_of(two + "/report.md") == report);
  CHECK(text_of(two + "/report.json") == text_of(one + "/report.json"));
  CHECK(std::filesystem::exists(two + "/logs/city-seed2/run.lcmlog"));
  CHECK(std::filesystem::exists(two + "/runs/city/all/seed2/solution.csv"));

  CHECK(has(fleet(matrix_words(file.path(), LEONAV_BIN_DIR, one, "--resume")).err,
            "0 runs to do, 8 already there"));
  CHECK(text_of(one + "/report.md") == report);
  CHECK(has(fleet(matrix_words(file.path(), LEONAV_BIN_DIR, one,
                               "--resume --duration 50 --rows 'open/*'"))
                .err,
            "4 runs to do, 0 already there"));
}

TEST_CASE("A matrix holds errors against their levels, and draws them where it can",
          "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile file("small.yaml", matrix_text());
  const std::string out = file.beside("out");
  const std::string all =
      matrix_words(file.path(), LEONAV_BIN_DIR, out,
                   "--rows 'open/*' --resume --set integrity.risk_per_hour=1e-4 --set "
                   "integrity.tail_share=0");
  CHECK(fleet(all).exit_code == 0);
  const std::string report = text_of(out + "/report.md");
  INFO(report);
  CHECK(has(report,
            "Levels of risk 0.0001 per hour, errors independent after 10 s, sigma factor 1, tail 0 "
            "% of 2 sigma. Runs: 4, logs: 2.\n"));
  CHECK(has(report,
            "| horizontal | 0.0001, configured | as stated (at least 5.27 sigma) | 1.000 | "));
  CHECK(has(report, "| vertical | 1 | 2.99 sigma | 0.582 | "));
  CHECK(has(report,
            "| scene | systems | epochs expected | horizontal level at most 1 / 3 / 10 m, % "));
  CHECK(has(report, "| open | GPS | "));
  CHECK(has(report, "| all scenes | all together | "));
  CHECK_FALSE(has(text_of(out + "/report.json"), "\"multiples\""));
  CHECK(has(text_of(out + "/report.json"), "\"confidence_if_independent\""));
  const std::string sums = text_of(out + "/stanford.json");
  CHECK(has(sums, "\"diagram\": [["));
  const std::string picture = out + "/stanford_horizontal.png";
  if (shell("/usr/bin/python3 -c 'import matplotlib'").exit_code == 0)
    CHECK(std::filesystem::file_size(picture) > 1000);
  // Without the package the report is the same, and no picture of an earlier call stays.
  const TemporaryFile absent("matplotlib.py", "raise ImportError('No module named matplotlib')\n");
  const std::string folder = std::filesystem::path(absent.path()).parent_path();
  const ProgramRun without =
      shell("PYTHONPATH='" + folder + "' timeout 300 '" LEONAV_BIN_DIR "/leonav-fleet' " + all);
  INFO(without.err);
  CHECK(without.exit_code == 0);
  CHECK(
      has(without.err, "no Stanford diagrams: leonav-integrity-plots: No module named matplotlib"));
  CHECK(text_of(out + "/report.md") == report);
  CHECK(text_of(out + "/stanford.json") == sums);
  CHECK_FALSE(std::filesystem::exists(picture));
}

TEST_CASE("A worker that is lost in a matrix changes nothing", "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile file("small.yaml", matrix_text());
  const WaitingPrograms programs(file);
  const std::string disturbed = file.beside("disturbed"), calm = file.beside("calm");
  const ProgramRun run = programs.disturbed(
      "kill", matrix_words(file.path(), programs.bin, disturbed, "--rows 'open/*' --workers 2"));
  INFO(run.out + run.err);
  CHECK(has(run.out, "a worker killed"));
  CHECK(has(run.out, "exit 0"));
  CHECK(has(run.out, "programs left: 0"));
  CHECK(fleet(matrix_words(file.path(), programs.bin, calm, "--rows 'open/*'")).exit_code == 0);
  CHECK(text_of(disturbed + "/report.json") == text_of(calm + "/report.json"));
}

TEST_CASE("A scene that is not simulated is told run by run", "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile file("small.yaml", matrix_text());
  const std::string out = file.beside("out");
  const ProgramRun run = fleet(matrix_words(file.path(), LEONAV_BIN_DIR, out, "--rows '*/GPS'") +
                               " --duration 60000000");
  CHECK(run.exit_code == 1);
  CHECK(has(run.err, "4 of 4 runs failed"));
  const std::string report = text_of(out + "/report.md");
  INFO(report);
  CHECK(has(report, "- city/GPS/seed1: not simulated: "));
  CHECK(has(report, "FAILED in 2 of 2 seeds"));
}

TEST_CASE("Wrong matrices are named", "[tools][fleet]") {
  if (!have_fleet()) return;
  const auto says = [](const std::string& from, const std::string& to, const std::string& text) {
    std::string matrix = matrix_text();
    const std::size_t at = matrix.find(from);
    REQUIRE(at != std::string::npos);
    const TemporaryFile file("wrong.yaml", matrix.replace(at, from.size(), to));
    const ProgramRun run = fleet(matrix_words(file.path(), LEONAV_BIN_DIR, file.beside("out")));
    INFO(to + ": " + run.err);
    CHECK(run.exit_code == 2);
    CHECK(has(run.err, "wrong.yaml"));
    CHECK(has(run.err, text));
    CHECK_FALSE(has(run.err, "Traceback"));
  };
  says("seeds: 2", "seed: 2", "seed: no such key; there are ");
  says("settle_s: 20", "settle_s: 60", "its 60 s are over before the 60 s that do not count");
  says("seeds: 2", "seeds: none", "must be a number of seeds, or a list of them");
  says("[10, 45]", "[10, much]", "per_seed.atmosphere.tecu: must be a number");
  says("[10, 45]", "[]", "per_seed.atmosphere.tecu: must be a number");
  says("preset: urban", "preset: urban\nconfig: x.yaml", "only one of them");
  says("available >= 50", "shares >= 50", "'shares >= 50': must be one of share, ");
  says("optional: true", "optional: false", "absent.yaml: no such file");
  says("set: [places=city]", "set: places=city", "scenes.city.set: must be a list");
  says("axes:", "compare: {axis: noise}\naxes:", "compare.axis: must be one of systems");
  says("axes:", "compare: {axis: systems, value: none}\naxes:",
       "compare.value: must be one of several values of systems: GPS, all");
  says("all: {}", "all: {sets: []}", "axes.systems.all.sets: no such key");
  says("scenes:", "scenes: [", "wrong.yaml:");
  const TemporaryFile file("small.yaml", matrix_text());
  const ProgramRun row =
      fleet(matrix_words(file.path(), LEONAV_BIN_DIR, file.beside("out"), "--rows x"));
  CHECK(row.exit_code == 2);
  CHECK(has(row.err, "--rows x: no row has such a name"));
  CHECK(fleet("--matrix '" + file.path() + "' --list").out ==
        "open/GPS\nopen/all\ncity/GPS\ncity/all\n");
}

TEST_CASE("Keys differ from seed to seed", "[tools][fleet]") {
  if (!have_fleet()) return;
  const std::string said = fleet_python(R"(from fleet import matrix
scene = matrix.Scene("city", "urban.yaml", ("places=city",), ())
for seed in 1, 2, 5: print(*scene.settings_of(seed, (("advance", 7001), ("tecu", [10, 45]))))
)");
  CHECK(said ==
        "seed=1 advance=7001 tecu=10 places=city\nseed=2 advance=14002 tecu=45 places=city\n"
        "seed=5 advance=35005 tecu=10 places=city\n");
}

TEST_CASE("Rows pool the epochs of their seeds and name the worst", "[tools][fleet]") {
  if (!have_fleet()) return;
  const std::string said = fleet_python(R"(from fleet import matrix, matrix_report, replays
def result(rmse, within, count, ratio, integrity=None, failure=None):
    errors = {key: {"rmse": rmse, "p95": 1.0, "worst": 1.0} for key in ("north", "east", "up", "horizontal", "3d")}
    sigmas = {axis: {"count": count, "within": within, "mean_sigma_m": ratio * rmse, "sigma_over_rmse": ratio} for axis in ("north", "east", "up")}
    return {"name": "n", "failure": failure, "judged": True, "epochs": count, "answered": count, "expected_in_truth": count, "errors": errors,
            "sigmas": sigmas, "integrity": integrity}
def row(limits, *results):
    scene = matrix.Scene("city", "x.yaml", (), tuple(matrix.Reader("m.yaml").limit(text, "limits") for text in limits))
    return matrix_report.Row(scene, matrix.Variant(("GPS",), replays.Estimator()), dict(enumerate(results, 1)))
both = row(["share >= 98", "sigma_over_rmse <= 2", "worst_share >= 85"], result(1.0, 99, 100, 2.0), result(3.0, 270, 300, 1.0))
print(both.line(False))
print(row(["share >= 92", "worst_3d <= 3"], result(1.0, 99, 100, 2.0), result(3.0, 270, 300, 1.0)).verdict())
print(row(["share >= 92"], result(1.0, 99, 100, 2.0), {"name": "n", "failure": "no disk"}).verdict())
counted = row([], result(1.0, 9, 10, 1.0, {"horizontal": {"misleading": 2, "epochs": 10, "largest_ratio": 1.5, "limits": [{"limit_m": 1, "hazardous": 1}]}}), result(1.0, 9, 10, 1.0, {"horizontal": {"misleading": 3, "epochs": 10, "limits": [{"limit_m": 1, "hazardous": 4}]}}))
print(counted.pooled["integrity"], "|", counted.line(True))
print("limit", counted.values("misleading"))
)");
  INFO(said);
  // 369 of 400 epochs; mean sigma (100 x 2 + 300 x 3) / 400 over the root of (100 + 300 x 9) / 400.
  CHECK(has(said,
            "| city | GPS | 2 of 2 | 2.00 / 2.00 / 2.00 | 2.00 | 3.00 (seed 2) | 92.2 / 92.2 / "
            "92.2 | 90.0 / 90.0 / 90.0 | 1.04 / 1.04 / 1.04 | 100.0 | MISSED: share >= 98: 92.25"));
  CHECK(has(said, "\nmet\n"));
  CHECK(has(said, "\nFAILED in 1 of 2 seeds\n"));
  CHECK(has(said, "'horizontal.limits.1_m.hazardous': 5, 'horizontal.misleading': 5} | "));
  CHECK(has(said, "| horizontal 5 of 20 | - |"));
  CHECK(has(said, "limit [25.0]"));
}

TEST_CASE("One value of an axis is held against the best of the others", "[tools][fleet]") {
  if (!have_fleet()) return;
  const std::string said = fleet_python(R"(import types
from fleet import matrix, matrix_report, replays
def result(horizontal, rmse):
    errors = {key: {"rmse": rmse, "p95": 1.0, "worst": 1.0} for key in ("north", "east", "up", "3d")}
    errors["horizontal"] = {"rmse": horizontal, "p95": 1.0, "worst": 1.0}
    sigmas = {axis: {"count": 10, "within": 9, "mean_sigma_m": 1.0, "sigma_over_rmse": 1.0} for axis in ("north", "east", "up")}
    return {"name": "n", "failure": None, "judged": True, "epochs": 10, "answered": 10, "expected_in_truth": 10, "errors": errors,
            "sigmas": sigmas, "integrity": None}
def row(systems, noise, horizontal, rmse):
    return matrix_report.Row(matrix.Scene("city", "x.yaml", (), ()), matrix.Variant((systems, noise), replays.Estimator()), {1: result(horizontal, rmse)})
rows = [row("GPS", "learned", 1.0, 2.1), row("GPS", "small", 0.8, 3.0), row("GPS", "large", 1.0, 2.0),
        row("all", "learned", 0.9, 1.0), row("all", "small", 0.5, 1.0), row("all", "large", 0.1, 1.5)]
whole = types.SimpleNamespace(axes=["systems", "noise"], comparison=matrix.Comparison(1, "learned", 1.1))
print("\n".join(matrix_report.comparison_lines(whole, rows)))
print([found.plain()["ratios"] for found in matrix_report.compared(whole, rows)])
# At seed 1 "small" is chosen by seed 2, and the other way round.
by_two = [matrix_report.Row(matrix.Scene("city", "x.yaml", (), ()), matrix.Variant(("GPS", noise), replays.Estimator()),
                            {1: result(first, first), 2: result(second, second)})
          for noise, first, second in (("learned", 1.0, 2.0), ("small", 2.0, 1.0), ("large", 1.0, 4.0))]
print("unseen", matrix_report.compared(whole, by_two)[0].plain()["unseen_ratios"])
few, many = row("GPS", "few", 1.0, 1.0), row("GPS", "many", 1.0, 1.0)
print("good", matrix_report.bad_runs_lines([few, many]))
few.good[1]["sigmas"]["up"]["within"] = 8
many.good[1]["integrity"] = {"heading": {"misleading": 3}, "vertical": {"misleading": 0}}
print("\n".join(matrix_report.bad_runs_lines([few, many])))
whole.comparison = None
print("none", matrix_report.comparison_lines(whole, rows))
)");
  INFO(said);
  CHECK(has(said, "In 1 of 2 rows learned has at most 1.1 times its RMSE"));
  CHECK(has(said,
            "| city | GPS | 1.00 | 2.10 | large | 1.00 | 2.00 | 90.0 / 90.0 / 90.0 | 1.00 | 1.05 | "
            "met | - |"));
  CHECK(has(said,
            "| city | all | 0.90 | 1.00 | small | 0.50 | 1.00 | 90.0 / 90.0 / 90.0 | 1.80 | 1.00 | "
            "MISSED | - |"));
  // Of `small` 3.0 / 2.1 and 1.0 / 1.0, of `large` 2.0 / 2.1 and 1.5 / 1.0.
  CHECK(has(said,
            "| noise | mean | largest | least share, % |\n|---|---|---|---|\n"
            "| small | 1.20 | 1.43 | 90.0 |\n| large | 1.20 | 1.50 | 90.0 |\n"));
  // The learned 3.0 / 2 over (2.0 + 4.0) / 2.
  CHECK(has(said, "unseen {'horizontal': 0.5, '3d': 0.5}\n"));
  CHECK(has(said, "good []\n## Single runs to look at: 2\n"));
  CHECK(has(said, "| n | 90.0 / 90.0 / 80.0 | 1.00 / 1.00 / 1.00 | - |\n"));
  CHECK(has(said, "| n | 90.0 / 90.0 / 90.0 | 1.00 / 1.00 / 1.00 | heading 3 |\n"));
  CHECK(has(said, "none []\n"));
}

TEST_CASE("The streets' matrix can be read, and its script says what it does", "[tools][fleet]") {
  if (!have_fleet()) return;
  const ProgramRun list = shell("'" LEONAV_SOURCE_DIR "/tools/validate' streets --list");
  INFO(list.err);
  CHECK(list.exit_code == 0);
  CHECK(has(list.out, "rays_city/GPS-on-filter\n"));
  CHECK(has(list.out, "rays_dense_city/all-off-smoother\n"));
  CHECK(has(shell("'" LEONAV_SOURCE_DIR "/tools/validate' streets --hand --list").out,
            "/GPS-on-filter-learned\n"));
  CHECK(has(shell("'" LEONAV_SOURCE_DIR "/tools/validate' streets --help").out, "--seeds N"));
}
