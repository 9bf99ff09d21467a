#include "drivers/lcm/convert.h"

#include <optional>
#include <utility>

#include "core/navigator/sequencer/input_validation.h"

namespace leonav::wire {
namespace {

template <typename T>
std::optional<SatelliteId> satellite_of(const T& message) {
  if (message.system < 0 || message.system >= static_cast<int>(kSystemCount)) return std::nullopt;
  if (message.number <= 0) return std::nullopt;
  const SatelliteId id{static_cast<System>(message.system),
                       static_cast<std::uint16_t>(message.number)};
  return is_valid(id) ? std::optional(id) : std::nullopt;
}

bool message_fits_system(System system, std::int8_t message) {
  switch (static_cast<NavigationMessage>(message)) {
    case NavigationMessage::kGpsLnav:
      return system == System::kGps;
    case NavigationMessage::kGalileoInav:
    case NavigationMessage::kGalileoFnav:
      return system == System::kGalileo;
    case NavigationMessage::kBeidouD1:
    case NavigationMessage::kBeidouD2:
      return system == System::kBeidou;
    case NavigationMessage::kBeidouCnav1:
      break;
  }
  return false;
}

// Beyond it a correction is worthless, and a time could overflow.
constexpr float kLongestAge_s = 86400.0F;

bool is_uint16(std::int32_t value) { return value >= 0 && value <= 0xffff; }

}  // namespace

InputFault convert(const gnss_observation_t& from, SignalObservation* to) {
  const auto satellite = satellite_of(from);
  if (!satellite) return InputFault::kOutOfRange;
  if (from.band < '1' || from.band > '9') return InputFault::kOutOfRange;
  if (from.attribute < 'A' || from.attribute > 'Z') return InputFault::kOutOfRange;
  constexpr int kKnownFlags = kFlagLossOfLock | kFlagHalfCycle;
  if ((from.flags & ~kKnownFlags) != 0) return InputFault::kOutOfRange;
  to->satellite = *satellite;
  to->code = {static_cast<char>(from.band), static_cast<char>(from.attribute)};
  to->pseudorange_m = from.pseudorange_m;
  // Receivers send zero if they count no cycles; in RINEX too it means "not measured".
  to->carrier_cycles = from.carrier_cycles == 0.0 ? kNotMeasured : from.carrier_cycles;
  to->doppler_hz = from.doppler_hz;
  to->cn0_dbhz = from.cn0_dbhz;
  to->lock_time_s = from.lock_time_s;
  to->loss_of_lock = (from.flags & kFlagLossOfLock) != 0;
  to->half_cycle_ambiguous = (from.flags & kFlagHalfCycle) != 0;
  return check(*to);
}

InputFault convert(const precise_state_t& from, GpsTime time, PreciseState* to) {
  const auto satellite = satellite_of(from);
  if (!satellite) return InputFault::kOutOfRange;
  constexpr int kKnownFlags =
      kFlagClockEvent | kFlagManeuver | kFlagClockPredicted | kFlagOrbitPredicted;
  if ((from.flags & ~kKnownFlags) != 0) return InputFault::kOutOfRange;
  to->satellite = *satellite;
  to->time = time;
  for (int i = 0; i < 3; ++i) to->p_e[i] = from.p_e[i];
  to->clock_s = from.clock_s;
  to->clock_event = (from.flags & kFlagClockEvent) != 0;
  to->maneuver = (from.flags & kFlagManeuver) != 0;
  to->clock_predicted = (from.flags & kFlagClockPredicted) != 0;
  to->orbit_predicted = (from.flags & kFlagOrbitPredicted) != 0;
  const bool clock_only = to->is_clock_only() && std::isfinite(to->clock_s);
  if (!(all_finite(from.p_e) || clock_only) || std::isinf(from.clock_s)) {
    return InputFault::kNotFinite;
  }
  return InputFault::kNone;
}

InputFault convert(const corrected_state_t& from, GpsTime time, CorrectedState* to) {
  const auto satellite = satellite_of(from);
  if (!satellite || (from.flags & ~int{kFlagAtAntenna}) != 0) return InputFault::kOutOfRange;
  for (const float age_s : {from.orbit_age_s, from.clock_age_s}) {
    if (!std::isfinite(age_s)) return InputFault::kNotFinite;
    if (std::abs(age_s) > kLongestAge_s) return InputFault::kOutOfRange;
  }
  if (!is_uint16(from.issue)) return InputFault::kOutOfRange;
  to->satellite = *satellite;
  to->time = time;
  to->issue = static_cast<std::uint16_t>(from.issue);
  to->orbit_corrected_at = time.plus_seconds(-double{from.orbit_age_s});
  to->corrected_at = time.plus_seconds(-double{from.clock_age_s});
  to->at_antenna = (from.flags & kFlagAtAntenna) != 0;
  for (int i = 0; i < 3; ++i) to->p_e[i] = from.p_e[i];
  for (int i = 0; i < 3; ++i) to->v_e[i] = from.v_e[i];
  to->clock_s = from.clock_s;
  to->clock_drift = from.clock_drift;
  to->sigma_m = from.sigma_m;
  return check(*to);
}

InputFault convert(const bias_t& from, GpsTime time, SignalBias* to) {
  const auto satellite = satellite_of(from);
  if (!satellite || from.kind < 0 || from.kind > static_cast<int>(BiasKind::kBroadcastCode) ||
      !is_time_or_unset(from.from_ns) || !is_time_or_unset(from.until_ns))
    return InputFault::kOutOfRange;
  to->satellite = *satellite;
  to->code = {static_cast<char>(from.band), static_cast<char>(from.attribute)};
  to->kind = static_cast<BiasKind>(from.kind);
  to->time = time;
  to->bias_m = from.bias_m;
  to->valid_from = GpsTime::from_nanoseconds(from.from_ns);
  to->valid_until = GpsTime::from_nanoseconds(from.until_ns);
  return check(*to);
}

namespace {

// Fills what both messages of elements have.
template <typename T>
InputFault convert_elements(const T& from, Ephemeris* to) {
  const auto satellite = satellite_of(from);
  if (!satellite || !is_time_or_unset(from.time_ns) || !is_time(from.toe_ns) ||
      !is_time(from.toc_ns) || !is_uint16(from.issue) || !is_uint16(from.issue_clock) ||
      !is_uint16(from.health)) {
    return InputFault::kOutOfRange;
  }
  *to = Ephemeris();
  to->satellite = *satellite;
  to->transmission_time = GpsTime::from_nanoseconds(from.time_ns);
  to->toe = GpsTime::from_nanoseconds(from.toe_ns);
  to->toc = GpsTime::from_nanoseconds(from.toc_ns);
  to->issue = static_cast<std::uint16_t>(from.issue);
  to->issue_clock = static_cast<std::uint16_t>(from.issue_clock);
  to->health = static_cast<std::uint16_t>(from.health);
  // Every real-valued element is listed here once; others are not decoded.
  const std::pair<double, double*> elements[] = {{from.accuracy_m, &to->accuracy_m},
                                                 {from.sqrt_a, &to->sqrt_a},
                                                 {from.eccentricity, &to->eccentricity},
                                                 {from.m0, &to->m0},
                                                 {from.delta_n, &to->delta_n},
                                                 {from.omega0, &to->omega0},
                                                 {from.omega_dot, &to->omega_dot},
                                                 {from.i0, &to->i0},
                                                 {from.i_dot, &to->i_dot},
                                                 {from.omega, &to->omega},
                                                 {from.cuc, &to->cuc},
                                                 {from.cus, &to->cus},
                                                 {from.crc, &to->crc},
                                                 {from.crs, &to->crs},
                                                 {from.cic, &to->cic},
                                                 {from.cis, &to->cis},
                                                 {from.af0, &to->af0},
                                                 {from.af1, &to->af1},
                                                 {from.af2, &to->af2}};
  for (const auto& [value, target] : elements) {
    if (!std::isfinite(value)) return InputFault::kNotFinite;
    *target = value;
  }
  return InputFault::kNone;
}

}  // namespace

InputFault convert(const ephemeris_t& from, Ephemeris* to) {
  const auto satellite = satellite_of(from);
  if (!satellite || !message_fits_system(satellite->system, from.message)) {
    return InputFault::kOutOfRange;
  }
  const InputFault fault = convert_elements(from, to);
  if (fault != InputFault::kNone) return fault;
  to->message = static_cast<NavigationMessage>(from.message);
  if (!all_finite(from.group_delay_s)) return InputFault::kNotFinite;
  for (std::size_t i = 0; i < 2; ++i) to->group_delay_s[i] = from.group_delay_s[i];
  return is_sane(*to) ? InputFault::kNone : InputFault::kNotSane;
}

InputFault convert(const leo_ephemeris_t& from, Ephemeris* to) {
  const InputFault fault = convert_elements(from, to);
  if (fault != InputFault::kNone) return fault;
  if (to->satellite.system != System::kLeo) return InputFault::kOutOfRange;
  if (!std::isfinite(from.a_dot) || !std::isfinite(from.delta_n_dot)) return InputFault::kNotFinite;
  to->a_dot = from.a_dot;
  to->delta_n_dot = from.delta_n_dot;
  return is_sane(*to) ? InputFault::kNone : InputFault::kNotSane;
}

InputFault convert(const antenna_t& from, AntennaPattern* to) {
  const bool known = from.is_receiver == 0 || from.is_receiver == 1;
  if (!known || from.system < 0 || from.system >= static_cast<int>(kSystemCount) ||
      from.number < 0 || !is_time_or_unset(from.valid_from_ns) ||
      !is_time_or_unset(from.valid_until_ns)) {
    return InputFault::kOutOfRange;
  }
  const bool finite = all_finite(from.offset_m) && std::isfinite(from.first_angle_rad) &&
                      std::isfinite(from.angle_step_rad) &&
                      std::all_of(from.values_m.begin(), from.values_m.end(),
                                  [](float value) { return std::isfinite(value); });
  if (!finite) return InputFault::kNotFinite;
  to->is_receiver = from.is_receiver == 1;
  to->satellite = {static_cast<System>(from.system), static_cast<std::uint16_t>(from.number)};
  to->band = static_cast<char>(from.band);
  to->valid_from = GpsTime::from_nanoseconds(from.valid_from_ns);
  to->valid_until = GpsTime::from_nanoseconds(from.valid_until_ns);
  for (int i = 0; i < 3; ++i) to->offset_m[i] = from.offset_m[i];
  to->variation.first_angle = from.first_angle_rad;
  to->variation.angle_step = from.angle_step_rad;
  to->variation.angles = from.angles;
  to->variation.azimuths = from.azimuths;
  to->variation.values.assign(from.values_m.begin(), from.values_m.end());
  return is_storable(*to) ? InputFault::kNone : InputFault::kNotSane;
}

namespace {

Eigen::Vector3d vector_of(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

// What all versions of a checkpoint have.
template <typename T>
InputFault convert_place(const T& from, Checkpoint* to) {
  if (!is_time(from.time_ns) || from.standing < 0 || from.standing > 1)
    return InputFault::kOutOfRange;
  to->time = GpsTime::from_nanoseconds(from.time_ns);
  to->standing = from.standing == 1;
  to->antenna_sigma = from.antenna_sigma_m;
  to->heading = from.heading_rad;
  to->heading_sigma = from.heading_sigma_rad;
  to->gyro_bias_sigma = from.gyro_bias_sigma;
  for (int i = 0; i < 3; ++i) {
    to->antenna_p_e[i] = from.antenna_p_e[i];
    to->gyro_bias_b[i] = from.gyro_bias_b[i];
  }
  return check(*to);
}

}  // namespace

InputFault convert(const checkpoint_v1_t& from, Checkpoint* to) {
  to->code_sigma_factor = to->doppler_sigma_factor = 0.0;
  to->calibration.reset();
  return convert_place(from, to);
}

InputFault convert(const checkpoint_v2_t& from, Checkpoint* to) {
  to->code_sigma_factor = from.code_sigma_factor;
  to->doppler_sigma_factor = from.doppler_sigma_factor;
  to->calibration.reset();
  return convert_place(from, to);
}

InputFault convert(const checkpoint_t& from, Checkpoint* to) {
  if (from.calibrated < 0 || from.calibrated > 1) return InputFault::kOutOfRange;
  to->code_sigma_factor = from.code_sigma_factor;
  to->doppler_sigma_factor = from.doppler_sigma_factor;
  to->calibration.reset();
  if (from.calibrated == 1) {
    Calibration& calibration = to->calibration.emplace();
    calibration.mounting_rpy = vector_of(from.mounting_rpy);
    calibration.accel_bias_b = vector_of(from.accel_bias_b);
    calibration.accel_bias_sigma = vector_of(from.accel_bias_sigma);
    calibration.gyro_scale = vector_of(from.gyro_scale);
    calibration.gyro_scale_sigma = vector_of(from.gyro_scale_sigma);
    calibration.accel_scale = vector_of(from.accel_scale);
    calibration.accel_scale_sigma = vector_of(from.accel_scale_sigma);
    std::copy(std::begin(from.constants), std::end(from.constants), calibration.constants.begin());
    std::copy(std::begin(from.constant_sigmas), std::end(from.constant_sigmas),
              calibration.constant_sigmas.begin());
  }
  return convert_place(from, to);
}

}  // namespace leonav::wire
