// A u-blox byte stream -> observations, ephemerides and ionosphere coefficients.
// Source: u-blox F9/X20 interface descriptions, UBX-RXM-RAWX version 1, UBX-RXM-SFRBX version 2.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "drivers/ubx/rxm_rawx.h"
#include "drivers/ubx/rxm_sfrbx.h"
#include "drivers/ubx/ubx_framer.h"

namespace leonav {

// Gets what the decoder finds, in the order of the stream.
class UbxHandler {
 public:
  virtual ~UbxHandler() = default;
  virtual void on_epoch(const RawEpoch& epoch) = 0;
  virtual void on_ephemeris(const Ephemeris& ephemeris) = 0;
  virtual void on_klobuchar(const KlobucharModel& model) = 0;
};

struct UbxCounters {
  UbxFramerCounters framer;
  RxmRawxCounters rawx;
  RxmSfrbxCounters sfrbx;
  std::uint64_t other_messages = 0;  // framed, but not one that leonav reads
};

// Streaming: chunks of any size, no recursion, bounded memory. An ephemeris is reported once per
// issue: the receiver repeats the same one every 30 s or so.
class UbxDecoder {
 public:
  explicit UbxDecoder(const RxmRawxOptions& options = {});
  ~UbxDecoder();

  void feed(std::span<const std::uint8_t> bytes, UbxHandler* handler);
  // End of the stream: decodes what a false sync near the end still holds back.
  void finish(UbxHandler* handler);
  UbxCounters counters() const;

 private:
  void drain(UbxHandler* handler);
  void dispatch(const UbxMessage& message, UbxHandler* handler);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
