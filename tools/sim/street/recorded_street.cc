#include "tools/sim/street/recorded_street.h"

#include <algorithm>
#include <cmath>

#include "tools/sim/scenario/random_streams.h"
#include "tools/sim/street/street_slips.h"

namespace leonav::sim {
namespace {

constexpr double kRounding_s = 1e-3;   // the receiver's clock against its stamps
constexpr int kCyclesOfNewArc = 1000;  // an arc that begins anew counts from anywhere

}  // namespace

RecordedStreet::RecordedStreet(const StreetErrorsConfig& config, std::uint64_t seed,
                               std::size_t satellite)
    : config_(config), seed_(seed), satellite_(satellite) {}

void RecordedStreet::begin_block(double from_s, double elevation) {
  const ResidualLibrary& library = *config_.library;
  GaussianGenerator random = random_stream(
      seed_, "street block", (static_cast<std::uint64_t>(blocks_) << 16) | satellite_);
  const std::vector<std::size_t>& rows = library.rows_near(elevation);
  const auto drawn = static_cast<std::size_t>(random.uniform() * static_cast<double>(rows.size()));
  block_.first = rows[std::min(drawn, rows.size() - 1)];
  block_.interval_s = library.interval_s(block_.first);
  const auto left = static_cast<double>(library.end_of_piece(block_.first) - block_.first);
  block_.from_s = from_s;
  block_.to_s = from_s + std::min(config_.block_s, left * block_.interval_s);
  ++blocks_;
}

void RecordedStreet::enter(std::size_t row, StreetEffect* effect) {
  const RecordedResidual& now = config_.library->row(row);
  row_ = row;
  GaussianGenerator random =
      random_stream(seed_, "street recorded slip",
                    (static_cast<std::uint64_t>(row) << 36) ^
                        (static_cast<std::uint64_t>(blocks_) << 16) ^ satellite_);
  switch (now.carrier) {
    case RecordedCarrier::kNone:
      ++gaps_;
      break;
    case RecordedCarrier::kBegins:
      for (CycleSlip& slip : effect->slips) {
        slip.cycles += std::ceil(random.uniform() * kCyclesOfNewArc);
        slip.told = true;
      }
      break;
    case RecordedCarrier::kSlips:
      add_random_slip(config_.slips.max_cycles, false, &random, &effect->slips);
      break;
    case RecordedCarrier::kGoesOn:
      break;
  }
}

// Enters the rows up to that one. Those that lie between two epochs of the receiver are not seen,
// but what happened to the carrier in them has happened.
void RecordedStreet::go_to(std::size_t row, StreetEffect* effect) {
  while (row_ < row) enter(row_ + 1, effect);
}

StreetEffect RecordedStreet::at(const SatelliteSight& sight) {
  const double t = sight.t + kRounding_s;
  StreetEffect effect;
  // A satellite that was away for long begins anew.
  const bool was_away = blocks_ == 0 || t > block_.to_s + config_.block_s;
  while (was_away || t >= block_.to_s) {
    begin_block(was_away ? t : block_.to_s, sight.elevation);
    enter(block_.first, &effect);
    if (was_away) break;
  }
  const double passed = std::floor((t - block_.from_s) / block_.interval_s);
  go_to(block_.first + static_cast<std::size_t>(std::max(0.0, passed)), &effect);
  const RecordedResidual& now = config_.library->row(row_);
  effect.possible = now.code_m[0].has_value();
  effect.loss_db = now.cn0_loss_db;
  effect.route = gaps_;
  for (std::size_t s = 0; s < kTrackedSignals; ++s) {
    StreetSignalError& error = effect.signals[s];
    error.code_m = now.code_m[s].value_or(now.code_m[0].value_or(0.0));
    error.code_noise = now.code_m[s] ? 0.0 : 1.0;
    error.doppler_m_s = now.doppler_m_s.value_or(0.0);
    error.doppler_noise = now.doppler_m_s ? 0.0 : 1.0;
    error.carrier_m = now.carrier_m.value_or(0.0);
    error.carrier_noise = now.carrier_m ? 0.0 : 1.0;
  }
  return effect;
}

}  // namespace leonav::sim
