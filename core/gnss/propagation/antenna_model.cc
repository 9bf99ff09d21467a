#include "core/gnss/propagation/antenna_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/gnss/signals/band_plan.h"

namespace leonav {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kMaxOffset_m = 10.0;  // the largest known is 4 m
constexpr double kMaxVariation_m = 1.0;

// A position between two grid points: the index of the lower one and the share of the upper one.
struct GridPosition {
  int index = 0;
  double share = 0.0;
};

GridPosition between(double steps, int count) {
  const double clamped = std::clamp(steps, 0.0, static_cast<double>(count - 1));
  const int index = std::min(static_cast<int>(clamped), std::max(count - 2, 0));
  return {index, clamped - index};
}

double along_row(const AntennaGridView& grid, int row, GridPosition position) {
  const auto first = static_cast<std::size_t>(row * grid.angles + position.index);
  const double lower = grid.values[first];
  if (position.share == 0.0) return lower;
  return lower + position.share * (grid.values[first + 1] - lower);
}

bool is_sane_grid(const AntennaGrid& grid) {
  if (grid.angles == 0 || grid.azimuths == 0) {
    return grid.angles == 0 && grid.azimuths == 0 && grid.values.empty();
  }
  if (grid.angles < 0 || grid.azimuths < 0 || grid.azimuths == 2) return false;
  const auto capacity = static_cast<int>(kMaxAntennaValues);
  if (grid.angles > capacity || grid.azimuths > capacity / grid.angles) return false;
  if (grid.values.size() != static_cast<std::size_t>(grid.angles * grid.azimuths)) return false;
  const double last = grid.first_angle + grid.angle_step * (grid.angles - 1);
  const bool step_ok = grid.angles == 1 ? grid.angle_step >= 0.0 : grid.angle_step > 1e-4;
  if (!(grid.first_angle >= 0.0 && step_ok && last < 1.01 * std::numbers::pi)) return false;
  return std::all_of(grid.values.begin(), grid.values.end(),
                     [](float value) { return std::abs(value) <= kMaxVariation_m; });
}

}  // namespace

bool is_sane(const AntennaPattern& pattern) {
  const SatelliteId id = pattern.satellite;
  if (index_of(id.system) >= kSystemCount) return false;
  if (pattern.is_receiver ? id.number != 0 : !is_valid(id)) return false;
  if (!is_band_of(id.system, pattern.band)) return false;
  if (pattern.valid_from.is_set() && pattern.valid_until.is_set() &&
      pattern.valid_until < pattern.valid_from) {
    return false;
  }
  if (!(pattern.offset_m.cwiseAbs().maxCoeff() <= kMaxOffset_m) || !pattern.offset_m.allFinite()) {
    return false;
  }
  return is_sane_grid(pattern.variation);
}

bool is_storable(const AntennaPattern& pattern) {
  const AntennaGrid& grid = pattern.variation;
  return is_sane(pattern) &&
         (pattern.is_receiver || (grid.azimuths <= 1 && grid.values.size() <= kMaxNadirValues));
}

AntennaGridView view(const AntennaGrid& grid) {
  return {grid.first_angle, grid.angle_step, grid.angles, grid.azimuths, grid.values.data()};
}

double variation_m(const AntennaGridView& grid, double angle, double azimuth) {
  if (grid.angles < 1 || grid.azimuths < 1 || !std::isfinite(angle)) return 0.0;
  const double steps = grid.angles > 1 ? (angle - grid.first_angle) / grid.angle_step : 0.0;
  const GridPosition position = between(steps, grid.angles);
  if (grid.azimuths == 1) return along_row(grid, 0, position);
  if (!std::isfinite(azimuth)) return 0.0;
  const double turn = azimuth / kTurn - std::floor(azimuth / kTurn);  // [0, 1]
  const GridPosition row = between(turn * (grid.azimuths - 1), grid.azimuths);
  const double lower = along_row(grid, row.index, position);
  return lower + row.share * (along_row(grid, row.index + 1, position) - lower);
}

double satellite_antenna_range_m(const Eigen::Vector3d& offset_m, const AntennaGridView& variation,
                                 const Eigen::Vector3d& p_sat_e, const Eigen::Matrix3d& C_es,
                                 const Eigen::Vector3d& p_a_e) {
  const Eigen::Vector3d path = p_a_e - p_sat_e;
  const double range = path.norm();
  if (!(range > 0.0)) return 0.0;
  const Eigen::Vector3d offset = C_es * offset_m;
  // This is |path - offset| - |path| without the cancellation of two ranges of 2e7 m.
  const double shifted = (path - offset).norm();
  const double difference = (offset.squaredNorm() - 2.0 * path.dot(offset)) / (shifted + range);
  const Eigen::Vector3d u_s = C_es.transpose() * path / range;
  const double nadir = std::atan2(std::hypot(u_s.x(), u_s.y()), u_s.z());
  return difference + variation_m(variation, nadir, std::atan2(u_s.x(), u_s.y()));
}

double receiver_antenna_range_m(const Eigen::Vector3d& offset_m, const AntennaGridView& variation,
                                const Eigen::Vector3d& u_r) {
  const Eigen::Vector3d north_east_up(u_r.x(), u_r.y(), -u_r.z());
  const double zenith = std::atan2(std::hypot(u_r.x(), u_r.y()), -u_r.z());
  return -offset_m.dot(north_east_up) +
         variation_m(variation, zenith, std::atan2(u_r.y(), u_r.x()));
}

}  // namespace leonav
