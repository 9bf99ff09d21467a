#include "core/filter/error_model/learned_errors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/square.h"
#include "core/filter/error_model/epoch_residuals.h"

namespace leonav {
namespace {

// Fewer innovations are mostly what their own median is.
constexpr std::size_t kMinInnovations = 5;
// Least share of an innovation's variance that is the measurement's, for its correlation.
constexpr double kLeastMeasuredShare = 0.9;
// A residual shows too little of its measurement's own error below this redundancy.
constexpr double kLeastRedundancy = 0.1;
constexpr std::size_t kSolved = 4;  // unknowns of a point solution
constexpr double kLongestInterval_s = 10.0;

// Where errors are learned, this share of the variance is taken as correlated at first; otherwise
// the whole error is. Of a correlation time that is not configured these are taken.
constexpr double kCodeShare = 0.9, kDopplerShare = 0.5;
constexpr double kCodeTime_s = 4.0, kDopplerTime_s = 1.0;
// The filter follows carriers so closely that their innovations do not show how they are
// correlated, so this is not learned: multipath of some millimetres lasts while the antenna moves
// by some metres. What lasts longer, as in front of a standing one, is within the configured sigma.
constexpr double kCarrierShare = 0.5, kCarrierDistance_m = 10.0;
constexpr double kShortestCarrierTime_s = 5.0, kLongestCarrierTime_s = 10.0;
// In front of a standing vehicle reflections change with the satellites alone, so that errors of
// codes last longer. Their detours then hardly change, so errors of Dopplers are not taken to.
constexpr double kCodeStandingTimes = 3.0, kDopplerStandingTimes = 1.0;

using OfMotion = std::array<CorrelationModel, kMotionClasses>;

ErrorCorrelation::Priors configured(const EkfConfig& config) {
  const auto prior = [&](double configured_s, const CorrelationModel& usual,
                         double standing_times) -> OfMotion {
    if (!config.learn_errors) return {{{1.0, configured_s}, {1.0, configured_s}}};
    const double time_s = configured_s > 0.0 ? configured_s : usual.time_s;
    return {{{usual.share, time_s}, {usual.share, standing_times * time_s}}};
  };
  ErrorCorrelation::Priors priors;
  priors[static_cast<std::size_t>(Observable::kCode)] =
      prior(config.code_correlation_time_s, {kCodeShare, kCodeTime_s}, kCodeStandingTimes);
  priors[static_cast<std::size_t>(Observable::kDoppler)] = prior(
      config.doppler_correlation_time_s, {kDopplerShare, kDopplerTime_s}, kDopplerStandingTimes);
  return priors;
}

// Errors of a satellite in low orbit change with its direction, within seconds.
bool lasts_as_in_medium_orbit(const SatelliteInView& satellite) {
  return satellite.satellite.system != System::kLeo;
}

}  // namespace

LearnedErrors::LearnedErrors(const EkfConfig& config)
    : learns_(config.learn_errors), correlation_(configured(config)) {}

void LearnedErrors::reset() {
  scale_.reset();
  correlation_.reset();
  losses_.reset();
  lasting_.reset();
  last_time_ = GpsTime();
}

void LearnedErrors::start(double code_sigma_factor, double doppler_sigma_factor, double share) {
  scale_.start(Observable::kCode, code_sigma_factor, share);
  scale_.start(Observable::kDoppler, doppler_sigma_factor, share);
}

CorrelationModel LearnedErrors::carrier_correlation(double speed) const {
  if (!learns_) return {0.0, 0.0};
  return {kCarrierShare, std::clamp(kCarrierDistance_m / std::max(speed, 1e-3),
                                    kShortestCarrierTime_s, kLongestCarrierTime_s)};
}

bool LearnedErrors::fit_first(const MeasurementEpoch& epoch, const FilterMeasurements& measurements,
                              const ClockRemovedInnovations& innovations, bool standing) {
  if (!learns_ || innovations.size() <= kSolved) return false;
  boost::container::static_vector<SigmaScale::Sample, kMaxMeasurements> samples;
  const auto count = static_cast<double>(innovations.size());
  const double share_left = (count - static_cast<double>(kSolved)) / count;
  Observable observable = Observable::kCode;
  for (const ClockRemovedInnovation& entry : innovations) {
    const Measurement& measurement = epoch.measurements[measurements[entry.index].index];
    const ErrorClass of =
        class_of(measurement, epoch.satellites[measurement.satellite_index], standing);
    observable = measurement.observable;
    const double configured = entry.measured_variance / square(scale_.scale(of));
    samples.push_back({of, square(entry.innovation) / (configured * share_left), 1.0});
  }
  return scale_.fit_first(observable, {samples.data(), samples.size()});
}

void LearnedErrors::add_codes(const MeasurementEpoch& epoch, const FilterMeasurements& measurements,
                              const Eigen::Matrix4d& known_covariance, const Motion& motion,
                              bool agree) {
  if (!learns_) return;
  for (const EpochResidual& entry : code_residuals(measurements, known_covariance)) {
    if (entry.redundancy < kLeastRedundancy) continue;
    const Measurement& measurement = epoch.measurements[measurements[entry.index].index];
    const SatelliteInView& satellite = epoch.satellites[measurement.satellite_index];
    lasting_.add({satellite.satellite, entry.residual, entry.redundancy,
                  measurement.lasting_variance, motion.speed_m_s},
                 epoch.time);
    if (!agree) continue;
    const ErrorClass of = class_of(measurement, satellite, motion.standing);
    const double ratio = entry.residual / std::sqrt(entry.variance);
    scale_.add({of, square(ratio), entry.redundancy});
    if (lasts_as_in_medium_orbit(satellite))
      correlation_.add({satellite.satellite, measurement.code, of, ratio}, epoch.time);
  }
}

void LearnedErrors::add_dopplers(const MeasurementEpoch& epoch,
                                 const FilterMeasurements& measurements,
                                 const ClockRemovedInnovations& innovations, bool standing) {
  if (!learns_ || innovations.size() < kMinInnovations) return;
  for (const ClockRemovedInnovation& entry : innovations) {
    const Measurement& measurement = epoch.measurements[measurements[entry.index].index];
    const SatelliteInView& satellite = epoch.satellites[measurement.satellite_index];
    const ErrorClass of = class_of(measurement, satellite, standing);
    const double measured_share = std::min(entry.measured_variance / entry.variance, 1.0);
    scale_.add({of, square(entry.innovation) / entry.variance, measured_share});
    // While a filter starts, its velocity contains the very errors that are to be seen.
    if (measured_share < kLeastMeasuredShare || !lasts_as_in_medium_orbit(satellite)) continue;
    correlation_.add({satellite.satellite, measurement.code, of,
                      entry.innovation / std::sqrt(entry.measured_variance)},
                     epoch.time);
  }
}

LearnedSummary LearnedErrors::summary(bool standing) const {
  static_assert(kLearnedClassNames.size() ==
                kSystemCount + kElevationClasses + kSignalClasses + kLossClasses);
  const auto of_observable = [&](Observable observable) {
    ErrorClass of;
    of.observable = static_cast<std::size_t>(observable);
    of.motion = standing ? 1 : 0;
    ObservableErrors errors;
    scale_.summarize(observable, &errors);
    for (of.elevation = 0; of.elevation < kElevationClasses; ++of.elevation) {
      LearnedError& error = errors.classes[kSystemCount + of.elevation];
      error.correlated_share = correlation(of).share;
      error.correlation_time_s = correlation(of).time_s;
      errors.all.correlated_share += error.correlated_share / kElevationClasses;
      errors.all.correlation_time_s += error.correlation_time_s / kElevationClasses;
    }
    return errors;
  };
  LearnedSummary summary = {
      learns_, of_observable(Observable::kCode), of_observable(Observable::kDoppler), {}};
  for (const System system : kSystems)
    summary.lasting_m[index_of(system)] = lasting_.own_sigma_m(system);
  return summary;
}

void LearnedErrors::end_epoch(GpsTime time, bool agree) {
  if (!learns_) return;
  lasting_.end_epoch(time);
  if (!agree) return;
  const double interval_s = last_time_.is_set() ? seconds_between(time, last_time_) : 0.0;
  last_time_ = time;
  const double passed_s = std::clamp(interval_s, 0.0, kLongestInterval_s);
  scale_.end_epoch(passed_s);
  correlation_.end_epoch(passed_s);
}

}  // namespace leonav
