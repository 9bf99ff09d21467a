// One cold start of the navigator somewhere in a recorded run, beside the truth.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/navigator/pipeline.h"
#include "daemon/input_dispatch.h"
#include "tools/alignment/heading_record.h"
#include "tools/evaluation/track.h"

namespace leonav {

// What the vehicle does in the first ten seconds.
enum class Way { kStanding, kStraight, kCurve, kReverse, kOther };
std::string_view to_string(Way way);

// The truth at or between its points; nullopt outside, or where it has no attitude or velocity.
struct TrueMotion {
  double yaw = 0.0;      // rad
  double speed = 0.0;    // m/s, horizontal
  double forward = 0.0;  // m/s, where the body points: negative in reverse
};
std::optional<TrueMotion> motion_at(const Track& truth, GpsTime time);
// kReverse: at some time of it; kOther: none of these, or not known.
Way way_at(const Track& truth, GpsTime start);

struct StartResult {
  GpsTime start;
  Way way = Way::kOther;
  HeadingRecord heading;
  double heard_30_s = 0.0;        // s of the first thirty with GNSS
  double driven_30_s = 0.0;       // s of those at more than a walking pace
  bool gyros_find_north = false;  // by their data sheet, here
  // The heading found wrong and aligned anew: how often, and at the first time, how long after the
  // start and after so many seconds driven; -1: never.
  int restarts = 0;
  double noticed_after_s = -1.0, noticed_driven_s = -1.0;
  std::optional<HeadingSample> when_noticed;  // of the epoch before
  double driven_s = 0.0;                      // in all
  std::optional<double> told_off;             // rad; what it was told, less the truth
};

// Nobody could: for nearly all of the thirty seconds it heard nothing, or it stood, and its gyros
// cannot find north.
bool cannot_align(const StartResult& result);

// A message of the log that a receiver would repeat: orbits, clocks, ionosphere, antennas.
struct Product {
  Channel channel;
  std::vector<std::uint8_t> data;
};

class Start final : private OutputSink {
 public:
  // Begins with what was told of the satellites before.
  // `told_off`: it is told the true heading (+- alignment.initial_heading_sigma_deg) plus this,
  // rad.
  Start(const NavigatorConfig& config, const Track& truth, GpsTime start,
        std::span<const Product> products, std::optional<double> told_off = std::nullopt);
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
  GpsTime last_;  // epoch
  Pipeline pipeline_;
  InputDispatch dispatch_;
};

}  // namespace leonav
