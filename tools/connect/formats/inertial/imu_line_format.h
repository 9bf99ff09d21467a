// The ImuLineFormat publishes the samples of a sensor that writes text.
#pragma once
#include <utility>

#include "drivers/imu_line/imu_line_decoder.h"
#include "tools/connect/formats/inertial/imu_format.h"

namespace leonav {

class ImuLineFormat final : public ImuFormat, private ImuLineHandler {
 public:
  ImuLineFormat(LineLayout layout, const GpsClock* gps, const ImuStampOptions& options,
                MessageOutput* output, PulseQueue* pulses = nullptr)
      : ImuFormat(gps, options, output, pulses),
        are_increments_(layout.are_increments),
        decoder_(std::move(layout)) {}

  void on_open() override { decoder_.begin_connection(); }
  void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  FormatCounts counts() const override;
  std::string why_no_frames() const override;

 private:
  void on_line(const ImuLine& line) override;

  bool are_increments_;
  ImuLineDecoder decoder_;
  std::int64_t arrival_ns_ = 0;  // of the bytes at hand
};

}  // namespace leonav
