// A log that the chain solves in segments has the same result as one that it solves as a whole.
#include "core/smoother/batch/log_chain.h"
#include "core/smoother/drive_rig.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;

LogCorrections solved(const LogGraph& graph, int segment) {
  LogCorrections corrections;
  double last = 0.0;
  REQUIRE(solve_chain(
      graph, [&](double done) { last = done; }, &corrections, segment));
  CHECK(last == 1.0);
  return corrections;
}

}  // namespace

TEST_CASE("the chain: segments change no bit") {
  DriveOptions options;
  options.random_walk = 1e-3;
  options.arc_epochs = 15;
  options.constrained = true;
  Drive drive(options);
  LogGraph graph(drive.lever_b());
  for (int i = 0; i < 41; ++i) graph.add(drive.step());
  const LogCorrections whole = solved(graph, 41);
  const int segment = GENERATE(1, 7, 20, 40, 1000);
  const LogCorrections parts = solved(graph, segment);
  CHECK(parts.core == whole.core);
  CHECK(parts.pieces == whole.pieces);
  CHECK(parts.covariance == whole.covariance);
  CHECK(parts.filtered_core == whole.filtered_core);
  CHECK(parts.filtered_covariance == whole.filtered_covariance);
}

}  // namespace leonav
