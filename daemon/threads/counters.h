// The EngineCounters are numbers that each thread writes and `main` reads.
#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>

#include "core/filter/error_model/learned_summary.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/signals/satellite.h"
#include "core/installation_checks/convention.h"
#include "core/navigator/interface/event.h"
#include "drivers/lcm/channels.h"

namespace leonav {

// A number with one writing thread and any number of readers.
class Gauge {
 public:
  void set(std::int64_t value) { value_.store(value, std::memory_order_release); }
  void add(std::int64_t value) { value_.fetch_add(value, std::memory_order_release); }
  void raise_to(std::int64_t value) {
    if (value > get()) set(value);
  }
  std::int64_t get() const { return value_.load(std::memory_order_acquire); }
  std::int64_t take() { return value_.exchange(0, std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> value_{0};
};

// Nanoseconds since construction.
class Stopwatch {
 public:
  std::int64_t nanoseconds() const {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() -
                                                                start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// The learned errors of one observable: over all classes, then by kLearnedClassNames.
struct LearnedGauge {
  Gauge sigma_percent;  // of the configured sigma; 0: none is learned
  Gauge time_ms;        // of their correlation; 0: not learned by this property
};
using LearnedGauges = std::array<LearnedGauge, 1 + kLearnedClassNames.size()>;

// What one stage has found of one Convention.
struct ConventionGauge {
  Gauge events;
  Gauge void_events;  // of these, those of before the last time step of the inputs
  Gauge milli;        // a thousand times the value of the last
};

// The last ones of these enumerations.
inline constexpr std::size_t kReasonCount = static_cast<std::size_t>(Reason::kFaulty) + 1;
inline constexpr std::size_t kEventKindCount =
    static_cast<std::size_t>(EventKind::kOrbitRefused) + 1;

// Channels of which it is known what became of each message.
inline constexpr std::array kStreams = {Channel::kImu, Channel::kGnssEpoch, Channel::kOdometer};

struct EngineCounters {
  // io
  Gauge io_rounds;  // polls for messages, with or without one
  std::array<Gauge, kInputChannels.size()> received, refused, lost;
  // By channel and InputFault.
  std::array<std::array<Gauge, kInputFaultCount>, kInputChannels.size()> refused_by;
  std::array<Gauge, 16> rejected;                                         // by InputFault
  std::array<std::array<Gauge, 16>, kStreams.size()> rejected_of_stream;  // of these, the same
  Gauge odometer_age_ms;                                                  // -1: none came
  Gauge accepted_odometer, late_odometer;
  Gauge accepted_imu, accepted_epochs, empty_epochs, late_epochs, imu_gaps, imu_smoothed,
      epochs_without_imu;
  // ins, or gnss where that publishes
  // Protection levels of the last solution, 1e-6 m and 1e-6 rad; -1: none is known.
  Gauge horizontal_protection_micro, vertical_protection_micro, heading_protection_micro;
  Gauge solution_time_ns, source, commits, misses, smoother_commits, smoother_misses, worst_tick_ns;
  // gnss
  std::array<Gauge, kSystemCount> satellites_used;
  std::array<Gauge, kSystemCount> ephemeris_age_ms;  // -1: none in use
  // The same by source of the orbit: broadcast, precise.
  std::array<Gauge, 2> satellites_by_source, age_by_source_ms;
  // Satellites of the last epoch that had any, by Reason.
  std::array<Gauge, kReasonCount> satellites_by_reason;
  // Of all epochs: measurements, and those of them that robust weights exclude or weaken by half.
  Gauge measurements, contradicting_measurements;
  Gauge orbits_refused;  // of the last epoch's satellites
  Gauge orbit_fallbacks, orbit_returns, widened_predictions, arcs_joined;
  // Learned errors of codes and Dopplers: over all classes, then by kLearnedClassNames.
  std::array<LearnedGauges, 2> learned;
  std::array<Gauge, kSystemCount> lasting_cm;  // LastingErrors; 0: none
  Gauge alignment_need;                        // pack_alignment_need(), alignment_text.h
  Gauge worst_epoch_ns;
  Gauge keyframes_skipped;
  Gauge checkpoints_used, checkpoints_ignored;
  // The last kCheckpoint event: 1 + CheckpointUse (0: none), and a thousand times the value.
  Gauge checkpoint_use, checkpoint_milli;
  // The same of what is said about its calibration.
  Gauge calibration_use, calibration_milli;
  // smoother
  Gauge worst_solve_ns, smoother_failures, smoother_iterations, smoother_shortened,
      smoother_left_to_chain;
  // any stage
  std::array<Gauge, kEventKindCount> events;  // that were published, by EventKind
  // Jumps of the solution above a metre, and those beyond three of its sigmas among them.
  Gauge large_jumps, surprising_jumps;
  // Findings of the GNSS stage, by Convention, and those of the Sequencer, which come again each
  // minute while the mistake lasts.
  std::array<ConventionGauge, kConventionCount> conventions, lasting_conventions;
  // Events kFilterReset without those of cause kWindow, each of which follows another one by some
  // seconds; the ResetCause of the last.
  Gauge filter_starts, reset_cause;
  // main
  Gauge unpublished;  // messages of HEALTH that found no room
  // out
  Gauge published;
};

}  // namespace leonav
