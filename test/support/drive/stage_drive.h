// Synthetic drives through a Navigator, and what their epochs say about the GNSS stage.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/navigator/navigator.h"
#include "core/navigator/stages/gnss_stage.h"
#include "support/drive/navigator_config.h"
#include "support/drive/synthetic_drive.h"
#include "support/stages/recording_sink.h"

namespace leonav::test {

// A filter that never widens its covariance must be restarted where its prediction is wrong.
inline constexpr double kNeverWiden = 1e9;

inline SyntheticDrive drive_of(double duration_s, double east_m = 0.0, bool imu = true) {
  SyntheticDriveOptions options;
  options.duration_s = duration_s;
  options.start.longitude += east_m / (6.378e6 * std::cos(options.start.latitude));
  if (!imu) options.imu_rate_hz = 1.0;  // few samples: nobody reads them
  return synthetic_drive(options);
}

inline SyntheticDrive drive_with_noise(double duration_s) {
  SyntheticDriveOptions options;
  options.duration_s = duration_s;
  return synthetic_drive(with_noise(options, 1.0));
}

inline double seconds(GpsTime time) { return seconds_between(time, kSkyEpoch); }

// The product of the satellites `of`: nodes every `interval_s`, each told `ahead_s` before its
// time.
class ProductNodes {
 public:
  ProductNodes(std::vector<Ephemeris> of, double interval_s, double ahead_s)
      : of_(std::move(of)),
        interval_s_(interval_s),
        ahead_s_(ahead_s),
        next_s_(-std::max(ahead_s, 10.0 * interval_s)) {}

  void send_until(double now_s, Sequencer* sequencer) {
    for (; next_s_ <= now_s + ahead_s_; next_s_ += interval_s_) {
      PreciseStates nodes;
      for (const Ephemeris& e : of_)
        nodes.push_back(product_node(e, kSkyEpoch.plus_seconds(next_s_)));
      sequencer->on_precise_states(nodes);
    }
  }

 private:
  std::vector<Ephemeris> of_;
  double interval_s_, ahead_s_, next_s_;
};

// The drive's messages into a Navigator, as a live system would receive them, with
// before_epoch(raw, &sequencer) ahead of each epoch. Allocates nothing.
template <typename BeforeEpoch>
void feed(const SyntheticDrive& drive, Navigator* navigator, BeforeEpoch before_epoch) {
  constexpr double kEpochLatency_s = 0.06;
  Sequencer& sequencer = navigator->sequencer();
  feed(
      drive, kEpochLatency_s, [&](const Ephemeris& e) { sequencer.on_ephemeris(e); },
      [&](const ImuSample& s) { sequencer.on_imu(s); },
      [&](const RawEpoch& raw) {
        before_epoch(raw, &sequencer);
        sequencer.on_raw_epoch(raw);
      });
}

inline void feed(const SyntheticDrive& drive, Navigator* navigator) {
  feed(drive, navigator, [](const RawEpoch&, Sequencer*) {});
}

inline RecordingSink run(const SyntheticDrive& drive, const NavigatorConfig& config) {
  RecordingSink sink;
  Navigator navigator(config, &sink);
  if (config.motion == MotionModel::kInertial) {
    feed(drive, &navigator);
  } else {
    Sequencer& sequencer = navigator.sequencer();
    for (const Ephemeris& e : drive.ephemerides) sequencer.on_ephemeris(e);
    for (const RawEpoch& r : drive.epochs) sequencer.on_raw_epoch(r);
  }
  return sink;
}

// Error of the epochs' own solutions against the truth, in metres.
inline double epoch_error(const EpochReport& report, const SyntheticDrive& drive) {
  const SyntheticPath path(drive.options);
  const double t = seconds(report.time);
  const Eigen::Vector3d truth =
      report.solution.has_attitude ? path.state(t).p_e : path.antenna_p_e(t);
  return (report.solution.p_e - truth).norm();
}

inline double worst_error(const RecordingSink& sink, const SyntheticDrive& drive, double from_s,
                          double to_s) {
  double worst = 0.0;
  int count = 0;
  for (const EpochReport& report : sink.epochs) {
    if (seconds(report.time) < from_s || seconds(report.time) > to_s) continue;
    ++count;
    worst = std::max(worst, epoch_error(report, drive));
  }
  return count > 0 ? worst : 1e9;
}

inline std::vector<ResetCause> resets(const RecordingSink& sink) {
  std::vector<ResetCause> causes;
  for (const Event& event : sink.events) {
    if (event.kind == EventKind::kFilterReset && event.stage == Stage::kGnss) {
      causes.push_back(static_cast<ResetCause>(event.code));
    }
  }
  return causes;
}

// The drive is that of `first` until `change_s`, then as if the vehicle had been carried away.
inline SyntheticDrive carried_away(double duration_s, double change_s, double east_m) {
  SyntheticDrive drive = drive_of(duration_s);
  const SyntheticDrive there = drive_of(duration_s, east_m);
  for (std::size_t k = 0; k < drive.epochs.size(); ++k) {
    if (seconds(drive.epochs[k].time) >= change_s) drive.epochs[k] = there.epochs[k];
  }
  return drive;
}

}  // namespace leonav::test
