// The PulseTie finds the sample that each pulse belongs to, and ties the sensor's clock to GPS time
// by them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "tools/connect/stamps/pulse_line.h"
#include "tools/connect/stamps/pulse_mark.h"

namespace leonav {

// A pulse belongs to the sample whose time, as far as it is known, is nearest to the pulse's. It is
// known by the line through pulses once that is ready; before, by arrivals, whose least delays are
// configured. The choice is right where these are wrong by less than half of the time between
// samples that may have pulses; otherwise every stamp is wrong by whole such times, and nothing in
// the data shows it. Therefore:
//
// - a sensor that marks samples with pulses has them counted alone, so that pulses of 1 Hz allow
//   errors of half a second;
// - a pulse farther than half of that time from every sample belongs to none (a lost message);
// - the first pulses must agree with arrivals alike, within a fourth of that time;
// - text() says how far arrivals and pulses are apart, of what is allowed.
//
// Of pulses that follow each other sooner than PulseLine::kApart_ns one is used.
//
// A pulse that never came costs nothing. Where the line through arrivals has stepped, the line
// through pulses begins anew.
class PulseTie {
 public:
  void on_mark(const PulseMark& mark);
  // Takes a reading of the sensor. `has_pulse`: whether the sensor marks it as one with a pulse, if
  // it marks any. `by_arrivals`: its GPS time.
  void on_reading(std::int64_t clock_ns, std::optional<bool> has_pulse, GpsTime by_arrivals);
  // The sensor's clock has stepped: what was known about that clock no longer holds.
  void restart();

  const PulseLine& line() const { return line_; }
  std::uint64_t unmatched() const { return unmatched_; }  // pulses of no sample
  std::uint64_t refused() const { return refused_; }      // less certain than kMaxSigma_s
  std::uint64_t restarts() const { return restarts_; }
  std::string text() const;  // for users: how well, how far from arrivals, what was lost

 private:
  static constexpr double kMaxSigma_s = 1e-3;
  static constexpr std::size_t kSamples = 4096;  // 10 s at 400 Hz
  static constexpr std::size_t kWaiting = 64;    // pulses whose samples have not come yet
  static constexpr std::size_t kSpacings = 31;
  static constexpr std::int64_t kAhead_ns = 10'000'000'000;  // no pulse is so far before its sample

  struct Sample {
    std::int64_t clock_ns;
    GpsTime by_arrivals;
  };
  GpsTime time_of(const Sample& sample) const;
  void match_waiting();
  void match(const PulseMark& mark);
  std::int64_t usual_spacing_ns() const;

  PulseLine line_;
  std::deque<Sample> samples_;  // that may have pulses, in the order of the clock
  std::deque<PulseMark> waiting_;
  GpsTime last_mark_;          // the last one that was put there
  bool marks_pulses_ = false;  // the sensor marks samples with pulses
  std::optional<std::int64_t> first_off_ns_;
  std::int64_t off_ns_ = 0;  // of the last pulse: its sample's time by arrivals - its own
  std::uint64_t unmatched_ = 0, refused_ = 0, restarts_ = 0;
};

}  // namespace leonav
