// What a replay's summary says of the smoother's solves.
#include "tools/replay/run_statistics.h"

#include <sstream>

#include "support/catch.h"

namespace leonav::test {
namespace {

using Catch::Contains;

std::string summary_of(const RunStatistics& statistics) {
  std::ostringstream text;
  statistics.print(text);
  return text.str();
}

}  // namespace

TEST_CASE("steps that were shortened and solves left to the chain are in the summary, if any") {
  RunStatistics statistics;
  SmootherReport report;
  report.status = SmootherStatus::kOk;
  statistics.add(report);
  CHECK_THAT(summary_of(statistics), !Contains("shortened") && !Contains("left to the chain"));
  report.shortened = 2;
  report.left_to_chain = true;
  statistics.add(report);
  statistics.add(report);
  CHECK_THAT(summary_of(statistics),
             Contains("smoother steps shortened: 4\n") &&
                 Contains("smoother solves that Ceres left to the chain: 2\n"));
}

}  // namespace leonav::test
