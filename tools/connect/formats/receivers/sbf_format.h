// The SbfFormat publishes what a Septentrio receiver has measured and received, what Galileo HAS
// and PPP-B2b make of it, and the samples of its inertial sensor.
#pragma once
#include "drivers/sbf/sbf_decoder.h"
#include "tools/connect/formats/outputs/receiver_output.h"
#include "tools/connect/formats/pages/received_pages.h"
#include "tools/connect/formats/receivers/sbf_options.h"
#include "tools/connect/formats/stream_format.h"
#include "tools/import/sbf_samples.h"

namespace leonav {

// The messages are those that leonav-import writes from the same bytes: GNSS_EPOCH of every
// MeasEpoch, EPHEMERIS, IONOSPHERE and BIASES of the blocks with navigation data, CORRECTED_STATES
// and BIASES of the pages in GALRawCNAV and BDSRawB2b, IMU of ExtSensorMeas, which has GPS time.
// Besides, what navigation messages gave is repeated.
class SbfFormat final : public StreamFormat, private SbfHandler {
 public:
  // `latency_s`: an epoch arrives so long after its time. `repeat_s`: as of NavigationRepeater. The
  // epochs' arrivals set `clock`. `corrections`, if given, gets the ephemerides too; it must be
  // given where the options use pages. The pointers must outlive this object.
  SbfFormat(const SbfStreamOptions& options, double latency_s, double repeat_s, GpsClock* clock,
            MessageOutput* output, CorrectionOutput* corrections = nullptr)
      : options_(options),
        latency_s_(latency_s),
        output_(output),
        receiver_(repeat_s, clock, output, corrections, ephemeris_remedy),
        pages_(options.uses_pages, corrections) {}

  void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  void finish() override { decoder_.finish(this); }
  FormatCounts counts() const override;
  std::optional<DataTime> data_time() const override;
  std::string detail() const override;
  std::string why_no_frames() const override;
  std::string why_no_messages() const override;
  std::string why_no_samples() const override { return inertial_text(); }
  std::vector<FormatNews> take_news() override { return warnings_of({receiver_.take_news()}); }

 private:
  static const char* ephemeris_remedy(System system);
  void on_epoch(const RawEpoch& epoch) override;
  void on_ephemeris(const Ephemeris& ephemeris) override;
  void on_klobuchar(const KlobucharModel& model) override;
  void on_biases(const std::vector<SignalBias>& biases) override { receiver_.send(biases); }
  void on_page(const CorrectionPage& page) override { pages_.take(page); }
  void on_imu(const ExtSensorRates& rates) override;
  std::string inertial_text() const;

  SbfStreamOptions options_;
  double latency_s_;
  MessageOutput* output_;
  ReceiverOutput receiver_;
  ReceivedPages pages_;
  SbfDecoder decoder_;
  SbfSamples samples_;
  std::uint64_t sent_samples_ = 0;
  GpsTime last_sample_;
  std::int64_t arrival_ns_ = 0;  // of the bytes at hand
};

}  // namespace leonav
