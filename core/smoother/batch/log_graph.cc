#include "core/smoother/batch/log_graph.h"

#include <algorithm>
#include <cmath>

#include "core/filter/state/ambiguities.h"
#include "core/filter/state/covariance_blocks.h"
#include "core/smoother/internal/definite_inverse.h"
#include "core/smoother/linearization.h"

namespace leonav {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// A first guess of an ambiguity comes from one carrier and the filter's prediction; its variance is
// such that it does not count.
constexpr double kFirstGuessVariance = 1e6;  // m^2
// A larger step of the filter's ambiguity is a new start.
constexpr double kNewStartVariance = 1e3;  // m^2

ActiveStates core_states(const KeyframeInput& input) {
  ActiveStates active;
  active.before_ambiguities = input.state.first_ambiguity();
  for (int i = 0; i < active.before_ambiguities; ++i)
    if (input.covariance(i, i) > 0.0) active.core.push_back(i);
  return active;
}

template <typename Matrix>
MatrixXd selected(const Matrix& matrix, const ActiveStates& rows, const ActiveStates& columns) {
  MatrixXd part(rows.core_size(), columns.core_size());
  for (Index i = 0; i < part.rows(); ++i)
    for (Index j = 0; j < part.cols(); ++j)
      part(i, j) =
          matrix(rows.core[static_cast<std::size_t>(i)], columns.core[static_cast<std::size_t>(j)]);
  return part;
}

// Sets the filter's estimate, which contains the keyframe's measurements. Returns false if its
// covariance is not positive definite.
bool set_prior(const KeyframeInput& input, LogKeyframe* keyframe) {
  const ActiveStates& active = keyframe->active;
  const auto pieces = static_cast<Index>(input.state.ambiguities.size());
  MatrixXd covariance(active.core_size() + pieces, active.core_size() + pieces);
  const auto whole = [&](Index i) {
    return i < active.core_size() ? active.core[static_cast<std::size_t>(i)]
                                  : active.before_ambiguities + i - active.core_size();
  };
  for (Index i = 0; i < covariance.rows(); ++i)
    for (Index j = 0; j < covariance.cols(); ++j)
      covariance(i, j) = input.covariance(whole(i), whole(j));
  if (!invert(covariance, &keyframe->prior_information)) return false;
  keyframe->prior_gradient.setZero(covariance.rows());
  keyframe->prior_at = input.state;
  keyframe->prior_pieces_at.resize(pieces);
  for (Index i = 0; i < pieces; ++i)
    keyframe->prior_pieces_at(i) = input.state.ambiguities[static_cast<std::size_t>(i)].value_m;
  return true;
}

// Returns the ambiguity of the keyframe before that the one in `row` goes on from: its own, or the
// one that its arc was joined to as it began.
int origin_of(const KeyframeInput& input, Index row) {
  const Index first = input.from.first_ambiguity();
  for (std::size_t i = 0; i < input.from.ambiguities.size(); ++i)
    if (input.process.transition(row, first + static_cast<Index>(i)) == 1.0)
      return static_cast<int>(i);
  return kNoAmbiguity;
}

}  // namespace

void LogGraph::add(const KeyframeInput& input) {
  if (!input.valid) return;
  const bool linked = !keyframes_.empty() && !left_out_ && input.follows_previous;
  LogKeyframe keyframe;
  keyframe.index = input.index;
  keyframe.time = input.time;
  keyframe.has_attitude = input.has_attitude;
  keyframe.has_gnss = input.has_gnss;
  keyframe.attitude_replaced = input.attitude_replaced;
  keyframe.active = core_states(input);
  keyframe.state = input.state;
  keyframe.filter_sigma_m = std::sqrt(position_covariance_e(input.covariance).trace());
  keyframe.measured_rate_b = input.measured_rate_b;
  keyframe.acceleration_e = input.acceleration_e;
  keyframe.vertical_antenna_offset_e = input.vertical_antenna_offset_e;
  keyframe.block.assign(input.block.begin(), input.block.end());
  keyframe.block_complete = input.block_complete;
  keyframe.sample_before_block = input.sample_before_block;
  keyframe.instants.assign(input.instants.begin(), input.instants.end());
  if (linked)
    add_process(input, keyframes_.back(), &keyframe);
  else if (!set_prior(input, &keyframe))
    return (void)(left_out_ = true);
  left_out_ = false;
  follow_arcs(input, linked);
  if (linked) add_measurements(input, &keyframe);
  keyframe.pieces.clear();
  for (const auto& [id, arc] : arcs_) keyframe.pieces.push_back(arc.piece);
  std::sort(keyframe.pieces.begin(), keyframe.pieces.end());
  keyframes_.push_back(std::move(keyframe));
}

void LogGraph::add_process(const KeyframeInput& input, const LogKeyframe& before,
                           LogKeyframe* keyframe) {
  LogProcess& process = keyframe->process;
  process.exists = true;
  process.from = input.from;
  process.to = input.prior;
  process.rows = keyframe->active;
  process.columns = before.active;
  process.F = selected(input.process.transition, keyframe->active, before.active);
  process.noise = selected(input.process.noise, keyframe->active, keyframe->active);
  for (const ArcJoin& join : joins_of(input)) {
    const auto arc_of = [&](int i) {
      return arcs_.find(input.from.ambiguities[static_cast<std::size_t>(i)].arc);
    };
    const auto from = arc_of(join.from), to = arc_of(join.to);
    if (from == arcs_.end() || to == arcs_.end()) continue;
    // A piece stands for its arc as it began, so the walk of both since then counts too.
    const double walk = from->second.pending_variance + to->second.pending_variance;
    process.joins.push_back({from->second.piece, to->second.piece,
                             join.difference_m - (to->second.offset_m - from->second.offset_m),
                             join.variance + walk});
  }
  if (!input.process.has_information) return;
  process.information = selected(input.process.information, before.active, before.active);
  process.gradient.resize(before.core_size());
  for (Index i = 0; i < before.core_size(); ++i)
    process.gradient(i) = input.process.gradient(before.active.core[static_cast<std::size_t>(i)]);
}

void LogGraph::follow_arcs(const KeyframeInput& input, bool linked) {
  Arcs followed;
  const Ambiguities& now = input.state.ambiguities;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto row = input.state.first_ambiguity() + static_cast<Index>(i);
    const double variance = linked ? input.process.noise(row, row) : kFirstGuessVariance;
    const int before = linked ? origin_of(input, row) : kNoAmbiguity;
    const auto known =
        before == kNoAmbiguity
            ? arcs_.end()
            : arcs_.find(input.from.ambiguities[static_cast<std::size_t>(before)].arc);
    if (known != arcs_.end() && variance < kNewStartVariance) {
      Arc arc = known->second;
      arc.pending_variance += variance;
      arc.offset_m += input.prior.ambiguities[i].value_m -
                      input.from.ambiguities[static_cast<std::size_t>(before)].value_m;
      followed.emplace(now[i].arc, arc);
      continue;
    }
    AmbiguityPiece piece;
    piece.satellite = now[i].satellite;
    piece.value_m = piece.start_value_m = now[i].value_m;
    piece.step_variance = kFirstGuessVariance;
    followed.emplace(now[i].arc, Arc{static_cast<int>(pieces_.size()), 0.0, 0.0});
    pieces_.push_back(piece);
  }
  arcs_ = std::move(followed);
}

void LogGraph::add_measurements(const KeyframeInput& input, LogKeyframe* keyframe) {
  keyframe->satellites.assign(input.satellites.begin(), input.satellites.end());
  for (const KeyframeMeasurement& given : input.measurements) {
    LogMeasurement measurement;
    measurement.measurement = given.measurement;
    measurement.variance = given.variance;
    measurement.gain_variance = given.gain_variance;
    measurement.factor = given.factor;
    if (given.ambiguity >= 0) {
      const Ambiguity& ambiguity =
          input.state.ambiguities[static_cast<std::size_t>(given.ambiguity)];
      Arc& arc = arcs_.at(ambiguity.arc);
      if (arc.pending_variance > given.variance) {
        AmbiguityPiece next = pieces_[static_cast<std::size_t>(arc.piece)];
        next.previous = arc.piece;
        next.step_variance = arc.pending_variance;
        arc.piece = static_cast<int>(pieces_.size());
        arc.pending_variance = 0.0;
        pieces_.push_back(next);
      }
      measurement.piece = arc.piece;
      measurement.ambiguity_offset_m = arc.offset_m;
    }
    keyframe->measurements.push_back(measurement);
  }
}

AntennaMotion antenna_of(const LogKeyframe& keyframe, const CoreState& state,
                         const Eigen::Vector3d& lever_arm_b) {
  AntennaMotion antenna =
      antenna_motion(state.nav, keyframe.measured_rate_b, lever_arm_b, keyframe.has_attitude,
                     state.vehicle, keyframe.acceleration_e);
  antenna.p_e += keyframe.vertical_antenna_offset_e;
  return antenna;
}

}  // namespace leonav
