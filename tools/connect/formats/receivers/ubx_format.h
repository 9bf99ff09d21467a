// The UbxFormat publishes a u-blox receiver's raw measurements and broadcast ephemerides, what
// Galileo's High Accuracy Service makes of these, the samples of its inertial sensor, and hands on
// the times of another sensor's pulses.
#pragma once
#include "drivers/ubx/ubx_decoder.h"
#include "tools/connect/formats/outputs/imu_output.h"
#include "tools/connect/formats/outputs/receiver_output.h"
#include "tools/connect/formats/pages/received_pages.h"
#include "tools/connect/formats/receivers/ubx_options.h"
#include "tools/connect/formats/stream_format.h"

namespace leonav {

// The messages are those that leonav-import writes from the same bytes: GNSS_EPOCH of every
// UBX-RXM-RAWX; EPHEMERIS, IONOSPHERE and BIASES as UBX-RXM-SFRBX completes them; CORRECTED_STATES
// and BIASES of the pages of E6-B. Besides, what navigation messages gave is repeated. Samples of
// UBX-ESF-RAW or UBX-ESF-MEAS are stamped by arrivals.
class UbxFormat final : public StreamFormat, private UbxHandler {
 public:
  // `latency_s`: an epoch arrives so long after its time. `repeat_s`: as of NavigationRepeater. The
  // epochs' arrivals set `clock`; `corrections`: as of ReceiverOutput, and must be given where the
  // options use pages. `pulses` gets the times of UBX-TIM-TM2; nullptr: nobody needs them. The
  // pointers must outlive this object.
  UbxFormat(double latency_s, double repeat_s, GpsClock* clock, MessageOutput* output,
            CorrectionOutput* corrections = nullptr, const UbxStreamOptions& options = {},
            PulseQueue* pulses = nullptr)
      : latency_s_(latency_s),
        options_(options),
        pulses_(pulses),
        receiver_(repeat_s, clock, output, corrections, ephemeris_remedy),
        pages_(options.uses_pages, corrections),
        imu_(clock, options.stamps, output) {}

  void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  void finish() override { decoder_.finish(this); }
  FormatCounts counts() const override;
  std::optional<DataTime> data_time() const override { return receiver_.data_time(); }
  std::string detail() const override;
  double stamp_sigma_s() const override;
  std::string why_no_frames() const override;
  std::string why_no_messages() const override;
  std::string why_no_samples() const override { return inertial_text(); }
  std::vector<FormatNews> take_news() override { return warnings_of({receiver_.take_news()}); }

 private:
  static const char* ephemeris_remedy(System system);
  void on_epoch(const RawEpoch& epoch) override;
  void on_ephemeris(const Ephemeris& ephemeris) override;
  void on_klobuchar(const KlobucharModel& model) override;
  void on_biases(const std::vector<SignalBias>& biases) override;
  void on_page(const CorrectionPage& page) override { pages_.take(page); }
  void on_inertial(const EsfReading& reading) override;
  void on_time_mark(const TimeMark& mark) override;
  std::string inertial_text() const;
  std::string pulse_text() const;

  double latency_s_;
  UbxStreamOptions options_;
  PulseQueue* pulses_;
  ReceiverOutput receiver_;
  ReceivedPages pages_;
  ImuOutput imu_;
  std::uint64_t sent_pulses_ = 0, other_pulses_ = 0;  // handed on; of another input or edge
  UbxDecoder decoder_;
  std::int64_t arrival_ns_ = 0;        // of the bytes at hand
  std::int64_t epoch_arrival_ns_ = 0;  // of the last epoch
};

}  // namespace leonav
