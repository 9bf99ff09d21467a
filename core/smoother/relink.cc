#include "core/smoother/relink.h"

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

bool is_far(const EkfCorrection& moved) {
  return moved.segment<3>(kAttitude).norm() > kFarAttitude ||
         moved.segment<3>(kVelocity).norm() > kFarVelocity ||
         moved.segment<3>(kPosition).norm() > kFarPosition;
}

}  // namespace

Relinker::Relinker(const RelinkConfig& config)
    : propagator_(std::make_unique<Ekf>(propagating(config.ekf), config.imu, config.lever_arm_b)) {}

void Relinker::operator()(const Keyframe& before, Keyframe* keyframe) {
  KeyframeLink& link = keyframe->link;
  if (!keyframe->has_attitude || !keyframe->block_whole) return;
  if (!is_far(difference(before.state, link.from))) return;
  propagator_->place(before.state, true, keyframe->before_block);
  propagator_->predict({keyframe->block.data(), keyframe->block.size()}, keyframe->time);

  FilterState to = predicted_state(before, *keyframe);
  to.nav = propagator_->state();
  const auto F = propagator_->process().transition.topLeftCorner<kInsSize, kInsSize>();
  for (Index i = 0; i < keyframe->active.core_size(); ++i) {
    const int row = keyframe->active.core[static_cast<std::size_t>(i)];
    for (Index j = 0; j < before.active.core_size(); ++j) {
      const int column = before.active.core[static_cast<std::size_t>(j)];
      if (row < kInsSize && column < kInsSize) link.F(i, j) = F(row, column);
    }
  }
  link.from = before.state;
  link.to = to;
  ++relinked_;
}

}  // namespace leonav
