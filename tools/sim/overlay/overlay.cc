#include "tools/sim/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/event_log.h"
#include "tools/common/format.h"
#include "tools/sim/overlay/recorded_clock.h"
#include "tools/sim/overlay/recording_rules.h"
#include "tools/sim/route/drive.h"
#include "tools/sim/run/antennas.h"
#include "tools/sim/run/product_messages.h"
#include "tools/sim/signals/receiver.h"

namespace leonav::sim {
namespace {

constexpr double kEdge_s = 1.0;  // of the motion, where there are no rates
constexpr std::uint64_t kUncounted = 0;

// Returns the scenario over the whole of its recorded route, without other satellites.
Scenario low_satellites_alone(Scenario scenario) {
  const std::vector<TruthPoint>& track = scenario.route.track;
  if (track.empty()) throw std::runtime_error("an overlay needs the truth of the recording");
  scenario.start = track.front().time;
  scenario.duration_s = seconds_between(track.back().time, track.front().time);
  for (ConstellationConfig& c : scenario.constellations) {
    if (c.system != System::kLeo) c.enabled = false;
  }
  return scenario;
}

// Output is written under another name until it is complete.
class Output {
 public:
  explicit Output(const std::string& path) : path_(path), part_(path + ".part"), writer_(part_) {}
  ~Output() {
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  void write(std::int64_t stamp_us, std::string_view channel, ByteSpan data) {
    if (!writer_.write(stamp_us, channel, data)) throw EventLogError(writer_.error());
  }
  void commit() {
    if (!writer_.flush(true)) throw EventLogError(writer_.error());
    std::filesystem::rename(part_, path_);
  }

 private:
  std::string path_, part_;
  EventLogWriter writer_;
};

class Overlay {
 public:
  Overlay(const Scenario& scenario, const std::string& recorded, const std::string& output)
      : scenario_(low_satellites_alone(scenario)),
        motion_(drive(scenario_)),
        faults_(scenario.faults),
        clock_(recorded_clock(recorded, scenario_, motion_)),
        sky_(build_sky(scenario_)),
        products_(
            in_order_of_arrival(provided_products(scenario_, sky_, faults_), scenario_.start)),
        receiver_(scenario_, motion_, sky_, faults_),
        log_(recorded),
        output_(output) {
    report_.without_clock = clock_.without;
    report_.clock_noise_m = clock_noise_m();
    report_.unused = keys_of_the_recording(scenario.given);
  }

  OverlayReport run(ProgressBar* progress) {
    LogEvent event;
    while (log_.next(&event)) {
      ++report_.messages;
      if (channel_from_name(event.channel) != Channel::kGnssEpoch || !change(event)) {
        output_.write(event.timestamp_us, event.channel, event.data);
      }
      progress->show(static_cast<double>(log_.position_bytes()) /
                     static_cast<double>(log_.size_bytes()));
    }
    if (report_.epochs == 0) {
      throw std::runtime_error(
          "the recording has no channel " + std::string(channel_name(Channel::kGnssEpoch)) +
          (clock_.other_prefix.empty() ? ""
                                       : "; it has " + clock_.other_prefix +
                                             "GNSS_EPOCH: --overlay knows no other prefix"));
    }
    if (report_.added == 0 && report_.removed == 0) {
      throw std::runtime_error(
          "nothing to add and nothing to take away: no epoch of the recording lies in the truth's "
          "time with satellites enough to tell its clock (nor at its place, if codes scatter), and "
          "no outage names any");
    }
    report_.truncated = log_.truncated();
    output_.commit();
    return report_;
  }

 private:
  // Writes the changed epoch; returns false if it stays unchanged.
  bool change(const LogEvent& event) {
    const DecodeResult result = decoder_.decode(event.data, raw_.get());
    if (result.fault != InputFault::kNone) return false;
    ++report_.epochs;
    tell_products(event);
    const long removed = remove_observations();
    const long added = add_observations();
    if (removed == 0 && added == 0) return false;
    report_.removed += removed;
    report_.added += added;
    report_.with_leo += added > 0 ? 1 : 0;
    output_.write(event.timestamp_us, event.channel, encoder_.encode(*raw_, result.sequence));
    return true;
  }

  // Products are written before the epoch, as a live system would have received them; antennas come
  // first.
  void tell_products(const LogEvent& event) {
    if (report_.epochs == 1) {
      for (const AntennaPattern& pattern : ideal_antennas(scenario_, sky_)) {
        output_.write(event.timestamp_us, channel_name(Channel::kAntenna),
                      encoder_.encode(pattern, raw_->time, kUncounted));
      }
    }
    while (next_product_ < products_.size() && products_[next_product_].arrival <= raw_->time) {
      const std::vector<PreciseState>& states = products_[next_product_++].epoch.states;
      output_.write(event.timestamp_us, channel_name(Channel::kOrbitClock),
                    encoder_.encode(std::span<const PreciseState>(states), kUncounted));
    }
  }

  long remove_observations() {
    const double t = seconds_between(raw_->time, motion_.start());
    const auto before = raw_->observations.size();
    const auto kept = std::remove_if(raw_->observations.begin(), raw_->observations.end(),
                                     [&](const SignalObservation& o) {
                                       // check_overlay_faults() excludes outages that depend on the
                                       // elevation.
                                       return faults_.is_out(o.satellite, 0.0, t);
                                     });
    raw_->observations.erase(kept, raw_->observations.end());
    return static_cast<long>(before - raw_->observations.size());
  }

  long add_observations() {
    const auto reading = clock_.readings.find(raw_->time);
    if (reading == clock_.readings.end()) return 0;
    const double t = reading->second.t;
    if (t < kEdge_s || t > motion_.duration_s() - kEdge_s) return 0;
    const double t_tag = seconds_between(raw_->time, motion_.start());
    const RawEpoch low = receiver_.epoch(t_tag, reading->second);
    const auto own = std::ranges::find(raw_->observations, System::kLeo,
                                       [](const auto& o) { return o.satellite.system; });
    if (own != raw_->observations.end()) {
      throw std::runtime_error("the recording has low satellites of its own (" +
                               to_string(own->satellite) + "): they cannot be told apart");
    }
    for (const SignalObservation& o : low.observations) {
      if (raw_->observations.size() == raw_->observations.max_size()) {
        throw std::runtime_error("more signals at once than an epoch holds");
      }
      raw_->observations.push_back(o);
    }
    std::ranges::stable_sort(raw_->observations, {}, [](const SignalObservation& o) {
      return std::pair(o.satellite, o.code);
    });
    return static_cast<long>(low.observations.size());
  }

  // Returns the noise of the recorded clock; a receiver that sets its clock at every epoch is a
  // phone. The median excludes steps and gaps.
  double clock_noise_m() const {
    std::vector<double> changes;
    for (auto b = clock_.readings.begin(); b != clock_.readings.end(); ++b) {
      if (b == clock_.readings.begin()) continue;
      const ClockReading& before = std::prev(b)->second;
      const double dt = seconds_between(b->first, std::prev(b)->first);
      const double by_drift = 0.5 * (b->second.drift + before.drift) * dt;
      changes.push_back(kSpeedOfLight * std::abs(b->second.code_s - before.code_s - by_drift));
    }
    if (changes.empty()) return 0.0;
    const auto middle = changes.begin() + static_cast<std::ptrdiff_t>(changes.size() / 2);
    std::nth_element(changes.begin(), middle, changes.end());
    constexpr double kSigmaPerMedian = 1.4826;
    return kSigmaPerMedian * *middle;
  }

  Scenario scenario_;
  SplineMotion motion_;
  FaultScript faults_;
  RecordedClock clock_;
  TrueSky sky_;
  std::vector<ScheduledOrbitEpoch> products_;
  Receiver receiver_;
  EventLogReader log_;
  Output output_;
  Decoder decoder_;
  Encoder encoder_;
  std::unique_ptr<RawEpoch> raw_ = std::make_unique<RawEpoch>();
  std::size_t next_product_ = 0;
  OverlayReport report_;
};

}  // namespace

std::string to_string(const OverlayReport& r) {
  std::string unused;
  for (const std::string& key : r.unused) unused += (unused.empty() ? "" : ", ") + key;
  if (!unused.empty()) unused = "not used, as the recording says it: " + unused + "\n";
  return unused +
         format(
             "%ld messages copied; %ld epochs, %ld with simulated low satellites: %ld observations "
             "added, "
             "%ld removed\n%ld epochs without a clock that could be told; clock from epoch to "
             "epoch, "
             "drift removed: %.1f m (1 sigma, by the median)\n%s",
             r.messages, r.epochs, r.with_leo, r.added, r.removed, r.without_clock, r.clock_noise_m,
             r.truncated
                 ? "the recording is cut short: its last message is not whole and was left out\n"
                 : "");
}

OverlayReport overlay(const Scenario& scenario, const std::string& recorded,
                      const std::string& output, ProgressBar* progress) {
  check_overlay_faults(scenario.faults);
  Overlay job(scenario, recorded, output);
  return job.run(progress);
}

}  // namespace leonav::sim
