// Codes of one epoch as the filter has them, for the tests of what is learned from them.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <vector>

#include "core/filter/update/filter_measurement.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav::test {

// Satellites all around, every second one of Galileo, at 16 to 73 degrees; or all of GPS. Position
// in axes east, north, up: the functions under test know no others.
inline MeasurementEpoch sky_of(int satellites, bool two_systems = true) {
  MeasurementEpoch epoch;
  for (int i = 0; i < satellites; ++i) {
    SatelliteInView view;
    const System system = two_systems && i % 2 == 1 ? System::kGalileo : System::kGps;
    view.satellite = {system, static_cast<std::uint16_t>(i + 1)};
    view.azimuth = 2.4 * i;
    view.elevation = 0.28 + 0.2 * (i % 6);
    Measurement code;
    code.satellite_index = static_cast<std::uint16_t>(i);
    code.code = {'1', 'C'};
    code.sigma = 1.0;
    epoch.satellites.push_back(view);
    epoch.measurements.push_back(code);
  }
  return epoch;
}

inline Eigen::Vector3d direction(const SatelliteInView& view) {
  return {std::sin(view.azimuth) * std::cos(view.elevation),
          std::cos(view.azimuth) * std::cos(view.elevation), std::sin(view.elevation)};
}

// `error` of a code in m, and `sigma`, by its index; the filter's position is off by
// `position_off`.
inline FilterMeasurements codes_of(const MeasurementEpoch& epoch,
                                   const std::function<double(std::size_t)>& error,
                                   const std::function<double(std::size_t)>& sigma,
                                   const Eigen::Vector3d& position_off = Eigen::Vector3d::Zero()) {
  FilterMeasurements codes;
  for (std::size_t i = 0; i < epoch.measurements.size(); ++i) {
    const SatelliteInView& view = epoch.satellites[epoch.measurements[i].satellite_index];
    FilterMeasurement code;
    code.index = i;
    code.row.segment<3>(ekf_index::kPosition) = -direction(view);
    code.row(ekf_index::kClock + static_cast<int>(index_of(view.satellite.system))) = 1.0;
    code.variance = sigma(i) * sigma(i);
    code.innovation = error(i) + code.row.segment<3>(ekf_index::kPosition).dot(position_off);
    codes.push_back(code);
  }
  return codes;
}

// Returns what is known before the codes: the covariance of the position, and no delay of the
// ionosphere.
inline Eigen::Matrix4d known_of(const Eigen::Matrix3d& position_covariance) {
  Eigen::Matrix4d known = Eigen::Matrix4d::Zero();
  known.topLeftCorner<3, 3>() = position_covariance;
  return known;
}
inline Eigen::Matrix4d known_of(double position_sigma) {
  return known_of(position_sigma * position_sigma * Eigen::Matrix3d::Identity());
}

}  // namespace leonav::test
