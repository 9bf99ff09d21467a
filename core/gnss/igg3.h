// IGG-III robust weighting (Electronics 2024 eq. 32, Remote Sensing 2024): one factor per
// measurement.
#pragma once
namespace leonav {

struct RobustConfig {
  bool enabled = true;
  double k0 = 1.5;         // standardized residual up to which a measurement keeps its full weight
  double k1 = 5.0;         // standardized residual from which it is out
  int max_iterations = 5;  // re-weighting passes per epoch
};

// Factor in [0, 1] on the weight (it divides the variance); 0: the measurement is out.
// `standardized_residual` is residual over its standard deviation; its sign does not matter.
double igg3_factor(double standardized_residual, double k0, double k1);

}  // namespace leonav
