// What the tests of the filter's consistency share: normalized estimation errors squared (NEES)
// over many runs (Bar-Shalom, Li, Kirubarajan 2001, 5.4.2).
#pragma once
#include <Eigen/Core>
#include <cmath>

#include "support/dense/dense_algebra.h"
#include "synthetic.h"

namespace leonav::synthetic {

inline constexpr int kRuns = 100;

// 95 % band of the mean of kRuns chi-square variables with 3 degrees: 300 degrees over 100,
// quantiles 253.9 and 349.9 (Wilson-Hilferty).
inline constexpr double kLeastNees3 = 2.54, kMostNees3 = 3.50;

using dense::nees;

// Moves the truth over a second of white acceleration as the constant-velocity model has it:
// velocity and position parts with their correlation.
inline void move_a_second(const EkfConfig& config, const Eigen::Matrix3d& C_en, Truth* truth,
                          Generator* noise) {
  const Eigen::Vector3d density{config.acceleration_noise_horizontal,
                                config.acceleration_noise_horizontal,
                                config.acceleration_noise_vertical};
  const Eigen::Vector3d a = noise->normal3().cwiseProduct(density);
  const Eigen::Vector3d b = noise->normal3().cwiseProduct(density);
  truth->p_antenna_e += truth->v_antenna_e + C_en * (0.5 * a + b / std::sqrt(12.0));
  truth->v_antenna_e += C_en * a;
}

// Adds the carriers, and a wet delay to both. A slip that its checks have found: every satellite
// begins a new arc now and then.
inline void add_carriers(const Truth& truth, const Eigen::VectorXd& ambiguities_m, double wet_m,
                         double sigma, int epoch_index, Generator* noise, MeasurementEpoch* epoch) {
  const auto codes = epoch->measurements;
  for (SatelliteInView& view : epoch->satellites) view.wet_mapping = 1.0 / std::sin(view.elevation);
  for (Measurement& m : epoch->measurements)
    if (m.observable == Observable::kCode)
      m.value += wet_m * epoch->satellites[m.satellite_index].wet_mapping;
  for (const Measurement& code : codes) {
    if (code.observable != Observable::kCode) continue;
    Measurement carrier = code;
    const SatelliteInView& view = epoch->satellites[code.satellite_index];
    carrier.observable = Observable::kCarrier;
    carrier.sigma = sigma;
    carrier.arc = 1u + code.satellite_index +
                  100u * static_cast<unsigned>((epoch_index + 7 * code.satellite_index) / 40);
    carrier.value =
        predict_range(view, truth.p_antenna_e).range_m +
        truth.clocks.offset_m(static_cast<Eigen::Index>(index_of(view.satellite.system))) +
        ambiguities_m(code.satellite_index) + 10.0 * (carrier.arc / 100u) +
        wet_m * view.wet_mapping + sigma * noise->normal();
    epoch->measurements.push_back(carrier);
  }
}

}  // namespace leonav::synthetic
