// The SbfFormat publishes what a Septentrio receiver has measured and received, and the samples of
// its inertial sensor.
#pragma once
#include "drivers/sbf/sbf_decoder.h"
#include "tools/connect/formats/receiver_output.h"
#include "tools/connect/formats/stream_format.h"
#include "tools/import/sbf_samples.h"

namespace leonav {

// The messages are those that leonav-import writes from the same bytes: GNSS_EPOCH of every
// MeasEpoch, EPHEMERIS and IONOSPHERE of the blocks with navigation data, IMU of ExtSensorMeas,
// which has GPS time. Besides, ephemerides are repeated.
class SbfFormat final : public StreamFormat, private SbfHandler {
 public:
  // `is_inertial`: the samples of the inertial sensor are published. `latency_s`: an epoch arrives
  // so long after its time. `repeat_s`: as of EphemerisRepeater. The epochs' arrivals set `clock`.
  // `corrections`, if given, gets the ephemerides too. The pointers must outlive this object.
  SbfFormat(bool is_inertial, double latency_s, double repeat_s, GpsClock* clock,
            MessageOutput* output, CorrectionOutput* corrections = nullptr)
      : is_inertial_(is_inertial),
        latency_s_(latency_s),
        output_(output),
        receiver_(repeat_s, clock, output, corrections) {}

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
  void on_imu(const ExtSensorRates& rates) override;
  std::string inertial_text() const;

  bool is_inertial_;
  double latency_s_;
  MessageOutput* output_;
  ReceiverOutput receiver_;
  SbfDecoder decoder_;
  SbfSamples samples_;
  std::uint64_t sent_samples_ = 0;
  GpsTime last_sample_;
  std::int64_t arrival_ns_ = 0;  // of the bytes at hand
};

}  // namespace leonav
