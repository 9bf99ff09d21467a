// This function computes the residuals of one epoch's codes at the position that fits them best.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/filter/update/filter_measurement.h"

namespace leonav {

// EpochResidual is what one code of an epoch shows of its error.
struct EpochResidual {
  std::size_t index = 0;    // into the measurements
  double residual = 0.0;    // m
  double variance = 0.0;    // of `residual`, from the variances of the measurements, m^2
  double redundancy = 0.0;  // share of the measurement's own error that its residual shows, 0 to 1
};
using EpochResiduals = boost::container::static_vector<EpochResidual, kMaxMeasurements>;

// Returns the residuals of the codes of `measurements` at the position, the clocks of their systems
// and the zenith ionosphere delay that fit them best, by iteratively reweighted least
// squares. Position and ionosphere are known from before with the covariance P, which counts with
// three of its sigmas, Lambda = (9 P)^-1. Weights psi are Huber's at the predicted position, then
// IGG-III's (core/robust/igg3.h) at the fitted one:
//   N = H^T W H + Lambda,  W = diag(psi_i / R_i),  r = (I - H N^-1 H^T W) innovation
//   var(r_i) = R_i - 2 psi_i h_i N^-1 h_i^T + h_i N^-1 (H^T W R W H + Lambda P Lambda) N^-1 h_i^T
//   redundancy_i = 1 - psi_i h_i N^-1 h_i^T / R_i
// They hardly depend on the filter's position, so that neither an error of it is taken for one of
// the codes, nor do errors that the filter has followed disappear. Empty if the codes do not
// determine a position with one code to spare. `known_covariance`: P of position (ECEF) and
// ionosphere, m^2. R_i: FilterMeasurement::variance. Sources: Foerstner, Zeitschrift fuer
// Vermessungswesen 104, 1979 (redundancy and estimation of variance components); Huber and
// Ronchetti, Robust Statistics, 2009, 7.8 (reweighting).
EpochResiduals code_residuals(const FilterMeasurements& measurements,
                              const Eigen::Matrix4d& known_covariance);

}  // namespace leonav
