#include "drivers/ubx/ubx_decoder.h"

namespace leonav {
namespace {

constexpr std::uint8_t kClassRxm = 0x02;
constexpr std::uint8_t kIdSfrbx = 0x13;
constexpr std::uint8_t kIdRawx = 0x15;
constexpr std::uint8_t kClassTim = 0x0D, kIdTm2 = 0x03;
constexpr std::uint8_t kClassEsf = 0x10, kIdMeas = 0x02, kIdRaw = 0x03;

}  // namespace

struct UbxDecoder::State {
  explicit State(const RxmRawxOptions& options) : rawx(options) {}

  UbxFramer framer;
  RxmRawxDecoder rawx;
  RxmSfrbxDecoder sfrbx;
  EsfDecoder esf;
  TimTm2Decoder time_marks;
  RawEpoch epoch;  // kept here: too large for a stack of unknown size
  GpsTime now;     // of the last RAWX
  std::uint64_t other_messages = 0;
};

UbxDecoder::UbxDecoder(const RxmRawxOptions& options) : state_(std::make_unique<State>(options)) {}
UbxDecoder::~UbxDecoder() = default;

void UbxDecoder::feed(std::span<const std::uint8_t> bytes, UbxHandler* handler) {
  while (!bytes.empty()) {
    bytes = bytes.subspan(state_->framer.append(bytes));
    drain(handler);
  }
}

void UbxDecoder::forget_time() { state_->now = {}; }

void UbxDecoder::finish(UbxHandler* handler) {
  state_->framer.finish();
  drain(handler);
}

void UbxDecoder::drain(UbxHandler* handler) {
  UbxMessage message;
  while (state_->framer.next(&message)) dispatch(message, handler);
}

void UbxDecoder::dispatch(const UbxMessage& message, UbxHandler* handler) {
  if (message.message_class == kClassRxm && message.id == kIdRawx) {
    if (state_->rawx.decode(message.payload, &state_->epoch) != RxmRawxStatus::kOk) return;
    state_->now = state_->epoch.time;
    handler->on_epoch(state_->epoch);
  } else if (message.message_class == kClassRxm && message.id == kIdSfrbx) {
    const NavigationUpdate update = state_->sfrbx.decode(message.payload, state_->now);
    if (update.ephemeris) handler->on_ephemeris(*update.ephemeris);
    if (update.klobuchar) handler->on_klobuchar(*update.klobuchar);
    if (update.page) handler->on_page(*update.page);
    if (!update.biases.empty()) handler->on_biases(update.biases);
  } else if (message.message_class == kClassEsf && message.id == kIdMeas) {
    state_->esf.decode_meas(message.payload,
                            [handler](const EsfReading& r) { handler->on_inertial(r); });
  } else if (message.message_class == kClassEsf && message.id == kIdRaw) {
    state_->esf.decode_raw(message.payload,
                           [handler](const EsfReading& r) { handler->on_inertial(r); });
  } else if (message.message_class == kClassTim && message.id == kIdTm2) {
    if (const auto mark = state_->time_marks.decode(message.payload)) handler->on_time_mark(*mark);
  } else {
    ++state_->other_messages;
  }
}

UbxCounters UbxDecoder::counters() const {
  return {state_->framer.counters(), state_->rawx.counters(),       state_->sfrbx.counters(),
          state_->esf.counters(),    state_->time_marks.counters(), state_->other_messages};
}

}  // namespace leonav
