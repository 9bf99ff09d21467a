// The Oem7Format publishes what a NovAtel receiver has measured and received, and the samples of
// its inertial sensor.
#pragma once
#include "drivers/oem7/oem7_decoder.h"
#include "tools/connect/formats/outputs/receiver_output.h"
#include "tools/connect/formats/receivers/oem7_options.h"
#include "tools/connect/formats/stream_format.h"
#include "tools/import/oem7_samples.h"

namespace leonav {

// The messages are those that leonav-import writes from the same bytes: GNSS_EPOCH of every range
// log, EPHEMERIS and IONOSPHERE of the logs with navigation data, IMU of RAWIMU and its relatives,
// which have GPS time. Besides, what navigation messages gave is repeated.
class Oem7Format final : public StreamFormat, private Oem7Handler {
 public:
  // `latency_s`: an epoch arrives so long after its time. `repeat_s`: as of NavigationRepeater. The
  // epochs' arrivals set `clock`; `corrections`: as of ReceiverOutput. The pointers must outlive
  // this object.
  Oem7Format(const Oem7StreamOptions& options, double latency_s, double repeat_s, GpsClock* clock,
             MessageOutput* output, CorrectionOutput* corrections = nullptr)
      : options_(options),
        latency_s_(latency_s),
        output_(output),
        receiver_(repeat_s, clock, output, corrections, ephemeris_remedy),
        decoder_({options.imu_scale}) {}

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
  void on_imu(const RawImuIncrements& increments) override;
  std::string inertial_text() const;

  Oem7StreamOptions options_;
  double latency_s_;
  MessageOutput* output_;
  ReceiverOutput receiver_;
  Oem7Decoder decoder_;
  Oem7Samples samples_;
  std::uint64_t sent_samples_ = 0;
  GpsTime last_sample_;
  std::int64_t arrival_ns_ = 0;  // of the bytes at hand
};

}  // namespace leonav
