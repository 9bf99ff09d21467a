#include "tools/quality/quality.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "core/gnss/preprocessing/signal_selection.h"
#include "tools/quality/internal/code_steps.h"

namespace leonav {
namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

// The values of all epochs are kept, for exact percentiles: a day at 10 Hz is 7 MB each.
DopRange range_of(std::vector<float> values) {
  if (values.empty()) return {0, kNoValue, kNoValue, kNoValue};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double place = std::ceil(share * static_cast<double>(values.size())) - 1.0;
    return static_cast<double>(values[static_cast<std::size_t>(std::max(0.0, place))]);
  };
  return {values.size(), at(0.5), at(0.95), static_cast<double>(values.back())};
}

GnssConfig config_of(const QualityOptions& options) {
  GnssConfig config = default_gnss_config();
  config.elevation_mask = options.elevation_mask;
  config.bands = options.bands;
  return config;
}

// Analysis is the second pass over the log.
class Analysis {
 public:
  Analysis(const Census& census, const QualityOptions& options, Quality* quality)
      : quality_(*quality),
        sky_(config_of(options)),
        streams_(census.plans(), config_of(options)),
        code_steps_(options.bands) {
    const std::uint64_t most = options.plot_epochs;
    if (most > 0) plot_every_ = (quality_.times.epochs + most - 1) / most;
  }

  EphemerisStore* ephemeris_store() { return sky_.ephemeris_store(); }

  void add(const RawEpoch& raw) {
    if (last_time_.is_set() && raw.time <= last_time_) return;  // counted by the census
    last_time_ = raw.time;
    sky_.look(raw);
    quality_.solved_epochs += sky_.is_solved() ? 1 : 0;
    const bool plotted = plot_every_ > 0 && epochs_ % plot_every_ == 0;
    ++epochs_;
    count_satellites(plotted);
    *repaired_ = raw;
    code_steps_.repair(repaired_.get());
    count_breaks(streams_.process(*repaired_, sky_));
    count_carriers();
    for (const SignalObservation& o : repaired_->observations) count_signal(raw.time, o, plotted);
  }

  void finish() {
    levels_.finish();
    for (const auto& [signal, multipath] : levels_.signals())
      quality_.satellites[signal.first].signals[signal.second].multipath = multipath;
    for (auto& [id, satellite] : quality_.satellites) {
      satellite.one_frequency = !streams_.has_pair(id);
      ++quality_.systems[index_of(id.system)].satellites;
      ++quality_.all_systems.satellites;
      for (const auto& [code, signal] : satellite.signals)
        quality_.signals[{id.system, code}].add(signal);
    }
    for (std::size_t i = 0; i < quality_.plot_samples.size(); ++i) {
      if (sample_arcs_[i] == kNoArc) continue;
      const double mean_m = levels_.means_m()[sample_arcs_[i]];
      float& value = quality_.plot_samples[i].multipath_m;
      value = static_cast<float>(sample_values_m_[i] - mean_m);
    }
    quality_.clock_jumps = streams_.clock_jumps();
    quality_.code_steps = code_steps_.count();
    quality_.gdop = range_of(gdop_);
    quality_.pdop = range_of(pdop_);
    quality_.hdop = range_of(hdop_);
    quality_.vdop = range_of(vdop_);
  }

 private:
  static constexpr std::size_t kNoArc = static_cast<std::size_t>(-1);

  void count_satellites(bool plotted) {
    EpochQuality epoch;
    epoch.time = sky_.epoch().time;
    epoch.solved = sky_.is_solved();
    epoch.dop = sky_.dop();
    for (const SatelliteInView& view : sky_.epoch().satellites) {
      SatelliteQuality& satellite = quality_.satellites[view.satellite];
      const std::size_t system = index_of(view.satellite.system);
      ++satellite.epochs;
      ++satellite.reasons[view.reason];
      ++epoch.seen[system];
      if (is_usable(view.reason) && sky_.has_position()) {
        ++satellite.usable_epochs;
        ++epoch.usable[system];
      }
      if (has_direction(view, sky_.has_position()) &&
          !(view.elevation < satellite.highest_elevation))
        satellite.highest_elevation = view.elevation;
    }
    std::uint64_t seen = 0, usable = 0;
    for (std::size_t system = 0; system < kSystemCount; ++system) {
      quality_.systems[system].seen.add(epoch.seen[system]);
      quality_.systems[system].usable.add(epoch.usable[system]);
      seen += epoch.seen[system];
      usable += epoch.usable[system];
    }
    quality_.all_systems.seen.add(seen);
    quality_.all_systems.usable.add(usable);
    if (std::isfinite(epoch.dop.pdop)) {
      gdop_.push_back(static_cast<float>(epoch.dop.gdop));
      pdop_.push_back(static_cast<float>(epoch.dop.pdop));
      hdop_.push_back(static_cast<float>(epoch.dop.hdop));
      vdop_.push_back(static_cast<float>(epoch.dop.vdop));
    }
    if (plotted) quality_.plot_epochs.push_back(epoch);
  }

  void count_breaks(const std::vector<ArcBreak>& breaks) {
    for (const ArcBreak& one : breaks) {
      SatelliteQuality& satellite = quality_.satellites[one.satellite];
      if (is_slip(one.causes)) {
        ++satellite.slips;
        satellite.flagged_slips += is_flagged_by_receiver(one.causes) ? 1 : 0;
      } else {
        ++satellite.interruptions;
      }
      quality_.breaks.push_back(one);
    }
  }

  void count_carriers() {
    for (const SatelliteInView& view : sky_.epoch().satellites) {
      if (!streams_.is_followed(view.satellite)) continue;
      SatelliteQuality& satellite = quality_.satellites[view.satellite];
      ++satellite.followed;
      satellite.unresolved += streams_.half_cycle_unresolved(view.satellite) ? 1 : 0;
    }
  }

  void count_signal(GpsTime time, const SignalObservation& o, bool plotted) {
    SignalQuality& signal = quality_.satellites[o.satellite].signals[o.code];
    const SatelliteInView* view = sky_.find(o.satellite);
    const bool seen = view != nullptr && has_direction(*view, sky_.has_position());
    const double elevation = seen ? view->elevation : std::numeric_limits<double>::quiet_NaN();
    signal.carriers += std::isfinite(o.carrier_cycles) ? 1 : 0;
    signal.loss_of_lock += o.loss_of_lock ? 1 : 0;
    signal.half_cycles += o.half_cycle_ambiguous ? 1 : 0;
    signal.cn0[elevation_bin(elevation)].add(o.cn0_dbhz);
    double value_m = 0.0;
    const std::size_t arc = count_multipath(o, elevation, &signal, &value_m);
    if (!plotted) return;
    quality_.plot_samples.push_back({time, o.satellite, o.code, static_cast<float>(elevation),
                                     seen ? static_cast<float>(view->azimuth) : kNoValue,
                                     static_cast<float>(o.cn0_dbhz), kNoValue});
    sample_arcs_.push_back(arc);
    sample_values_m_.push_back(value_m);
  }

  // Returns the index of the arc, or kNoArc.
  std::size_t count_multipath(const SignalObservation& o, double elevation, SignalQuality* signal,
                              double* value_m) {
    if (!std::isfinite(o.pseudorange_m)) return kNoArc;
    if (!is_plausible_pseudorange(o.satellite.system, o.pseudorange_m)) {
      ++signal->implausible;
      return kNoArc;
    }
    ++signal->codes;
    const PairedCarriers pair = streams_.carriers_of(o.satellite, o.code.band);
    if (pair.arc != 0)
      *value_m = multipath_combination_m(o.pseudorange_m, pair.own_m, pair.other_m, pair.own_hz,
                                         pair.other_hz);
    if (pair.arc == 0 || !std::isfinite(*value_m)) {
      ++signal->without_carriers;
      return kNoArc;
    }
    return levels_.add({o.satellite, o.code}, pair.arc, *value_m, elevation);
  }

  Quality& quality_;
  Sky sky_;
  CarrierStreams streams_;
  MultipathLevels levels_;
  CodeSteps code_steps_;
  std::unique_ptr<RawEpoch> repaired_ = std::make_unique<RawEpoch>();
  GpsTime last_time_;
  std::uint64_t epochs_ = 0, plot_every_ = 0;
  std::vector<float> gdop_, pdop_, hdop_, vdop_;
  std::vector<std::size_t> sample_arcs_;  // index-parallel to plot_samples
  std::vector<double> sample_values_m_;   // index-parallel to plot_samples, arc's level included
};

[[noreturn]] void fail_without_epochs(const std::string& log, const InputCounts& inputs,
                                      const std::string& prefix) {
  const std::string channel = channel_name(Channel::kGnssEpoch, prefix);
  std::string what = log + ": holds no GNSS epoch (channel " + channel + ")";
  if (inputs.refused_epochs > 0)
    what = log + ": all " + std::to_string(inputs.refused_epochs) + " GNSS epochs are malformed";
  if (!inputs.other_prefix.empty())
    what += "; there is a channel " + inputs.other_prefix + "GNSS_EPOCH: give --prefix " +
            inputs.other_prefix;
  if (!inputs.damage.empty()) what += "; the log is damaged: " + inputs.damage;
  throw std::runtime_error(what);
}

}  // namespace

Cn0Distribution SignalQuality::cn0_all() const {
  Cn0Distribution sum;
  for (const Cn0Distribution& bin : cn0) sum.add(bin);
  return sum;
}

void SignalQuality::add(const SignalQuality& other) {
  codes += other.codes;
  carriers += other.carriers;
  loss_of_lock += other.loss_of_lock;
  half_cycles += other.half_cycles;
  implausible += other.implausible;
  without_carriers += other.without_carriers;
  multipath.arcs += other.multipath.arcs;
  multipath.short_arcs += other.multipath.short_arcs;
  multipath.short_arc_samples += other.multipath.short_arc_samples;
  for (std::size_t i = 0; i < kElevationBins; ++i) {
    cn0[i].add(other.cn0[i]);
    multipath.bins[i].add(other.multipath.bins[i]);
  }
}

void CountRange::add(std::uint64_t count) {
  least = epochs == 0 ? count : std::min(least, count);
  most = std::max(most, count);
  sum += count;
  ++epochs;
}

double CountRange::mean() const {
  return epochs == 0 ? 0.0 : static_cast<double>(sum) / static_cast<double>(epochs);
}

Quality analyse_quality(const std::string& log, const QualityOptions& options,
                        std::ostream* progress) {
  Quality quality;
  quality.log = log;
  quality.options = options;
  Census census(config_of(options));
  const auto count = [&](const RawEpoch& raw) { census.add(raw); };
  const InputCounts first =
      read_inputs(log, options.prefix, {count, nullptr}, progress, "counting ");
  quality.times = census.times();
  quality.times.backwards += first.disordered_epochs;
  if (quality.times.epochs == 0) fail_without_epochs(log, first, options.prefix);
  Analysis analysis(census, options, &quality);
  const auto analyse = [&](const RawEpoch& raw) { analysis.add(raw); };
  quality.inputs =
      read_inputs(log, options.prefix, {analyse, analysis.ephemeris_store()}, progress, "judging ");
  analysis.finish();
  return quality;
}

}  // namespace leonav
