#include "drivers/rtcm3/rtcm3_decoder.h"

#include "drivers/binary/reported_ephemerides.h"
#include "drivers/rtcm3/broadcast_ephemeris.h"

namespace leonav {

struct Rtcm3Decoder::State {
  Rtcm3Framer framer;
  EpochAssembly assembly;
  ReportedEphemerides reported;
  GpsTime near;      // what times are completed with: the reference, then the last epoch's time
  GpsTime received;  // when the present message came; unset: not known
  Rtcm3EphemerisCounters ephemerides;
  Rtcm3SsrCounters ssr;
  std::uint64_t station_messages = 0, damaged_station_messages = 0;
  std::map<std::uint16_t, std::uint64_t> unused;
};

Rtcm3Decoder::Rtcm3Decoder(const Rtcm3Options& options) : state_(std::make_unique<State>()) {
  state_->near = options.reference;
}
Rtcm3Decoder::~Rtcm3Decoder() = default;

void Rtcm3Decoder::tell_time(GpsTime now) {
  state_->near = now;
  state_->received = now;
}

void Rtcm3Decoder::tell_week(GpsTime near) {
  state_->near = near;
  state_->received = {};
}

void Rtcm3Decoder::allow_other_station() { state_->assembly.allow_other_station(); }

void Rtcm3Decoder::feed(std::span<const std::uint8_t> bytes, Rtcm3Handler* handler) {
  while (!bytes.empty()) {
    bytes = bytes.subspan(state_->framer.append(bytes));
    drain(handler);
  }
}

void Rtcm3Decoder::finish(Rtcm3Handler* handler) {
  state_->framer.finish();
  drain(handler);
  state_->assembly.finish([&](const RawEpoch& epoch) { take_epoch(epoch, handler); });
}

void Rtcm3Decoder::drain(Rtcm3Handler* handler) {
  Rtcm3Frame frame;
  while (state_->framer.next(&frame)) dispatch(frame, handler);
}

void Rtcm3Decoder::dispatch(const Rtcm3Frame& frame, Rtcm3Handler* handler) {
  const std::optional<MsmType> msm = msm_type(frame.type);
  if (msm) {
    // The message of a system that is not used still ends epochs, but is none that was read.
    if (!msm->system) ++state_->unused[frame.type];
    state_->assembly.take(*msm, frame.message, state_->near,
                          [&](const RawEpoch& epoch) { take_epoch(epoch, handler); });
  } else if (is_broadcast_ephemeris(frame.type)) {
    take_ephemeris(frame, handler);
  } else if (const std::optional<SsrType> ssr = ssr_type(frame.type, frame.message)) {
    take_ssr(*ssr, frame, handler);
  } else if (!take_station(frame, handler)) {
    ++state_->unused[frame.type];
  }
}

void Rtcm3Decoder::take_epoch(const RawEpoch& epoch, Rtcm3Handler* handler) {
  state_->near = epoch.time;
  state_->received = epoch.time;
  handler->on_epoch(epoch);
}

void Rtcm3Decoder::take_ephemeris(const Rtcm3Frame& frame, Rtcm3Handler* handler) {
  Rtcm3EphemerisCounters& counters = state_->ephemerides;
  if (!state_->near.is_set()) {
    ++counters.without_reference;
    return;
  }
  Ephemeris ephemeris;
  GpsTime stated_toe;
  const EphemerisStatus status =
      decode_ephemeris(frame.type, frame.message, state_->near, &ephemeris, &stated_toe);
  if (stated_toe.is_set()) {
    const bool is_other = is_of_other_week(stated_toe, state_->near);
    counters.other_week_in_row = is_other ? counters.other_week_in_row + 1 : 0;
  }
  if (!counters.count(status)) return;
  handler->on_stated_toe(stated_toe);
  if (!state_->reported.is_new(ephemeris)) {
    ++counters.repeated;
    return;
  }
  ephemeris.transmission_time = state_->received;
  ++counters.ephemerides;
  handler->on_ephemeris(ephemeris);
}

void Rtcm3Decoder::take_ssr(const SsrType& type, const Rtcm3Frame& frame, Rtcm3Handler* handler) {
  Rtcm3SsrCounters& counters = state_->ssr;
  if (!state_->near.is_set()) {
    ++counters.without_reference;
    return;
  }
  SsrMessage message;
  switch (read_ssr(type, frame.message, state_->near, &message, &counters.left_out)) {
    case SsrStatus::kBadLength:
      ++counters.bad_length;
      return;
    case SsrStatus::kBadTime:
      ++counters.bad_time;
      return;
    case SsrStatus::kOk:
      break;
  }
  ++counters.messages;
  handler->on_ssr(message);
}

// Returns whether it is a message of the station.
bool Rtcm3Decoder::take_station(const Rtcm3Frame& frame, Rtcm3Handler* handler) {
  bool is_whole = false;
  if (is_station_position(frame.type)) {
    const auto position = read_station_position(frame.type, frame.message);
    is_whole = position.has_value();
    if (position) handler->on_station_position(*position);
  } else if (is_station_equipment(frame.type)) {
    const auto equipment = read_station_equipment(frame.type, frame.message);
    is_whole = equipment.has_value();
    if (equipment) handler->on_station_equipment(*equipment);
  } else {
    return false;
  }
  ++(is_whole ? state_->station_messages : state_->damaged_station_messages);
  return true;
}

Rtcm3Counters Rtcm3Decoder::counters() const {
  Rtcm3Counters counters;
  counters.framer = state_->framer.counters();
  counters.epochs = state_->assembly.counters();
  counters.measurements = state_->assembly.measurement_counters();
  counters.losses = state_->assembly.losses();
  counters.ephemerides = state_->ephemerides;
  counters.ssr = state_->ssr;
  counters.station_messages = state_->station_messages;
  counters.damaged_station_messages = state_->damaged_station_messages;
  counters.unused = state_->unused;
  return counters;
}

}  // namespace leonav
