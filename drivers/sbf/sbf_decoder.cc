#include "drivers/sbf/sbf_decoder.h"

#include <vector>

#include "drivers/sbf/decoded_navigation.h"
#include "drivers/sbf/meas_epoch.h"

namespace leonav {
namespace {

constexpr std::uint16_t kMeasEpoch = 4027, kExtSensorMeas = 4050;
constexpr std::uint16_t kGpsNav = 5891, kGalNav = 4002, kBdsNav = 4081, kGpsIon = 5893;

}  // namespace

struct SbfDecoder::State {
  void give(const KlobucharModel& model, SbfHandler* handler);
  void give(EphemerisStatus status, const Ephemeris& ephemeris, SbfHandler* handler);

  SbfFramer framer;
  RangeEpochs epochs;
  NavigationCollector navigation;
  RawNavigationReader raw;
  ExtSensorReader imu;
  KlobucharModel klobuchar;                    // the last one given out
  std::vector<RangeMeasurement> measurements;  // of the block at hand
  RawEpoch epoch;                              // kept here: too large for a stack of unknown size
  MeasEpochCounters counters;
  DecodedNavigationCounters decoded;
  std::map<std::uint16_t, std::uint64_t> unused;
};

void SbfDecoder::State::give(const KlobucharModel& model, SbfHandler* handler) {
  if (model == klobuchar) return;
  klobuchar = model;
  handler->on_klobuchar(model);
}

void SbfDecoder::State::give(EphemerisStatus status, const Ephemeris& ephemeris,
                             SbfHandler* handler) {
  if (!decoded.count(status)) return;
  if (raw.has(ephemeris)) {
    ++decoded.beside_raw;
  } else if (navigation.take_decoded(ephemeris)) {
    handler->on_ephemeris(ephemeris);
  }
}

SbfDecoder::SbfDecoder() : state_(std::make_unique<State>()) {}
SbfDecoder::~SbfDecoder() = default;

void SbfDecoder::feed(std::span<const std::uint8_t> bytes, SbfHandler* handler) {
  while (!bytes.empty()) {
    bytes = bytes.subspan(state_->framer.append(bytes));
    drain(handler);
  }
}

void SbfDecoder::finish(SbfHandler* handler) {
  state_->framer.finish();
  drain(handler);
}

void SbfDecoder::drain(SbfHandler* handler) {
  SbfBlock block;
  while (state_->framer.next(&block)) dispatch(block, handler);
}

void SbfDecoder::dispatch(const SbfBlock& block, SbfHandler* handler) {
  if (block.number == kMeasEpoch) {
    take_measurements(block, handler);
  } else if (RawNavigationReader::is_raw_navigation(block.number)) {
    take_raw_navigation(block, handler);
  } else if (block.number == kExtSensorMeas) {
    const auto rates = state_->imu.read(block.time, block.payload);
    if (rates) handler->on_imu(*rates);
  } else if (!take_decoded_navigation(block, handler)) {
    ++state_->unused[block.number];
  }
}

void SbfDecoder::take_measurements(const SbfBlock& block, SbfHandler* handler) {
  State& s = *state_;
  switch (read_meas_epoch(block.payload, &s.measurements, &s.counters.other_antennas)) {
    case MeasEpochStatus::kBadLength:
      ++s.counters.bad_length;
      return;
    case MeasEpochStatus::kScrambled:
      ++s.counters.scrambled;
      return;
    case MeasEpochStatus::kOk:
      break;
  }
  if (!block.time.is_set()) {
    ++s.counters.without_time;
  } else if (s.epochs.assemble(block.time, s.measurements, &s.epoch)) {
    handler->on_epoch(s.epoch);
  }
}

void SbfDecoder::take_raw_navigation(const SbfBlock& block, SbfHandler* handler) {
  State& s = *state_;
  const NavigationUpdate update =
      s.raw.read(block.number, block.time, block.payload, &s.navigation);
  if (update.ephemeris) handler->on_ephemeris(*update.ephemeris);
  if (update.klobuchar) s.give(*update.klobuchar, handler);
  if (!update.biases.empty()) handler->on_biases(update.biases);
  if (update.page) handler->on_page(*update.page);
}

// Returns whether the block holds navigation data that the receiver has decoded.
bool SbfDecoder::take_decoded_navigation(const SbfBlock& block, SbfHandler* handler) {
  State& s = *state_;
  const bool is_ephemeris =
      block.number == kGpsNav || block.number == kGalNav || block.number == kBdsNav;
  if (is_ephemeris && !block.time.is_set()) {
    ++s.decoded.without_time;
    return true;
  }
  Ephemeris e;
  switch (block.number) {
    case kGpsNav:
      s.give(read_gpsnav(block.payload, block.time, &e), e, handler);
      return true;
    case kGalNav:
      s.give(read_galnav(block.payload, block.time, &e), e, handler);
      return true;
    case kBdsNav:
      s.give(read_bdsnav(block.payload, block.time, &e), e, handler);
      return true;
    case kGpsIon:
      if (const auto model = read_gpsion(block.payload)) {
        s.give(*model, handler);
      } else {
        ++s.decoded.bad_ionosphere;
      }
      return true;
    default:
      return false;
  }
}

SbfCounters SbfDecoder::counters() const {
  const State& s = *state_;
  return {s.framer.counters(),     s.counters,       s.epochs.counters(),
          s.navigation.counters(), s.raw.counters(), s.decoded,
          s.imu.counters(),        s.unused,         s.epochs.losses()};
}

}  // namespace leonav
