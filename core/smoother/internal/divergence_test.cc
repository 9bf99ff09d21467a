#include "core/smoother/internal/divergence_test.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"

namespace leonav {
namespace {

constexpr double kAlwaysAllowed_m = 0.3;
constexpr double kDifference = 3.0;  // sigmas
constexpr int kContradictions = 10;

}  // namespace

bool DivergenceTest::operator()(const WindowAgainstFilter& at) {
  with_last_solve_ = 0;
  if (at.apart_m < std::max(kAlwaysAllowed_m, at.filter_sigma_m + at.window_sigma_m)) return true;
  if (!at.filter_is_younger) return false;
  const double variance = square(at.filter_sigma_m) - square(at.window_sigma_m);
  if (at.apart_m < kDifference * std::sqrt(std::max(0.0, variance))) return true;
  if (at.codes_fit_window) return true;
  with_last_solve_ = contradictions_ + 1;
  return with_last_solve_ < kContradictions;
}

}  // namespace leonav
