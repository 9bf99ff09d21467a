#include "core/filter/error_model/learned_errors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/square.h"

namespace leonav {
namespace {

// Fewer innovations are mostly what their own median is.
constexpr std::size_t kMinInnovations = 5;
constexpr double kLongestInterval_s = 10.0;

// Where errors are learned, this share of the variance is taken as correlated at first; otherwise
// the whole error is.
constexpr double kCodeShare = 0.9, kDopplerShare = 0.5, kCarrierShare = 0.5;
// The filter follows carriers so closely that their innovations do not show how they are
// correlated: multipath of some millimetres lasts as long as that of the codes does. It is
// therefore not learned.
constexpr double kCodeTime_s = 20.0, kDopplerTime_s = 3.0;
constexpr double kCarrierTime_s = 10.0;
// In front of a standing vehicle reflections change with the satellites alone.
constexpr double kStandingTimes = 5.0;

ErrorCorrelation::Priors configured(const EkfConfig& config) {
  const auto prior = [&](double share, double time_s) {
    const double standing = config.learn_errors ? kStandingTimes : 1.0;
    return std::array<CorrelationModel, kMotionClasses>{
        {{config.learn_errors ? share : 1.0, time_s},
         {config.learn_errors ? share : 1.0, standing * time_s}}};
  };
  ErrorCorrelation::Priors priors;
  const auto time_or = [&](double configured_s, double usual_s) {
    return config.learn_errors && configured_s <= 0.0 ? usual_s : configured_s;
  };
  priors[static_cast<std::size_t>(Observable::kCode)] =
      prior(kCodeShare, time_or(config.code_correlation_time_s, kCodeTime_s));
  priors[static_cast<std::size_t>(Observable::kDoppler)] =
      prior(kDopplerShare, time_or(config.doppler_correlation_time_s, kDopplerTime_s));
  priors[static_cast<std::size_t>(Observable::kCarrier)] =
      prior(kCarrierShare, config.learn_errors ? kCarrierTime_s : 0.0);
  return priors;
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
                        const ClockRemovedInnovations& innovations, bool standing) {
  if (!learns_ || innovations.size() < kMinInnovations) return;
  for (const ClockRemovedInnovation& entry : innovations) {
    const FilterMeasurement& used = measurements[entry.index];
    const Measurement& measurement = epoch.measurements[used.index];
    const SatelliteInView& satellite = epoch.satellites[measurement.satellite_index];
    const ErrorClass of = error_class(measurement, satellite, standing);
    // The innovation of a carrier contains that of another one, too.
    const double measured =
        (measurement.observable == Observable::kCarrier ? 2.0 : 1.0) * entry.measured_variance;
    const double predicted = std::max(entry.variance - measured, 0.0);
    scale_.add(
        {of, square(entry.innovation) / entry.variance, std::min(measured / entry.variance, 1.0)});
    // Errors of a satellite in low orbit change with its direction, within seconds.
    if (satellite.satellite.system == System::kLeo) continue;
    correlation_.add({satellite.satellite, measurement.code, of,
                      entry.innovation / std::sqrt(measured), predicted / measured},
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
