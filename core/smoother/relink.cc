#include "core/smoother/relink.h"

#include <algorithm>
#include <limits>
#include <span>

#include "core/smoother/window.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Index;

// An attitude off by this turns 1 g of specific force over a second into 5e-6 m/s beyond the first
// order; a scale of 1e-3 beside it does less.
constexpr double kFarAttitude = 1e-3;   // rad
constexpr double kFarVelocity = 5.0;    // m/s
constexpr double kFarPosition = 100.0;  // m

EkfConfig propagating(EkfConfig config) {
  config.keep_process = true;
  return config;
}

// What the propagator knows of: neither clocks nor wet delay.
bool is_of_motion(int state) { return state < kInsSize || state >= kSize; }

bool is_far(const EkfCorrection& moved) {
  return moved.segment<3>(kAttitude).norm() > kFarAttitude ||
         moved.segment<3>(kVelocity).norm() > kFarVelocity ||
         moved.segment<3>(kPosition).norm() > kFarPosition;
}

// What constraints tell of the inertial states before; they know of no others.
void take_information(const FilterProcess& process, const ActiveStates& active,
                      KeyframeLink* link) {
  link->information.setZero(active.size(), active.size());
  link->gradient.setZero(active.size());
  if (!process.informed) return;
  for (Index i = 0; i < active.core_size(); ++i) {
    const int row = active.core[static_cast<std::size_t>(i)];
    link->gradient(i) = process.gradient(row);
    for (Index j = 0; j < active.core_size(); ++j)
      link->information(i, j) = process.information(row, active.core[static_cast<std::size_t>(j)]);
  }
}

}  // namespace

Relinker::Relinker(const RelinkConfig& config)
    : motion_(config.motion),
      propagator_(std::make_unique<Ekf>(propagating(config.ekf), config.imu, config.lever_arm_b)) {}

// From the estimate before, with the constraints that the filter has used.
void Relinker::propagate(const Keyframe& before, const Keyframe& keyframe) {
  propagator_->place(before.state, true, keyframe.before_block);
  const std::span<const ImuSample> block{keyframe.block.data(), keyframe.block.size()};
  for (const ConstraintInstant& instant : keyframe.instants) {
    propagator_->predict(block, instant.time);  // takes up what is still ahead of it
    motion_measurements(motion_, instant, propagator_->whole_state(),
                        propagator_->measured_rate_b(), &measurements_);
    const auto unused = [&](const MotionMeasurement& measurement) {
      return (instant.used >> measurement.component & 1) == 0;
    };
    measurements_.erase(std::remove_if(measurements_.begin(), measurements_.end(), unused),
                        measurements_.end());
    propagator_->constrain(&measurements_, std::numeric_limits<double>::infinity());
  }
  propagator_->predict(block, keyframe.time);
}

void Relinker::operator()(const Keyframe& before, Keyframe* keyframe) {
  KeyframeLink& link = keyframe->link;
  if (!keyframe->has_attitude || !keyframe->block_whole) return;
  if (!is_far(difference(before.state, link.from))) return;
  propagate(before, *keyframe);

  const FilterProcess& process = propagator_->process();
  FilterState whole = propagator_->whole_state();
  // Constraints have moved the state away from where the process then leads.
  if (process.informed) add(process.transition.rightCols<1>(), true, &whole);
  FilterState to = predicted_state(before, *keyframe);
  to.nav = whole.nav;
  to.vehicle = whole.vehicle;
  const ProcessMatrix& F = process.transition;
  if (link.informed) take_information(process, before.active, &link);
  for (Index i = 0; i < keyframe->active.core_size(); ++i) {
    const int row = keyframe->active.core[static_cast<std::size_t>(i)];
    for (Index j = 0; j < before.active.core_size(); ++j) {
      const int column = before.active.core[static_cast<std::size_t>(j)];
      if (is_of_motion(row) && is_of_motion(column)) link.F(i, j) = F(row, column);
    }
  }
  link.from = before.state;
  link.to = to;
  ++relinked_;
}

}  // namespace leonav
