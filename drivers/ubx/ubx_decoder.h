// This unit decodes a u-blox byte stream to observations, ephemerides, ionosphere coefficients,
// group delays, pages of corrections, inertial readings and time marks. Source: u-blox F9/X20
// interface descriptions, UBX-RXM-RAWX version 1, UBX-RXM-SFRBX version 2, UBX-ESF-MEAS,
// UBX-ESF-RAW, UBX-TIM-TM2.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/signals/observation.h"
#include "drivers/binary/correction_page.h"
#include "drivers/ubx/esf_decoder.h"
#include "drivers/ubx/rxm_rawx.h"
#include "drivers/ubx/rxm_sfrbx.h"
#include "drivers/ubx/tim_tm2.h"
#include "drivers/ubx/ubx_framer.h"

namespace leonav {

// The handler gets the decoder's results in the order of the stream.
class UbxHandler {
 public:
  virtual ~UbxHandler() = default;
  virtual void on_epoch(const RawEpoch& epoch) = 0;
  virtual void on_ephemeris(const Ephemeris& ephemeris) = 0;
  virtual void on_klobuchar(const KlobucharModel& model) = 0;
  // Group delays of one satellite; a page of Galileo HAS, received at the time of the last epoch;
  // readings of a receiver with an inertial sensor; pulses at its inputs. Who does not need one
  // leaves it as it is.
  virtual void on_biases(const std::vector<SignalBias>& /*biases*/) {}
  virtual void on_page(const CorrectionPage& /*page*/) {}
  virtual void on_inertial(const EsfReading& /*reading*/) {}
  virtual void on_time_mark(const TimeMark& /*mark*/) {}
};

// Counts of all parts of the decoder.
struct UbxCounters {
  UbxFramerCounters framer;
  RxmRawxCounters rawx;
  RxmSfrbxCounters sfrbx;
  EsfCounters esf;
  TimTm2Counters time_marks;
  std::uint64_t other_messages = 0;  // framed, but not one that leonav reads
};

// The decoder streams: chunks of any size, no recursion, bounded memory. An ephemeris is reported
// once per issue, although the receiver repeats it every 30 s or so.
class UbxDecoder {
 public:
  explicit UbxDecoder(const RxmRawxOptions& options = {});
  ~UbxDecoder();

  void feed(std::span<const std::uint8_t> bytes, UbxHandler* handler);
  // The time of the last RAWX is too long ago to be that of the next subframes: they are counted as
  // without time until a RAWX comes. Who knows when bytes arrive calls it.
  void forget_time();
  // Ends the stream and decodes the bytes that a false sync near the end still holds back.
  void finish(UbxHandler* handler);
  UbxCounters counters() const;

 private:
  void drain(UbxHandler* handler);
  void dispatch(const UbxMessage& message, UbxHandler* handler);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
