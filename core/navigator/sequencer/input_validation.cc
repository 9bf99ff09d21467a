#include "core/navigator/sequencer/input_validation.h"

#include <array>
#include <cmath>

namespace leonav {

bool is_plausible(GpsTime time) {
  constexpr std::int64_t k120YearsNs = 3'786'912'000LL * kNanosecondsPerSecond;
  return time.nanoseconds() > 0 && time.nanoseconds() < k120YearsNs;
}

InputFault check(const ImuSample& sample, const ImuLimits& limits) {
  if (!sample.delta_theta_b.allFinite() || !sample.delta_velocity_b.allFinite()) {
    return InputFault::kNotFinite;
  }
  if (!is_plausible(sample.time) || sample.interval_ns <= 0 ||
      sample.interval_ns > limits.interval_ns) {
    return InputFault::kOutOfRange;
  }
  // Because of gravity, Earth rotation and noise, all six are zero only if the sensor is dead.
  if (sample.delta_theta_b.isZero(0.0) && sample.delta_velocity_b.isZero(0.0))
    return InputFault::kNotSane;
  const double dt = sample.interval_s();
  const bool in_range = sample.delta_theta_b.cwiseAbs().maxCoeff() <= limits.rotation_rate * dt &&
                        sample.delta_velocity_b.cwiseAbs().maxCoeff() <= limits.specific_force * dt;
  return in_range ? InputFault::kNone : InputFault::kOutOfRange;
}

InputFault check(const OdometerIncrement& increment, double speed, std::int64_t interval_ns) {
  if (!std::isfinite(increment.distance_m)) return InputFault::kNotFinite;
  if (!is_plausible(increment.time) || increment.interval_ns <= 0 ||
      increment.interval_ns > interval_ns ||
      (!increment.sign_known && increment.distance_m < 0.0)) {
    return InputFault::kOutOfRange;
  }
  const bool in_range = std::abs(increment.distance_m) <= speed * increment.interval_s();
  return in_range ? InputFault::kNone : InputFault::kOutOfRange;
}

InputFault check(const PreciseState& state) {
  const bool clock_only = state.is_clock_only() && std::isfinite(state.clock_s);
  if (!(state.p_e.allFinite() || clock_only) || std::isinf(state.clock_s)) {
    return InputFault::kNotFinite;
  }
  if (!is_valid(state.satellite) || !is_plausible(state.time)) return InputFault::kOutOfRange;
  // The range is from the ground to beyond the geosynchronous orbits; satellite clocks are off by
  // less than a second.
  const double radius = state.p_e.norm();
  const bool in_range =
      (clock_only || (radius > 6.3e6 && radius < 1e8)) && !(std::abs(state.clock_s) > 1.0);
  return in_range ? InputFault::kNone : InputFault::kOutOfRange;
}

InputFault check(const CorrectedState& state) {
  const bool is_finite = state.p_e.allFinite() && state.v_e.allFinite() &&
                         std::isfinite(state.clock_s) && std::isfinite(state.clock_drift) &&
                         std::isfinite(state.sigma_m);
  if (!is_finite) return InputFault::kNotFinite;
  const bool in_time = is_plausible(state.time) && is_plausible(state.corrected_at) &&
                       is_plausible(state.orbit_corrected_at);
  return in_time && is_sane(state) ? InputFault::kNone : InputFault::kOutOfRange;
}

InputFault check(const SignalBias& bias) {
  if (!std::isfinite(bias.bias_m)) return InputFault::kNotFinite;
  const auto is_plausible_or_unset = [](GpsTime t) { return !t.is_set() || is_plausible(t); };
  if (!is_plausible(bias.time) || !is_sane(bias) || !is_plausible_or_unset(bias.valid_from) ||
      !is_plausible_or_unset(bias.valid_until))
    return InputFault::kOutOfRange;
  return InputFault::kNone;
}

InputFault check(const SignalObservation& observation) {
  // The limits are wide: a receiver's clock may be off by a second, a carrier count may start at
  // any number, and the Doppler of a low orbit in the Ku band is 0.3 MHz. NaN means "not measured"
  // and passes.
  constexpr double kMaxCode = 1e9, kMaxCarrier = 1e11, kMaxDoppler = 1e6, kMaxCn0 = 100.0;
  for (const double value :
       {observation.pseudorange_m, observation.carrier_cycles, observation.doppler_hz,
        observation.cn0_dbhz, observation.lock_time_s}) {
    if (std::isinf(value)) return InputFault::kNotFinite;
  }
  const bool absurd = std::abs(observation.pseudorange_m) >= kMaxCode ||
                      std::abs(observation.carrier_cycles) >= kMaxCarrier ||
                      std::abs(observation.doppler_hz) >= kMaxDoppler ||
                      observation.cn0_dbhz < 0.0 || observation.cn0_dbhz > kMaxCn0;
  return absurd ? InputFault::kNotSane : InputFault::kNone;
}

InputFault check(const KlobucharModel& model) {
  // The largest values of the broadcast format, eight bits each (IS-GPS-200 table 20-X).
  constexpr std::array<double, 4> kMaxAlpha = {0x1p-23, 0x1p-20, 0x1p-17, 0x1p-17};
  constexpr std::array<double, 4> kMaxBeta = {0x1p18, 0x1p21, 0x1p23, 0x1p23};
  bool in_range = true;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!std::isfinite(model.alpha[i]) || !std::isfinite(model.beta[i]))
      return InputFault::kNotFinite;
    in_range = in_range && std::abs(model.alpha[i]) <= kMaxAlpha[i] &&
               std::abs(model.beta[i]) <= kMaxBeta[i];
  }
  return in_range ? InputFault::kNone : InputFault::kOutOfRange;
}

InputFault check(const AntennaPattern& pattern) {
  const bool times = (!pattern.valid_from.is_set() || is_plausible(pattern.valid_from)) &&
                     (!pattern.valid_until.is_set() || is_plausible(pattern.valid_until));
  if (!times) return InputFault::kOutOfRange;
  return is_storable(pattern) ? InputFault::kNone : InputFault::kNotSane;
}

InputFault check(const Command& command) {
  if (command.kind != CommandKind::kRestart && command.kind != CommandKind::kSetHeading) {
    return InputFault::kOutOfRange;
  }
  if (!std::isfinite(command.value) || !std::isfinite(command.sigma)) {
    return InputFault::kNotFinite;
  }
  const bool heading = command.kind == CommandKind::kSetHeading;
  if (heading && (std::abs(command.value) > 7.0 || command.sigma <= 0.0)) {
    return InputFault::kOutOfRange;
  }
  return InputFault::kNone;
}

InputFault check(const Calibration& calibration) {
  constexpr double kMaxAngle = 6.3, kMaxAccelBias = 100.0, kMaxScale = 0.5;  // rad, m/s^2, 1
  constexpr double kMaxTravel = 3.2, kMaxOdometer = 1.0, kMaxArm_m = 1000.0, kMaxOffset_s = 10.0;
  constexpr std::array<double, ekf_index::kMaxVehicle> kMaxConstants = {
      kMaxTravel, kMaxTravel, kMaxOdometer, kMaxArm_m, kMaxArm_m, kMaxArm_m, kMaxOffset_s};
  bool finite = calibration.mounting_rpy.allFinite();
  bool in_range = calibration.mounting_rpy.cwiseAbs().maxCoeff() <= kMaxAngle;
  const auto add = [&](double value, double sigma, double limit) {
    finite = finite && std::isfinite(value) && std::isfinite(sigma);
    in_range = in_range && std::abs(value) <= limit && sigma >= 0.0 && sigma <= limit;
  };
  for (int i = 0; i < 3; ++i) {
    add(calibration.accel_bias_b[i], calibration.accel_bias_sigma[i], kMaxAccelBias);
    add(calibration.gyro_scale[i], calibration.gyro_scale_sigma[i], kMaxScale);
    add(calibration.accel_scale[i], calibration.accel_scale_sigma[i], kMaxScale);
  }
  for (std::size_t i = 0; i < kMaxConstants.size(); ++i)
    add(calibration.constants[i], calibration.constant_sigmas[i], kMaxConstants[i]);
  if (!finite) return InputFault::kNotFinite;
  return in_range ? InputFault::kNone : InputFault::kOutOfRange;
}

InputFault check(const Checkpoint& checkpoint) {
  if (checkpoint.calibration) {
    const InputFault fault = check(*checkpoint.calibration);
    if (fault != InputFault::kNone) return fault;
  }
  const bool finite =
      checkpoint.antenna_p_e.allFinite() && checkpoint.gyro_bias_b.allFinite() &&
      std::isfinite(checkpoint.antenna_sigma) && std::isfinite(checkpoint.heading) &&
      std::isfinite(checkpoint.heading_sigma) && std::isfinite(checkpoint.gyro_bias_sigma) &&
      std::isfinite(checkpoint.code_sigma_factor) && std::isfinite(checkpoint.doppler_sigma_factor);
  if (!finite) return InputFault::kNotFinite;
  // From the polar radius minus the deepest valley to the equatorial radius plus the highest
  // flight.
  constexpr double kMinRadius_m = 6.35e6, kMaxRadius_m = 6.43e6, kMaxSigma_m = 1e5;
  constexpr double kMaxHeading = 6.3, kMaxBias = 1.0;  // rad, rad/s
  constexpr double kMaxFactor = 100.0;
  const auto is_factor = [](double factor) {
    return factor == 0.0 || (factor >= 1.0 && factor <= kMaxFactor);
  };
  const double radius_m = checkpoint.antenna_p_e.norm();
  const bool in_range =
      is_plausible(checkpoint.time) && radius_m > kMinRadius_m && radius_m < kMaxRadius_m &&
      checkpoint.antenna_sigma > 0.0 && checkpoint.antenna_sigma < kMaxSigma_m &&
      std::abs(checkpoint.heading) <= kMaxHeading && checkpoint.heading_sigma > 0.0 &&
      checkpoint.heading_sigma <= kMaxCheckpointHeadingSigma &&
      checkpoint.gyro_bias_b.cwiseAbs().maxCoeff() <= kMaxBias &&
      checkpoint.gyro_bias_sigma > 0.0 && checkpoint.gyro_bias_sigma <= kMaxBias &&
      is_factor(checkpoint.code_sigma_factor) && is_factor(checkpoint.doppler_sigma_factor);
  return in_range ? InputFault::kNone : InputFault::kOutOfRange;
}

std::size_t copy_valid_observations(const RawEpoch& from, RawEpoch* to) {
  to->time = from.time;
  to->observations.clear();
  for (const SignalObservation& observation : from.observations) {
    if (is_valid(observation.satellite) && observation.code.is_set()) {
      to->observations.push_back(observation);
    }
  }
  const auto key = [](const SignalObservation& o) { return std::pair(o.satellite, o.code); };
  auto& kept = to->observations;
  std::sort(kept.begin(), kept.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  kept.erase(std::unique(kept.begin(), kept.end(),
                         [&](const auto& a, const auto& b) { return key(a) == key(b); }),
             kept.end());
  return from.observations.size() - kept.size();
}

}  // namespace leonav
