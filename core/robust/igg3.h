// This unit computes the IGG-III robust weight factor of one measurement (Electronics 2024, 13,
// 508, eq. 32; Remote Sensing 2024, 16, 1782).
#pragma once
namespace leonav {

// Thresholds of the robust weights.
struct RobustConfig {
  bool enabled = true;
  double k0 = 1.5;         // standardized residual up to which a measurement keeps its full weight
  double k1 = 5.0;         // standardized residual from which a measurement is excluded
  int max_iterations = 5;  // re-weighting passes per epoch

  bool operator==(const RobustConfig&) const = default;
};

// Returns the factor in [0, 1] on the weight (it divides the variance); 0 excludes the measurement.
// `standardized_residual` is the residual over its standard deviation; its sign does not matter.
double igg3_factor(double standardized_residual, double k0, double k1);

}  // namespace leonav
