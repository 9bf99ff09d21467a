// The VectornavFormat publishes the samples of a VectorNav sensor.
#pragma once
#include "drivers/vectornav/vectornav_decoder.h"
#include "tools/connect/formats/inertial/imu_format.h"

namespace leonav {

class VectornavFormat final : public ImuFormat, private VectornavHandler {
 public:
  using ImuFormat::ImuFormat;

  void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  void finish() override { decoder_.finish(this); }
  FormatCounts counts() const override;
  std::string why_no_frames() const override;
  std::string why_no_messages() const override;

 private:
  void on_measurement(const VectornavMeasurement& measurement) override;

  VectornavDecoder decoder_;
  std::int64_t arrival_ns_ = 0;               // of the bytes at hand
  std::uint64_t text_bytes_ = 0, bytes_ = 0;  // printable, and all
};

}  // namespace leonav
