#include "core/filter/cycle_search.h"

#include <cmath>
#include <limits>

#include "core/base/square.h"

namespace leonav {
namespace {

constexpr double kSearched = 5.0;          // sigma
constexpr double kMostCandidates = 400.0;  // of the first number; so many are never decided

// Adds candidates one by one and keeps the best, with the sum of all weights relative to it.
class Candidates {
 public:
  void add(const std::array<double, 2>& cycles, double length_m, double chi_square) {
    if (!search_.found || chi_square < search_.chi_square) {
      const double best = search_.found ? search_.chi_square : chi_square;
      others_ = search_.found ? (others_ + 1.0) * std::exp(0.5 * (chi_square - best)) : 0.0;
      if (search_.found) note_second(search_.length_m, search_.chi_square);
      search_.found = true;
      search_.cycles = cycles;
      search_.length_m = length_m;
      search_.chi_square = chi_square;
    } else {
      others_ += std::exp(0.5 * (search_.chi_square - chi_square));
      note_second(length_m, chi_square);
    }
  }
  CycleSearch result(double sharpness, double difference_sigma_m) const {
    CycleSearch search = search_;
    search.sharpness = sharpness;
    if (!search.found) return search;
    search.alternative_m = second_chi_square_ < kNone ? std::abs(second_length_m_ - search.length_m)
                                                      : 3.0 * difference_sigma_m;
    search.wrong_probability = others_ / (1.0 + others_);
    search.likelihood_ratio = sharpness * (1.0 + others_) * std::exp(-0.5 * search.chi_square);
    return search;
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  void note_second(double length_m, double chi_square) {
    if (chi_square >= second_chi_square_) return;
    second_length_m_ = length_m;
    second_chi_square_ = chi_square;
  }

  CycleSearch search_;
  double second_length_m_ = 0.0, second_chi_square_ = kNone;
  double others_ = 0.0;  // weights of all but the best, whose weight is one
};

CycleSearch search_single(const CycleEquations& e) {
  const double center = e.difference_m / e.wavelength_m[0];
  const double width = kSearched * e.difference_sigma_m / e.wavelength_m[0];
  Candidates candidates;
  if (!(2.0 * width < kMostCandidates)) return {};
  for (double n = std::ceil(center - width); n <= center + width; n += 1.0) {
    const double length_m = n * e.wavelength_m[0];
    candidates.add({n, 0.0}, length_m, square((e.difference_m - length_m) / e.difference_sigma_m));
  }
  return candidates.result(e.wavelength_m[0] / (std::sqrt(2.0 * M_PI) * e.difference_sigma_m),
                           e.difference_sigma_m);
}

}  // namespace

// With gamma[0] + gamma[1] = 1 the first carrier's cycles are, from both equations,
// x = difference + gamma[1] geometry_free, and the second's follow from each of them by the
// geometry-free equation, which is the sharper one.
CycleSearch search_cycles(const CycleEquations& e) {
  if (!(e.wavelength_m[1] > 0.0)) return search_single(e);
  const double x = e.difference_m + e.gamma[1] * e.geometry_free_m;
  const double x_sigma = std::hypot(e.difference_sigma_m, e.gamma[1] * e.geometry_free_sigma_m);
  const double center = x / e.wavelength_m[0], width = kSearched * x_sigma / e.wavelength_m[0];
  const double width_2 = kSearched * e.geometry_free_sigma_m / e.wavelength_m[1];
  if (!(2.0 * width < kMostCandidates) || !(2.0 * width_2 < kMostCandidates)) return {};
  Candidates candidates;
  for (double n1 = std::ceil(center - width); n1 <= center + width; n1 += 1.0) {
    const double carrier_1 = n1 * e.wavelength_m[0];
    const double center_2 = (carrier_1 - e.geometry_free_m) / e.wavelength_m[1];
    for (double n2 = std::ceil(center_2 - width_2); n2 <= center_2 + width_2; n2 += 1.0) {
      const double carrier_2 = n2 * e.wavelength_m[1];
      const double length_m = e.gamma[0] * carrier_1 + e.gamma[1] * carrier_2;
      const double by_difference = square((e.difference_m - length_m) / e.difference_sigma_m);
      if (by_difference > square(kSearched)) continue;
      candidates.add({n1, n2}, length_m,
                     by_difference + square((e.geometry_free_m - carrier_1 + carrier_2) /
                                            e.geometry_free_sigma_m));
    }
  }
  // The equations have the determinant one: cells are as large in their left sides.
  return candidates.result(e.wavelength_m[0] * e.wavelength_m[1] /
                               (2.0 * M_PI * e.difference_sigma_m * e.geometry_free_sigma_m),
                           e.difference_sigma_m);
}

}  // namespace leonav
