// The ReceiverOutput publishes what one GNSS receiver has measured and received.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/transport/byte_source.h"
#include "tools/connect/formats/outputs/correction_output.h"
#include "tools/connect/formats/outputs/ephemeris_monitor.h"
#include "tools/connect/formats/outputs/message_output.h"
#include "tools/connect/formats/outputs/navigation_repeater.h"
#include "tools/connect/stamps/gps_clock.h"

namespace leonav {

// Every format of receivers sends through it, so that all of them publish the same messages as
// leonav-import writes. Besides, what it takes from navigation messages is repeated.
class ReceiverOutput {
 public:
  // `repeat_s`: as of NavigationRepeater. The epochs' arrivals set `clock`. `corrections`, if
  // given, gets the ephemerides too. `remedy`: as of EphemerisMonitor. The pointers must outlive
  // this object.
  ReceiverOutput(double repeat_s, GpsClock* clock, MessageOutput* output,
                 CorrectionOutput* corrections = nullptr, EphemerisMonitor::Remedy remedy = nullptr)
      : clock_(clock),
        output_(output),
        corrections_(corrections),
        repeater_(repeat_s, output),
        monitor_(&output->orbits(), remedy) {}

  // Publishes an epoch whose last byte arrived at `arrival_ns` of the ArrivalClock. `has_own_week`:
  // its week comes from the receiver, and not from the host's clock.
  void send(const RawEpoch& epoch, std::int64_t arrival_ns, bool has_own_week = true);
  // Elements for corrections alone are not published. `received`, of a stream without epochs: when
  // it came, if that is known.
  void send(const Ephemeris& ephemeris, GpsTime received = {});
  // `received`: GPS time.
  void send(const KlobucharModel& model, GpsTime received);
  // Of one satellite.
  void send(const std::vector<SignalBias>& biases);

  // Sends again what is due, as every epoch does; for a stream without epochs.
  void repeat_navigation(GpsTime now);

  GpsTime last_epoch() const { return last_epoch_; }
  std::uint64_t messages() const { return messages_; }  // published
  // Of these the epochs with signals, and those without, as of an antenna that is cut.
  std::uint64_t epochs() const { return epochs_; }
  std::uint64_t empty_epochs() const { return empty_epochs_; }
  // The time of the last epoch, by which a file without recorded arrivals is played.
  std::optional<DataTime> data_time() const;
  // What came, in a few words; empty while nothing has come.
  std::string detail() const;
  // What is wrong since the last call, a sentence without a full stop; empty: nothing new is.
  std::string take_news() { return monitor_.take_news(); }

 private:
  GpsClock* clock_;
  void note_step(GpsTime time);

  MessageOutput* output_;
  CorrectionOutput* corrections_;
  NavigationRepeater repeater_;
  EphemerisMonitor monitor_;
  GpsTime last_epoch_;
  std::uint64_t time_steps_ = 0;
  double last_step_s_ = 0.0;
  std::size_t last_signals_ = 0;
  std::uint64_t messages_ = 0, epochs_ = 0, empty_epochs_ = 0, ephemerides_ = 0;
};

}  // namespace leonav
