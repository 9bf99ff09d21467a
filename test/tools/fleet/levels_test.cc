// tools/fleet/fleet/levels.py: protection levels of many runs, against the equations of
// core/integrity, published tables and sums worked out by hand.
#include <sstream>

#include "core/integrity/level_equation.h"
#include "core/integrity/level_growth.h"
#include "core/integrity/risk.h"
#include "tools/fleet/fleet_run.h"

using namespace leonav;
using namespace leonav::test;

namespace {

// Two runs of one log and one of another, 720 s each: errors up to 3.9, 7.3 and 12 sigma.
constexpr const char* kRuns = R"(from fleet import levels, report
told = {"risk_per_hour": 1e-5, "error_correlation_s": 10.0, "sigma_factor": 1.0, "tail_share": 0.05, "tail_factor": 2.0}
def counts(multiples, misleading=0, ratio=0.3, near=300, diagram=((20, 60, 720),)):
    epochs = sum(m[1] for m in multiples)
    return {"expected": 800, "epochs": epochs, "misleading": misleading, "blocks": 12, "misleading_blocks": min(misleading, 1),
            "largest_ratio": ratio, "observed_s": float(epochs), "multiples": multiples, "diagram": [list(d) for d in diagram],
            "limits": [{"limit_m": 1, "nominal": near, "misleading": 0, "hazardous": misleading, "unavailable": 720 - near - misleading}]}
def result(*given, model=told):
    return {"name": "n", "failure": None, "integrity": {"horizontal": counts(*given)}, "integrity_model": model}
runs = [("a", result([[3, 700, 11], [39, 20, 1]])), ("a", result([[3, 719, 11], [73, 1, 1]], 0, 0.7)),
        ("b", result([[5, 715, 11], [120, 5, 1]], 2, 1.17, 400, ((20, 60, 715), (80, 60, 5))))]
)";

double number_after(const std::string& text, const std::string& name) {
  const std::size_t at = text.find(name + " ");
  REQUIRE(at != std::string::npos);
  return std::stod(text.substr(at + name.size()));
}

}  // namespace

TEST_CASE("Multiples of sigma are those of the core's levels", "[tools][fleet]") {
  if (!have_fleet()) return;
  for (const double risk : {1e-7, 1e-3, 0.5}) {
    for (const double correlation_s : {10.0, 7200.0}) {
      IntegrityConfig config;
      config.risk_per_hour = risk;
      config.error_correlation_s = correlation_s;
      config.overbound = {1.3, 0.1, 1.7};
      NominalError error;
      error.position_covariance_n << 4.0, 1.0, 0.2, 1.0, 2.0, 0.1, 0.2, 0.1, 9.0;
      error.heading_variance = 1e-4;
      const ProtectionLevels levels = protection_levels(error, {}, config);
      std::ostringstream script;
      script << "from fleet import levels\nm = levels.Model(" << risk / 10.0 << ", "
             << correlation_s << ", 1.3, 0.1, 1.7)\nfor q in levels.QUANTITIES:\n"
             << "    print(q, levels.multiple_of(q, " << risk << ", m))\n";
      const std::string said = fleet_python(script.str());
      INFO(said);
      CHECK(number_after(said, "horizontal") * std::sqrt(6.0) ==
            Approx(levels.horizontal_m).epsilon(1e-7));
      CHECK(number_after(said, "vertical") * 3.0 == Approx(levels.vertical_m).epsilon(1e-7));
      CHECK(number_after(said, "heading") * 0.01 == Approx(levels.heading).epsilon(1e-7));
    }
  }
}

TEST_CASE("With fault hypotheses a level is no smaller than the multiple of sigma of its risk",
          "[tools][fleet]") {
  // A rare hypothesis decides about the level of a small risk, and not about that of a larger one:
  // to take the former down by the ratio of the multiples would be too much.
  const Overbound overbound;
  const LevelTerm terms[] = {{1.0 - 1e-5, 0.0, 1.0}, {1e-5, 0.0, 5.0}};
  const LevelTerm unit = {1.0, 0.0, 1.0};
  const auto level = [&](double risk) { return solve_level(terms, risk, overbound); };
  const auto multiple = [&](double risk) { return solve_level({&unit, 1}, risk, overbound); };
  for (const double risk : {1e-10, 1e-8, 1e-6, 1e-4, 1e-2}) CHECK(level(risk) >= multiple(risk));
  CHECK(level(1e-8) * multiple(1e-4) / multiple(1e-8) > 1.5 * level(1e-4));
}

TEST_CASE("The confidence is that of Poisson's distribution", "[tools][fleet]") {
  if (!have_fleet()) return;
  const std::string said = fleet_python(R"(from fleet import levels
for events, allowed in ((0, 0.0), (0, 1e-9), (0, 3.0), (2, 1.0), (5, 20.0), (200, 260.0), (100000, 100.0)):
    print(f"{events} {allowed:g} {levels.confidence_of(events, allowed):.6g}")
print("at most", *(f"{levels.at_most(k):.4f}" for k in (0, 1, 2, 10)))
)");
  INFO(said);
  CHECK(has(said, "0 0 0\n0 1e-09 1e-09\n"));
  CHECK(has(said, "0 3 0.950213\n"));
  CHECK(has(said, "2 1 0.0803014\n"));  // 1 - 2.5/e
  CHECK(has(said, "5 20 0.999928\n"));
  CHECK(has(said, "200 260 0.999937\n"));
  CHECK(has(said, "100000 100 0\n"));
  // Half the quantiles of the chi-squared distribution with 2, 4, 6 and 22 degrees of freedom.
  CHECK(has(said, "at most 2.9957 4.7439 6.2958 16.9622\n"));
}

TEST_CASE("Events are blocks beyond the level of each risk; replays of a log count as one",
          "[tools][fleet]") {
  if (!have_fleet()) return;
  const std::string said = fleet_python(kRuns + std::string(R"(
for line in levels.groups_of(runs)[0].lines():
    print(f"{line.risk_per_hour:g} {line.stated} {line.multiple:.3f} hours {line.hours:g} epochs {line.epochs} events {line.events} runs {line.runs}",
          f"allowed {line.allowed():g} one {line.confidence():.6f} independent {line.confidence_if_independent():.6f} rate {line.rate():.4f}",
          f"at most {line.rate_at_most():.4f}")
many = levels.Line("heading", 1.0, False, 3.9, 0.4, hours=6.0, epochs=900, events=48, runs=14, replays=12.0)
print("many", many.confidence() == many.confidence_if_independent() < levels.confidence_of(4, 0.5))
sums = levels.summed(r for _, r in runs)["horizontal"]
print(sums.epochs, sums.misleading, sums.largest_ratio, sums.available(1), dict(sums.diagram))
print(levels.diagrams(runs))
print(levels.availability([r for _, r in runs]))
)"));
  INFO(said);
  // 0.6 h. 11.88, 10.27, 8.38 and 7.27 sigma at 1e-7, 1e-5, 1e-3 and 1e-2; 7.2 counts for 7.27.
  CHECK(has(said,
            "1e-07 False 11.888 hours 0.6 epochs 5 events 1 runs 1 allowed 6e-08 one 0.000000 "));
  CHECK(has(said, "1e-05 True 10.276 hours 0.6 epochs 2 events 1 runs 1 "));
  CHECK(has(said, "0.001 False 8.382 hours 0.6 epochs 5 events 1 runs 1 "));
  CHECK(has(said, "0.01 False 7.270 hours 0.6 epochs 6 events 2 runs 2 "));
  CHECK(has(said, "0.1 False 5.983 hours 0.6 epochs 6 events 2 runs 2 "));
  // 3 runs of 2 logs: 2 events in 0.6 h are 1.33, rounded up 2, in 0.4 h; 6.2958 / 0.4.
  CHECK(has(said,
            "1 False 4.406 hours 0.6 epochs 6 events 2 runs 2 allowed 0.6 one 0.007926 independent "
            "0.023115 rate 3.3333 at most 15.7395\n"));
  CHECK(has(said, "many True\n"));
  CHECK(has(said, "2160 2 1.17 1002 {(20, 60): 2155, (80, 60): 5}\n"));
  CHECK(has(said,
            "'limits': [{'limit_m': 1, 'nominal': 1000, 'misleading': 0, 'hazardous': 2, "
            "'unavailable': 1158}], 'diagram': [[20, 60, 2155], [80, 60, 5]]}"));
  CHECK(has(said, "{'horizontal': {'1': 0.4175}}\n"));
}

TEST_CASE("The report judges runs of different configurations apart", "[tools][fleet]") {
  if (!have_fleet()) return;
  const std::string said = fleet_python(kRuns + std::string(R"(
other = dict(told, risk_per_hour=1e-3, error_correlation_s=60.0)
runs.append(("a", result([[3, 720, 12]], model=other)))
runs.append(("c", result([[3, 720, 12]], model=None)))
parts = [(("city", "GPS"), [runs[0][1]]), (("all scenes", "all together"), [r for _, r in runs])]
print("\n".join(levels.section(runs, ["scene", "systems"], parts)))
print("[none]", levels.section([("a", {"integrity": None})], ["scene"], []), levels.plain([]))
print(levels.without_lists(runs[0][1])["integrity"]["horizontal"].keys())
)"));
  INFO(said);
  CHECK(
      has(said,
          "Levels of risk 1e-05 per hour, errors independent after 10 s, sigma factor 1, tail 5 % "
          "of 2 sigma. Runs: 3, logs: 2.\n"));
  CHECK(has(said, "| horizontal | 2160 | 0.60 | 2 | 1 of 36 | 1.170 |\n"));
  CHECK(
      has(said,
          "| horizontal | 1e-05, configured | as stated (at least 10.28 sigma) | 1.000 | 0.60 | 2 "
          "| 1 | 1 | 6e-06 | 1.67 | "));
  CHECK(has(said, "Levels of risk 0.001 per hour, errors independent after 60 s"));
  CHECK(
      has(said, "The runs do not tell what their levels were computed with. Runs: 1, logs: 1.\n"));
  CHECK(
      has(said,
          "| scene | systems | epochs expected | horizontal level at most 1 m, % | vertical level "
          "at most 1 m, % |\n"));
  CHECK(has(said, "| city | GPS | 800 | 37.50 | - |\n"));
  CHECK(has(said, "| all scenes | all together | 4000 | 40.05 | - |\n"));
  CHECK(has(said, "[none] [] None\n"));
  CHECK_FALSE(has(said, "'multiples'"));
}

TEST_CASE("The configuration of a replay tells what its levels were computed with",
          "[tools][fleet]") {
  if (!have_fleet()) return;
  const TemporaryFile file("configuration.yaml",
                           "integrity:\n  risk_per_hour: 1e-05  # from: default\n"
                           "  error_correlation_s: 20\n  sigma_factor: 1.5\n  tail_share: 0.1\n"
                           "  tail_factor: 3\n");
  const std::string said =
      fleet_python("from fleet import measure\nprint(measure.integrity_model_of('" + file.path() +
                   "'))\nprint(measure.integrity_model_of('" + file.beside("absent") + "'))\n");
  CHECK(said ==
        "{'risk_per_hour': 1e-05, 'error_correlation_s': 20.0, 'sigma_factor': 1.5, 'tail_share': "
        "0.1, 'tail_factor': 3.0}\nNone\n");
}

TEST_CASE("Diagrams are drawn from sums as from tables, and a missing package is told",
          "[tools][fleet]") {
  if (!have_fleet()) return;
  if (shell("/usr/bin/python3 -c 'import matplotlib'").exit_code != 0) {
    std::cout << "SKIPPED: no python3-matplotlib\n";
    return;
  }
  const TemporaryFile table("integrity.csv",
                            "gps_week,gps_tow_s,error_horizontal_m,protection_horizontal_m,"
                            "error_vertical_m,protection_vertical_m\n"
                            "2300,1,0.5,0.9,0.0,3.1\n2300,2,2.0,0.9,0.1,2.0\n2300,3,2.0,,0.1,\n");
  const std::string folder = std::filesystem::path(table.path()).parent_path();
  // The script's own functions: the same bins and regions from the table as leonav-eval counts.
  const std::string said = fleet_python(R"(import importlib.machinery, importlib.util
loader = importlib.machinery.SourceFileLoader("plots", ")" LEONAV_SOURCE_DIR
                                        R"(/tools/report/leonav-integrity-plots")
plots = importlib.util.module_from_spec(importlib.util.spec_from_loader("plots", loader))
loader.exec_module(plots)
counts = plots.Counts([1.0])
plots.add_table(")" + folder + R"(", "horizontal", counts)
print(counts.epochs, counts.misleading, sorted(counts.bins.items()), dict(counts.regions[1.0]))
)");
  INFO(said);
  CHECK(has(said,
            "2 1 [((53, 59), 1), ((66, 59), 1)] {'nominal': 1, 'misleading': 0, 'hazardous': "
            "1, 'unavailable': 0, 'unavailable_misleading': 0}\n"));
  const std::string quantity =
      R"({"epochs": 5, "misleading": 1, "limits": [{"limit_m": 1, "nominal": 4, "hazardous": 1}],
          "diagram": [[53, 59, 4], [66, 59, 1]]})";
  const TemporaryFile sums("stanford.json", R"([{"label": "x", "horizontal": )" + quantity +
                                                R"(, "vertical": )" + quantity + "}]");
  const std::string plots = "'" LEONAV_BIN_DIR "/leonav-integrity-plots' ";
  const std::string files = "--alert-limit-m 1 '" + folder + "' '" + sums.path() + "'";
  const ProgramRun drawn = shell(plots + "--out '" + sums.beside("out") + "' " + files);
  INFO(drawn.err);
  CHECK(drawn.exit_code == 0);
  for (const char* name : {"out/stanford_horizontal.png", "out/stanford_vertical.png"})
    CHECK(std::filesystem::file_size(sums.beside(name)) > 1000);
  const ProgramRun limit = shell(plots + "--alert-limit-m 1,2 '" + sums.path() + "'");
  CHECK(limit.exit_code == 1);
  CHECK(has(limit.err, "has no counts for an alert limit of 2 m"));
  const TemporaryFile wrong("wrong.json", "[{}]");
  CHECK(has(shell(plots + "'" + wrong.path() + "'").err, "no counts of leonav-eval"));
}
