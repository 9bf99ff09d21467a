#include "tools/smooth/smooth_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>

#include "core/base/angle.h"
#include "core/base/median.h"
#include "core/base/square.h"
#include "tools/common/format.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Index;

constexpr double kCommonResidual = 1.5;  // rms over sigma; above, the sigmas are wrong

struct ResidualSums {
  long offered = 0, used = 0;
  double squares = 0.0;  // of residual over sigma, of those used
  double rms() const { return used > 0 ? std::sqrt(squares / static_cast<double>(used)) : 0.0; }
};

std::array<ResidualSums, kObservables> sum_residuals(const LogGraph& graph) {
  std::array<ResidualSums, kObservables> sums;
  for (int k = 0; k < graph.size(); ++k) {
    for (const LogMeasurement& measurement : graph.at(k).measurements) {
      ResidualSums& sum = sums[static_cast<std::size_t>(measurement.measurement.observable)];
      ++sum.offered;
      if (!(measurement.factor > 0.0)) continue;
      ++sum.used;
      sum.squares += square(measurement.residual) / measurement.variance;
    }
  }
  return sums;
}

// The median over the log of a root of summed variances, from active state `first` on.
double median_sigma(const LogGraph& graph, const BatchResult& result, int first, int count) {
  std::vector<double> sigmas;
  for (int k = 0; k < graph.size(); ++k) {
    const ActiveStates& active = graph.at(k).active;
    const auto found = std::find(active.core.begin(), active.core.end(), first);
    if (found == active.core.end()) continue;
    const Index at = found - active.core.begin();
    sigmas.push_back(std::sqrt(
        result.last.covariance[static_cast<std::size_t>(k)].diagonal().segment(at, count).sum()));
  }
  if (sigmas.empty()) return std::nan("");
  std::nth_element(sigmas.begin(), sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2),
                   sigmas.end());
  return sigmas[sigmas.size() / 2];
}

// Prints the vehicle constants at the end of the log, as far as they are estimated.
void print_constants(const LogGraph& graph, const BatchResult& result, std::ostream& out) {
  struct Unit {
    const char* name;
    double scale;
    const char* unit;
  };
  constexpr std::array<Unit, kMaxVehicle> kUnits = {
      {{"direction of travel, yaw", kDegreesPerRadian, "deg"},
       {"direction of travel, pitch", kDegreesPerRadian, "deg"},
       {"odometer scale", 100.0, "%"},
       {"lever arm beyond, forward", 1.0, "m"},
       {"lever arm beyond, right", 1.0, "m"},
       {"lever arm beyond, down", 1.0, "m"},
       {"time offset", 1e3, "ms"}}};
  const LogKeyframe& last = graph.at(graph.size() - 1);
  const Eigen::MatrixXd& covariance = result.last.covariance.back();
  for (Index i = 0; i < last.core_size(); ++i) {
    const int state = last.active.core[static_cast<std::size_t>(i)];
    if (state < kSize) continue;
    const Unit& unit = kUnits[static_cast<std::size_t>(state - kSize)];
    out << format("%s: %.4f %s (1 sigma %.4f)\n", unit.name,
                  unit.scale * last.state.vehicle[static_cast<std::size_t>(state - kSize)],
                  unit.unit, unit.scale * std::sqrt(covariance(i, i)));
  }
}

}  // namespace

void print_smoothed(const LogGraph& graph, const BatchResult& result, std::ostream& out) {
  const LogKeyframe& first = graph.at(0);
  const LogKeyframe& last = graph.at(graph.size() - 1);
  int segments = 0;
  for (int k = 0; k < graph.size(); ++k) segments += graph.at(k).process.exists ? 0 : 1;
  out << format("epochs: %d over %.0f s\n", graph.size(), seconds_between(last.time, first.time));
  out << "segments: " << segments << "\n";
  out << "gaps joined: " << result.extension.joined << "\n";
  out << "epochs given an attitude: " << result.extension.attitudes << "\n";
  out << "pieces of ambiguities: " << graph.pieces().size() << "\n";
  for (std::size_t i = 0; i < result.iterations.size(); ++i) {
    const BatchIteration& iteration = result.iterations[i];
    out << format(
        "iteration %zu: cost of measurements %.1f, moved at most %.4f m, %.3f of the filter's "
        "sigma; "
        "factors integrated anew %d\n",
        i + 1, iteration.cost, iteration.moved_m, iteration.moved_sigmas, iteration.reintegrated);
  }
  out << "converged: " << (result.converged ? "yes" : "no") << "\n";
  const auto residuals = sum_residuals(graph);
  constexpr std::array<const char*, kObservables> kNames = {"codes", "carriers", "Dopplers"};
  for (std::size_t i = 0; i < kObservables; ++i)
    out << format("%s: %ld, used %.1f %%, residuals %.2f of their sigmas (rms)\n", kNames[i],
                  residuals[i].offered,
                  100.0 * static_cast<double>(residuals[i].used) /
                      static_cast<double>(std::max(1L, residuals[i].offered)),
                  residuals[i].rms());
  out << format("1 sigma, median: position %.3f m, velocity %.4f m/s",
                median_sigma(graph, result, kPosition, 3),
                median_sigma(graph, result, kVelocity, 3));
  const double attitude = median_sigma(graph, result, kAttitude, 3);
  if (std::isfinite(attitude)) out << format(", attitude %.4f deg", kDegreesPerRadian * attitude);
  out << "\n";
  print_constants(graph, result, out);
}

std::vector<std::string> smoothing_warnings(const LogGraph& graph, const BatchResult& result) {
  std::vector<std::string> warnings;
  if (!result.converged)
    warnings.push_back(format("not converged: the last iteration still moved a position by %.3f m",
                              result.iterations.back().moved_m));
  const auto residuals = sum_residuals(graph);
  if (residuals[static_cast<std::size_t>(Observable::kCode)].rms() > kCommonResidual)
    warnings.push_back(
        "codes do not fit their sigmas; is a convention wrong? leonav-eval --quality shows which");
  if (residuals[static_cast<std::size_t>(Observable::kCarrier)].rms() > kCommonResidual)
    warnings.push_back(
        "carriers do not fit their sigmas; is carrier_sigma_m or the lever arm wrong? "
        "residuals.csv shows which satellites do not");
  int segments = 0;
  for (int k = 0; k < graph.size(); ++k) segments += graph.at(k).process.exists ? 0 : 1;
  if (result.extension_left_out)
    warnings.push_back(
        "with so few iterations the IMU bridges no outage, and epochs before the alignment get no "
        "attitude; --iterations 3 or more");
  else if (segments > 1)
    warnings.push_back(format(
        "the log falls into %d parts without an inertial connection; each is smoothed by itself",
        segments));
  return warnings;
}

}  // namespace leonav
