#include "core/smoother/batch/log_processes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kUnknownAttitude = 0.5;  // rad, 1 sigma: only the whole log determines it

// The rotation of an attitude body to ECEF by the Earth's over `seconds`.
Quaterniond earth_rotation(double seconds) {
  return quaternion_from_rotation_vector(Vector3d{0.0, 0.0, -kEarthRotationRate * seconds});
}

Index position_of(const ActiveStates& active, int state) {
  const auto found = std::find(active.core.begin(), active.core.end(), state);
  return found == active.core.end() ? -1 : found - active.core.begin();
}

// Takes where a factor was linearized along when its keyframe gets an attitude: what the estimate
// differs by stays.
void move_along(const CoreState& had, const CoreState& state, CoreState* linearized_at) {
  NavState& nav = linearized_at->nav;
  nav.p_e += state.nav.p_e - had.nav.p_e;
  nav.v_e += state.nav.v_e - had.nav.v_e;
  nav.q_eb = state.nav.q_eb;
  nav.errors = state.nav.errors;
  linearized_at->vehicle = state.vehicle;
}

// Clocks, delays and ionosphere of `from`.
void copy_slow_states(const CoreState& from, CoreState* to) {
  to->clocks = from.clocks;
  to->wet_delay_m = from.wet_delay_m;
  to->carrier_clock_m = from.carrier_clock_m;
  to->ionosphere_m = from.ionosphere_m;
}

}  // namespace

bool LogProcesses::can_integrate(const LogKeyframe& before, const LogKeyframe& keyframe) const {
  const double apart_s = seconds_between(keyframe.time, before.time);
  const ImuSample& sample_before = keyframe.sample_before_block;
  const bool reaches_back = sample_before.interval_ns == 0 || sample_before.time <= before.time;
  return keyframe.block_complete && reaches_back && apart_s > 0.0 && apart_s < kLongestBridge_s;
}

// The rotation of the body over the keyframe's block, in its own axes. It depends on the start by
// the gyros' errors alone.
Quaterniond LogProcesses::body_rotation(const LogKeyframe& keyframe, const NavState& start) {
  CoreState from;
  from.nav = start;
  const NavState& to =
      propagation_(from, keyframe.sample_before_block, keyframe.block, {}, keyframe.time)
          .state()
          .nav;
  const Quaterniond turned = earth_rotation(seconds_between(keyframe.time, start.time));
  return (turned * start.q_eb).conjugate() * to.q_eb;
}

// The filter's position is that of the antenna or, with a vertical arm, of the point below.
void LogProcesses::give_attitude(const LogKeyframe& from, const Quaterniond& q_eb,
                                 const Vector3d& lever_arm_b, LogKeyframe* keyframe,
                                 LogKeyframe* next) const {
  const AntennaMotion antenna = antenna_of(*keyframe, keyframe->state, lever_arm_b);
  const CoreState had_state = keyframe->state;
  const ActiveStates had = keyframe->active;
  NavState& nav = keyframe->state.nav;
  nav.q_eb = q_eb;
  nav.errors = from.state.nav.errors;
  keyframe->state.vehicle = from.state.vehicle;
  keyframe->has_attitude = true;
  keyframe->vertical_antenna_offset_e.setZero();
  const AntennaMotion arm = antenna_of(*keyframe, keyframe->state, lever_arm_b);
  nav.p_e += antenna.p_e - arm.p_e;
  nav.v_e += antenna.v_e - arm.v_e;
  ActiveStates& active = keyframe->active;
  active.core.clear();
  active.before_ambiguities = keyframe->state.size();
  for (int state = 0; state < keyframe->state.size(); ++state) {
    const ActiveStates& model = is_of_motion(state) ? from.active : had;
    if (position_of(model, state) >= 0) active.core.push_back(state);
  }
  if (keyframe->process.exists) move_along(had_state, keyframe->state, &keyframe->process.to);
  if (next != nullptr && next->process.exists)
    move_along(had_state, keyframe->state, &next->process.from);
  if (keyframe->prior_information.size() == 0) return;
  move_along(had_state, keyframe->state, &keyframe->prior_at);
  widen_prior(keyframe, had);
}

// 1 sigma of a state of motion of which nothing but the configuration is known.
double LogProcesses::configured_sigma(int state) const {
  const ImuErrorModel& imu = config_.imu;
  if (state >= kSize) return config_.ekf.vehicle.sigma[static_cast<std::size_t>(state - kSize)];
  if (state >= kAccelScale) return imu.accel_scale.sigma;
  if (state >= kGyroScale) return imu.gyro_scale.sigma;
  if (state >= kAccelBias) return imu.accel_bias.sigma;
  return state >= kGyroBias ? imu.gyro_bias.sigma : kUnknownAttitude;
}

// The states that the keyframe did not have are as uncertain as the configuration says, about its
// values: those of the estimate come from the rest of the log, which must not count twice.
void LogProcesses::widen_prior(LogKeyframe* keyframe, const ActiveStates& had) const {
  const Index core = keyframe->core_size();
  // Where a state or a piece was in the prior; -1: nowhere.
  const auto old_index = [&](Index i) {
    if (i >= core) return had.core_size() + i - core;
    return position_of(had, keyframe->active.core[static_cast<std::size_t>(i)]);
  };
  MatrixXd information = MatrixXd::Zero(keyframe->size(), keyframe->size());
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(keyframe->size());
  for (Index i = 0; i < information.rows(); ++i) {
    const Index before = old_index(i);
    if (before < 0) {
      const int state = keyframe->active.core[static_cast<std::size_t>(i)];
      information(i, i) = 1.0 / square(configured_sigma(state));
      continue;
    }
    gradient(i) = keyframe->prior_gradient(before);
    for (Index j = 0; j < information.cols(); ++j)
      if (old_index(j) >= 0) information(i, j) = keyframe->prior_information(before, old_index(j));
  }
  keyframe->prior_information = information;
  keyframe->prior_gradient = gradient;
  keyframe->prior_at.nav.errors = ImuErrors();
  std::fill(keyframe->prior_at.vehicle.begin(), keyframe->prior_at.vehicle.end(), 0.0);
}

// A factor that cannot be integrated stays the filter's; it knows nothing of the states that its
// keyframes have got since.
void LogProcesses::refit(const LogKeyframe& before, LogKeyframe* keyframe) const {
  LogProcess& process = keyframe->process;
  const ActiveStates& rows = keyframe->active;
  const ActiveStates& columns = before.active;
  if (rows.core == process.rows.core && columns.core == process.columns.core) return;
  MatrixXd F = MatrixXd::Zero(rows.core_size(), columns.core_size());
  MatrixXd noise = MatrixXd::Zero(rows.core_size(), rows.core_size());
  for (Index i = 0; i < rows.core_size(); ++i) {
    const int row = rows.core[static_cast<std::size_t>(i)];
    const Index old_row = position_of(process.rows, row);
    if (old_row < 0) {
      noise(i, i) = square(configured_sigma(row));
      continue;
    }
    for (Index j = 0; j < columns.core_size(); ++j) {
      const int column = columns.core[static_cast<std::size_t>(j)];
      const Index old_column = position_of(process.columns, column);
      if (old_column >= 0) F(i, j) = process.F(old_row, old_column);
    }
    for (Index j = 0; j < rows.core_size(); ++j) {
      const Index other = position_of(process.rows, rows.core[static_cast<std::size_t>(j)]);
      if (other >= 0) noise(i, j) = process.noise(old_row, other);
    }
  }
  process.F = F;
  process.noise = noise;
  process.rows = rows;
  process.columns = columns;
}

// The IMU gives the process of position, velocity, attitude, IMU errors and vehicle constants.
// Clocks and delays keep the process that the factor had. Without one, clocks are unknown, and
// delays are those of the keyframe before with some noise.
void LogProcesses::integrate(LogKeyframe* before, LogKeyframe* keyframe) {
  const StateEstimate& estimate = propagation_(before->state, keyframe->sample_before_block,
                                               keyframe->block, keyframe->instants, keyframe->time);
  const FilterProcess& inertial = estimate.process();
  const LogProcess old = std::move(keyframe->process);
  LogProcess& process = keyframe->process;
  process = LogProcess();
  process.exists = true;
  process.joins = old.joins;
  process.from = before->state;
  process.to = uncorrected_state(estimate);
  process.to.vehicle.resize(keyframe->state.vehicle.size(), 0.0);
  const ActiveStates& rows = keyframe->active;
  const ActiveStates& columns = before->active;
  process.F.setZero(rows.core_size(), columns.core_size());
  process.noise.setZero(rows.core_size(), rows.core_size());
  // The old process may lack the states that a keyframe has got since.
  const auto old_row = [&](int state) {
    return old.exists ? position_of(old.rows, state) : Index(-1);
  };
  copy_slow_states(before->state, &process.to);
  process.to.clocks = keyframe->state.clocks;
  if (old.exists) {
    copy_slow_states(old.to, &process.to);
    EkfCorrection moved = EkfCorrection::Zero(process.to.size());
    const EkfCorrection then = difference(before->state, [&] {
      CoreState from = before->state;
      copy_slow_states(old.from, &from);
      return from;
    }());
    for (const int row : rows.core) {
      if (is_of_motion(row) || old_row(row) < 0) continue;
      for (Index j = 0; j < old.columns.core_size(); ++j) {
        const int column = old.columns.core[static_cast<std::size_t>(j)];
        if (!is_of_motion(column)) moved(row) += old.F(old_row(row), j) * then(column);
      }
    }
    add(moved, true, &process.to);
  }
  for (Index i = 0; i < rows.core_size(); ++i) {
    const int row = rows.core[static_cast<std::size_t>(i)];
    for (Index j = 0; j < columns.core_size(); ++j) {
      const int column = columns.core[static_cast<std::size_t>(j)];
      if (is_of_motion(row) != is_of_motion(column)) continue;
      if (row >= before->state.size()) continue;  // a vehicle constant that begins here
      if (is_of_motion(row)) {
        process.F(i, j) = inertial.transition(row, column);
      } else if (const Index from = old.exists ? position_of(old.columns, column) : -1;
                 from >= 0 && old_row(row) >= 0) {
        process.F(i, j) = old.F(old_row(row), from);
      } else if (!old.exists && row == column && row >= kWetDelay) {
        process.F(i, j) = 1.0;
      }
    }
    for (Index j = 0; j < rows.core_size(); ++j) {
      const int other = rows.core[static_cast<std::size_t>(j)];
      if (is_of_motion(row) != is_of_motion(other)) continue;
      if (row >= before->state.size() || other >= before->state.size())
        process.noise(i, j) = i == j ? square(configured_sigma(row)) : 0.0;
      else if (is_of_motion(row))
        process.noise(i, j) = inertial.noise(row, other);
      else if (old_row(row) >= 0 && old_row(other) >= 0)
        process.noise(i, j) = old.noise(old_row(row), old_row(other));
      else if (i == j)
        process.noise(i, j) = restarted_variance(row);
    }
  }
  process.rows = rows;
  process.columns = columns;
  if (!inertial.has_information) return;
  process.information.resize(columns.core_size(), columns.core_size());
  process.gradient.resize(columns.core_size());
  for (Index i = 0; i < columns.core_size(); ++i) {
    const int row = columns.core[static_cast<std::size_t>(i)];
    process.gradient(i) = inertial.gradient(row);
    for (Index j = 0; j < columns.core_size(); ++j)
      process.information(i, j) =
          inertial.information(row, columns.core[static_cast<std::size_t>(j)]);
  }
}

LogProcesses::Extension LogProcesses::extend(LogGraph* graph) {
  Extension extension;
  std::vector<bool> aligned;  // by the filter
  for (int k = 0; k < graph->size(); ++k) aligned.push_back(graph->at(k).has_attitude);
  for (int k = graph->size() - 1; k > 0; --k) {
    LogKeyframe& keyframe = graph->at(k);
    LogKeyframe& before = graph->at(k - 1);
    if (!keyframe.has_attitude || before.has_attitude || !can_integrate(before, keyframe)) continue;
    NavState start = keyframe.state.nav;
    start.time = before.time;
    const Quaterniond turned = earth_rotation(seconds_between(keyframe.time, before.time));
    const Quaterniond q_eb =
        turned.conjugate() * keyframe.state.nav.q_eb * body_rotation(keyframe, start).conjugate();
    give_attitude(keyframe, q_eb.normalized(), graph->lever_arm_b(), &before, &keyframe);
    ++extension.attitudes;
  }
  for (int k = 1; k < graph->size(); ++k) {
    LogKeyframe& before = graph->at(k - 1);
    LogKeyframe& keyframe = graph->at(k);
    if (!before.has_attitude || !can_integrate(before, keyframe)) {
      if (keyframe.process.exists) refit(before, &keyframe);
      continue;
    }
    if (!keyframe.has_attitude) {
      const Quaterniond turned = earth_rotation(seconds_between(keyframe.time, before.time));
      const Quaterniond q_eb =
          turned * before.state.nav.q_eb * body_rotation(keyframe, before.state.nav);
      give_attitude(before, q_eb.normalized(), graph->lever_arm_b(), &keyframe,
                    k + 1 < graph->size() ? &graph->at(k + 1) : nullptr);
      ++extension.attitudes;
    }
    if (!keyframe.process.exists) {
      if (keyframe.attitude_replaced) continue;  // what came from outside counts, not the IMU
      keyframe.prior_information.resize(0, 0);
      // An alignment is no gap.
      if (aligned[static_cast<std::size_t>(k - 1)]) ++extension.joined;
    }
    integrate(&before, &keyframe);
  }
  return extension;
}

int LogProcesses::reintegrate(LogGraph* graph) {
  int count = 0;
  for (int k = 1; k < graph->size(); ++k) {
    LogKeyframe& before = graph->at(k - 1);
    LogKeyframe& keyframe = graph->at(k);
    if (!before.has_attitude || !keyframe.has_attitude || !keyframe.process.exists ||
        !can_integrate(before, keyframe) || !is_far(before.state, keyframe.process.from))
      continue;
    integrate(&before, &keyframe);
    ++count;
  }
  return count;
}

}  // namespace leonav
