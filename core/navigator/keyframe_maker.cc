#include "core/navigator/keyframe_maker.h"

#include <algorithm>

namespace leonav {
namespace {

using ekf_index::kSize;

double square(double x) { return x * x; }

// Place of the epoch's satellite among the keyframe's, added if need be; -1: no room.
int place_of(const SatelliteInView& satellite, KeyframeSatellites* satellites) {
  for (std::size_t i = 0; i < satellites->size(); ++i)
    if ((*satellites)[i].satellite == satellite.satellite) return static_cast<int>(i);
  if (satellites->size() == satellites->capacity()) return -1;
  satellites->push_back(satellite);
  return static_cast<int>(satellites->size()) - 1;
}

// What the filter has used, with the variances that it gave: codes and Dopplers that contradicted
// each other weigh less.
void copy_measurements(const MeasurementEpoch& epoch, const Ekf& ekf, KeyframeInput* keyframe) {
  for (const FilterMeasurement& used : ekf.measurements()) {
    const Measurement& measurement = epoch.measurements[used.index];
    const SatelliteInView& satellite = epoch.satellites[measurement.satellite_index];
    const int place = place_of(satellite, &keyframe->satellites);
    if (place < 0) continue;
    KeyframeMeasurement entry;
    entry.measurement = measurement;
    entry.measurement.satellite_index = static_cast<std::uint16_t>(place);
    entry.ambiguity = used.ambiguity < 0 ? -1 : used.ambiguity - kSize;
    const double relaxed = ekf.relaxed_by(used.observable);
    entry.variance = used.variance * square(relaxed);
    entry.gain_variance = used.gain_variance * square(relaxed);
    entry.factor = std::min(1.0, used.factor * square(relaxed));
    keyframe->measurements.push_back(entry);
  }
}

}  // namespace

void KeyframeMaker::add(const ImuBlock& block) {
  for (const ImuSample& sample : block) {
    if (block_->size() == block_->capacity()) whole_ = false;
    if (whole_) block_->push_back(sample);
    newest_ = sample;
  }
}

bool KeyframeMaker::is_due(const Ekf& ekf, GpsTime time) const {
  return !last_time_.is_set() || !ekf.process().continuous ||
         seconds_between(time, last_time_) >= interval_s_;
}

void KeyframeMaker::make(const EpochWork& work, const MeasurementEpoch* measurements, Ekf* ekf,
                         KeyframeInput* keyframe) {
  keyframe->index = work.index;
  keyframe->time = work.time;
  keyframe->valid = ekf->initialized() && ekf->is_finite();
  keyframe->linked = ekf->process().continuous;
  keyframe->has_attitude = ekf->has_attitude();
  keyframe->state = ekf->whole_state();
  keyframe->covariance = ekf->covariance();
  keyframe->measured_rate_b = ekf->measured_rate_b();
  keyframe->mast_e = ekf->mast_e();
  keyframe->satellites.clear();
  keyframe->measurements.clear();
  keyframe->block.clear();
  keyframe->before_block = before_block_;
  if (keyframe->linked) {
    keyframe->from = last_state_;
    // Where the process alone would have led, without the filter's updates.
    keyframe->prior = ekf->whole_state();
    leonav::add(ekf->process().transition.rightCols<1>(), ekf->has_attitude(), &keyframe->prior);
    keyframe->process = ekf->process();
    if (measurements != nullptr) copy_measurements(*measurements, *ekf, keyframe);
    if (whole_) keyframe->block = *block_;
  }
  last_time_ = work.time;
  last_state_ = ekf->whole_state();
  block_->clear();
  before_block_ = newest_;
  whole_ = true;
  if (keyframe->valid) ekf->begin_process();
}

}  // namespace leonav
