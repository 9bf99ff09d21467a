#include "drivers/lcm/decode.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <leonav/antenna_t.hpp>
#include <leonav/biases_t.hpp>
#include <leonav/checkpoint_t.hpp>
#include <leonav/checkpoint_v1_t.hpp>
#include <leonav/checkpoint_v2_t.hpp>
#include <leonav/command_t.hpp>
#include <leonav/corrected_states_t.hpp>
#include <leonav/decision_t.hpp>
#include <leonav/gnss_epoch_t.hpp>
#include <leonav/imu_t.hpp>
#include <leonav/ionosphere_t.hpp>
#include <leonav/leo_ephemeris_t.hpp>
#include <leonav/odometer_t.hpp>
#include <leonav/orbit_clock_t.hpp>
#include <leonav/smoother_t.hpp>
#include <leonav/smoother_v1_t.hpp>

#include "drivers/lcm/convert.h"
#include "drivers/lcm/internal/read_message.h"
#include "drivers/lcm/output_schema.h"
#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

using wire::all_finite;
using wire::convert;
using wire::is_time;
using wire::is_time_or_unset;

constexpr std::int64_t kMaxImuIntervalNs = 10 * kNanosecondsPerSecond;

constexpr std::uint32_t bit(InputFault fault) { return 1U << static_cast<unsigned>(fault); }

// Checks that the count at `offset` is within `capacity`.
InputFault check_count(ByteSpan bytes, std::size_t offset, std::size_t capacity) {
  if (bytes.size() < offset + 4) return InputFault::kUndecodable;
  const std::int32_t count = static_cast<std::int32_t>(wire::read_uint32(bytes, offset));
  if (count < 0) return InputFault::kUndecodable;
  return static_cast<std::size_t>(count) > capacity ? InputFault::kTooMany : InputFault::kNone;
}

template <typename T>
constexpr std::int32_t schema_of(const T&) {
  return wire::kSchema;
}
constexpr std::int32_t schema_of(const smoother_t&) {
  return static_cast<std::int32_t>(OutputSchema::kNewest);
}
constexpr std::int32_t schema_of(const checkpoint_t&) { return wire::kCheckpointSchema; }
constexpr std::int32_t schema_of(const checkpoint_v2_t&) { return 2; }
constexpr std::int32_t schema_of(const leo_ephemeris_t&) { return wire::kLeoEphemerisSchema; }

// Reads a message of the newest schema. Precondition: counts have been checked.
template <typename T>
InputFault read(ByteSpan bytes, T* message) {
  return read_message(bytes, schema_of(*message), message);
}

// Reads a message whose only array may hold `capacity` elements.
template <typename T>
InputFault read_array(ByteSpan bytes, std::size_t capacity, T* message) {
  const InputFault fault = check_count(bytes, wire::kFirstCountOffset, capacity);
  return fault != InputFault::kNone ? fault : read(bytes, message);
}

template <typename T>
DecodeResult result_of(const T& message, InputFault fault) {
  return {fault, static_cast<std::uint64_t>(message.sequence), 0};
}

// Sorts the observations and removes all that share satellite and signal with another. Returns
// whether there were any.
bool sort_and_drop_copies(RawEpoch* epoch) {
  auto& list = epoch->observations;
  if (!std::is_sorted(list.begin(), list.end(), comes_before)) {
    std::sort(list.begin(), list.end(), comes_before);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list.size();) {
    std::size_t end = i + 1;
    while (end < list.size() && !comes_before(list[i], list[end])) ++end;
    if (end == i + 1) list[kept++] = list[i];
    i = end;
  }
  const bool had_copies = kept != list.size();
  list.resize(kept);
  return had_copies;
}

// Reads a message of at most `capacity` elements that hold at its time. Elements with a fault are
// left out.
template <typename Message, typename Element, typename Values>
DecodeResult decode_elements(ByteSpan bytes, std::size_t capacity, Message* message,
                             const std::vector<Element>& elements, Values* values) {
  message->sequence = 0;
  InputFault fault = read_array(bytes, capacity, message);
  if (fault == InputFault::kNone && !is_time(message->time_ns)) fault = InputFault::kOutOfRange;
  DecodeResult result = result_of(*message, fault);
  if (fault != InputFault::kNone) return result;
  const GpsTime time = GpsTime::from_nanoseconds(message->time_ns);
  values->clear();
  for (const Element& from : elements) {
    typename Values::value_type value;
    const InputFault element = convert(from, time, &value);
    if (element == InputFault::kNone) {
      values->push_back(value);
    } else {
      result.element_faults |= bit(element);
    }
  }
  return result;
}

// Returns the schema of a message whose type depends on it; 0 where the message is too short.
std::int32_t schema_in(ByteSpan bytes) {
  if (bytes.size() < wire::kSchemaOffset + 4) return 0;
  return static_cast<std::int32_t>(wire::read_uint32(bytes, wire::kSchemaOffset));
}

// Reads broadcast elements, those of a LEO satellite or others.
template <typename T>
DecodeResult decode_ephemeris(ByteSpan bytes, Ephemeris* ephemeris) {
  T message{};
  InputFault fault = read(bytes, &message);
  if (fault == InputFault::kNone) {
    Ephemeris converted;
    fault = wire::convert(message, &converted);
    if (fault == InputFault::kNone) *ephemeris = converted;
  }
  return result_of(message, fault);
}

// Reads a checkpoint in one of its versions.
template <typename T>
DecodeResult decode_checkpoint(ByteSpan bytes, Checkpoint* checkpoint) {
  T message{};
  InputFault fault = read(bytes, &message);
  if (fault == InputFault::kNone) fault = wire::convert(message, checkpoint);
  return result_of(message, fault);
}

// Reads a result of the smoother in one of its versions.
template <typename T>
DecodeResult decode_smoother(ByteSpan bytes, SmootherReport* report) {
  T message{};
  InputFault fault = read(bytes, &message);
  if (fault != InputFault::kNone) return result_of(message, fault);
  if (!is_time(message.time_ns) || message.epoch <= 0 || message.iterations < 0) {
    fault = InputFault::kOutOfRange;
  } else {
    report->sequence = static_cast<std::uint64_t>(message.sequence);
    report->index = static_cast<std::uint64_t>(message.epoch);
    report->iterations = message.iterations;
  }
  return result_of(message, fault);
}

}  // namespace

struct Decoder::Storage {
  // Messages are kept between calls, so that their vectors keep their memory.
  gnss_epoch_t gnss_epoch;
  orbit_clock_t orbit_clock;
  corrected_states_t corrected_states;
  biases_t biases;
  antenna_t antenna;
};

Decoder::Decoder() : storage_(std::make_unique<Storage>()) {
  storage_->gnss_epoch.observations.reserve(kMaxObservations);
  storage_->orbit_clock.states.reserve(kMaxEphemerisSatellites);
  storage_->corrected_states.states.reserve(kMaxCorrectedStates);
  storage_->biases.biases.reserve(kMaxBiases);
  storage_->antenna.values_m.reserve(kMaxAntennaValues);
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

DecodeResult Decoder::decode(ByteSpan bytes, OdometerIncrement* increment) {
  odometer_t message{};
  InputFault fault = read(bytes, &message);
  if (fault != InputFault::kNone) return result_of(message, fault);
  if (!is_time(message.time_ns) || message.interval_ns <= 0 ||
      message.interval_ns >= message.time_ns || message.sign_known < 0 || message.sign_known > 1) {
    fault = InputFault::kOutOfRange;
  } else if (!std::isfinite(message.distance_m)) {
    fault = InputFault::kNotFinite;
  } else {
    *increment = {GpsTime::from_nanoseconds(message.time_ns), message.interval_ns,
                  message.distance_m, message.sign_known == 1};
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
  return schema_in(bytes) == wire::kLeoEphemerisSchema
             ? decode_ephemeris<leo_ephemeris_t>(bytes, ephemeris)
             : decode_ephemeris<ephemeris_t>(bytes, ephemeris);
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
  return decode_elements(bytes, kMaxEphemerisSatellites, &message, message.states, states);
}

DecodeResult Decoder::decode(ByteSpan bytes, CorrectedStates* states) {
  corrected_states_t& message = storage_->corrected_states;
  return decode_elements(bytes, kMaxCorrectedStates, &message, message.states, states);
}

DecodeResult Decoder::decode(ByteSpan bytes, SignalBiases* biases) {
  biases_t& message = storage_->biases;
  return decode_elements(bytes, kMaxBiases, &message, message.biases, biases);
}

DecodeResult Decoder::decode(ByteSpan bytes, AntennaPattern* pattern) {
  antenna_t& message = storage_->antenna;
  message.sequence = 0;
  InputFault fault = read_array(bytes, kMaxAntennaValues, &message);
  if (fault == InputFault::kNone && !is_time_or_unset(message.time_ns)) {
    fault = InputFault::kOutOfRange;
  }
  if (fault == InputFault::kNone) fault = convert(message, pattern);
  return result_of(message, fault);
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
    command->sequence = static_cast<std::uint64_t>(std::max<std::int64_t>(message.sequence, 0));
  }
  return result_of(message, fault);
}

DecodeResult Decoder::decode(ByteSpan bytes, Checkpoint* checkpoint) {
  switch (schema_in(bytes)) {
    case 1:
      return decode_checkpoint<checkpoint_v1_t>(bytes, checkpoint);
    case 2:
      return decode_checkpoint<checkpoint_v2_t>(bytes, checkpoint);
    default:
      return decode_checkpoint<checkpoint_t>(bytes, checkpoint);
  }
}

DecodeResult Decoder::decode(ByteSpan bytes, Decision* decision) {
  decision_t message{};
  InputFault fault = read(bytes, &message);
  if (fault != InputFault::kNone) return result_of(message, fault);
  if (!is_time(message.time_ns) || message.epoch <= 0 || message.mailbox < 0 ||
      message.mailbox > 2 || message.committed < 0 || message.committed > 1 ||
      message.iterations < 0) {
    fault = InputFault::kOutOfRange;
  } else {
    decision->sequence = static_cast<std::uint64_t>(message.sequence);
    decision->epoch = static_cast<std::uint64_t>(message.epoch);
    decision->time = GpsTime::from_nanoseconds(message.time_ns);
    decision->subject = static_cast<Decision::Subject>(message.mailbox);
    decision->committed = message.committed == 1;
    decision->iterations = message.iterations;
  }
  return result_of(message, fault);
}

DecodeResult Decoder::decode(ByteSpan bytes, SmootherReport* report) {
  if (output_schema_of(Channel::kSmoother, bytes) == OutputSchema::kFirst)
    return decode_smoother<smoother_v1_t>(bytes, report);
  return decode_smoother<smoother_t>(bytes, report);
}

}  // namespace leonav
