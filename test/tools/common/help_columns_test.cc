// Who needs a table as input finds its columns in --help.
#include <string>

#include "drivers/csv/imu_csv.h"
#include "drivers/csv/truth_csv.h"
#include "support/catch.h"
#include "support/programs/program_run.h"

using namespace leonav;

TEST_CASE("--help of the programs that read imu.csv and truth.csv names their columns") {
  if (!test::have_programs("leonav-import", "leonav-eval")) return;
  const std::string import = test::run_program("leonav-import", "--help").out;
  CHECK(import.find(kImuCsvHeader) != std::string::npos);
  CHECK(import.find(kTruthCsvHeader) != std::string::npos);
  CHECK(import.find("navigation (RINEX 2 to 4") != std::string::npos);
  const std::string eval = test::run_program("leonav-eval", "--help").out;
  CHECK(eval.find(kTruthCsvHeader) != std::string::npos);
}
