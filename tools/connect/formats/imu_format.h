// The ImuFormat is what all formats of inertial sensors share: stamp, sample, publish, report.
#pragma once
#include "tools/connect/formats/message_output.h"
#include "tools/connect/formats/stream_format.h"
#include "tools/connect/stamps/imu_sampler.h"
#include "tools/connect/stamps/imu_stamper.h"

namespace leonav {

class ImuFormat : public StreamFormat {
 public:
  // `gps` and `output` must outlive this object.
  ImuFormat(const GpsClock* gps, const ImuStampOptions& options, MessageOutput* output)
      : stamper_(gps, options), output_(output) {}

  std::optional<DataTime> data_time() const override { return data_time_; }
  std::string detail() const override { return stamper_.text(); }
  std::string why_no_messages() const override { return stamper_.text(); }
  double stamp_sigma_s() const override { return stamper_.sigma_s(); }

 protected:
  // Publishes the reading as a sample, or counts why not.
  void take(const ImuReading& reading);
  // Adds what was published, and what was refused behind the decoder.
  void add_to(FormatCounts* counts) const;

 private:
  ImuStamper stamper_;
  ImuSampler sampler_;
  MessageOutput* output_;
  std::optional<DataTime> data_time_;
  std::uint64_t messages_ = 0;
};

}  // namespace leonav
