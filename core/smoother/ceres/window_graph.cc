#include "core/smoother/ceres/window_graph.h"

#include <vector>

namespace leonav {
namespace {

using Eigen::Index;

constexpr double kNoStep = 1e30;  // m^2

ActiveStates core_of(const ActiveStates& active) {
  ActiveStates core = active;
  core.ambiguities = 0;
  return core;
}

// Returns the ambiguity of the keyframe before that ambiguity `i` goes on from; -1: none.
Index origin_of(const ProcessFactor& process_factor, Index core_before, Index row) {
  for (Index j = core_before; j < process_factor.F.cols(); ++j)
    if (process_factor.F(row, j) == 1.0) return j - core_before;
  return -1;
}

// Returns whether the noise of every ambiguity is its own.
bool is_separable(const ProcessFactor& process_factor, Index core) {
  const EkfCovariance& noise = process_factor.noise;
  for (Index i = core; i < noise.cols(); ++i)
    if (noise.col(i).cwiseAbs().sum() != noise(i, i)) return false;
  return true;
}

void copy_process(const Keyframe& before, const Keyframe& keyframe, LogProcess* process) {
  const ProcessFactor& factor = keyframe.process_factor;
  const Index core = keyframe.active.core_size(), core_before = before.active.core_size();
  process->exists = true;
  process->from = factor.from;
  process->to = factor.to;
  process->rows = core_of(keyframe.active);
  process->columns = core_of(before.active);
  process->F = factor.F.topLeftCorner(core, core_before);
  process->noise = factor.noise.topLeftCorner(core, core);
  if (!factor.has_information) return;
  process->information = factor.information;
  process->gradient = factor.gradient.head(core_before);
}

// An ambiguity of a keyframe: its value is the piece's plus the steps that the filter has taken it
// by since the window's first keyframe.
struct Followed {
  int piece = -1;
  double offset_m = 0.0;
};

// `before`: the ambiguities of the keyframe before.
void copy_joins(const ArcJoins& joins, const std::vector<Followed>& before, LogProcess* process) {
  for (const ArcJoin& join : joins) {
    const Followed& from = before[static_cast<std::size_t>(join.from)];
    const Followed& to = before[static_cast<std::size_t>(join.to)];
    process->joins.push_back(
        {from.piece, to.piece, join.difference_m - (to.offset_m - from.offset_m), join.variance});
  }
}

// Follows the keyframe's ambiguities. `last` is the keyframe before, with its `before`.
std::vector<Followed> follow(const Keyframe* last, const Keyframe& keyframe,
                             const std::vector<Followed>& before, LogGraph* graph) {
  const ProcessFactor& factor = keyframe.process_factor;
  const Index core = keyframe.active.core_size();
  std::vector<Followed> followed;
  for (std::size_t i = 0; i < keyframe.state.ambiguities.size(); ++i) {
    const Ambiguity& ambiguity = keyframe.state.ambiguities[i];
    AmbiguityPiece piece;
    piece.satellite = ambiguity.satellite;
    piece.value_m = piece.start_value_m = ambiguity.value_m;
    piece.step_variance = kNoStep;  // the prior knows of it
    Followed one;
    if (last != nullptr) {
      const Index row = core + static_cast<Index>(i);
      const Index from = origin_of(factor, last->active.core_size(), row);
      const double to_m = factor.to.ambiguities[i].value_m;
      piece.start_value_m = to_m;
      piece.step_variance = factor.noise(row, row);
      if (from >= 0) {
        const auto of = static_cast<std::size_t>(from);
        one.offset_m = before[of].offset_m + to_m - factor.from.ambiguities[of].value_m;
        one.piece = before[of].piece;
        piece.previous = one.piece;
        piece.value_m -= one.offset_m;
      }
      if (from >= 0 && !(piece.step_variance > 0.0)) {
        followed.push_back(one);
        continue;
      }
    }
    one.piece = graph->add(piece);
    followed.push_back(one);
  }
  return followed;
}

void copy_measurements(const Keyframe& keyframe, const std::vector<Followed>& followed,
                       LogKeyframe* of) {
  of->satellites.assign(keyframe.satellites.begin(), keyframe.satellites.end());
  for (const KeyframeMeasurement& given : keyframe.measurements) {
    LogMeasurement measurement;
    measurement.measurement = given.measurement;
    measurement.variance = given.variance;
    measurement.gain_variance = given.gain_variance;
    measurement.factor = given.factor;
    if (given.ambiguity >= 0) {
      const Followed& ambiguity = followed[static_cast<std::size_t>(given.ambiguity)];
      measurement.piece = ambiguity.piece;
      measurement.ambiguity_offset_m = ambiguity.offset_m;
    }
    of->measurements.push_back(measurement);
  }
}

void copy_prior(const Window& window, LogKeyframe* of) {
  const WindowPrior& prior = window.prior();
  of->prior_information = prior.information;
  of->prior_gradient = prior.gradient;
  of->prior_at = prior.at;
  of->prior_pieces_at.resize(static_cast<Index>(prior.at.ambiguities.size()));
  for (std::size_t i = 0; i < prior.at.ambiguities.size(); ++i)
    of->prior_pieces_at(static_cast<Index>(i)) = prior.at.ambiguities[i].value_m;
}

}  // namespace

std::optional<WindowGraph> graph_of(const Window& window, const Eigen::Vector3d& lever_arm_b) {
  WindowGraph result{LogGraph(lever_arm_b), {}};
  LogGraph& graph = result.graph;
  std::vector<Followed> before;
  for (int k = 0; k < window.size(); ++k) {
    const Keyframe& keyframe = window.at(k);
    const Keyframe* last = k > 0 ? &window.at(k - 1) : nullptr;
    if (k > 0 && !is_separable(keyframe.process_factor, keyframe.active.core_size()))
      return std::nullopt;
    LogKeyframe of;
    of.index = keyframe.index;
    of.time = keyframe.time;
    of.has_attitude = keyframe.has_attitude;
    of.active = core_of(keyframe.active);
    of.state = keyframe.state;
    of.measured_rate_b = keyframe.measured_rate_b;
    of.acceleration_e = keyframe.acceleration_e;
    of.vertical_antenna_offset_e = keyframe.vertical_antenna_offset_e;
    if (k > 0) {
      copy_process(*last, keyframe, &of.process);
      copy_joins(keyframe.process_factor.joins, before, &of.process);
    }
    before = follow(last, keyframe, before, &graph);
    result.ambiguities_m.emplace_back();
    for (const Followed& ambiguity : before) {
      of.pieces.push_back(ambiguity.piece);
      result.ambiguities_m.back().push_back(graph.piece(ambiguity.piece).value_m +
                                            ambiguity.offset_m);
    }
    copy_measurements(keyframe, before, &of);
    if (k == 0) copy_prior(window, &of);
    graph.add(std::move(of));
  }
  return result;
}

}  // namespace leonav
