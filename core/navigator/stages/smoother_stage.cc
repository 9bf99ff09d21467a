#include "core/navigator/stages/smoother_stage.h"

#include <memory>

#include "core/filter/state/covariance_blocks.h"
#include "core/navigator/interface/solution_conversion.h"
#include "core/smoother/ceres/ceres_solver.h"

namespace leonav {
namespace {

Solution solution_of(const Anchor& anchor, Source source) {
  Solution solution;
  const PvaCovariance covariance = anchor.covariance.topLeftCorner<9, 9>();
  fill_solution(at_stamp(anchor.state, anchor.time_offset_s), covariance, anchor.has_attitude,
                &solution);
  set_levels(anchor.levels.at(nominal_error(covariance, solution)), &solution);
  solution.source = source;
  solution.anchor_epoch = anchor.index;
  return solution;
}

Solution solution_of(const LaggedState& lagged) {
  Solution solution;
  fill_solution(at_stamp(lagged.state, lagged.time_offset_s), lagged.covariance,
                lagged.has_attitude, &solution);
  solution.source = Source::kSmoother;
  solution.anchor_epoch = lagged.index;
  if (!is_finite(solution)) solution.source = Source::kNone;
  return solution;
}

// Returns what takes all steps of a solve at once; nullptr: the smoother's own chain takes them.
std::unique_ptr<WindowSolver> minimizer(const SmootherConfig& config, bool robust) {
  if (config.solver == SmootherSolver::kChain) return nullptr;
  LogCeresOptions options;
  options.threads = 1;  // the order of sums decides bits
  options.library = LogCeresLibrary::kEigen;
  options.max_iterations = config.max_iterations;
  if (robust) options.loss = config.ceres_loss;
  return std::make_unique<CeresSolver>(options);
}

}  // namespace

SmootherStage::SmootherStage(const NavigatorConfig& config, TimedMailbox<SmootherAnchor>* mailbox,
                             OutputSink* sink)
    : mailbox_(mailbox),
      sink_(sink),
      events_(Stage::kSmoother, sink),
      inertial_(config.motion == MotionModel::kInertial),
      integrity_(config.integrity),
      smoother_(config.smoother, config.ekf.robust, config.vehicle.lever_arm_b,
                {config.ekf, config.imu, config.vehicle.motion.constraints},
                minimizer(config.smoother, config.ekf.robust.enabled)) {}

void SmootherStage::process(const KeyframeInput& input, SolveBudget* budget) {
  smoother_.add(input);
  if (inertial_ && !mailbox_->is_open(input.index)) return;
  const SmootherResult result = smoother_.solve(budget);
  const SmootherAnchor update = anchor_of(input, result);
  const bool delivered = !inertial_ || mailbox_->deliver(input.index, update);
  smoother_.commit_or_roll_back(delivered);
  if (delivered) report(input, result, update);
}

// Adds the protection levels for the fault hypotheses of the keyframe. These are the filter's,
// which leave out what is small beside its own sigma: where it has started over and the window has
// not, that sigma is added.
void SmootherStage::add_levels(const KeyframeInput& input, bool filter_is_younger,
                               Anchor* anchor) const {
  const Solution solution = solution_of(*anchor, Source::kSmoother);
  NominalError error = nominal_error(anchor->covariance.topLeftCorner<9, 9>(), solution);
  if (filter_is_younger) {
    const InertialCovariance of_filter = inertial_covariance(input.covariance);
    error.position_covariance_n +=
        nominal_error(of_filter.topLeftCorner<9, 9>(), solution).position_covariance_n;
  }
  const FaultHypotheses& faults = input.fault_hypotheses;
  anchor->levels = LevelGrowth(error, {faults.data(), faults.size()}, integrity_);
}

SmootherAnchor SmootherStage::anchor_of(const KeyframeInput& input,
                                        const SmootherResult& result) const {
  SmootherAnchor update;
  update.due = true;
  update.status = result.status;
  update.iterations = result.iterations;
  update.filter_may_follow = result.filter_may_follow && result.has_attitude;
  update.anchor.index = input.index;
  if (result.status != SmootherStatus::kOk) return update;
  update.anchor.valid = true;
  update.anchor.has_attitude = result.has_attitude;
  update.anchor.state = result.state;
  update.anchor.covariance = result.covariance;
  update.anchor.time_offset_s = result.time_offset_s;
  update.anchor.random_walk = result.random_walk;
  update.anchor.gnss_used = result.used > 0;
  update.anchor.valid = is_finite(solution_of(update.anchor, Source::kSmoother));
  if (update.anchor.valid) add_levels(input, result.filter_is_younger, &update.anchor);
  return update;
}

void SmootherStage::report(const KeyframeInput& input, const SmootherResult& result,
                           const SmootherAnchor& update) {
  if (result.status == SmootherStatus::kSingular || result.status == SmootherStatus::kDiverged)
    events_.emit(EventKind::kSmootherFailed, static_cast<std::uint8_t>(result.status),
                 static_cast<double>(input.index), input.time);
  SmootherReport report;
  report.sequence = next_report_++;
  report.index = input.index;
  report.status = result.status;
  report.iterations = result.iterations;
  report.converged = result.converged;
  report.shortened = result.shortened;
  report.left_to_chain = result.left_to_chain;
  report.keyframes = smoother_.window().size();
  report.used = result.used;
  if (update.anchor.valid) report.solution = solution_of(update.anchor, Source::kSmoother);
  report.solution.time = input.time;
  if (result.lagged.valid) report.lagged = solution_of(result.lagged);
  report.lagged.sequence = report.sequence;
  sink_->on_smoother(report);
  if (inertial_ || !input.valid) return;
  Solution solution = report.solution;
  if (!update.anchor.valid) {
    Anchor filter;
    filter.index = input.index;
    filter.state = input.state.nav;
    filter.covariance = inertial_covariance(input.covariance);
    add_levels(input, false, &filter);
    solution = solution_of(filter, Source::kEkf);
  }
  if (!input.has_gnss) solution.source = Source::kInsOnly;
  publish(solution);
}

void SmootherStage::process_non_keyframe(const Solution& filter, bool due) {
  SmootherAnchor none;
  none.due = due;
  if (inertial_)
    mailbox_->deliver(filter.anchor_epoch, none);
  else if (filter.source != Source::kNone)
    publish(filter);
}

// Publishes a solution; without IMU no other stage does.
void SmootherStage::publish(Solution solution) {
  if (!is_finite(solution)) return;
  source_ = solution.source;
  solution.sequence = next_solution_++;
  sink_->on_solution(solution);
}

}  // namespace leonav
