// CarrierSpeed computes the antenna's mean horizontal speed from time-differenced carrier phase
// over a few seconds.
//
// The speed depends neither on the IMU nor on the filter, so that a falsely detected standstill
// cannot influence it. Source of the differences: core/gnss/preprocessing
// (CarrierPreprocessor::antenna_change).
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <optional>

#include "core/gnss/preprocessing/carrier_preprocessor.h"

namespace leonav {

// CarrierSpeed sums up the displacements of the antenna (ECEF, m) between successive epochs.
class CarrierSpeed {
 public:
  // Adds the displacement after each epoch with measurements; nullopt, if the carriers determine
  // none, or a gap in time starts anew.
  //
  // Reflections make a single displacement wrong by centimetres, but the sum over the same arcs is
  // wrong by no more than that.
  void add(const std::optional<AntennaChange>& change);
  // Returns the mean horizontal speed of the last kWindow_s, m/s, or nullopt if displacements do
  // not reach back so far. `antenna_p_e` (ECEF, m) defines the horizontal plane.
  std::optional<double> horizontal(const Eigen::Vector3d& antenna_p_e) const;

  static constexpr double kWindow_s = 4.0;

 private:
  static constexpr std::size_t kMaxSamples = 32;
  static constexpr double kSampleInterval_s = 0.2;
  struct Sample {
    GpsTime time;
    Eigen::Vector3d displacement_e = Eigen::Vector3d::Zero();  // m, since the start
  };
  boost::container::static_vector<Sample, kMaxSamples> samples_;
  Sample now_;
};

}  // namespace leonav
