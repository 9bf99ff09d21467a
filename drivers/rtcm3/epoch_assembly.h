// This unit collects the multiple signal messages of one epoch and finds their time.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/gnss/signals/observation.h"
#include "drivers/epoch/epoch_capacity.h"
#include "drivers/rtcm3/msm_observations.h"

namespace leonav {

// Counts of epochs and of multiple signal messages.
struct EpochAssemblyCounters {
  std::uint64_t epochs = 0;              // given out
  std::uint64_t messages = 0;            // decoded into epochs
  std::uint64_t not_ended = 0;           // epochs ended by the next one's time: a message was lost
  std::uint64_t empty_epochs = 0;        // complete, but without a measurement that can be used
  std::uint64_t bad_length = 0;          // message shorter than its masks require
  std::uint64_t bad_mask = 0;            // more cells than a message may have
  std::uint64_t bad_time = 0;            // time beyond the end of the week
  std::uint64_t late = 0;                // for the epoch that was just given out
  bool bit_is_wrong = false;             // DF393 ends epochs that go on: it is no longer believed
  std::uint64_t other_station = 0;       // of another station than the one in use
  std::uint64_t without_reference = 0;   // the week is not known
  std::uint64_t without_full_range = 0;  // formats 1 to 3
  std::uint64_t station_changes = 0;     // another station came into use
  std::uint16_t station = 0;             // the one in use
  std::uint16_t station_before = 0;      // the one before the last change
};

// The messages of an epoch come one after the other, and all but the last say that another follows
// (DF393). A message of another time ends the epoch as well, so that a lost one costs only itself.
// A sender that never sets the bit would have its first message alone used: where two epochs in a
// row go on after their end, the time alone ends them from then on, which delays each by one
// interval.
//
// The messages of one station are used: of the first one seen, until another one has sent alone for
// kOtherStation_s, and for three intervals of the one in use. Carriers are interrupted by the
// change.
class EpochAssembly {
 public:
  static constexpr double kOtherStation_s = 5.0;

  // Takes a message of any MSM type, which may complete up to two epochs: the one before, whose
  // last message did not come, and its own. Each is given to `on_epoch` as a const RawEpoch&,
  // sorted. The week is the one that brings the time nearest to `near`; without it nothing is
  // decoded.
  template <typename OnEpoch>
  void take(const MsmType& type, std::span<const std::uint8_t> message, GpsTime near,
            OnEpoch on_epoch) {
    const std::optional<GpsTime> time = begin(type, message, near);
    if (time && epoch_.time.is_set() && *time != epoch_.time) {
      if (!counters_.bit_is_wrong) ++counters_.not_ended;
      if (complete()) on_epoch(epoch_);
      clear();
    }
    const bool is_last = add(time);
    if (!is_last) return;
    if (complete()) on_epoch(epoch_);
    clear();
  }

  // Ends the stream: gives out an epoch whose last message did not come.
  template <typename OnEpoch>
  void finish(OnEpoch on_epoch) {
    if (!epoch_.time.is_set()) return;
    if (!counters_.bit_is_wrong) ++counters_.not_ended;
    if (complete()) on_epoch(epoch_);
    clear();
  }

  // The next message may be another station's, as after a new connection: it is then the one used.
  void allow_other_station() { is_station_open_ = true; }

  const EpochAssemblyCounters& counters() const { return counters_; }
  const MsmMeasurementCounters& measurement_counters() const { return observations_.counters(); }
  const CapacityLosses& losses() const { return capacity_.losses(); }

 private:
  // Reads the message; returns the time of a message whose measurements can be used.
  std::optional<GpsTime> begin(const MsmType& type, std::span<const std::uint8_t> message,
                               GpsTime near);
  bool is_of_other_station(const MsmType& type, const MsmHeader& header, GpsTime near);
  bool has_sent_alone(std::uint16_t station, GpsTime time);
  // Adds what begin() has read; returns whether the epoch ends with it.
  bool add(std::optional<GpsTime> time);
  void change_station(std::uint16_t station);
  bool complete();
  void count_late();
  void clear();

  EpochAssemblyCounters counters_;
  MsmObservations observations_;
  MsmMessage message_;
  bool more_follow_ = true;  // as the present message says
  std::optional<std::uint16_t> station_;
  bool is_station_open_ = true;             // the next message decides it
  std::uint16_t other_ = 0;                 // the one that may follow
  GpsTime other_since_;                     // since when it sends alone; unset: it does not
  int without_other_ = 0;                   // messages of further stations since its last one
  double interval_s_ = 0.0;                 // between the last two epochs
  RawEpoch epoch_;                          // time unset: none is open
  std::vector<SignalObservation> signals_;  // of the open epoch; each signal comes once at most
  EpochCapacity capacity_;
  GpsTime last_given_;      // time of the last epoch that was given out or was empty
  bool went_on_ = false;    // that epoch had a late message
  int gone_on_in_row_ = 0;  // epochs in a row that had one
};

}  // namespace leonav
