#include "drivers/lcm/encode.h"

#include <algorithm>
#include <array>
#include <leonav/antenna_t.hpp>
#include <leonav/biases_t.hpp>
#include <leonav/checkpoint_t.hpp>
#include <leonav/command_t.hpp>
#include <leonav/constraints_t.hpp>
#include <leonav/corrected_states_t.hpp>
#include <leonav/decision_t.hpp>
#include <leonav/ephemeris_t.hpp>
#include <leonav/epoch_t.hpp>
#include <leonav/epoch_v1_t.hpp>
#include <leonav/event_t.hpp>
#include <leonav/gnss_epoch_t.hpp>
#include <leonav/imu_t.hpp>
#include <leonav/ionosphere_t.hpp>
#include <leonav/leo_ephemeris_t.hpp>
#include <leonav/odometer_t.hpp>
#include <leonav/orbit_clock_t.hpp>
#include <leonav/smoother_t.hpp>
#include <leonav/smoother_v1_t.hpp>

#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

void copy(const Eigen::Vector3d& from, double (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

template <typename T>
void set_header(GpsTime time, std::uint64_t sequence, T* message) {
  message->time_ns = time.nanoseconds();
  message->sequence = static_cast<std::int64_t>(sequence);
  message->schema = wire::kSchema;
}

// Writes system and number of a satellite into any message that has them.
template <typename T>
void set_satellite(SatelliteId satellite, T* message) {
  message->system = static_cast<std::int8_t>(satellite.system);
  message->number = static_cast<std::int16_t>(satellite.number);
}

void fill(const SignalObservation& from, gnss_observation_t* to) {
  set_satellite(from.satellite, to);
  to->band = static_cast<std::int8_t>(from.code.band);
  to->attribute = static_cast<std::int8_t>(from.code.attribute);
  to->pseudorange_m = from.pseudorange_m;
  to->carrier_cycles = from.carrier_cycles;
  to->doppler_hz = from.doppler_hz;
  to->cn0_dbhz = static_cast<float>(from.cn0_dbhz);
  to->lock_time_s = static_cast<float>(from.lock_time_s);
  to->flags = static_cast<std::int8_t>((from.loss_of_lock ? wire::kFlagLossOfLock : 0) |
                                       (from.half_cycle_ambiguous ? wire::kFlagHalfCycle : 0));
}

// Fills what both messages of elements have.
template <typename T>
void fill_elements(const Ephemeris& from, std::uint64_t sequence, T* to) {
  set_header(from.transmission_time, sequence, to);
  set_satellite(from.satellite, to);
  to->toe_ns = from.toe.nanoseconds();
  to->toc_ns = from.toc.nanoseconds();
  to->issue = from.issue;
  to->issue_clock = from.issue_clock;
  to->health = from.health;
  to->accuracy_m = from.accuracy_m;
  to->sqrt_a = from.sqrt_a;
  to->eccentricity = from.eccentricity;
  to->m0 = from.m0;
  to->delta_n = from.delta_n;
  to->omega0 = from.omega0;
  to->omega_dot = from.omega_dot;
  to->i0 = from.i0;
  to->i_dot = from.i_dot;
  to->omega = from.omega;
  to->cuc = from.cuc;
  to->cus = from.cus;
  to->crc = from.crc;
  to->crs = from.crs;
  to->cic = from.cic;
  to->cis = from.cis;
  to->af0 = from.af0;
  to->af1 = from.af1;
  to->af2 = from.af2;
}

// Sets the header of an output that has versions.
template <typename T>
void set_header(GpsTime time, std::uint64_t sequence, OutputSchema schema, T* message) {
  set_header(time, sequence, message);
  message->schema = static_cast<std::int32_t>(schema);
}

// Fills what all versions have.
template <typename T>
void fill_all_versions(const Solution& from, T* to) {
  to->source = static_cast<std::int8_t>(from.source);
  to->has_attitude = from.has_attitude ? 1 : 0;
  copy(from.p_e, to->p_e);
  to->latitude_rad = from.latitude;
  to->longitude_rad = from.longitude;
  to->height_m = from.height;
  copy(from.v_n, to->v_n);
  copy({from.roll, from.pitch, from.yaw}, to->rpy_rad);
  copy(from.sigma_p_n, to->sigma_p_n);
  copy(from.sigma_v_n, to->sigma_v_n);
  copy(from.sigma_rpy, to->sigma_rpy);
  copy(from.errors.gyro_bias_b, to->gyro_bias_b);
  copy(from.errors.accel_bias_b, to->accel_bias_b);
  copy(from.errors.gyro_scale, to->gyro_scale);
  copy(from.errors.accel_scale, to->accel_scale);
  to->anchor_epoch = static_cast<std::int64_t>(from.anchor_epoch);
  to->jump_m = from.jump_m;
}

void fill(const Solution& from, solution_v1_t* to) {
  set_header(from.time, from.sequence, OutputSchema::kFirst, to);
  fill_all_versions(from, to);
}

void fill(const Solution& from, solution_t* to) {
  set_header(from.time, from.sequence, OutputSchema::kNewest, to);
  fill_all_versions(from, to);
  to->horizontal_protection_m = from.horizontal_protection_m;
  to->vertical_protection_m = from.vertical_protection_m;
  to->heading_protection_rad = from.heading_protection;
}

std::int8_t flags_of(const PreciseState& state) {
  return static_cast<std::int8_t>((state.clock_event ? wire::kFlagClockEvent : 0) |
                                  (state.maneuver ? wire::kFlagManeuver : 0) |
                                  (state.clock_predicted ? wire::kFlagClockPredicted : 0) |
                                  (state.orbit_predicted ? wire::kFlagOrbitPredicted : 0));
}

void fill(const CorrectedState& from, corrected_state_t* to) {
  set_satellite(from.satellite, to);
  to->flags = static_cast<std::int8_t>(from.at_antenna ? wire::kFlagAtAntenna : 0);
  to->issue = from.issue;
  copy(from.p_e, to->p_e);
  copy(from.v_e, to->v_e);
  to->clock_s = from.clock_s;
  to->clock_drift = from.clock_drift;
  to->sigma_m = static_cast<float>(from.sigma_m);
  to->orbit_age_s = static_cast<float>(seconds_between(from.time, from.orbit_corrected_at));
  to->clock_age_s = static_cast<float>(seconds_between(from.time, from.corrected_at));
}

void fill(const SatelliteReport& from, satellite_report_t* to) {
  set_satellite(from.satellite, to);
  to->reason = static_cast<std::int8_t>(from.reason);
  to->elevation_rad = static_cast<float>(from.elevation);
  to->azimuth_rad = static_cast<float>(from.azimuth);
  to->cn0_dbhz = static_cast<float>(from.cn0_dbhz);
  to->ephemeris_age_s = static_cast<float>(from.ephemeris_age_s);
  to->orbit_source = static_cast<std::int8_t>(from.source);
  to->arc = static_cast<std::int32_t>(from.arc);
  to->arc_started = from.arc_started ? 1 : 0;
  to->arc_causes = static_cast<std::int16_t>(from.arc_causes.bits());
}

void fill(const AidingReport& from, aiding_t* to) {
  set_satellite(from.satellite, to);
  to->observable = static_cast<std::int8_t>(from.observable);
  to->band = static_cast<std::int8_t>(from.code.band);
  to->attribute = static_cast<std::int8_t>(from.code.attribute);
  to->second_band = static_cast<std::int8_t>(from.second_code.band);
  to->second_attribute = static_cast<std::int8_t>(from.second_code.attribute);
  to->observation = from.observation;
  to->innovation = from.innovation;
  to->innovation_variance = from.innovation_variance;
  to->test_ratio = static_cast<float>(from.test_ratio);
  to->weight_factor = static_cast<float>(from.weight_factor);
  to->reason = static_cast<std::int8_t>(from.reason);
  to->residual = from.residual;
}

void fill(const ConstraintReport& from, constraint_t* to) {
  to->time_ns = from.time.nanoseconds();
  to->component = static_cast<std::int8_t>(from.component);
  to->observation = from.observation;
  to->innovation = from.innovation;
  to->innovation_variance = from.innovation_variance;
  to->test_ratio = static_cast<float>(from.test_ratio);
  to->used = from.used ? 1 : 0;
  to->residual = from.residual;
}

template <typename T>
void fill_all_versions(const EpochReport& from, T* to) {
  to->n_satellites = static_cast<std::int32_t>(from.satellites.size());
  to->n_aiding = static_cast<std::int32_t>(from.aiding.size());
  to->index = static_cast<std::int64_t>(from.index);
  to->empty = from.empty ? 1 : 0;
  fill(from.solution, &to->solution);
  to->satellites_used = from.satellites_used;
  to->pdop = from.pdop;
  to->hdop = from.hdop;
  to->vdop = from.vdop;
  std::copy(from.clock_m.begin(), from.clock_m.end(), to->clock_m);
  std::copy(from.clock_drift_m_s.begin(), from.clock_drift_m_s.end(), to->clock_drift_m_s);
  to->wet_delay_m = from.wet_delay_m;
  to->wet_delay_sigma_m = from.wet_delay_sigma_m;
  to->nis = from.nis;
  to->nis_degrees = from.nis_degrees;
  to->satellites.resize(from.satellites.size());
  for (std::size_t i = 0; i < from.satellites.size(); ++i) {
    fill(from.satellites[i], &to->satellites[i]);
  }
  to->aiding.resize(from.aiding.size());
  for (std::size_t i = 0; i < from.aiding.size(); ++i) fill(from.aiding[i], &to->aiding[i]);
}

void fill(const EpochReport& from, epoch_v1_t* to) {
  set_header(from.time, from.sequence, OutputSchema::kFirst, to);
  fill_all_versions(from, to);
}

void fill(const EpochReport& from, epoch_t* to) {
  set_header(from.time, from.sequence, OutputSchema::kNewest, to);
  fill_all_versions(from, to);
  to->fault_hypotheses = static_cast<std::int32_t>(from.fault_hypotheses.size());
}

template <typename T>
void fill(const SmootherReport& from, OutputSchema schema, T* to) {
  set_header(from.solution.time, from.sequence, schema, to);
  to->epoch = static_cast<std::int64_t>(from.index);
  to->status = static_cast<std::int8_t>(from.status);
  to->iterations = from.iterations;
  to->converged = from.converged ? 1 : 0;
  to->keyframes = from.keyframes;
  to->used = from.used;
  fill(from.solution, &to->solution);
}

}  // namespace

struct Encoder::Storage {
  OutputSchema schema = OutputSchema::kNewest;
  // Messages are kept between calls, so that their vectors keep their memory.
  gnss_epoch_t gnss_epoch;
  orbit_clock_t orbit_clock;
  corrected_states_t corrected_states;
  biases_t biases;
  antenna_t antenna;
  epoch_t epoch;
  epoch_v1_t epoch_v1;
  constraints_t constraints;
  std::array<std::uint8_t, wire::kMaxMessageBytes> buffer;

  template <typename T>
  ByteSpan write(const T& message) {
    const int size = message.encode(buffer.data(), 0, static_cast<int>(buffer.size()));
    // Encoding cannot fail: core/base/capacity.h limits every array, and the buffer holds the
    // largest message.
    return {buffer.data(), static_cast<std::size_t>(std::max(size, 0))};
  }
};

Encoder::Encoder(OutputSchema schema, Room room) : storage_(std::make_unique<Storage>()) {
  storage_->schema = schema;
  if (schema == OutputSchema::kFirst) {
    storage_->epoch_v1.satellites.reserve(kMaxSatellites);
    storage_->epoch_v1.aiding.reserve(kMaxMeasurements);
  } else {
    storage_->epoch.satellites.reserve(kMaxSatellites);
    storage_->epoch.aiding.reserve(kMaxMeasurements);
  }
  storage_->constraints.components.reserve(kMaxConstraintReports);
  if (room == Room::kOutputs) return;
  storage_->gnss_epoch.observations.reserve(kMaxObservations);
  storage_->orbit_clock.states.reserve(kMaxEphemerisSatellites);
  storage_->corrected_states.states.reserve(kMaxCorrectedStates);
  storage_->biases.biases.reserve(kMaxBiases);
  storage_->antenna.values_m.reserve(kMaxAntennaValues);
}
Encoder::~Encoder() = default;
Encoder::Encoder(Encoder&&) noexcept = default;
Encoder& Encoder::operator=(Encoder&&) noexcept = default;

ByteSpan Encoder::encode(const ImuSample& sample, std::uint64_t sequence) {
  imu_t message;
  set_header(sample.time, sequence, &message);
  message.interval_ns = sample.interval_ns;
  copy(sample.delta_theta_b, message.delta_theta_b);
  copy(sample.delta_velocity_b, message.delta_velocity_b);
  return storage_->write(message);
}

ByteSpan Encoder::encode(const OdometerIncrement& increment, std::uint64_t sequence) {
  odometer_t message;
  set_header(increment.time, sequence, &message);
  message.interval_ns = increment.interval_ns;
  message.distance_m = increment.distance_m;
  message.sign_known = increment.sign_known ? 1 : 0;
  return storage_->write(message);
}

ByteSpan Encoder::encode(const RawEpoch& epoch, std::uint64_t sequence) {
  gnss_epoch_t& message = storage_->gnss_epoch;
  set_header(epoch.time, sequence, &message);
  message.n = static_cast<std::int32_t>(epoch.observations.size());
  message.observations.resize(epoch.observations.size());
  for (std::size_t i = 0; i < epoch.observations.size(); ++i) {
    fill(epoch.observations[i], &message.observations[i]);
  }
  return storage_->write(message);
}

ByteSpan Encoder::encode(const Ephemeris& from, std::uint64_t sequence) {
  if (from.satellite.system == System::kLeo) {
    leo_ephemeris_t to;
    fill_elements(from, sequence, &to);
    to.schema = wire::kLeoEphemerisSchema;
    to.a_dot = from.a_dot;
    to.delta_n_dot = from.delta_n_dot;
    return storage_->write(to);
  }
  ephemeris_t to;
  fill_elements(from, sequence, &to);
  to.message = static_cast<std::int8_t>(from.message);
  for (std::size_t i = 0; i < from.group_delay_s.size(); ++i) {
    to.group_delay_s[i] = from.group_delay_s[i];
  }
  return storage_->write(to);
}

ByteSpan Encoder::encode(std::span<const PreciseState> states, std::uint64_t sequence) {
  orbit_clock_t& message = storage_->orbit_clock;
  const std::size_t n = std::min(states.size(), kMaxEphemerisSatellites);
  set_header(n == 0 ? GpsTime() : states.front().time, sequence, &message);
  message.n = static_cast<std::int32_t>(n);
  message.states.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    set_satellite(states[i].satellite, &message.states[i]);
    message.states[i].flags = flags_of(states[i]);
    copy(states[i].p_e, message.states[i].p_e);
    message.states[i].clock_s = states[i].clock_s;
  }
  return storage_->write(message);
}

ByteSpan Encoder::encode(std::span<const CorrectedState> states, const CorrectionSource& source,
                         std::uint64_t sequence) {
  corrected_states_t& message = storage_->corrected_states;
  const std::size_t n = std::min(states.size(), kMaxCorrectedStates);
  set_header(n == 0 ? GpsTime() : states.front().time, sequence, &message);
  message.n = static_cast<std::int32_t>(n);
  message.provider = source.provider;
  message.solution = source.solution;
  message.ssr_issue = source.issue;
  message.states.resize(n);
  for (std::size_t i = 0; i < n; ++i) fill(states[i], &message.states[i]);
  return storage_->write(message);
}

ByteSpan Encoder::encode(std::span<const SignalBias> biases, std::uint64_t sequence) {
  biases_t& message = storage_->biases;
  const std::size_t n = std::min(biases.size(), kMaxBiases);
  set_header(n == 0 ? GpsTime() : biases.front().time, sequence, &message);
  message.n = static_cast<std::int32_t>(n);
  message.biases.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    set_satellite(biases[i].satellite, &message.biases[i]);
    message.biases[i].band = static_cast<std::int8_t>(biases[i].code.band);
    message.biases[i].attribute = static_cast<std::int8_t>(biases[i].code.attribute);
    message.biases[i].kind = static_cast<std::int8_t>(biases[i].kind);
    message.biases[i].bias_m = biases[i].bias_m;
    message.biases[i].from_ns = biases[i].valid_from.nanoseconds();
    message.biases[i].until_ns = biases[i].valid_until.nanoseconds();
  }
  return storage_->write(message);
}

ByteSpan Encoder::encode(const KlobucharModel& model, GpsTime time, std::uint64_t sequence) {
  ionosphere_t message;
  set_header(time, sequence, &message);
  std::copy(model.alpha.begin(), model.alpha.end(), message.alpha);
  std::copy(model.beta.begin(), model.beta.end(), message.beta);
  return storage_->write(message);
}

ByteSpan Encoder::encode(const AntennaPattern& pattern, GpsTime time, std::uint64_t sequence) {
  antenna_t& message = storage_->antenna;
  const AntennaGrid& grid = pattern.variation;
  set_header(time, sequence, &message);
  set_satellite(pattern.satellite, &message);
  message.is_receiver = pattern.is_receiver ? 1 : 0;
  message.band = static_cast<std::int8_t>(pattern.band);
  message.valid_from_ns = pattern.valid_from.nanoseconds();
  message.valid_until_ns = pattern.valid_until.nanoseconds();
  copy(pattern.offset_m, message.offset_m);
  message.first_angle_rad = grid.first_angle;
  message.angle_step_rad = grid.angle_step;
  message.angles = grid.angles;
  message.azimuths = grid.azimuths;
  message.n = static_cast<std::int32_t>(grid.values.size());
  message.values_m.assign(grid.values.begin(), grid.values.end());
  return storage_->write(message);
}

ByteSpan Encoder::encode(const Command& command, GpsTime time, std::uint64_t sequence) {
  command_t message;
  set_header(time, sequence, &message);
  message.kind = static_cast<std::int8_t>(command.kind);
  message.value = command.value;
  message.sigma = command.sigma;
  return storage_->write(message);
}

ByteSpan Encoder::encode(const Checkpoint& checkpoint, std::uint64_t sequence) {
  checkpoint_t message;
  set_header(checkpoint.time, sequence, &message);
  message.schema = wire::kCheckpointSchema;
  message.standing = checkpoint.standing ? 1 : 0;
  copy(checkpoint.antenna_p_e, message.antenna_p_e);
  message.antenna_sigma_m = checkpoint.antenna_sigma;
  message.heading_rad = checkpoint.heading;
  message.heading_sigma_rad = checkpoint.heading_sigma;
  copy(checkpoint.gyro_bias_b, message.gyro_bias_b);
  message.gyro_bias_sigma = checkpoint.gyro_bias_sigma;
  message.code_sigma_factor = checkpoint.code_sigma_factor;
  message.doppler_sigma_factor = checkpoint.doppler_sigma_factor;
  message.calibrated = checkpoint.calibration ? 1 : 0;
  const Calibration calibration = checkpoint.calibration.value_or(Calibration());
  copy(calibration.mounting_rpy, message.mounting_rpy);
  copy(calibration.accel_bias_b, message.accel_bias_b);
  copy(calibration.accel_bias_sigma, message.accel_bias_sigma);
  copy(calibration.gyro_scale, message.gyro_scale);
  copy(calibration.gyro_scale_sigma, message.gyro_scale_sigma);
  copy(calibration.accel_scale, message.accel_scale);
  copy(calibration.accel_scale_sigma, message.accel_scale_sigma);
  std::copy(calibration.constants.begin(), calibration.constants.end(), message.constants);
  std::copy(calibration.constant_sigmas.begin(), calibration.constant_sigmas.end(),
            message.constant_sigmas);
  return storage_->write(message);
}

ByteSpan Encoder::encode(const Solution& solution) {
  const auto write = [&](auto message) {
    fill(solution, &message);
    return storage_->write(message);
  };
  return storage_->schema == OutputSchema::kFirst ? write(solution_v1_t()) : write(solution_t());
}

ByteSpan Encoder::encode(const EpochReport& report) {
  const auto write = [&](auto& message) {
    fill(report, &message);
    return storage_->write(message);
  };
  const bool first = storage_->schema == OutputSchema::kFirst;
  return first ? write(storage_->epoch_v1) : write(storage_->epoch);
}

ByteSpan Encoder::encode_constraints(const EpochReport& from) {
  constraints_t& to = storage_->constraints;
  set_header(from.time, from.sequence, &to);
  to.index = static_cast<std::int64_t>(from.index);
  to.n = static_cast<std::int32_t>(from.constraint_reports.size());
  to.components.resize(from.constraint_reports.size());
  for (std::size_t i = 0; i < from.constraint_reports.size(); ++i)
    fill(from.constraint_reports[i], &to.components[i]);
  return storage_->write(to);
}

ByteSpan Encoder::encode(const Event& event) {
  event_t message;
  set_header(event.time, event.sequence, &message);
  message.stage = static_cast<std::int8_t>(event.stage);
  message.kind = static_cast<std::int8_t>(event.kind);
  message.code = static_cast<std::int8_t>(event.code);
  message.value = event.value;
  return storage_->write(message);
}

ByteSpan Encoder::encode(const Decision& decision) {
  decision_t message;
  set_header(decision.time, decision.sequence, &message);
  message.epoch = static_cast<std::int64_t>(decision.epoch);
  message.mailbox = static_cast<std::int8_t>(decision.subject);
  message.committed = decision.committed ? 1 : 0;
  message.iterations = decision.iterations;
  return storage_->write(message);
}

ByteSpan Encoder::encode(const SmootherReport& report) {
  const auto write = [&](auto message) {
    fill(report, storage_->schema, &message);
    return storage_->write(message);
  };
  return storage_->schema == OutputSchema::kFirst ? write(smoother_v1_t()) : write(smoother_t());
}

}  // namespace leonav
