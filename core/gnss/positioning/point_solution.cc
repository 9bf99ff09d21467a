#include "core/gnss/positioning/point_solution.h"

#include <cmath>
#include <limits>

#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/dop.h"
#include "core/gnss/positioning/internal/point_fit.h"
#include "core/gnss/preprocessing/preprocess.h"

namespace leonav {
namespace {

constexpr int kMaxPasses = 5;
constexpr double kConvergence_m = 10.0;  // m; nearer, elevation and delays no longer change
constexpr double kMinHeight = -2.0e4;    // m; outside, the fit found another crossing of the ranges
constexpr double kMaxHeight = 1.0e6;

PointStatus status_of(FitStatus status) {
  switch (status) {
    case FitStatus::kOk:
      return PointStatus::kOk;
    case FitStatus::kTooFewRows:
      return PointStatus::kTooFewSatellites;
    case FitStatus::kSingular:
      return PointStatus::kSingularGeometry;
    case FitStatus::kNotConverged:
      return PointStatus::kNotConverged;
    case FitStatus::kFaulty:
      return PointStatus::kFaulty;
  }
  return PointStatus::kNotConverged;
}

bool near_earth(const Eigen::Vector3d& p_e) {
  const double height = to_geodetic(p_e).height;
  return p_e.allFinite() && height > kMinHeight && height < kMaxHeight;
}

// Returns whether the fit gives a position; a suspect fit still does, as the start of the next
// pass.
bool gives_position(const PositionFit& position) {
  const FitStatus status = position.fit.status;
  return (status == FitStatus::kOk || status == FitStatus::kFaulty) &&
         near_earth(position.state.head<3>());
}

struct Problem {
  const RawEpoch& raw;
  const EphemerisStore& ephemeris_store;
  const GnssConfig& config;
  const RobustConfig& robust;
  ReceiverCodeBiases* biases;
  std::span<const SatelliteId> faulty;
  const SignalBiasStore* signal_biases;
};

PreprocessAids aids_of(const Problem& problem) {
  PreprocessAids aids;
  aids.biases = problem.biases;
  aids.signal_biases = problem.signal_biases;
  aids.caps = false;
  aids.faulty = problem.faulty;
  return aids;
}

// Solves a first position without any assumption: no mask and no atmosphere.
bool solve_cold_start(const Problem& problem, MeasurementEpoch* epoch, PositionFit* position) {
  preprocess(problem.raw, problem.ephemeris_store, problem.config, Eigen::Vector3d::Zero(), epoch,
             aids_of(problem));
  fit_position(*epoch, problem.robust, surface_below(*epoch), position);
  if (gives_position(*position)) return true;
  if (position->fit.status == FitStatus::kTooFewRows) return false;
  fit_position(*epoch, problem.robust, Eigen::Vector3d::Zero(), position);
  return gives_position(*position);
}

// Fits and preprocesses again until the delays were computed at the position of the solution.
bool solve_from(const Problem& problem, Eigen::Vector3d p_e, MeasurementEpoch* epoch,
                PositionFit* position) {
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    preprocess(problem.raw, problem.ephemeris_store, problem.config, p_e, epoch, aids_of(problem));
    fit_position(*epoch, problem.robust, p_e, position);
    if (!gives_position(*position)) return false;
    const double moved = (position->state.head<3>() - p_e).norm();
    p_e = position->state.head<3>();
    if (moved < kConvergence_m) return true;
  }
  position->fit.status = FitStatus::kNotConverged;
  return false;
}

Reason reason_of(const FitRow& row) {
  if (row.excluded) return Reason::kOutlier;
  if (row.single_in_group)
    return Reason::kNotSolved;  // its factor is meaningless: its clock was not fitted
  if (row.factor <= 0.0) return Reason::kOutlier;
  return row.factor < 1.0 ? Reason::kDownweighted : Reason::kUsed;
}

void write_reasons(const FitRows& rows, MeasurementEpoch* epoch) {
  for (const FitRow& row : rows) epoch->measurements[row.source].reason = reason_of(row);
}

void mark_not_solved(MeasurementEpoch* epoch, Observable observable) {
  for (Measurement& measurement : epoch->measurements) {
    if (measurement.observable == observable) measurement.reason = Reason::kNotSolved;
  }
}

// A satellite has the reason of its best code.
int summarize_satellites(MeasurementEpoch* epoch) {
  std::array<bool, kMaxSatellites> used{};
  for (const Measurement& code : epoch->measurements) {
    if (code.observable != Observable::kCode) continue;
    if (is_used(code.reason)) used[code.satellite_index] = true;
  }
  int count = 0;
  for (const Measurement& code : epoch->measurements) {
    if (code.observable != Observable::kCode) continue;
    SatelliteInView& satellite = epoch->satellites[code.satellite_index];
    if (!used[code.satellite_index]) satellite.reason = code.reason;
  }
  for (const bool one : used) count += one ? 1 : 0;
  return count;
}

void take_position(const PositionFit& position, MeasurementEpoch* epoch, PointSolution* solution) {
  write_reasons(position.rows, epoch);
  solution->p_e = position.state.head<3>();
  solution->covariance_p_e = position.fit.covariance.topLeftCorner<3, 3>();
  double sum = 0.0;
  int rows_used = 0;
  for (const FitRow& row : position.rows) {
    if (!is_used(reason_of(row))) continue;
    solution->clock_m[static_cast<std::size_t>(row.group)] = position.state(3 + row.group);
    sum += row.residual * row.residual;
    ++rows_used;
  }
  solution->residual_rms_m = std::sqrt(sum / rows_used);
  solution->satellites = summarize_satellites(epoch);
  solution->pdop = dilution_of_precision(*epoch, solution->p_e).pdop;
}

void add_velocity(const Problem& problem, MeasurementEpoch* epoch, PointSolution* solution) {
  VelocityFit velocity;
  fit_velocity(*epoch, problem.robust, solution->p_e, &velocity);
  if (velocity.fit.status != FitStatus::kOk) {
    mark_not_solved(epoch, Observable::kDoppler);
    return;
  }
  write_reasons(velocity.rows, epoch);
  solution->has_velocity = true;
  solution->v_e = velocity.state.head<3>();
  solution->covariance_v_e = velocity.fit.covariance.topLeftCorner<3, 3>();
  for (const FitRow& row : velocity.rows) {
    if (!is_used(reason_of(row))) continue;
    const std::size_t measured = epoch->measurements[row.source].satellite_index;
    solution->clock_drift_m_s[index_of(epoch->satellites[measured].satellite.system)] =
        velocity.state(3);
  }
}

}  // namespace

int redundancy(const PointSolution& point) {
  int clocks = 0;
  for (const double clock_m : point.clock_m) clocks += std::isfinite(clock_m) ? 1 : 0;
  return point.satellites - 3 - clocks;
}

PointSolution solve_point(const RawEpoch& raw, const EphemerisStore& ephemeris_store,
                          const GnssConfig& config, const RobustConfig& robust,
                          const Eigen::Vector3d& approximate_p_e, MeasurementEpoch* epoch,
                          ReceiverCodeBiases* biases, std::span<const SatelliteId> faulty,
                          const SignalBiasStore* signal_biases) {
  ReceiverCodeBiases of_this_epoch;
  const Problem problem{
      raw,    ephemeris_store, config, robust, biases != nullptr ? biases : &of_this_epoch,
      faulty, signal_biases};
  PointSolution solution;
  solution.clock_m.fill(std::numeric_limits<double>::quiet_NaN());
  solution.clock_drift_m_s.fill(std::numeric_limits<double>::quiet_NaN());

  PositionFit position;
  const bool trusts_start = approximate_p_e.allFinite() && near_earth(approximate_p_e);
  bool solved = trusts_start && solve_from(problem, approximate_p_e, epoch, &position);
  if (!solved || position.fit.status != FitStatus::kOk) {
    // A wrong start excludes satellites below a wrong horizon, so the solution is repeated without
    // it.
    solved = solve_cold_start(problem, epoch, &position) &&
             solve_from(problem, position.state.head<3>(), epoch, &position);
  }
  solution.status = status_of(position.fit.status);
  if (!solved && solution.status == PointStatus::kOk) solution.status = PointStatus::kNotConverged;
  if (solution.status != PointStatus::kOk) {
    mark_not_solved(epoch, Observable::kCode);
    mark_not_solved(epoch, Observable::kDoppler);
    summarize_satellites(epoch);
    return solution;
  }
  take_position(position, epoch, &solution);
  add_velocity(problem, epoch, &solution);
  return solution;
}

}  // namespace leonav
