#include "core/navigator/interface/filter_estimate.h"

#include <cmath>

#include "core/filter/state/covariance_blocks.h"
#include "core/navigator/interface/solution_conversion.h"

namespace leonav {

double position_sigma(const Ekf& filter) {
  return norm_of_sigmas(position_covariance_e(filter.covariance()));
}

double velocity_sigma(const Ekf& filter) {
  const Eigen::Matrix3d covariance = velocity_covariance_e(filter.covariance());
  return norm_of_sigmas(covariance) / std::sqrt(3.0);
}

double gyro_bias_sigma(const Ekf& filter) {
  return std::sqrt(gyro_bias_variances(filter.covariance()).maxCoeff());
}

void fill_solution(const Ekf& filter, Solution* solution) {
  const PvaCovariance covariance = filter.covariance().topLeftCorner<9, 9>();
  const double offset_s =
      filter.has_attitude() ? time_offset_of(filter.filter_state().vehicle) : 0.0;
  fill_solution(at_stamp(filter.state(), offset_s), covariance, filter.has_attitude(), solution);
}

NominalError nominal_error(const Ekf& filter, const Solution& solution) {
  return nominal_error(PvaCovariance(filter.covariance().topLeftCorner<9, 9>()), solution);
}

Eigen::Vector3d sigma_of_euler(const Ekf& filter) {
  Solution solution;
  fill_solution(filter, &solution);
  return solution.sigma_rpy;
}

}  // namespace leonav
