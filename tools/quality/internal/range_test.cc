#include "tools/quality/internal/range_test.h"

#include <cmath>

#include "core/gnss/measurement/range_model.h"
#include "core/gnss/measurement/weighting.h"

namespace leonav {
namespace {

// Noise of a satellite's clock between two epochs beyond its product, m per root of second: caesium
// and old rubidium clocks.
constexpr double kClockWalk = 0.0015;

// Below this elevation, errors of the troposphere model change by centimetres between two epochs.
constexpr double kMinElevation = 0.17453292519943295;  // rad (10 degrees)

struct Combined {
  double carrier_m = 0.0;
  double noise = 1.0;  // of one carrier
  bool single = false;
};

Combined combine(const BandPlan& bands, const CarrierInput& input, const CarrierStatus& status) {
  if (!std::isfinite(status.second_m)) return {status.first_m, 1.0, true};
  const System system = input.first->satellite.system;
  const IonosphereFree pair = ionosphere_free(bands.frequency_hz(system, input.first->code.band),
                                              bands.frequency_hz(system, input.second->code.band));
  return {pair.gamma1 * status.first_m + pair.gamma2 * status.second_m,
          combined_sigma(pair, 1.0, 1.0), false};
}

double residual_m(const SatelliteInView& satellite, const Combined& combined, const Sky& sky) {
  return combined.carrier_m - predict_range(satellite, sky.antenna_p_e()).range_m +
         satellite.clock_m - satellite.troposphere_m;
}

}  // namespace

std::vector<RangeChangeRowResult> RangeTest::test(const std::vector<CarrierInput>& inputs,
                                                  const ArcEpoch& arcs, const Sky& sky) {
  std::vector<RangeChangeRowResult> results(inputs.size());
  if (!sky.is_solved() || !last_time_.is_set()) return results;
  const double interval_s = seconds_between(sky.epoch().time, last_time_);
  std::vector<RangeChangeRow> rows;
  std::vector<std::size_t> owners;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const CarrierStatus& status = arcs.satellites[i];
    if (status.arc == 0 || status.started) continue;
    const SatelliteId id = inputs[i].first->satellite;
    const auto found = before_.find(id);
    const SatelliteInView* satellite = sky.find(id);
    if (found == before_.end() || satellite == nullptr || satellite->source == OrbitSource::kNone ||
        satellite->elevation < kMinElevation)
      continue;
    const Before& before = found->second;
    if (before.time != last_time_ || before.arc != status.arc ||
        before.source != satellite->source || before.issue != satellite->orbit_issue)
      continue;
    const Combined now = combine(bands_, inputs[i], status);
    RangeChangeRow row;
    row.direction = predict_range(*satellite, sky.antenna_p_e()).d_range_d_p.transpose();
    row.direction_change = row.direction - before.direction;
    row.residual_m = residual_m(*satellite, now, sky) - before.residual_m;
    const double factor = elevation_factor(satellite->elevation);
    const double noise = std::sqrt(2.0) * config_.carrier_sigma_m * factor * now.noise;
    const double ionosphere = now.single ? config_.ionosphere_rate_m_s * factor * interval_s : 0.0;
    row.sigma_m =
        std::sqrt(noise * noise + ionosphere * ionosphere + kClockWalk * kClockWalk * interval_s +
                  2.0 * satellite->orbit_sigma_change_m * satellite->orbit_sigma_change_m);
    row.system_time = static_cast<int>(index_of(id.system));
    rows.push_back(row);
    owners.push_back(i);
  }
  RangeChangePrior prior;
  prior.position_covariance =
      last_position_sigma_m_ * last_position_sigma_m_ * Eigen::Matrix3d::Identity();
  const RangeChangeResult result = range_change(rows, prior, config_);
  for (std::size_t i = 0; i < owners.size(); ++i) results[owners[i]] = result.rows[i];
  return results;
}

void RangeTest::remember(const std::vector<CarrierInput>& inputs, const ArcEpoch& arcs,
                         const Sky& sky) {
  last_time_ = {};
  if (!sky.is_solved()) return;
  last_time_ = sky.epoch().time;
  last_position_sigma_m_ = sky.position_sigma_m();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const CarrierStatus& status = arcs.satellites[i];
    const SatelliteInView* satellite = sky.find(inputs[i].first->satellite);
    if (status.arc == 0 || satellite == nullptr || satellite->source == OrbitSource::kNone)
      continue;
    before_[satellite->satellite] = {
        last_time_,
        status.arc,
        residual_m(*satellite, combine(bands_, inputs[i], status), sky),
        predict_range(*satellite, sky.antenna_p_e()).d_range_d_p.transpose(),
        satellite->source,
        satellite->orbit_issue};
  }
}

}  // namespace leonav
