// The ImuFormat is what all formats of inertial sensors share: stamp, sample, publish, report.
#pragma once
#include "tools/connect/formats/outputs/imu_output.h"
#include "tools/connect/formats/stream_format.h"

namespace leonav {

class ImuFormat : public StreamFormat {
 public:
  // As of ImuOutput.
  ImuFormat(const GpsClock* gps, const ImuStampOptions& options, MessageOutput* output,
            PulseQueue* pulses = nullptr)
      : output_(gps, options, output, pulses) {}

  std::optional<DataTime> data_time() const override { return output_.data_time(); }
  std::string detail() const override { return output_.text(); }
  std::string why_no_messages() const override { return output_.text(); }
  double stamp_sigma_s() const override { return output_.sigma_s(); }

 protected:
  // Publishes the reading as a sample, or counts why not.
  void take(const ImuReading& reading) {
    has_time_ = has_time_ || reading.gps_time || reading.clock_ns;
    output_.take(reading);
  }
  // Returns why nothing is published, and `remedy` where no reading has had a time of the sensor.
  std::string why_no_samples_of(const std::string& remedy) const {
    return output_.text() + (has_time_ ? "" : "; " + remedy);
  }
  // Adds what was published, and what was refused behind the decoder.
  void add_to(FormatCounts* counts) const {
    counts->messages += output_.messages();
    counts->refused += output_.refused();
  }

 private:
  ImuOutput output_;
  bool has_time_ = false;  // GPS time or the sensor's own clock, in any reading
};

}  // namespace leonav
