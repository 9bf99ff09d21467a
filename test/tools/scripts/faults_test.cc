// tools/scripts/lib/faults.py judges made-up tables, whose answers are known.
#include <cstdlib>
#include <iostream>
#include <string>

#include "python_script.h"
#include "support/catch.h"
#include "support/has.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"

using namespace leonav::test;

namespace {

bool have_numpy() {
  if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") == 0) return true;
  std::cout << "SKIPPED: no python3-numpy\n";
  return false;
}

// What a script prints that has imported faults.py.
std::string faults_script(const std::string& script) {
  return python_script("lib", "import faults\n" + script);
}

// Makes `folder` with the tables of a replay of nine seconds, the truth's first second before it.
// The height is wrong by `up`, its sigma 0.5 m, its level 5 m; `levels` replaces these. The heading
// is wrong at the start and by 2 degrees at second 5, across north, its level 8 degrees.
constexpr const char* kTables = R"(
import pathlib, tempfile
place = tempfile.TemporaryDirectory()
folder = pathlib.Path(place.name)
def write(name, header, rows):
    (folder / name).write_text("\n".join([header, *(",".join(map(str, row)) for row in rows)]) + "\n")
up = [9, 0, 0, 1, 2, -6, 3, 1, 0]
def tables(events, levels={}):
    write("truth.csv", "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m,yaw_deg", [(2300, 99 + i, 45.0, 7.0, 100.0, 359.0) for i in range(10)])
    write("solution.csv", "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m,std_north_m,std_east_m,std_down_m,protection_horizontal_m,"
          "protection_vertical_m,yaw_deg,protection_heading_deg",
          [(2300, 100 + i, 45.0, 7.0, 100.0 + u, 0.3, 0.4, 0.5, 10.0, levels.get(i, 5.0), 1.0 if i == 5 else 359.0 if i else 90.0, 8.0)
           for i, u in enumerate(up)])
    write("events.csv", "gps_week,gps_tow_s,stage,event,code,value", [(week, tow, "gnss", kind, 0, 0) for week, tow, kind in events])
)";

}  // namespace

TEST_CASE("A fault is judged from its begin on: largest error, misleading epochs, who tells of it",
          "[tools]") {
  if (!have_numpy()) return;
  const std::string said = faults_script(std::string(kTables) + R"(
def show(result):
    size, sigma, levels = result["worst"]
    print(f"worst {size:.3f} {sigma:.4f} {levels.tolist()} sigmas {result['sigmas']:.2f} share {result['share']:.2f} heading {result['heading']:.2f}",
          f"misleading {result['misleading']} of {result['epochs']}")
    if result["event"]:
        kind, after, then = result["event"]
        print(f"told {kind} after {after:.1f} error {then[0]:.2f}")
    else:
        print("not told")
# Before the fault, of another kind, without a time, and after the first that counts.
tables([(2300, 101, "improbable"), (2300, 104, "aligned"), ("", "", "improbable"), (2300, 106, "satellite_fault"), (2300, 107, "improbable")])
show(faults.judge(folder, folder / "truth.csv", 4, 4, set()))
# A level that is not known is none; who is told from the start takes what came before the begin.
tables([(2300, 101, "improbable")], {7: ""})
show(faults.judge(folder, folder / "truth.csv", 4, 0, set()))
tables([(2300, 101, "improbable")])
show(faults.judge(folder, folder / "truth.csv", 7, 3, set()))
# What also comes without a fault does not tell.
tables([(2300, 104, "prediction_widened"), (2300, 107, "satellite_fault")])
result = faults.judge(folder, folder / "truth.csv", 4, 4, {"prediction_widened"})
print("unusual", result["event"][0], sorted(result["kinds"]), f"until {result['until']:.1f}")
)");
  INFO(said);
  CHECK(
      has(said,
          "worst 6.000 0.7071 [10.0, 5.0] sigmas 12.00 share 1.20 heading 0.25 misleading 1 of 6\n"
          "told satellite_fault after 3.0 error 3.00\n"));
  CHECK(has(said,
            "sigmas 12.00 share inf heading 0.25 misleading 2 of 6\ntold improbable after 2.0 "
            "error 0.00\n"));
  CHECK(has(said,
            "worst 3.000 0.7071 [10.0, 5.0] sigmas 6.00 share 0.60 heading 0.00 misleading 0 of "
            "3\nnot told\n"));
  CHECK(has(said, "unusual satellite_fault ['prediction_widened', 'satellite_fault'] until 2.0\n"));
}

TEST_CASE("The steadiest satellite is used nearly always, and of these the highest", "[tools]") {
  if (!have_numpy()) return;
  const std::string said = faults_script(std::string(kTables) + R"(
seen = []
for i in range(40):
    at = lambda name, used, elevation: seen.append((2300, 100 + i, name, used, elevation))
    at("G01", 1, 30)
    at("G02", 1, 50)
    at("G03", int(i % 2), 80)  # every other epoch
    at("G04", int(i < 10), 85)  # before the fault only
    at("E01", 1, 70)
    at("L07", int(i >= 20), 40)
write("satellites.csv", "gps_week,gps_tow_s,satellite,used,elevation_deg", seen)
table = folder / "satellites.csv"
print(faults.steadiest(table, 10, 40, "G"), faults.steadiest(table, 0, 10, "G"), faults.steadiest(table, 10, 40, "LMNO"))
)");
  INFO(said);
  CHECK(has(said, "G02 G04 L07\n"));
}

TEST_CASE("A row of the faults' table has the errors with sigma and levels", "[tools]") {
  if (!have_numpy()) return;
  const std::string said = faults_script(R"(
result = dict(worst=(1.234, 0.5, (3.04, 4.06)), sigmas=2.51, share=0.333, heading=0.256, misleading=0, epochs=898, event=None)
faults.print_row("a fault", "GPS", "filter", result)
faults.print_row("a fault", "all", "smoother", result | {"event": ("improbable", 9.4, (0.1, 0.05, (2.0, 3.0)))})
names = [name for name, *_ in faults.faults_of("G05", "L01")]
print(len(names), len(set(names)), any("satellites: [G05]" in script for _, script, *_ in faults.faults_of("G05", "L01")))
)");
  INFO(said);
  CHECK(has(said,
            "| a fault | GPS | filter | 1.23 (0.50; 3.0, 4.1) | 2.5 | 0.33 | 0.26 | 0 of 898 | no "
            "| - |\n"));
  CHECK(has(said, "| 0 of 898 | `improbable` after 9 s | 0.10 (0.05; 2.0, 3.0) |\n"));
  CHECK(has(said, "9 9 True\n"));
}
