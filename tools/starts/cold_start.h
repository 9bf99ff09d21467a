// ColdStart runs one cold start of the navigator at an instant of a recorded run, beside the truth.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/navigator/navigator.h"
#include "daemon/messages/input_dispatch.h"
#include "tools/evaluate/track.h"
#include "tools/starts/heading_record.h"

namespace leonav {

// Kind of motion in the first ten seconds.
enum class InitialMotion { kStanding, kStraight, kCurve, kReverse, kOther };
std::string_view to_string(InitialMotion way);

// Returns the truth at or between its points; nullopt outside, or where it has no attitude or
// velocity.
struct TrueMotion {
  double yaw = 0.0;      // rad
  double speed = 0.0;    // m/s, horizontal
  double forward = 0.0;  // m/s, along the body axis: negative in reverse
};
std::optional<TrueMotion> motion_at(const Track& truth, GpsTime time);
// Classifies the motion. kReverse: at some time within it; kOther: none of these, or not known.
InitialMotion initial_motion_at(const Track& truth, GpsTime start);

// Result of one start.
struct StartResult {
  GpsTime start;
  InitialMotion way = InitialMotion::kOther;
  HeadingRecord heading;
  double with_gnss_30_s = 0.0;    // s with GNSS within the first thirty
  double driven_30_s = 0.0;       // s of those, faster than walking
  bool gyros_find_north = false;  // at this latitude, by their data sheet
  // The heading was found wrong and aligned anew: how often, and, for the first time, how long
  // after the start and after how many seconds driven; -1: never.
  int restarts = 0;
  double noticed_after_s = -1.0, noticed_driven_s = -1.0;
  std::optional<HeadingSample> when_noticed;  // at the previous epoch
  double driven_s = 0.0;                      // in all
  std::optional<double> given_heading_error;  // rad, given minus true
};

// Returns whether nobody could align: no GNSS for nearly all of the thirty seconds, or at rest with
// gyros that cannot find north.
bool cannot_align(const StartResult& result);

// A message of the log that a receiver would repeat: orbits, clocks, ionosphere, antennas.
struct Product {
  Channel channel;
  std::vector<std::uint8_t> data;
};

// ColdStart is fed with the messages from its start on.
class ColdStart final : private OutputSink {
 public:
  // Begins with the satellite products received before. If `given_heading_error` (rad) is set, the
  // navigator gets the true heading (1 sigma: alignment.initial_heading_sigma_deg) plus this error.
  ColdStart(const NavigatorConfig& config, const Track& truth, GpsTime start,
            std::span<const Product> products,
            std::optional<double> given_heading_error = std::nullopt);
  void dispatch(Channel channel, ByteSpan data) { dispatch_.dispatch(channel, data); }
  const StartResult& result() const { return result_; }

 private:
  void on_solution(const Solution&) override {}
  void on_epoch(const EpochReport& report) override;
  void on_event(const Event& event) override;
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}

  const Track& truth_;
  StartResult result_;
  GpsTime last_;  // time of the last epoch
  Navigator navigator_;
  InputDispatch dispatch_;
};

}  // namespace leonav
