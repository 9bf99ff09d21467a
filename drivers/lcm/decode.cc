#include "drivers/lcm/decode.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <leonav/command_t.hpp>
#include <leonav/decision_t.hpp>
#include <leonav/ephemeris_t.hpp>
#include <leonav/gnss_epoch_t.hpp>
#include <leonav/imu_t.hpp>
#include <leonav/ionosphere_t.hpp>
#include <leonav/orbit_clock_t.hpp>
#include <optional>
#include <utility>

#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

constexpr std::int64_t kMaxImuIntervalNs = 10 * kNanosecondsPerSecond;

constexpr std::uint32_t bit(InputFault fault) { return 1U << static_cast<unsigned>(fault); }

std::int32_t read_int32(ByteSpan bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[offset + i];
  return static_cast<std::int32_t>(value);
}

// The count at `offset` is within capacity.
InputFault check_count(ByteSpan bytes, std::size_t offset, std::size_t capacity) {
  if (bytes.size() < offset + 4) return InputFault::kUndecodable;
  const std::int32_t count = read_int32(bytes, offset);
  if (count < 0) return InputFault::kUndecodable;
  return static_cast<std::size_t>(count) > capacity ? InputFault::kTooMany : InputFault::kNone;
}

// Generated decoding, then: the whole message was used, and its schema is known. Counts must have
// been checked before.
template <typename T>
InputFault read(ByteSpan bytes, T* message) {
  if (bytes.size() > wire::kMaxMessageBytes) return InputFault::kTooMany;
  const int size = static_cast<int>(bytes.size());
  if (message->decode(bytes.data(), 0, size) != size) return InputFault::kUndecodable;
  return message->schema == wire::kSchema ? InputFault::kNone : InputFault::kUnknownSchema;
}

// As read(), for a message whose one array may hold `capacity` elements.
template <typename T>
InputFault read_array(ByteSpan bytes, std::size_t capacity, T* message) {
  const InputFault fault = check_count(bytes, wire::kFirstCountOffset, capacity);
  return fault != InputFault::kNone ? fault : read(bytes, message);
}

template <typename T>
DecodeResult result_of(const T& message, InputFault fault) {
  return {fault, static_cast<std::uint64_t>(message.sequence), 0};
}

bool is_time(std::int64_t ns) { return ns > 0 && ns <= wire::kMaxTimeNs; }
bool is_time_or_unset(std::int64_t ns) { return ns == 0 || is_time(ns); }

template <std::size_t N>
bool all_finite(const double (&values)[N]) {
  return std::all_of(values, values + N, [](double value) { return std::isfinite(value); });
}

template <typename T>
std::optional<SatelliteId> satellite_of(const T& message) {
  if (message.system < 0 || message.system >= static_cast<int>(kSystemCount)) return std::nullopt;
  if (message.number <= 0) return std::nullopt;
  const SatelliteId id{static_cast<System>(message.system),
                       static_cast<std::uint16_t>(message.number)};
  return is_valid(id) ? std::optional(id) : std::nullopt;
}

InputFault convert(const gnss_observation_t& from, SignalObservation* to) {
  const auto satellite = satellite_of(from);
  if (!satellite) return InputFault::kOutOfRange;
  if (from.band < '1' || from.band > '9') return InputFault::kOutOfRange;
  if (from.attribute < 'A' || from.attribute > 'Z') return InputFault::kOutOfRange;
  constexpr int kKnownFlags = wire::kFlagLossOfLock | wire::kFlagHalfCycle;
  if ((from.flags & ~kKnownFlags) != 0) return InputFault::kOutOfRange;
  // NaN is "not measured"; infinity is nothing.
  for (const double value : {from.pseudorange_m, from.carrier_cycles, from.doppler_hz,
                             double{from.cn0_dbhz}, double{from.lock_time_s}}) {
    if (std::isinf(value)) return InputFault::kNotFinite;
  }
  to->satellite = *satellite;
  to->code = {static_cast<char>(from.band), static_cast<char>(from.attribute)};
  to->pseudorange_m = from.pseudorange_m;
  to->carrier_cycles = from.carrier_cycles;
  to->doppler_hz = from.doppler_hz;
  to->cn0_dbhz = from.cn0_dbhz;
  to->lock_time_s = from.lock_time_s;
  to->loss_of_lock = (from.flags & wire::kFlagLossOfLock) != 0;
  to->half_cycle_ambiguous = (from.flags & wire::kFlagHalfCycle) != 0;
  return InputFault::kNone;
}

bool before(const SignalObservation& a, const SignalObservation& b) {
  return a.satellite != b.satellite ? a.satellite < b.satellite : a.code < b.code;
}

// Sorts, and removes every observation that shares its satellite and code with another.
bool sort_and_drop_copies(RawEpoch* epoch) {
  auto& list = epoch->observations;
  if (!std::is_sorted(list.begin(), list.end(), before)) {
    std::sort(list.begin(), list.end(), before);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list.size();) {
    std::size_t end = i + 1;
    while (end < list.size() && !before(list[i], list[end])) ++end;
    if (end == i + 1) list[kept++] = list[i];
    i = end;
  }
  const bool had_copies = kept != list.size();
  list.resize(kept);
  return had_copies;
}

InputFault convert(const precise_state_t& from, GpsTime time, PreciseState* to) {
  const auto satellite = satellite_of(from);
  if (!satellite) return InputFault::kOutOfRange;
  if (!all_finite(from.p_e) || std::isinf(from.clock_s)) return InputFault::kNotFinite;
  to->satellite = *satellite;
  to->time = time;
  for (int i = 0; i < 3; ++i) to->p_e[i] = from.p_e[i];
  to->clock_s = from.clock_s;
  return InputFault::kNone;
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
  }
  return false;
}

bool is_uint16(std::int32_t value) { return value >= 0 && value <= 0xffff; }

InputFault convert(const ephemeris_t& from, Ephemeris* to) {
  const auto satellite = satellite_of(from);
  if (!satellite || !message_fits_system(satellite->system, from.message) ||
      !is_time_or_unset(from.time_ns) || !is_time(from.toe_ns) || !is_time(from.toc_ns) ||
      !is_uint16(from.issue) || !is_uint16(from.issue_clock) || !is_uint16(from.health)) {
    return InputFault::kOutOfRange;
  }
  *to = Ephemeris();
  to->satellite = *satellite;
  to->message = static_cast<NavigationMessage>(from.message);
  to->transmission_time = GpsTime::from_nanoseconds(from.time_ns);
  to->toe = GpsTime::from_nanoseconds(from.toe_ns);
  to->toc = GpsTime::from_nanoseconds(from.toc_ns);
  to->issue = static_cast<std::uint16_t>(from.issue);
  to->issue_clock = static_cast<std::uint16_t>(from.issue_clock);
  to->health = static_cast<std::uint16_t>(from.health);
  // Every real-valued element, once: what is not listed here does not cross the wire.
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
                                                 {from.af2, &to->af2},
                                                 {from.group_delay_s[0], &to->group_delay_s[0]},
                                                 {from.group_delay_s[1], &to->group_delay_s[1]}};
  for (const auto& [value, target] : elements) {
    if (!std::isfinite(value)) return InputFault::kNotFinite;
    *target = value;
  }
  return is_sane(*to) ? InputFault::kNone : InputFault::kNotSane;
}

}  // namespace

struct Decoder::Storage {
  // Kept between calls: their vectors hold their memory.
  gnss_epoch_t gnss_epoch;
  orbit_clock_t orbit_clock;
};

Decoder::Decoder() : storage_(std::make_unique<Storage>()) {
  storage_->gnss_epoch.observations.reserve(kMaxObservations);
  storage_->orbit_clock.states.reserve(kMaxEphemerisSatellites);
}
Decoder::~Decoder() = default;
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;

DecodeResult Decoder::decode(ByteSpan bytes, ImuSample* sample) {
  imu_t message{};
  InputFault fault = read(bytes, &message);
  if (fault != InputFault::kNone) return result_of(message, fault);
  if (!is_time(message.time_ns) || message.interval_ns <= 0 ||
      message.interval_ns > kMaxImuIntervalNs || message.interval_ns >= message.time_ns) {
    fault = InputFault::kOutOfRange;
  } else if (!all_finite(message.delta_theta_b) || !all_finite(message.delta_velocity_b)) {
    fault = InputFault::kNotFinite;
  } else {
    sample->time = GpsTime::from_nanoseconds(message.time_ns);
    sample->interval_ns = message.interval_ns;
    for (int i = 0; i < 3; ++i) {
      sample->delta_theta_b[i] = message.delta_theta_b[i];
      sample->delta_velocity_b[i] = message.delta_velocity_b[i];
    }
  }
  return result_of(message, fault);
}

DecodeResult Decoder::decode(ByteSpan bytes, RawEpoch* epoch) {
  gnss_epoch_t& message = storage_->gnss_epoch;
  message.sequence = 0;
  InputFault fault = read_array(bytes, kMaxObservations, &message);
  if (fault == InputFault::kNone && !is_time(message.time_ns)) fault = InputFault::kOutOfRange;
  DecodeResult result = result_of(message, fault);
  if (fault != InputFault::kNone) return result;
  epoch->time = GpsTime::from_nanoseconds(message.time_ns);
  epoch->observations.clear();
  for (const gnss_observation_t& from : message.observations) {
    SignalObservation observation;
    const InputFault element = convert(from, &observation);
    if (element == InputFault::kNone) {
      epoch->observations.push_back(observation);
    } else {
      result.element_faults |= bit(element);
    }
  }
  if (sort_and_drop_copies(epoch)) result.element_faults |= bit(InputFault::kDuplicate);
  return result;
}

DecodeResult Decoder::decode(ByteSpan bytes, Ephemeris* ephemeris) {
  ephemeris_t message{};
  InputFault fault = read(bytes, &message);
  if (fault == InputFault::kNone) {
    Ephemeris converted;
    fault = convert(message, &converted);
    if (fault == InputFault::kNone) *ephemeris = converted;
  }
  return result_of(message, fault);
}

DecodeResult Decoder::decode(ByteSpan bytes, KlobucharModel* model) {
  ionosphere_t message{};
  InputFault fault = read(bytes, &message);
  if (fault != InputFault::kNone) return result_of(message, fault);
  if (!is_time_or_unset(message.time_ns)) {
    fault = InputFault::kOutOfRange;
  } else if (!all_finite(message.alpha) || !all_finite(message.beta)) {
    fault = InputFault::kNotFinite;
  } else {
    std::copy(std::begin(message.alpha), std::end(message.alpha), model->alpha.begin());
    std::copy(std::begin(message.beta), std::end(message.beta), model->beta.begin());
    model->valid = true;
  }
  return result_of(message, fault);
}

DecodeResult Decoder::decode(ByteSpan bytes, PreciseStates* states) {
  orbit_clock_t& message = storage_->orbit_clock;
  message.sequence = 0;
  InputFault fault = read_array(bytes, kMaxEphemerisSatellites, &message);
  if (fault == InputFault::kNone && !is_time(message.time_ns)) fault = InputFault::kOutOfRange;
  DecodeResult result = result_of(message, fault);
  if (fault != InputFault::kNone) return result;
  const GpsTime time = GpsTime::from_nanoseconds(message.time_ns);
  states->clear();
  for (const precise_state_t& from : message.states) {
    PreciseState state;
    const InputFault element = convert(from, time, &state);
    if (element == InputFault::kNone) {
      states->push_back(state);
    } else {
      result.element_faults |= bit(element);
    }
  }
  return result;
}

DecodeResult Decoder::decode(ByteSpan bytes, Command* command) {
  command_t message{};
  InputFault fault = read(bytes, &message);
  if (fault != InputFault::kNone) return result_of(message, fault);
  const bool is_heading = message.kind == static_cast<std::int8_t>(CommandKind::kSetHeading);
  const bool is_restart = message.kind == static_cast<std::int8_t>(CommandKind::kRestart);
  if (!is_time_or_unset(message.time_ns) || (!is_heading && !is_restart)) {
    fault = InputFault::kOutOfRange;
  } else if (!std::isfinite(message.value) || !std::isfinite(message.sigma)) {
    fault = InputFault::kNotFinite;
  } else if (is_heading && (std::abs(message.value) > 6.3 || message.sigma <= 0.0)) {
    fault = InputFault::kOutOfRange;
  } else {
    *command = {static_cast<CommandKind>(message.kind), message.value, message.sigma};
  }
  return result_of(message, fault);
}

DecodeResult Decoder::decode(ByteSpan bytes, Decision* decision) {
  decision_t message{};
  InputFault fault = read(bytes, &message);
  if (fault != InputFault::kNone) return result_of(message, fault);
  if (!is_time(message.time_ns) || message.epoch <= 0 || message.mailbox < 0 ||
      message.mailbox > 1 || message.committed < 0 || message.committed > 1 ||
      message.iterations < 0) {
    fault = InputFault::kOutOfRange;
  } else {
    decision->sequence = static_cast<std::uint64_t>(message.sequence);
    decision->epoch = static_cast<std::uint64_t>(message.epoch);
    decision->time = GpsTime::from_nanoseconds(message.time_ns);
    decision->mailbox = static_cast<std::uint8_t>(message.mailbox);
    decision->committed = message.committed == 1;
    decision->iterations = message.iterations;
  }
  return result_of(message, fault);
}

}  // namespace leonav
