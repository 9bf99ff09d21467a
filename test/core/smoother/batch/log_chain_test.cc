// The chain against one dense least-squares problem of the whole log, and its forward pass against
// the filter.
#include "core/smoother/batch/log_chain.h"

#include <algorithm>

#include "core/smoother/drive_rig.h"
#include "dense_log.h"
#include "drive_graph.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;
using Eigen::Index;

LogCorrections solved(const LogGraph& graph) {
  LogCorrections corrections;
  double last = 0.0;
  bool grows = true;
  const auto progress = [&](double done) {
    grows = grows && done >= last;
    last = done;
  };
  REQUIRE(solve_chain(graph, progress, &corrections));
  CHECK(grows);
  CHECK(last == Approx(1.0));
  return corrections;
}

double most_sigmas(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return error.cwiseQuotient(covariance.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff();
}

// Moves every estimate, so that no residual, prior or step of a piece is where it was linearized.
void displace(LogGraph* graph) {
  Generator noise(99);
  for (int k = 0; k < graph->size(); ++k) {
    LogKeyframe& keyframe = graph->at(k);
    EkfCorrection part(keyframe.core_size());
    for (Index i = 0; i < part.size(); ++i) {
      const int state = keyframe.active.core[static_cast<std::size_t>(i)];
      const bool small = state >= ekf_index::kAttitude && state < ekf_index::kClock;
      part(i) = (state < ekf_index::kSize && !small ? 0.1 : 1e-3) * noise.normal();
    }
    add(full_error(keyframe.active, part), keyframe.has_attitude, &keyframe.state);
  }
  for (AmbiguityPiece& piece : graph->pieces()) piece.value_m += 0.1 * noise.normal();
}

// The largest distances over all keyframes.
struct Apart {
  double core = 0.0, pieces = 0.0;  // sigmas
  double covariance = 0.0;          // correlations
};

Apart from_dense(const LogGraph& graph, const LogCorrections& chain) {
  const DenseLog dense = dense_log(graph);
  Apart apart;
  for (int k = 0; k < graph.size(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Eigen::MatrixXd covariance = dense.core_covariance(k);
    apart.core = std::max(apart.core, most_sigmas(chain.core[i] - dense.core(k), covariance));
    apart.covariance =
        std::max(apart.covariance, apart_in_correlations(chain.covariance[i], covariance));
  }
  if (chain.pieces.size() > 0)
    apart.pieces =
        (chain.pieces - dense.pieces()).cwiseQuotient(dense.piece_sigmas()).cwiseAbs().maxCoeff();
  return apart;
}

void check_dense(const char* what, LogGraph* graph) {
  displace(graph);
  const Apart apart = from_dense(*graph, solved(*graph));
  WARN(what << ": from dense least squares " << apart.core << " sigma, pieces " << apart.pieces
            << " sigma, covariance " << apart.covariance);
  CHECK(apart.core < 1e-6);
  CHECK(apart.pieces < 1e-3);  // a first guess with a sigma of 1,000 m leaves its rounding
  CHECK(apart.covariance < 1e-6);
}

int with_previous(const LogGraph& graph) {
  return static_cast<int>(
      std::count_if(graph.pieces().begin(), graph.pieces().end(),
                    [](const AmbiguityPiece& piece) { return piece.previous >= 0; }));
}

}  // namespace

TEST_CASE("a step of the chain is that of dense least squares, with its covariances") {
  DriveOptions options;
  SECTION("with codes and Dopplers alone") {
    options.carriers = false;
    LogGraph graph = graph_of(options, 14);
    REQUIRE(graph.pieces().empty());
    check_dense("no carriers", &graph);
  }
  SECTION("with arcs that stay") {
    LogGraph graph = graph_of(options, 14);
    REQUIRE(graph.pieces().size() == 8);
    check_dense("arcs that stay", &graph);
  }
  SECTION("with arcs that end and a constant velocity") {
    options.inertial = false;
    options.arc_epochs = 6;
    LogGraph graph = graph_of(options, 14);
    REQUIRE(graph.pieces().size() > 16);
    check_dense("constant velocity", &graph);
  }
  SECTION("with arcs that end and pieces that follow one another") {
    options.arc_epochs = 9;
    options.random_walk = 0.02;
    LogGraph graph = graph_of(options, 12);
    REQUIRE(with_previous(graph) > 50);
    check_dense("pieces that follow one another", &graph);
  }
  SECTION("with constraints on the motion, an odometer, and pieces of several epochs") {
    options.constrained = options.odometer = true;
    options.random_walk = 2e-3;
    LogGraph graph = graph_of(options, 14);
    REQUIRE(graph.at(5).process.information.size() > 0);
    REQUIRE(with_previous(graph) > 0);
    REQUIRE(with_previous(graph) < 40);
    check_dense("constraints", &graph);
  }
  SECTION("with a lever arm and a time offset that are estimated") {
    options.calibrating = true;
    LogGraph graph = graph_of(options, 12);
    check_dense("calibrating", &graph);
  }
  SECTION("with two segments that nothing links") {
    options.random_walk = 2e-3;
    LogGraph graph = graph_of(options, 14, [](KeyframeInput* input) {
      if (input->index == 8) input->follows_previous = false;
    });
    REQUIRE(segments(graph) == 2);
    check_dense("two segments", &graph);
  }
}

TEST_CASE("an unlinked segment is smoothed as if it were a log of its own") {
  const DriveOptions options;
  const auto starts_at_8 = [](KeyframeInput* input) {
    if (input->index == 8) input->follows_previous = false;
  };
  const LogCorrections both = solved(graph_of(options, 14, starts_at_8));
  const LogCorrections first = solved(graph_of(options, 7));
  const LogCorrections second = solved(graph_of(options, 14, [&](KeyframeInput* input) {
    starts_at_8(input);
    input->valid = input->index >= 8;
  }));
  REQUIRE(second.core.size() == 7);
  for (std::size_t k = 0; k < 7; ++k) {
    CHECK(both.core[k] == first.core[k]);
    CHECK(both.covariance[k] == first.covariance[k]);
    CHECK(both.core[k + 7] == second.core[k]);
    CHECK(both.covariance[k + 7] == second.covariance[k]);
  }
}

TEST_CASE("the forward estimate of an epoch is the last one of the log that ends there") {
  DriveOptions options;
  options.random_walk = 2e-3;
  options.arc_epochs = 9;
  options.constrained = GENERATE(false, true);
  const LogCorrections whole = solved(graph_of(options, 14));
  for (const int epochs : {2, 7, 11, 14}) {
    LogGraph cut = graph_of(options, epochs);
    const auto last = static_cast<std::size_t>(epochs) - 1;
    const DenseLog dense = dense_log(cut);
    const Eigen::MatrixXd covariance = dense.core_covariance(epochs - 1);
    CAPTURE(epochs);
    CHECK(most_sigmas(whole.filtered_core[last] - dense.core(epochs - 1), covariance) < 1e-6);
    CHECK(apart_in_correlations(whole.filtered_covariance[last], covariance) < 1e-6);
    // What comes later adds information, and never takes any.
    CHECK((whole.filtered_covariance[last] - whole.covariance[last]).diagonal().minCoeff() >=
          -1e-9 * whole.filtered_covariance[last].diagonal().maxCoeff());
  }
}

// Where the errors are small the filter has linearized where the log does. The log starts with the
// filter's covariance after the first epoch, but not with its ambiguities: what the carriers of the
// first two epochs tell of the velocity is missing.
TEST_CASE("forward estimates are the filter's own where the problem is linear") {
  DriveOptions options;
  options.noise = 1e-4;
  options.carriers = GENERATE(false, true);
  options.constrained = GENERATE(false, true);
  Drive drive(options);
  LogGraph graph(drive.lever_b());
  std::vector<EkfCovariance> covariances;
  for (int i = 0; i < 30; ++i) {
    graph.add(drive.step());
    covariances.push_back(drive.filter().covariance());
  }
  const LogCorrections chain = solved(graph);
  double apart = 0.0, apart_covariance = 0.0, narrowest = 1.0, widest_at_end = 1.0;
  for (int k = 1; k < graph.size(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ActiveStates& active = graph.at(k).active;
    Eigen::MatrixXd of_filter(active.core_size(), active.core_size());
    for (Index row = 0; row < of_filter.rows(); ++row)
      for (Index column = 0; column < of_filter.cols(); ++column)
        of_filter(row, column) = covariances[i](active.core[static_cast<std::size_t>(row)],
                                                active.core[static_cast<std::size_t>(column)]);
    apart = std::max(apart, most_sigmas(chain.filtered_core[i], of_filter));
    apart_covariance =
        std::max(apart_covariance, apart_in_correlations(chain.filtered_covariance[i], of_filter));
    const Eigen::VectorXd sigmas =
        chain.filtered_covariance[i].diagonal().cwiseQuotient(of_filter.diagonal()).cwiseSqrt();
    narrowest = std::min(narrowest, sigmas.minCoeff());
    if (k + 1 == graph.size()) widest_at_end = sigmas.maxCoeff();
  }
  WARN((options.carriers ? "with" : "without")
       << " carriers, " << (options.constrained ? "constrained" : "free") << ": from the filter "
       << apart << " sigma, covariance " << apart_covariance << "; sigmas at least " << narrowest
       << ", at the end at most " << widest_at_end << " of the filter's");
  CHECK(apart < 1e-3);
  CHECK(narrowest > 1.0 - 1e-3);
  CHECK(widest_at_end < (options.carriers ? 1.15 : 1.0 + 1e-3));
  if (!options.carriers) CHECK(apart_covariance < 1e-3);
}

TEST_CASE("a log that leaves a state unknown has no solution") {
  LogGraph graph = graph_of({}, 3);
  graph.at(0).prior_information.setZero();
  graph.at(1).measurements.clear();
  graph.at(2).measurements.clear();
  LogCorrections corrections;
  CHECK_FALSE(solve_chain(
      graph, [](double) {}, &corrections));
}

}  // namespace leonav
