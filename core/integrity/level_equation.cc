#include "core/integrity/level_equation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/integrity/overbound.h"

namespace leonav {
namespace {

constexpr double kRelativeTolerance = 1e-9;
constexpr int kMostHalvings = 64;
constexpr int kMostDoublings = 64;

bool is_finite(const LevelTerm& term) {
  return std::isfinite(term.probability) && std::isfinite(term.offset) && std::isfinite(term.sigma);
}

// Returns a level with a smaller remaining risk, or infinity.
double upper_bound(std::span<const LevelTerm> terms, double risk, const Overbound& overbound) {
  double level = 0.0;
  for (const LevelTerm& term : terms)
    level = std::max(level, term.offset + overbound.sigma_factor * term.sigma);
  if (level == 0.0) level = std::numeric_limits<double>::min();  // nothing is uncertain
  for (int i = 0; i < kMostDoublings; ++i, level *= 2.0)
    if (remaining_risk(level, terms, overbound) <= risk) return level;
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double remaining_risk(double level, std::span<const LevelTerm> terms, const Overbound& overbound) {
  double risk = 0.0;
  for (const LevelTerm& term : terms)
    risk += term.probability * exceedance(level - term.offset, term.sigma, overbound);
  return risk;
}

double solve_level(std::span<const LevelTerm> terms, double risk, const Overbound& overbound) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (!(risk > 0.0) || !std::all_of(terms.begin(), terms.end(), is_finite)) return nan;
  double low = 0.0, high = upper_bound(terms, risk, overbound);
  if (!std::isfinite(high)) return nan;
  if (remaining_risk(low, terms, overbound) <= risk) return low;
  for (int i = 0; i < kMostHalvings && high - low > kRelativeTolerance * high; ++i) {
    const double middle = 0.5 * (low + high);
    (remaining_risk(middle, terms, overbound) <= risk ? high : low) = middle;
  }
  return high;
}

}  // namespace leonav
