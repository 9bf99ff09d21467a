// leonav-fleet as its users call it, over short logs: the report, lost workers, a stop, wrong
// words.
#include "tools/fleet/fleet_run.h"

using namespace leonav::test;

namespace {

constexpr const char* kScenario = "'" LEONAV_SOURCE_DIR "/config/scenario/urban.yaml'";

// Two logs with a truth, one without, and one that is none; made once.
const std::string& logs() {
  static const TemporaryFile place("unused", "");
  static const std::string folder = [] {
    const std::string path = place.beside("logs");
    for (const std::string name : {"one", "two"}) {
      std::filesystem::create_directories(path + "/" + name);
      const ProgramRun run = run_program(
          "leonav-sim",
          kScenario +
              (" --set duration_s=60 --seed " + std::string(name == "one" ? "1" : "2") + " -o '") +
              path + "/" + name + "/run.lcmlog'");
      REQUIRE(run.exit_code == 0);
    }
    std::filesystem::rename(path + "/two/truth.csv", path + "/two/run.truth.csv");
    std::filesystem::copy(path + "/one/run.lcmlog", path + "/unknown.lcmlog");
    std::ofstream(path + "/broken.lcmlog") << "no log\n";
    return path;
  }();
  return folder;
}

std::string fleet_words(const std::string& bin, const std::string& out,
                        const std::string& more = "") {
  return "--bin '" + bin + "' --preset urban " + more + " --out '" + out + "' '" + logs() + "'";
}

void check_same(const std::string& a, const std::string& b) {
  for (const char* name : {"/report.md", "/report.json"})
    CHECK(text_of(a + name) == text_of(b + name));
}

}  // namespace

TEST_CASE("Many logs give one report, whatever the number of workers, and are not run twice",
          "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile place("unused", "");
  const std::string one = place.beside("one"), two = place.beside("two");
  const ProgramRun first = fleet(fleet_words(LEONAV_BIN_DIR, one, "--workers 1"));
  INFO(first.err);
  CHECK(first.exit_code == 1);
  CHECK(first.out == one + "/report.md\n");
  CHECK(has(first.err, "1 of 4 runs failed"));
  CHECK(has(first.err, "/4, "));
  CHECK_FALSE(has(first.err, "Traceback"));
  const std::string report = text_of(one + "/report.md");
  INFO(report);
  // Three warn that they end while aligning, because no drive moves within its minute.
  CHECK(has(report, "4 runs, 1 failed, 2 with a truth; 0 misses, 0 resets, 3 warnings."));
  CHECK(has(report, "- broken: "));
  CHECK(has(report, "is not an LCM log"));
  CHECK(has(report, "| one/run | "));
  CHECK(has(report, "| two/run | "));
  CHECK(has(report, "| unknown | - | "));
  CHECK(has(text_of(one + "/report.json"), "\"within_three_sigma\""));
  CHECK_FALSE(std::filesystem::exists(one + "/work"));
  CHECK_FALSE(std::filesystem::exists(one + "/runs/one/run"));

  const ProgramRun second = fleet(fleet_words(LEONAV_BIN_DIR, two, "--workers 2 --keep"));
  CHECK(second.exit_code == 1);
  check_same(one, two);
  CHECK(std::filesystem::exists(two + "/runs/one/run/solution.csv"));

  // What is there is taken; what failed is tried again.
  const std::string result = two + "/runs/one/run.json";
  const auto written = std::filesystem::last_write_time(result);
  CHECK(fleet(fleet_words(LEONAV_BIN_DIR, two, "--resume")).exit_code == 1);
  CHECK(std::filesystem::last_write_time(result) == written);
  check_same(one, two);
  // Another configuration is another run.
  CHECK(fleet(fleet_words(LEONAV_BIN_DIR, two, "--resume --set ekf.carrier=false")).exit_code == 1);
  CHECK(std::filesystem::last_write_time(result) != written);
}

TEST_CASE("A worker that is lost in the middle of a run changes nothing", "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile place("unused", "");
  const WaitingPrograms programs(place);
  const std::string disturbed = place.beside("disturbed"), calm = place.beside("calm");
  const ProgramRun run =
      programs.disturbed("kill", fleet_words(programs.bin, disturbed, "--workers 2"));
  INFO(run.out + run.err);
  CHECK(has(run.out, "a worker killed"));
  CHECK(has(run.out, "exit 1"));
  CHECK(has(run.out, "programs left: 0"));
  CHECK(has(run.err, "1 of 4 runs failed"));
  CHECK(fleet(fleet_words(programs.bin, calm, "--workers 1")).exit_code == 1);
  check_same(disturbed, calm);
}

TEST_CASE("A stop ends the programs, and the call goes on with --resume", "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile place("unused", "");
  const WaitingPrograms programs(place);
  const std::string out = place.beside("out");
  const ProgramRun run = programs.disturbed("stop", fleet_words(programs.bin, out, "--workers 2"));
  INFO(run.out + run.err);
  CHECK(has(run.out, "exit 130"));
  CHECK(has(run.out, "programs left: 0"));
  CHECK(has(run.err, "stopped; the same call with --resume goes on from here"));
  CHECK_FALSE(has(run.err, "Traceback"));
  CHECK_FALSE(std::filesystem::exists(out + "/work"));
  std::ofstream(programs.go) << "\n";
  const ProgramRun rest = fleet(fleet_words(programs.bin, out, "--resume"));
  CHECK(has(rest.err, "1 of 4 runs failed"));
}

TEST_CASE("Nothing listens but on 127.0.0.1", "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile place("unused", "");
  const WaitingPrograms programs(place);
  const ProgramRun run =
      programs.disturbed("listen", fleet_words(programs.bin, place.beside("out"), "--workers 2"));
  INFO(run.out + run.err);
  CHECK(has(run.out, "listens scheduler 0100007F\n"));
  CHECK(has(run.out, "listens worker 0100007F\n"));
  CHECK_FALSE(has(run.out, " 00000000"));
}

TEST_CASE("The workers of a scheduler that is there give the same report, and stay",
          "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile place("unused", "");
  const std::string theirs = place.beside("theirs"), ours = place.beside("ours");
  const TemporaryFile script("cluster.py", R"(import subprocess, sys
import distributed
if __name__ == "__main__":
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0",
                                  worker_dashboard_address="127.0.0.1:0", silence_logs="CRITICAL") as cluster:
        code = subprocess.run([*sys.argv[1:], "--scheduler", cluster.scheduler_address]).returncode
        with distributed.Client(cluster) as client:
            print("fleet", code, "workers", len(client.scheduler_info()["workers"]))
)");
  const ProgramRun run =
      shell("cd '" + place.beside("") + "' && timeout 300 /usr/bin/python3 -B '" + script.path() +
            "' '" LEONAV_BIN_DIR "/leonav-fleet' " + fleet_words(LEONAV_BIN_DIR, theirs));
  INFO(run.out + run.err);
  CHECK(has(run.out, "fleet 1 workers 1"));
  CHECK(fleet(fleet_words(LEONAV_BIN_DIR, ours)).exit_code == 1);
  check_same(theirs, ours);
}

TEST_CASE("Integrity is counted where leonav-eval can, and its lack of levels is no failure",
          "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile place("unused", "");
  const std::string bin = place.beside("bin"), out = place.beside("out");
  std::filesystem::create_directories(bin);
  std::filesystem::create_symlink(LEONAV_BIN_DIR "/leonav-replay", bin + "/leonav-replay");
  const std::string real = "exec '" LEONAV_BIN_DIR "/leonav-eval' \"$@\"\n";
  // Knows --integrity; of the log called two its solution states no level.
  write_program(bin + "/leonav-eval", R"(case "$*" in
  --help) echo '  --integrity        counts'; exit 0 ;;
  *two*--integrity*) echo 'leonav-eval: solution.csv: states no protection level where there is a truth'; exit 1 ;;
  *--integrity*)
    while [ "$1" != --json ]; do shift; done
    echo '[{"label": "x", "block_s": 60, "horizontal": {"epochs": 58, "misleading": 3, "largest_ratio": 1.2, "limits": [{"limit_m": 3, "hazardous": 1}]}}]' >"$2"
    exit 0 ;;
esac
)" + real);
  const ProgramRun run = fleet(fleet_words(bin, out));
  INFO(run.err);
  const std::string report = text_of(out + "/report.md");
  INFO(report);
  CHECK(has(report,
            "Errors beyond their protection levels: horizontal 3 of 58; "
            "horizontal.limits.3_m.hazardous 1."));
  CHECK_FALSE(has(report, "no integrity"));
  CHECK(has(report, "4 runs, 1 failed"));
  CHECK(has(report, "Levels of risk 1e-05 per hour"));
  CHECK(has(report, "| horizontal | 58 | 0.00 | 3 | 0 of 0 | 1.200 |"));
  CHECK_FALSE(std::filesystem::exists(out + "/stanford.json"));
}

TEST_CASE("Wrong words to the fleet are named", "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile place("unused", "");
  const auto says = [&](const std::string& given, const std::string& text) {
    const ProgramRun run =
        fleet("--bin '" LEONAV_BIN_DIR "' --out '" + place.beside("out") + "' " + given);
    INFO(given + ": " + run.err);
    CHECK(run.exit_code == 2);
    CHECK(has(run.err, text));
    CHECK_FALSE(has(run.err, "Traceback"));
  };
  std::filesystem::create_directories(place.beside("empty"));
  says("", "give either logs or --matrix");
  says("/nowhere", "/nowhere: no such file or folder");
  says("'" + place.beside("empty") + "'", "has no *.lcmlog");
  says("--preset urban --config x.yaml '" + logs() + "'", "only one of them");
  says("--config /nowhere.yaml '" + logs() + "'", "/nowhere.yaml: no such file");
  says("--seeds 3 '" + logs() + "'", "--seeds: not with logs");
  says("--workers 0 '" + logs() + "'", "whole number of 1 or more");
  says("--bin /nowhere '" + logs() + "'", "/nowhere: has no leonav-replay; build it");
  says("--truth /nowhere.csv '" + logs() + "'", "/nowhere.csv: no such file");
  CHECK(fleet("--help").exit_code == 0);
}

TEST_CASE("Errors and sigmas are those that leonav-eval compares, also between the truth's rows",
          "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile place("unused", "");
  const std::string log = logs() + "/one/run.lcmlog", truth = logs() + "/one/truth.csv";
  const std::string out = place.beside("out"), half = place.beside("half.csv");
  REQUIRE(
      run_program("leonav-replay", "--preset urban '" + log + "' --out '" + out + "'").exit_code ==
      0);
  // Every second row, with and without the velocities: a cubic, a line.
  const TemporaryFile still("still.csv",
                            shell("cut -d, -f1-5 '" + truth + "' | sed -n '1p;2~2p'").out);
  std::ofstream(half) << shell("sed -n '1p;2~2p' '" + truth + "'").out;
  for (const std::string& path : {truth, half, still.path()}) {
    REQUIRE(run_program("leonav-eval", "--truth '" + path + "' --json '" + out + "/errors.json' '" +
                                           out + "/solution.csv'")
                .exit_code == 0);
    const std::string said = fleet_python(
        "import numpy as np\nfrom fleet import measure\nout, truth = '" + out + "', '" + path + R"('
read = measure.evaluated(out + "/errors.json")
errors, stated = measure.errors_of(out + "/solution.csv", truth)
for axis, error in zip(measure.AXES, errors):
    print(axis, abs(np.sqrt(np.mean(error ** 2)) - read["errors"][axis]["rmse"]) < 1e-4)
sigmas = measure.sigmas(errors, stated).values()
print("epochs", errors.shape[1] == read["epochs"], "share", abs(sum(s["within"] for s in sigmas) / sum(s["count"] for s in sigmas) - read["within_three_sigma"]) < 1e-6)
)");
    INFO(path + "\n" + said);
    CHECK_FALSE(has(said, "False"));
    CHECK(has(said, "share True"));
  }
}

TEST_CASE("Logs are named by their paths, each once", "[tools][fleet]") {
  if (!have_fleet()) return;
  const std::string said = fleet_python(R"(import os, tempfile
from fleet import logs
root = tempfile.mkdtemp()
for name in ("a/run.lcmlog", "b/c/run.lcmlog", "b/run.txt", "b/x.lcmlog", "odd"):
    path = os.path.join(root, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    open(path, "w").close()
open(os.path.join(root, "b", "x.truth.csv"), "w").close()
open(os.path.join(root, "b", "truth.csv"), "w").close()
at = lambda *names: [os.path.join(root, name) for name in names]
print("folder", list(logs.named(at(""))))
print("alone", list(logs.named(at("a/run.lcmlog"))))
print("twice", list(logs.named(at("a/run.lcmlog", "a", "b/../a/run.lcmlog"))))
print("alike", list(logs.named(at("a/run.lcmlog", "b/c/run.lcmlog"))))
print("two folders", list(logs.named(at("a", "b/c", "odd"))))
print("truth", [t and os.path.relpath(t, root) for t in map(logs.truth_of, at("b/x.lcmlog", "b/y.lcmlog", "a/run.lcmlog"))])
)");
  CHECK(has(said, "folder ['a/run', 'b/c/run', 'b/x']"));
  CHECK(has(said, "alone ['run']"));
  CHECK(has(said, "twice ['run']"));
  CHECK(has(said, "alike ['a/run', 'b/c/run']"));
  CHECK(has(said, "two folders ['a/run', 'b/c/run', 'odd']"));
  CHECK(has(said, "truth ['b/x.truth.csv', 'b/truth.csv', None]"));
}

TEST_CASE("A bar on a terminal, lines elsewhere", "[tools][fleet]") {
  if (!have_fleet()) return;
  const std::string said = fleet_python(R"(import io
from fleet import progress
class Terminal(io.StringIO):
    def isatty(self):
        return True
for stream in (io.StringIO(), Terminal()):
    now = [0.0]
    shown = progress.Progress(4, stream, lambda: now[0])
    for text, failed in (("a", False), ("b", True)):
        now[0] += 200.0
        shown.tell(text, failed)
    shown.end()
    print(repr(stream.getvalue()))
)");
  CHECK(has(said, R"('[1/4, 10 min left] a\n[2/4, 7 min left] b\n')"));
  CHECK(has(said, R"(2 of 4, 7 min left, 1 failed\n')"));
  CHECK(has(said, R"(\x1b[Kb\n)"));
}
