// The UbxFormat publishes a u-blox receiver's raw measurements and broadcast ephemerides, and what
// Galileo's High Accuracy Service makes of these.
#pragma once
#include "drivers/ubx/ubx_decoder.h"
#include "tools/connect/formats/receiver_output.h"
#include "tools/connect/formats/stream_format.h"
#include "tools/import/page_decoder.h"

namespace leonav {

// The messages are those that leonav-import writes from the same bytes: GNSS_EPOCH of every
// UBX-RXM-RAWX; EPHEMERIS and IONOSPHERE as UBX-RXM-SFRBX completes them; CORRECTED_STATES and
// BIASES of the pages of E6-B. Besides, ephemerides are repeated.
class UbxFormat final : public StreamFormat, private UbxHandler {
 public:
  // `latency_s`: an epoch arrives so long after its time. `repeat_s`: as of EphemerisRepeater. The
  // epochs' arrivals set `clock`; `corrections`: as of ReceiverOutput. With `uses_pages` it gets
  // the corrections that the receiver receives, too, and must be given. The pointers must outlive
  // this object.
  UbxFormat(double latency_s, double repeat_s, GpsClock* clock, MessageOutput* output,
            CorrectionOutput* corrections = nullptr, bool uses_pages = false)
      : latency_s_(latency_s),
        uses_pages_(uses_pages),
        corrections_(corrections),
        receiver_(repeat_s, clock, output, corrections) {}

  void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  void finish() override { decoder_.finish(this); }
  FormatCounts counts() const override;
  std::optional<DataTime> data_time() const override { return receiver_.data_time(); }
  std::string detail() const override;
  std::string why_no_frames() const override;
  std::string why_no_messages() const override;

 private:
  void on_epoch(const RawEpoch& epoch) override;
  void on_ephemeris(const Ephemeris& ephemeris) override;
  void on_klobuchar(const KlobucharModel& model) override;
  void on_page(const CorrectionPage& page) override;

  double latency_s_;
  bool uses_pages_;
  CorrectionOutput* corrections_;
  ReceiverOutput receiver_;
  UbxDecoder decoder_;
  PageDecoder pages_;
  std::uint64_t published_corrections_ = 0;
  std::int64_t arrival_ns_ = 0;  // of the bytes at hand
};

}  // namespace leonav
