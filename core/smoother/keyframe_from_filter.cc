#include "core/smoother/keyframe_from_filter.h"

#include <algorithm>
#include <array>

#include "core/base/square.h"
#include "core/filter/error_model/error_correlation.h"

namespace leonav {
namespace {

constexpr int kNoIndex = -1;

// Returns the variance in the gain of a measurement that stands for all since the keyframe before.
// The filter has inflated it so that the mean over all its epochs has the right variance; the less
// often correlated errors are seen, the less each of them has to be inflated.
double thinned(const FilterMeasurement& used, double epoch_s, double keyframe_s) {
  if (!(keyframe_s > epoch_s) || !(epoch_s > 0.0)) return used.gain_variance;
  const CorrelationModel errors = {used.correlated_share, used.correlation_time_s};
  const double share = variance_inflation(errors, keyframe_s) / variance_inflation(errors, epoch_s);
  return std::max(share * used.gain_variance, used.variance);
}

// What was offered to the filter's update, with the variances that it gave: codes and Dopplers that
// contradicted each other weigh less, and what it rejected has the factor 0.
void copy_measurements(const MeasurementEpoch& epoch, const Ekf& filter, KeyframeInput* input) {
  const double keyframe_s = seconds_between(input->time, input->from.nav.time);
  std::array<int, kMaxSatellites> slot;
  slot.fill(kNoIndex);
  for (const FilterMeasurement& used : filter.measurements()) {
    KeyframeMeasurement measurement;
    measurement.measurement = epoch.measurements[used.index];
    std::uint16_t& satellite = measurement.measurement.satellite_index;
    if (slot[satellite] == kNoIndex) {
      slot[satellite] = static_cast<int>(input->satellites.size());
      input->satellites.push_back(epoch.satellites[satellite]);
    }
    satellite = static_cast<std::uint16_t>(slot[satellite]);
    if (used.ambiguity >= 0)
      measurement.ambiguity = used.ambiguity - input->state.first_ambiguity();
    const double inflation = square(filter.sigma_inflation(used.observable));
    measurement.variance = used.variance * inflation;
    measurement.gain_variance = thinned(used, filter.update_interval_s(), keyframe_s) * inflation;
    measurement.factor = std::min(1.0, used.factor * inflation);
    input->measurements.push_back(measurement);
  }
}

}  // namespace

void keyframe_from_filter(std::uint64_t index, GpsTime time, const MeasurementEpoch* measurements,
                          FilterState* from, Ekf* filter, KeyframeInput* input) {
  input->index = index;
  input->time = time;
  input->satellites.clear();
  input->measurements.clear();
  input->valid = filter->initialized() && filter->estimate().is_finite();
  input->follows_previous = input->valid && filter->estimate().process().continuous;
  if (!input->valid) return;
  input->attitude_replaced = filter->estimate().process().replaced;
  input->has_attitude = filter->has_attitude();
  input->state = filter->filter_state();
  input->covariance = filter->covariance();
  input->measured_rate_b = filter->body().measured_rate_b;
  input->acceleration_e = filter->body().acceleration_e;
  input->vertical_antenna_offset_e = filter->vertical_antenna_offset_e();
  if (input->follows_previous) {
    input->from = *from;
    // Where the process alone would have led, without the filter's updates.
    input->prior = input->state;
    add(filter->estimate().process().transition.rightCols<1>(), input->has_attitude, &input->prior);
    input->process = filter->estimate().process();
    if (measurements != nullptr) copy_measurements(*measurements, *filter, input);
  }
  *from = input->state;
  filter->begin_process();
}

}  // namespace leonav
