#include "drivers/oem7/oem7_decoder.h"

#include <vector>

#include "drivers/binary/reported_ephemerides.h"
#include "drivers/oem7/ephemeris_logs.h"
#include "drivers/oem7/range_logs.h"
#include "drivers/oem7/rangecmp2.h"
#include "drivers/oem7/rangecmp4.h"

namespace leonav {
namespace {

constexpr std::uint16_t kGpsephem = 7, kIonutc = 8, kRawephem = 41, kRange = 43, kRangecmp = 140;
constexpr std::uint16_t kGalephemeris = 1122, kRangecmp2 = 1273, kGalinavephemeris = 1309;
constexpr std::uint16_t kGalfnavephemeris = 1310, kBdsephemeris = 1696;
constexpr std::uint16_t kInsconfig = 1945, kRangecmp4 = 2050;
constexpr std::uint8_t kSecondAntenna = 1;

}  // namespace

struct Oem7Decoder::State {
  explicit State(const Oem7Options& options) : imu(options.imu_scale) {}

  void give(EphemerisStatus status, const Ephemeris& ephemeris, Oem7Handler* handler);
  void give(const Ephemeris& ephemeris, Oem7Handler* handler);
  void give_galileo(std::span<const std::uint8_t> payload, GpsTime now, Oem7Handler* handler);
  void give_ionosphere(std::span<const std::uint8_t> payload, Oem7Handler* handler);

  Oem7Framer framer;
  RangecmpFour rangecmp4;
  RangeEpochs epochs;
  RawImuReader imu;
  ReportedEphemerides reported;
  KlobucharModel klobuchar;  // the last one given out
  bool has_rawephem = false;
  std::vector<RangeMeasurement> measurements;  // of the log at hand
  RawEpoch epoch;                              // kept here: too large for a stack of unknown size
  Oem7RangeCounters ranges;
  Oem7EphemerisCounters ephemerides;
  std::uint64_t second_antenna = 0, responses = 0;
  std::map<std::uint16_t, std::uint64_t> unused;
};

void Oem7Decoder::State::give(const Ephemeris& ephemeris, Oem7Handler* handler) {
  if (!reported.is_new(ephemeris)) {
    ++ephemerides.repeated;
    return;
  }
  ++ephemerides.ephemerides;
  handler->on_ephemeris(ephemeris);
}

void Oem7Decoder::State::give(EphemerisStatus status, const Ephemeris& ephemeris,
                              Oem7Handler* handler) {
  if (ephemerides.count(status)) give(ephemeris, handler);
}

void Oem7Decoder::State::give_galileo(std::span<const std::uint8_t> payload, GpsTime now,
                                      Oem7Handler* handler) {
  GalileoSets sets;
  if (!ephemerides.count(read_galephemeris(payload, now, &sets))) return;
  if (sets.inav) give(*sets.inav, handler);
  if (sets.fnav) give(*sets.fnav, handler);
}

void Oem7Decoder::State::give_ionosphere(std::span<const std::uint8_t> payload,
                                         Oem7Handler* handler) {
  const std::optional<KlobucharModel> model = read_ionutc(payload);
  if (!model) {
    ++ephemerides.bad_ionosphere;
  } else if (*model != klobuchar) {
    klobuchar = *model;
    handler->on_klobuchar(*model);
  }
}

Oem7Decoder::Oem7Decoder(const Oem7Options& options) : state_(std::make_unique<State>(options)) {}
Oem7Decoder::~Oem7Decoder() = default;

void Oem7Decoder::feed(std::span<const std::uint8_t> bytes, Oem7Handler* handler) {
  while (!bytes.empty()) {
    bytes = bytes.subspan(state_->framer.append(bytes));
    drain(handler);
  }
}

void Oem7Decoder::finish(Oem7Handler* handler) {
  state_->framer.finish();
  drain(handler);
}

void Oem7Decoder::drain(Oem7Handler* handler) {
  Oem7Message message;
  while (state_->framer.next(&message)) dispatch(message, handler);
}

void Oem7Decoder::dispatch(const Oem7Message& message, Oem7Handler* handler) {
  if (message.is_response) {
    ++state_->responses;
  } else if (message.source == kSecondAntenna) {
    ++state_->second_antenna;
  } else if (!take_ranges(message, handler) && !take_navigation(message, handler) &&
             !take_imu(message, handler)) {
    ++state_->unused[message.id];
  }
}

// Returns whether the message is a range log.
bool Oem7Decoder::take_ranges(const Oem7Message& message, Oem7Handler* handler) {
  State& s = *state_;
  RangeStatus status;
  switch (message.id) {
    case kRange:
      status = read_range(message.payload, &s.measurements);
      break;
    case kRangecmp:
      status = read_rangecmp(message.payload, &s.measurements);
      break;
    case kRangecmp2:
      status = read_rangecmp2(message.payload, &s.measurements);
      break;
    case kRangecmp4:
      status = s.rangecmp4.read(message.payload, message.time, &s.measurements);
      break;
    default:
      return false;
  }
  if (status != RangeStatus::kOk) {
    ++s.ranges.bad_length;
  } else if (!message.time.is_set()) {
    ++s.ranges.without_time;
  } else if (s.epochs.assemble(message.time, s.measurements, &s.epoch)) {
    handler->on_epoch(s.epoch);
  }
  return true;
}

// Returns whether the message is a log of navigation data. RAWEPHEM holds every bit that GPSEPHEM
// holds as decimals, so that the second is left out once the first has come.
bool Oem7Decoder::take_navigation(const Oem7Message& message, Oem7Handler* handler) {
  State& s = *state_;
  const bool is_ephemeris = message.id == kRawephem || message.id == kGpsephem ||
                            message.id == kGalephemeris || message.id == kGalinavephemeris ||
                            message.id == kGalfnavephemeris || message.id == kBdsephemeris;
  if (is_ephemeris && !message.time.is_set()) {
    ++s.ephemerides.without_time;
    return true;
  }
  Ephemeris e;
  switch (message.id) {
    case kRawephem:
      s.has_rawephem = true;
      s.give(read_rawephem(message.payload, message.time, &e), e, handler);
      return true;
    case kGpsephem:
      if (s.has_rawephem) {
        ++s.ephemerides.repeated;
      } else {
        s.give(read_gpsephem(message.payload, message.time, &e), e, handler);
      }
      return true;
    case kGalephemeris:
      s.give_galileo(message.payload, message.time, handler);
      return true;
    case kGalinavephemeris:
      s.give(read_galinavephemeris(message.payload, message.time, &e), e, handler);
      return true;
    case kGalfnavephemeris:
      s.give(read_galfnavephemeris(message.payload, message.time, &e), e, handler);
      return true;
    case kBdsephemeris:
      s.give(read_bdsephemeris(message.payload, message.time, &e), e, handler);
      return true;
    case kIonutc:
      s.give_ionosphere(message.payload, handler);
      return true;
    default:
      return false;
  }
}

// Returns whether the message is of the inertial sensor.
bool Oem7Decoder::take_imu(const Oem7Message& message, Oem7Handler* handler) {
  if (message.id == kInsconfig) {
    state_->imu.take_insconfig(message.payload);
    return true;
  }
  if (!RawImuReader::is_raw_imu(message.id)) return false;
  const auto increments = state_->imu.read(message.id, message.payload);
  if (increments) handler->on_imu(*increments);
  return true;
}

Oem7Counters Oem7Decoder::counters() const {
  const State& s = *state_;
  Oem7Counters counters{s.framer.counters(), s.ranges,         s.epochs.counters(),
                        s.ephemerides,       s.imu.counters(), s.second_antenna,
                        s.responses,         s.unused,         s.epochs.losses()};
  counters.ranges.without_reference = s.rangecmp4.without_reference();
  return counters;
}

}  // namespace leonav
