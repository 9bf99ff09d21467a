// The XsensFormat publishes the samples of an Xsens sensor.
#pragma once
#include "drivers/binary/wrapped_counter.h"
#include "drivers/xsens/xsens_decoder.h"
#include "tools/connect/formats/inertial/imu_format.h"

namespace leonav {

// The sensor's axes, x forward, y left, z up, become forward, right, down. Its clock is
// SampleTimeFine, continued where it wraps.
class XsensFormat final : public ImuFormat, private XsensHandler {
 public:
  using ImuFormat::ImuFormat;

  void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  void finish() override { decoder_.finish(this); }
  FormatCounts counts() const override;
  std::string detail() const override;
  std::string why_no_frames() const override;
  std::string why_no_messages() const override;

 private:
  void on_measurement(const XsensMeasurement& measurement) override;
  // Whether increments hold the whole motion. Where DeltaQ and DeltaV come at different rates, one
  // of them lies in other messages as well.
  bool are_whole();

  XsensDecoder decoder_;
  std::uint64_t unpaired_ = 0;
  int until_trust_ = 0;  // so many measurements more
  WrappedCounter sample_time_{32};
  std::int64_t arrival_ns_ = 0;  // of the bytes at hand
};

}  // namespace leonav
