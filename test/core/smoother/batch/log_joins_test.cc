// Joins of arcs in a whole log, with what the ambiguities have walked while nobody measured them.
#include <algorithm>

#include "core/base/square.h"
#include "core/smoother/batch/log_graph.h"
#include "core/smoother/drive_rig.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;

constexpr double kWalk = 0.02;  // m/sqrt(s)
constexpr int kGapFrom = 4, kGapUntil = 14;

}  // namespace

TEST_CASE("a join over a gap allows for the walk over the gap") {
  DriveOptions options;
  options.random_walk = kWalk;
  options.joined = true;  // every third epoch, with a variance of 1e-4 m^2
  options.edit = [](int epoch, MeasurementEpoch* measured) {
    if (epoch < kGapFrom || epoch >= kGapUntil) return;
    auto& all = measured->measurements;
    const auto first = std::find_if(all.begin(), all.end(), [](const Measurement& one) {
      return one.observable == Observable::kCarrier;
    });
    if (first != all.end()) all.erase(first);
  };
  Drive drive(options);
  LogGraph graph(drive.lever_b());
  int in_the_gap = 0;
  for (int epoch = 1; epoch <= kGapUntil; ++epoch) {
    graph.add(drive.step());
    const LogProcess& process = graph.at(graph.size() - 1).process;
    if (epoch <= kGapFrom + 1 || epoch >= kGapUntil) continue;
    for (const PieceJoin& join : process.joins) {
      ++in_the_gap;
      const double walked_s = epoch - kGapFrom;  // at the keyframe before
      CHECK(join.variance > 1e-4 + 0.99 * walked_s * square(kWalk));
    }
  }
  CHECK(in_the_gap == 3);
}

}  // namespace leonav
