#include "core/gnss/carrier_arcs.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <utility>

#include "core/gnss/carrier_track.h"
#include "core/gnss/doppler_check.h"
#include "core/gnss/slip_judgement.h"
#include "core/gnss/usual_interval.h"

namespace leonav {
namespace {

constexpr double kMillisecond_m = 1.0e-3 * kSpeedOfLight;

}  // namespace

struct CarrierArcs::Storage {
  explicit Storage(const CycleSlipConfig& config_in) : config(config_in) {}

  struct Current {
    CarrierTrack* track = nullptr;  // nullptr: no carrier
    CarrierSample sample;
    bool late = false;       // no last sample near enough in time
    bool continued = false;  // last sample near enough in time, and of the same signals
    bool doppler_tested = false;
    SlipFindings findings;
  };

  CarrierTrack* track_of(SatelliteId id) { return &tracks[place_of(id)]; }
  double gap_limit_s(System system, double usual_s) const;
  void collect(GpsTime now, GpsTime previous, std::span<const CarrierInput> inputs);
  ClockJump repair_clock(double interval_s);
  void check_dopplers(const ClockJump& jump, double interval_s);
  void begin(Current* current, SlipCauses causes, CarrierStatus* status);
  void fill(const Current& current, CarrierStatus* status) const;
  void first_look(const ClockJump& jump, Current* current, CarrierStatus* status);

  CycleSlipConfig config;
  std::array<CarrierTrack, kMaxEphemerisSatellites> tracks;
  boost::container::static_vector<Current, kMaxSatellites> current;
  std::bitset<kMaxEphemerisSatellites> seen;  // in this epoch
  GpsTime time;
  UsualInterval usual;
  std::uint32_t last_arc = 0;
  int shift_ms = 0;  // by which codes have jumped against carriers since the start
  bool settled = true;
};

double CarrierArcs::Storage::gap_limit_s(System system, double usual_s) const {
  if (system == System::kLeo) return std::max(config.max_gap_leo_s, 1.5 * usual_s);
  return std::max(config.max_gap_s, config.max_gap_intervals * usual_s);
}

void CarrierArcs::Storage::collect(GpsTime now, GpsTime previous,
                                   std::span<const CarrierInput> inputs) {
  current.clear();
  seen.reset();
  const std::size_t count = std::min(inputs.size(), current.capacity());
  for (const CarrierInput& input : inputs.first(count)) {
    current.emplace_back();
    if (!has_carrier(input)) continue;
    const std::size_t place = place_of(input.first->satellite);
    if (place >= tracks.size() || seen.test(place)) continue;
    seen.set(place);
    Current& entry = current.back();
    entry.track = &tracks[place];
    entry.track->system = input.first->satellite.system;
    entry.sample = carrier_sample(input, now, shift_ms * kMillisecond_m);
    const CarrierSample& sample = entry.sample;
    // Nothing but the pair's combination tells of a slip while a satellite was away.
    const bool blind = sample.sides == 1 && entry.track->last().time != previous;
    entry.late = blind || !entry.track->is_continued_by(
                              sample, gap_limit_s(entry.track->system, usual.seconds()));
    entry.continued = !entry.late && entry.track->is_same_pair(sample);
  }
}

// Finds what jumped and takes it out of the samples.
ClockJump CarrierArcs::Storage::repair_clock(double interval_s) {
  boost::container::static_vector<ClockJumpSample, kMaxSatellites> samples;
  for (const Current& entry : current) {
    if (entry.track == nullptr || !entry.continued) continue;
    const CarrierSide& before = entry.track->last().side[0];
    const CarrierSide& now = entry.sample.side[0];
    // A satellite that was away for an epoch has seen another interval.
    if (seconds_between(entry.sample.time, entry.track->last().time) != interval_s) continue;
    samples.push_back({now.code_m - before.code_m, now.carrier_m - before.carrier_m,
                       0.5 * (now.doppler_m_s + before.doppler_m_s)});
  }
  const ClockJump jump =
      find_clock_jump({samples.data(), samples.size()}, interval_s, usual.seconds());
  const int apart_ms = jump.code_ms - jump.carrier_ms;
  shift_ms += apart_ms;
  for (Current& entry : current) {
    for (CarrierSide& side : entry.sample.side) side.code_m -= apart_ms * kMillisecond_m;
    entry.sample.carrier_shift_m = shift_ms * kMillisecond_m;
  }
  return jump;
}

void CarrierArcs::Storage::check_dopplers(const ClockJump& jump, double interval_s) {
  if (!config.use_doppler || !(interval_s <= config.doppler_max_interval_s)) return;
  boost::container::static_vector<DopplerRow, kMaxSatellites> rows;
  boost::container::static_vector<Current*, kMaxSatellites> owners;
  for (Current& entry : current) {
    if (entry.track == nullptr || !entry.continued || entry.findings.hard.any()) continue;
    if (seconds_between(entry.sample.time, entry.track->last().time) != interval_s) continue;
    DopplerRow row;
    row.elevation = entry.sample.elevation;
    for (int i = 0; i < entry.sample.sides; ++i) {
      const auto side = static_cast<std::size_t>(i);
      const CarrierSide& before = entry.track->last().side[side];
      const CarrierSide& now = entry.sample.side[side];
      row.carrier_change_m[side] =
          now.carrier_m + now.repair_m - before.carrier_m - before.repair_m;
      row.mean_rate_m_s[side] = 0.5 * (now.doppler_m_s + before.doppler_m_s);
      row.wavelength_m[side] = now.wavelength_m;
    }
    rows.push_back(row);
    owners.push_back(&entry);
  }
  check_doppler(config, true_interval_s(jump, interval_s), {rows.data(), rows.size()});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].loud) owners[i]->findings.soft |= SlipCause::kDoppler;
    owners[i]->doppler_tested = std::isfinite(rows[i].mean_rate_m_s[0]);
  }
}

void CarrierArcs::Storage::fill(const Current& entry, CarrierStatus* status) const {
  status->doppler_tested = entry.doppler_tested;
  status->arc = entry.track->arc;
  const CarrierSample& last = entry.track->last();
  for (int i = 0; i < last.sides; ++i) {
    if (last.side[static_cast<std::size_t>(i)].half_cycle_ambiguous) {
      status->half_cycle_unresolved = true;
    }
  }
  status->first_m = last.carrier(0);
  if (last.sides == 2) status->second_m = last.carrier(1);
}

void CarrierArcs::Storage::begin(Current* entry, SlipCauses causes, CarrierStatus* status) {
  entry->track->arc = ++last_arc;
  status->started = true;
  status->causes |= causes;
  status->suspected = {};
  fill(*entry, status);
}

void CarrierArcs::Storage::first_look(const ClockJump& jump, Current* entry,
                                      CarrierStatus* status) {
  CarrierTrack& track = *entry->track;
  SlipCauses causes = entry->findings.hard;
  if (track.is_known() && !entry->continued) {
    causes |= entry->late ? SlipCause::kGap : SlipCause::kSignalChanged;
  }
  if (jump.unrepairable && entry->continued) causes |= SlipCause::kClockJump;
  if (!track.is_known() || causes.any()) {
    // What the codes say after their own jump is no finding.
    if (!jump.unrepairable) causes |= entry->findings.soft;
    track.start(config, entry->sample, entry->continued && !jump.unrepairable);
    begin(entry, causes, status);
    return;
  }
  track.update(config, entry->sample, !entry->findings.code_outlier && !entry->findings.soft.any());
  status->suspected = entry->findings.soft;
  fill(*entry, status);
}

CarrierArcs::CarrierArcs(const CycleSlipConfig& config)
    : storage_(std::make_unique<Storage>(config)) {}
CarrierArcs::~CarrierArcs() = default;
CarrierArcs::CarrierArcs(CarrierArcs&&) noexcept = default;
CarrierArcs& CarrierArcs::operator=(CarrierArcs&&) noexcept = default;

void CarrierArcs::process(GpsTime time, std::span<const CarrierInput> inputs, ArcEpoch* epoch) {
  Storage& s = *storage_;
  if (!s.settled) settle({}, epoch);
  *epoch = {};
  // An epoch without any carrier is none for the arcs.
  if (std::none_of(inputs.begin(), inputs.end(), has_carrier)) {
    s.current.clear();
    s.seen.reset();
    epoch->satellites.resize(std::min(inputs.size(), epoch->satellites.capacity()));
    return;
  }
  const double interval_s = s.time.is_set() ? seconds_between(time, s.time) : 0.0;
  const GpsTime previous = std::exchange(s.time, time);
  // The first interval is the usual one until others are seen.
  const bool first_interval = interval_s > 0.0 && s.usual.seconds() == 0.0;
  if (first_interval) s.usual.add(interval_s);
  s.collect(time, previous, inputs);
  epoch->clock_jump = s.repair_clock(interval_s);
  if (interval_s > 0.0 && !first_interval)
    s.usual.add(true_interval_s(epoch->clock_jump, interval_s));
  for (Storage::Current& entry : s.current) {
    if (!entry.continued) continue;
    entry.findings = entry.track->examine(s.config, &entry.sample);
  }
  s.check_dopplers(epoch->clock_jump, interval_s);
  for (Storage::Current& entry : s.current) {
    epoch->satellites.emplace_back();
    if (entry.track == nullptr) continue;
    s.first_look(epoch->clock_jump, &entry, &epoch->satellites.back());
  }
  s.settled = false;
}

void CarrierArcs::settle(std::span<const RangeRowResult> results, ArcEpoch* epoch) {
  Storage& s = *storage_;
  s.settled = true;
  for (std::size_t i = 0; i < s.current.size(); ++i) {
    Storage::Current& entry = s.current[i];
    CarrierStatus* status = i < epoch->satellites.size() ? &epoch->satellites[i] : nullptr;
    if (entry.track == nullptr || status == nullptr || status->started) continue;
    const ArcEvidence evidence{entry.sample, entry.findings, status->suspected,
                               entry.doppler_tested, epoch->clock_jump.any()};
    const ArcJudgement judgement =
        judge_arc(s.config, evidence, i < results.size() ? &results[i] : nullptr);
    if (judgement.cleared) {
      if (status->suspected.any()) entry.track->learn_codes(s.config);
      status->suspected = {};
      continue;
    }
    if (!judgement.causes.any()) continue;
    entry.track->restart(s.config);
    s.begin(&entry, judgement.causes, status);
  }
}

CarrierStatus CarrierArcs::end_arc(SatelliteId satellite, SlipCause cause) {
  CarrierStatus status;
  Storage& s = *storage_;
  if (!is_valid(satellite) || index_of(satellite.system) >= kSystemCount) return status;
  const std::size_t place = place_of(satellite);
  if (place >= s.tracks.size() || !s.seen.test(place)) return status;
  Storage::Current entry;
  entry.track = &s.tracks[place];
  entry.track->restart(s.config);
  s.begin(&entry, cause, &status);
  return status;
}

double CarrierArcs::gap_limit_s(System system, GpsTime time) const {
  const Storage& s = *storage_;
  // The first interval is the usual one until others are seen.
  const bool first = s.usual.seconds() == 0.0 && s.time.is_set();
  return s.gap_limit_s(system, first ? seconds_between(time, s.time) : s.usual.seconds());
}

void CarrierArcs::reset() {
  for (CarrierTrack& track : storage_->tracks) track.forget();
  storage_->current.clear();
  storage_->seen.reset();
  storage_->time = {};
  storage_->usual = {};
  storage_->settled = true;
}

}  // namespace leonav
