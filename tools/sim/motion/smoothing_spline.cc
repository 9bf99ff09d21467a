#include "tools/sim/motion/smoothing_spline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace leonav {
namespace {

// Symmetric positive definite matrix with two off-diagonals; row i holds (i,i), (i,i+1), (i,i+2).
struct Pentadiagonal {
  std::vector<double> diagonal, first, second;
};

// Solves in place by L D L^T.
std::vector<double> solve(Pentadiagonal m, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double d = m.diagonal[i];
    const double l1 = m.first[i] / d, l2 = m.second[i] / d;
    if (i + 1 < n) {
      m.diagonal[i + 1] -= l1 * m.first[i];
      m.first[i + 1] -= l1 * m.second[i];
      b[i + 1] -= l1 * b[i];
    }
    if (i + 2 < n) {
      m.diagonal[i + 2] -= l2 * m.second[i];
      b[i + 2] -= l2 * b[i];
    }
    m.first[i] = l1;
    m.second[i] = l2;
  }
  for (std::size_t i = n; i-- > 0;) {
    b[i] /= m.diagonal[i];
    if (i + 1 < n) b[i] -= m.first[i] * b[i + 1];
    if (i + 2 < n) b[i] -= m.second[i] * b[i + 2];
  }
  return b;
}

}  // namespace

double SmoothingSpline::lambda_for_cutoff(double frequency_hz, double interval_s) {
  const double omega = 2.0 * std::numbers::pi * frequency_hz;
  return 1.0 / (interval_s * omega * omega * omega * omega);
}

// The notation is that of Green and Silverman, Nonparametric Regression, 2.3: (R + lambda Q'Q)
// gamma = Q'y, g = y - lambda Q gamma, with gamma the second derivatives at the inner knots.
SmoothingSpline::SmoothingSpline(std::vector<double> times, const std::vector<double>& values,
                                 double lambda)
    : times_(std::move(times)), values_(values), second_(values.size(), 0.0) {
  const std::size_t n = times_.size(), inner = n - 2;
  std::vector<double> inverse_h(n - 1), a(inner), b(inner), c(inner), right(inner);
  for (std::size_t i = 0; i + 1 < n; ++i) inverse_h[i] = 1.0 / (times_[i + 1] - times_[i]);
  for (std::size_t j = 0; j < inner; ++j) {  // column j of Q: rows j, j+1, j+2
    a[j] = inverse_h[j];
    b[j] = -inverse_h[j] - inverse_h[j + 1];
    c[j] = inverse_h[j + 1];
    right[j] = a[j] * values[j] + b[j] * values[j + 1] + c[j] * values[j + 2];
  }
  Pentadiagonal m{std::vector<double>(inner), std::vector<double>(inner, 0.0),
                  std::vector<double>(inner, 0.0)};
  for (std::size_t j = 0; j < inner; ++j) {
    m.diagonal[j] =
        (times_[j + 2] - times_[j]) / 3.0 + lambda * (a[j] * a[j] + b[j] * b[j] + c[j] * c[j]);
    if (j + 1 < inner) {
      m.first[j] = 1.0 / (6.0 * inverse_h[j + 1]) + lambda * (b[j] * a[j + 1] + c[j] * b[j + 1]);
    }
    if (j + 2 < inner) m.second[j] = lambda * c[j] * a[j + 2];
  }
  const std::vector<double> gamma = solve(std::move(m), std::move(right));
  for (std::size_t j = 0; j < inner; ++j) {
    second_[j + 1] = gamma[j];
    values_[j] -= lambda * a[j] * gamma[j];
    values_[j + 1] -= lambda * b[j] * gamma[j];
    values_[j + 2] -= lambda * c[j] * gamma[j];
  }
}

SmoothingSpline::Place SmoothingSpline::locate(double t) const {
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
  const std::size_t left = static_cast<std::size_t>(after - times_.begin()) - 1;
  return {left, times_[left + 1] - times_[left], t - times_[left], times_[left + 1] - t};
}

SmoothingSpline::Value SmoothingSpline::evaluate(double t) const {
  const Place p = locate(t);
  const double left = values_[p.left], right = values_[p.left + 1];
  const double bend_left = second_[p.left], bend_right = second_[p.left + 1];
  Value now;
  now.value = (p.u * right + p.w * left) / p.h -
              p.u * p.w / 6.0 * ((1.0 + p.u / p.h) * bend_right + (1.0 + p.w / p.h) * bend_left);
  now.first = (right - left) / p.h + bend_right * (3.0 * p.u * p.u - p.h * p.h) / (6.0 * p.h) -
              bend_left * (3.0 * p.w * p.w - p.h * p.h) / (6.0 * p.h);
  now.second = (p.u * bend_right + p.w * bend_left) / p.h;
  return now;
}

}  // namespace leonav
