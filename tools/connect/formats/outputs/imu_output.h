// The ImuOutput stamps the readings of one inertial sensor, makes samples of them and publishes
// them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/transport/byte_source.h"
#include "tools/connect/formats/outputs/message_output.h"
#include "tools/connect/stamps/imu_sampler.h"
#include "tools/connect/stamps/imu_stamper.h"

namespace leonav {

class ImuOutput {
 public:
  // `pulses` as of ImuStamper. The pointers must outlive this object.
  ImuOutput(const GpsClock* gps, const ImuStampOptions& options, MessageOutput* output,
            PulseQueue* pulses = nullptr)
      : stamper_(gps, options, pulses), output_(output) {}

  // Publishes the reading as a sample, or counts why not.
  void take(const ImuReading& reading);

  // The time of the last reading, by which a file without recorded arrivals is played.
  std::optional<DataTime> data_time() const { return data_time_; }
  std::string text() const {
    return stamper_.text();
  }  // how samples are stamped, or why they are not
  double sigma_s() const { return stamper_.sigma_s(); }
  std::uint64_t messages() const { return messages_; }  // published
  std::uint64_t refused() const;                        // behind the decoder

 private:
  ImuStamper stamper_;
  ImuSampler sampler_;
  MessageOutput* output_;
  std::optional<DataTime> data_time_;
  std::uint64_t messages_ = 0;
};

}  // namespace leonav
