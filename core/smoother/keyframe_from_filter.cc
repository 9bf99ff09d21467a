#include "core/smoother/keyframe_from_filter.h"

#include <array>

namespace leonav {
namespace {

using ekf_index::kSize;

constexpr int kNoPlace = -1;

void copy_measurements(const MeasurementEpoch& epoch, const FilterMeasurements& of_filter,
                       KeyframeInput* input) {
  std::array<int, kMaxSatellites> place;
  place.fill(kNoPlace);
  for (const FilterMeasurement& used : of_filter) {
    KeyframeMeasurement measurement;
    measurement.measurement = epoch.measurements[used.index];
    std::uint16_t& satellite = measurement.measurement.satellite_index;
    if (place[satellite] == kNoPlace) {
      if (input->satellites.size() == input->satellites.capacity()) continue;
      place[satellite] = static_cast<int>(input->satellites.size());
      input->satellites.push_back(epoch.satellites[satellite]);
    }
    satellite = static_cast<std::uint16_t>(place[satellite]);
    if (used.ambiguity >= 0) measurement.ambiguity = used.ambiguity - kSize;
    measurement.variance = used.variance;
    measurement.gain_variance = used.gain_variance;
    measurement.factor = used.factor;
    input->measurements.push_back(measurement);
  }
}

}  // namespace

void keyframe_from_filter(const MeasurementEpoch& epoch, FilterState* from, Ekf* filter,
                          KeyframeInput* input) {
  input->index = epoch.index;
  input->time = epoch.time;
  input->satellites.clear();
  input->measurements.clear();
  input->valid = filter->initialized();
  input->linked = input->valid && filter->process().continuous;
  if (!input->valid) return;
  input->has_attitude = filter->has_attitude();
  input->from = *from;
  input->prior = filter->prior();
  input->process = filter->process();
  input->state = filter->whole_state();
  input->covariance = filter->covariance();
  input->measured_rate_b = filter->measured_rate_b();
  input->mast_e.setZero();
  if (!input->has_attitude) input->mast_e = filter->antenna_position_e() - input->state.nav.p_e;
  copy_measurements(epoch, filter->measurements(), input);
  *from = input->state;
  filter->begin_process();
}

}  // namespace leonav
