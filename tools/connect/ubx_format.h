// The UbxFormat publishes a u-blox receiver's raw measurements and broadcast ephemerides.
#pragma once
#include "drivers/ubx/ubx_decoder.h"
#include "tools/connect/ephemeris_repeater.h"
#include "tools/connect/gps_clock.h"
#include "tools/connect/message_output.h"
#include "tools/connect/stream_format.h"

namespace leonav {

// The messages are those that leonav-import writes from the same bytes: GNSS_EPOCH of every
// UBX-RXM-RAWX; EPHEMERIS and IONOSPHERE as UBX-RXM-SFRBX completes them. Besides, ephemerides are
// repeated.
class UbxFormat final : public StreamFormat, private UbxHandler {
 public:
  // `latency_s`: an epoch arrives so long after its time. `repeat_s`: as of EphemerisRepeater. The
  // epochs' arrivals set `clock`. Both pointers must outlive this object.
  UbxFormat(double latency_s, double repeat_s, GpsClock* clock, MessageOutput* output)
      : latency_s_(latency_s), clock_(clock), output_(output), repeater_(repeat_s, output) {}

  void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  void finish() override { decoder_.finish(this); }
  FormatCounts counts() const override;
  std::optional<DataTime> data_time() const override;
  std::string detail() const override;
  std::string why_no_frames() const override;
  std::string why_no_messages() const override;

 private:
  void on_epoch(const RawEpoch& epoch) override;
  void on_ephemeris(const Ephemeris& ephemeris) override;
  void on_klobuchar(const KlobucharModel& model) override;

  double latency_s_;
  GpsClock* clock_;
  MessageOutput* output_;
  EphemerisRepeater repeater_;
  UbxDecoder decoder_;
  std::int64_t arrival_ns_ = 0;  // of the bytes at hand
  GpsTime last_epoch_;
  std::size_t last_signals_ = 0;
  std::uint64_t messages_ = 0, ephemerides_ = 0;
};

}  // namespace leonav
