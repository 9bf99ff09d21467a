#include "core/filter/error_model/learned_errors.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"

namespace leonav {
namespace {

// Fewer innovations are mostly what their own median is.
constexpr std::size_t kMinInnovations = 5;
constexpr double kLongestInterval_s = 10.0;

std::array<CorrelationModel, kObservables> configured(const EkfConfig& config) {
  std::array<CorrelationModel, kObservables> models;
  const double share = config.learn_errors ? 0.5 : 1.0;
  models[static_cast<std::size_t>(Observable::kCode)] = {share, config.code_correlation_time_s};
  models[static_cast<std::size_t>(Observable::kDoppler)] = {share,
                                                            config.doppler_correlation_time_s};
  return models;
}

}  // namespace

LearnedErrors::LearnedErrors(const EkfConfig& config)
    : learns_(config.learn_errors), correlation_(configured(config)) {}

void LearnedErrors::reset() {
  scale_.reset();
  correlation_.reset();
  last_time_ = GpsTime();
}

void LearnedErrors::add(const MeasurementEpoch& epoch, const FilterMeasurements& measurements,
                        const ClockRemovedInnovations& innovations) {
  if (!learns_ || innovations.size() < kMinInnovations) return;
  for (const ClockRemovedInnovation& entry : innovations) {
    const FilterMeasurement& used = measurements[entry.index];
    const Measurement& measurement = epoch.measurements[used.index];
    const SatelliteInView& satellite = epoch.satellites[measurement.satellite_index];
    const ErrorClass of = error_class(measurement, satellite);
    scale_.add({of, square(entry.innovation) / entry.variance,
                entry.measured_variance / entry.variance});
    // Errors of a satellite in low orbit change with its direction, within seconds.
    if (satellite.satellite.system == System::kLeo) continue;
    correlation_.add({satellite.satellite, measurement.code, of,
                      entry.innovation / std::sqrt(entry.measured_variance),
                      (entry.variance - entry.measured_variance) / entry.measured_variance},
                     epoch.time);
  }
}

void LearnedErrors::end_epoch(GpsTime time) {
  if (!learns_) return;
  const double interval_s = last_time_.is_set() ? seconds_between(time, last_time_) : 0.0;
  last_time_ = time;
  const double passed_s = std::clamp(interval_s, 0.0, kLongestInterval_s);
  scale_.end_epoch(passed_s);
  correlation_.end_epoch(passed_s);
}

}  // namespace leonav
