// A standing receiver of codes and carriers for the filter's tests: eight satellites that move
// across the sky, the first of them of GPS, the others of Galileo, every 30 s.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/filter/ekf.h"
#include "support/drive/white_errors.h"
#include "synthetic.h"

namespace leonav::synthetic {

inline constexpr double kCode = 0.3, kCarrier = 0.003;  // m
inline constexpr double kStep_s = 30.0;

// The eight satellites, moving across the sky.
inline std::vector<SatelliteInView> sky_at(double t, std::size_t gps = 5) {
  constexpr std::array<double, 8> kAzimuth = {0.1, 1.3, 2.4, 3.6, 5.0, 0.8, 2.9, 4.4};
  constexpr std::array<double, 8> kElevation = {0.4, 1.2, 0.5, 0.9, 0.35, 0.7, 0.6, 1.0};
  std::vector<SatelliteInView> sky;
  for (std::size_t i = 0; i < 8; ++i) {
    const double turn = (i % 2 == 0 ? 1.0 : -1.0) * 1.2e-4 * t;
    sky.push_back(satellite_at(i < gps ? System::kGps : System::kGalileo,
                               static_cast<std::uint16_t>(i + 1), kAzimuth[i] + turn,
                               kElevation[i] + 0.5 * turn));
  }
  return sky;
}

inline double ambiguity_of(std::size_t satellite) {
  return 3.7 * static_cast<double>(satellite) - 11.0;
}

class Receiver {
 public:
  explicit Receiver(std::uint64_t seed, std::size_t gps = 5) : noise_(seed), gps_(gps) {
    truth_.p_antenna_e = start_position();
    truth_.v_antenna_e = Eigen::Vector3d::Zero();
    truth_.clocks.offset_m.setConstant(1000.0);
    truth_.clocks.drift_m_s.setZero();
  }

  // Codes and carriers; arcs are numbered from `first_arc` on.
  MeasurementEpoch measure(double t, std::uint32_t first_arc = 1) {
    MeasurementEpoch epoch;
    epoch.time = kStart.plus_seconds(t);
    for (const SatelliteInView& view : sky_at(t, gps_)) {
      const std::size_t i = epoch.satellites.size();
      const auto base = static_cast<Eigen::Index>(index_of(view.satellite.system));
      epoch.satellites.push_back(view);
      Measurement code;
      code.satellite_index = static_cast<std::uint16_t>(i);
      code.sigma = kCode;
      const double range =
          predict_range(view, truth_.p_antenna_e).range_m + truth_.clocks.offset_m(base);
      code.value = range + kCode * noise_.normal();
      epoch.measurements.push_back(code);
      Measurement carrier = code;
      carrier.observable = Observable::kCarrier;
      carrier.sigma = kCarrier;
      carrier.arc = first_arc + static_cast<std::uint32_t>(i);
      carrier.value = range + ambiguity_of(i) + kCarrier * noise_.normal();
      epoch.measurements.push_back(carrier);
    }
    return epoch;
  }

  PointSolution point() { return point_near(truth_, 3.0, 0.2, &noise_); }
  Truth& truth() { return truth_; }

 private:
  Generator noise_;
  std::size_t gps_;
  Truth truth_;
};

inline EkfConfig static_config() {
  EkfConfig config = white_error_config();
  config.static_point = true;
  config.use_carrier = true;
  config.robust.enabled = false;
  // As good as independent from epoch to epoch.
  config.clock.offset_noise = 30.0;
  config.clock.inter_system_noise = 30.0;
  return config;
}

inline Ekf static_filter(Receiver* receiver, const EkfConfig& config = static_config()) {
  Ekf filter(config, ImuErrorModel(), Eigen::Vector3d::Zero());
  filter.initialize(kStart, receiver->point());
  return filter;
}

inline EkfUpdateResult step(Ekf* filter, const MeasurementEpoch& epoch) {
  filter->predict({}, epoch.time);
  return filter->update(epoch);
}

}  // namespace leonav::synthetic
