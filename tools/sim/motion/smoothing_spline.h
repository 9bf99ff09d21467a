// SmoothingSpline is a cubic smoothing spline: twice continuously differentiable, close to noisy
// samples.
#pragma once
#include <vector>

namespace leonav {

// It minimizes sum (y_i - f(t_i))^2 + lambda * integral f''^2 (Reinsch, Numerische Mathematik 10,
// 1967). The solution is a natural cubic spline with knots at the samples.
class SmoothingSpline {
 public:
  SmoothingSpline() = default;
  // Precondition: at least three samples, times strictly increasing. lambda 0 interpolates.
  SmoothingSpline(std::vector<double> times, const std::vector<double>& values, double lambda);

  struct Value {
    double value, first, second;  // value and its derivatives
  };
  Value evaluate(double t) const;

  // Returns the lambda that halves a sine of `frequency_hz` sampled every `interval_s`; slower ones
  // pass, faster ones fall with the fourth power.
  static double lambda_for_cutoff(double frequency_hz, double interval_s);

 private:
  struct Place {
    std::size_t left;  // knots left and left + 1 enclose t
    double h, u, w;    // their distance, t - left, right - t
  };
  Place locate(double t) const;

  std::vector<double> times_, values_, second_;  // at the knots
};

}  // namespace leonav
