// The UbxFormat publishes a u-blox receiver's raw measurements and broadcast ephemerides.
#pragma once
#include "drivers/ubx/ubx_decoder.h"
#include "tools/connect/formats/receiver_output.h"
#include "tools/connect/formats/stream_format.h"

namespace leonav {

// The messages are those that leonav-import writes from the same bytes: GNSS_EPOCH of every
// UBX-RXM-RAWX; EPHEMERIS, IONOSPHERE and BIASES as UBX-RXM-SFRBX completes them. Besides,
// ephemerides are repeated.
class UbxFormat final : public StreamFormat, private UbxHandler {
 public:
  // `latency_s`: an epoch arrives so long after its time. `repeat_s`: as of EphemerisRepeater. The
  // epochs' arrivals set `clock`; `corrections`: as of ReceiverOutput. The pointers must outlive
  // this object.
  UbxFormat(double latency_s, double repeat_s, GpsClock* clock, MessageOutput* output,
            CorrectionOutput* corrections = nullptr)
      : latency_s_(latency_s), receiver_(repeat_s, clock, output, corrections) {}

  void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  void finish() override { decoder_.finish(this); }
  FormatCounts counts() const override;
  std::optional<DataTime> data_time() const override { return receiver_.data_time(); }
  std::string detail() const override { return receiver_.detail(); }
  std::string why_no_frames() const override;
  std::string why_no_messages() const override;

 private:
  void on_epoch(const RawEpoch& epoch) override;
  void on_ephemeris(const Ephemeris& ephemeris) override;
  void on_klobuchar(const KlobucharModel& model) override;
  void on_biases(const std::vector<SignalBias>& biases) override;

  double latency_s_;
  ReceiverOutput receiver_;
  UbxDecoder decoder_;
  std::int64_t arrival_ns_ = 0;  // of the bytes at hand
};

}  // namespace leonav
