// search_cycles() finds by how many whole cycles two carrier arcs of a satellite differ.
#pragma once
#include <array>

namespace leonav {

// What is known of the cycles n1 and n2 by which a later arc differs from an earlier one, in m:
//   gamma[0] wavelength_m[0] n1 + gamma[1] wavelength_m[1] n2 = difference_m,
//   wavelength_m[0] n1 - wavelength_m[1] n2 = geometry_free_m,
// each with an error of its own sigma. On one frequency the second wavelength is 0 and the second
// equation does not exist.
struct CycleEquations {
  std::array<double, 2> wavelength_m{};
  std::array<double, 2> gamma{1.0, 0.0};
  double difference_m = 0.0, difference_sigma_m = 0.0;
  double geometry_free_m = 0.0, geometry_free_sigma_m = 0.0;
};

// The whole cycles that fit best.
struct CycleSearch {
  bool found = false;  // a candidate lies within five sigmas; too many candidates are none
  std::array<double, 2> cycles{};
  double length_m = 0.0;  // what they are in the first equation
  // Distance of the next best candidate's length from it, m; where there is no other within five
  // sigmas, three sigmas of the first equation.
  double alternative_m = 0.0;
  double chi_square = 0.0;  // of the equations, with one degree of freedom each
  // Probability that other cycles are the true ones, if all whole numbers are equally likely
  // beforehand: the other candidates' share of the sum of exp(-chi_square / 2) over all. This is
  // one minus the success rate of integer rounding conditioned on the data (Teunissen 1998, Journal
  // of Geodesy 72, 606; for cycle slips Blewitt 1990, GRL 17, 199).
  double wrong_probability = 1.0;
  // Likelihood of whole cycles over that of any length, both with a uniform density over the area
  // searched: the candidates' normal densities times the area of a cell of whole cycles. The
  // largest value that a single candidate may have is the sharpness.
  double likelihood_ratio = 0.0, sharpness = 0.0;
};

// Searches all cycles within five sigmas of both equations.
CycleSearch search_cycles(const CycleEquations& equations);

}  // namespace leonav
