#include "core/gnss/cycle_slips/carrier_arcs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/gnss/cycle_slips/internal/arc_detectors.h"
#include "core/gnss/cycle_slips/internal/clock_jump.h"
#include "core/gnss/cycle_slips/internal/doppler_test.h"
#include "core/gnss/cycle_slips/internal/nominal_interval.h"
#include "core/gnss/cycle_slips/internal/slip_decision.h"

namespace leonav {
struct CarrierArcs::Storage {
  Storage(const CycleSlipConfig& config_in, const BandPlan& bands_in)
      : config(config_in), bands(bands_in) {}

  struct Current {
    ArcDetectors* detectors = nullptr;  // nullptr: no carrier
    CarrierSample sample;
    bool late = false;       // the last sample is too long ago
    bool continued = false;  // the last sample is recent enough and of the same signals
    bool doppler_tested = false;
    SlipFindings findings;
  };

  ArcDetectors* find_detectors(SatelliteId id) { return &detectors_of[table_index_of(id)]; }
  double gap_limit_s(System system, double nominal_s) const;
  void collect(GpsTime now, GpsTime previous, std::span<const CarrierInput> inputs);
  ClockJump repair_clock(double interval_s);
  void test_dopplers(const ClockJump& jump, double interval_s);
  void begin(Current* current, SlipCauses causes, CarrierStatus* status);
  void fill(const Current& current, CarrierStatus* status) const;
  void apply_detectors(const ClockJump& jump, Current* current, CarrierStatus* status);

  CycleSlipConfig config;
  BandPlan bands;
  std::array<ArcDetectors, kMaxEphemerisSatellites> detectors_of;
  boost::container::static_vector<Current, kMaxSatellites> current;
  std::array<bool, kMaxEphemerisSatellites> seen{};  // in this epoch
  GpsTime time;
  NominalInterval nominal;
  std::uint32_t last_arc = 0;
  int shift_ms = 0;  // by which codes have jumped against carriers since the start
  bool range_change_applied = true;
};

double CarrierArcs::Storage::gap_limit_s(System system, double nominal_s) const {
  if (system == System::kLeo) return std::max(config.max_gap_leo_s, 1.5 * nominal_s);
  return std::max(config.max_gap_s, config.max_gap_intervals * nominal_s);
}

void CarrierArcs::Storage::collect(GpsTime now, GpsTime previous,
                                   std::span<const CarrierInput> inputs) {
  current.clear();
  seen.fill(false);
  const std::size_t count = std::min(inputs.size(), current.capacity());
  for (const CarrierInput& input : inputs.first(count)) {
    current.emplace_back();
    if (!has_carrier(input, bands)) continue;
    const std::size_t index = table_index_of(input.first->satellite);
    if (index >= detectors_of.size() || seen[index]) continue;
    seen[index] = true;
    Current& entry = current.back();
    entry.detectors = &detectors_of[index];
    entry.detectors->system = input.first->satellite.system;
    entry.sample = carrier_sample(input, bands, now, shift_ms * kMillisecond_m);
    const CarrierSample& sample = entry.sample;
    // On one frequency no test works across an absence; a pair has its geometry-free combination.
    const bool blind = sample.signal_count == 1 && entry.detectors->last().time != previous;
    entry.late = blind || !entry.detectors->is_continued_by(
                              sample, gap_limit_s(entry.detectors->system, nominal.seconds()));
    entry.continued = !entry.late && entry.detectors->is_same_pair(sample);
  }
}

// Finds the jumps of the clock and removes them from the samples.
ClockJump CarrierArcs::Storage::repair_clock(double interval_s) {
  boost::container::static_vector<ClockJumpSample, kMaxSatellites> samples;
  for (const Current& entry : current) {
    if (entry.detectors == nullptr || !entry.continued) continue;
    const CarrierSignal& before = entry.detectors->last().signal[0];
    const CarrierSignal& now = entry.sample.signal[0];
    // A satellite that was absent for an epoch has changed over another interval.
    if (seconds_between(entry.sample.time, entry.detectors->last().time) != interval_s) continue;
    samples.push_back({now.code_m - before.code_m, now.carrier_m - before.carrier_m,
                       0.5 * (now.doppler_m_s + before.doppler_m_s)});
  }
  const ClockJump jump =
      find_clock_jump({samples.data(), samples.size()}, interval_s, nominal.seconds());
  const int code_minus_carrier_ms = jump.code_ms - jump.carrier_ms;
  shift_ms += code_minus_carrier_ms;
  for (Current& entry : current) {
    for (CarrierSignal& signal : entry.sample.signal)
      signal.code_m -= code_minus_carrier_ms * kMillisecond_m;
    entry.sample.carrier_shift_m = shift_ms * kMillisecond_m;
  }
  return jump;
}

void CarrierArcs::Storage::test_dopplers(const ClockJump& jump, double interval_s) {
  if (!config.use_doppler || !(interval_s <= config.doppler_max_interval_s)) return;
  boost::container::static_vector<DopplerRow, kMaxSatellites> rows;
  boost::container::static_vector<Current*, kMaxSatellites> owners;
  for (Current& entry : current) {
    if (entry.detectors == nullptr || !entry.continued || entry.findings.certain.any()) continue;
    if (seconds_between(entry.sample.time, entry.detectors->last().time) != interval_s) continue;
    DopplerRow row;
    row.elevation = entry.sample.elevation;
    for (int i = 0; i < entry.sample.signal_count; ++i) {
      const auto signal = static_cast<std::size_t>(i);
      const CarrierSignal& before = entry.detectors->last().signal[signal];
      const CarrierSignal& now = entry.sample.signal[signal];
      row.carrier_change_m[signal] =
          now.carrier_m + now.repair_m - before.carrier_m - before.repair_m;
      row.mean_rate_m_s[signal] = 0.5 * (now.doppler_m_s + before.doppler_m_s);
      row.wavelength_m[signal] = now.wavelength_m;
    }
    rows.push_back(row);
    owners.push_back(&entry);
  }
  test_doppler(config, true_interval_s(jump, interval_s), {rows.data(), rows.size()});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].exceeds_limit) owners[i]->findings.refutable |= SlipCause::kDoppler;
    owners[i]->doppler_tested = std::isfinite(rows[i].mean_rate_m_s[0]);
  }
}

void CarrierArcs::Storage::fill(const Current& entry, CarrierStatus* status) const {
  status->doppler_tested = entry.doppler_tested;
  status->arc = entry.detectors->arc;
  const CarrierSample& last = entry.detectors->last();
  for (int i = 0; i < last.signal_count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (last.signal[index].half_cycle_ambiguous) status->half_cycle_unresolved = true;
    status->repaired_m[index] = last.signal[index].repair_m;
  }
  status->first_m = last.carrier(0);
  if (last.signal_count != 2) return;
  status->second_m = last.carrier(1);
  status->geometry_free_noise = entry.detectors->geometry_free_noise(config);
}

void CarrierArcs::Storage::begin(Current* entry, SlipCauses causes, CarrierStatus* status) {
  entry->detectors->arc = ++last_arc;
  status->started = true;
  status->causes |= causes;
  status->suspected = {};
  fill(*entry, status);
}

void CarrierArcs::Storage::apply_detectors(const ClockJump& jump, Current* entry,
                                           CarrierStatus* status) {
  ArcDetectors& detectors = *entry->detectors;
  SlipCauses causes = entry->findings.certain;
  if (detectors.is_known() && !entry->continued) {
    causes |= entry->late ? SlipCause::kGap : SlipCause::kSignalChanged;
  }
  if (jump.unrepairable && entry->continued) causes |= SlipCause::kClockJump;
  if (!detectors.is_known() || causes.any()) {
    // Where the codes jumped themselves, findings based on codes are no evidence.
    if (!jump.unrepairable) causes |= entry->findings.refutable;
    detectors.start(config, entry->sample, entry->continued && !jump.unrepairable);
    begin(entry, causes, status);
    return;
  }
  detectors.update(config, entry->sample,
                   !entry->findings.code_outlier && !entry->findings.refutable.any());
  status->suspected = entry->findings.refutable;
  fill(*entry, status);
}

CarrierArcs::CarrierArcs(const CycleSlipConfig& config, const BandPlan& bands)
    : storage_(std::make_unique<Storage>(config, bands)) {}
CarrierArcs::~CarrierArcs() = default;
CarrierArcs::CarrierArcs(CarrierArcs&&) noexcept = default;
CarrierArcs& CarrierArcs::operator=(CarrierArcs&&) noexcept = default;

void CarrierArcs::process(GpsTime time, std::span<const CarrierInput> inputs, ArcEpoch* epoch) {
  Storage& s = *storage_;
  if (!s.range_change_applied) apply_range_change({}, epoch);
  *epoch = {};
  // An epoch without any carrier does not count as an epoch of the arcs.
  if (std::none_of(inputs.begin(), inputs.end(),
                   [&s](const CarrierInput& input) { return has_carrier(input, s.bands); })) {
    s.current.clear();
    s.seen.fill(false);
    epoch->satellites.resize(std::min(inputs.size(), epoch->satellites.capacity()));
    return;
  }
  const double interval_s = s.time.is_set() ? seconds_between(time, s.time) : 0.0;
  const GpsTime previous = std::exchange(s.time, time);
  // The first interval is the nominal one until more are observed.
  const bool first_interval = interval_s > 0.0 && s.nominal.seconds() == 0.0;
  if (first_interval) s.nominal.add(interval_s);
  s.collect(time, previous, inputs);
  epoch->clock_jump = s.repair_clock(interval_s);
  if (interval_s > 0.0 && !first_interval)
    s.nominal.add(true_interval_s(epoch->clock_jump, interval_s));
  for (Storage::Current& entry : s.current) {
    if (!entry.continued) continue;
    entry.findings = entry.detectors->detect_slips(s.config, &entry.sample);
  }
  s.test_dopplers(epoch->clock_jump, interval_s);
  for (Storage::Current& entry : s.current) {
    epoch->satellites.emplace_back();
    if (entry.detectors == nullptr) continue;
    s.apply_detectors(epoch->clock_jump, &entry, &epoch->satellites.back());
  }
  s.range_change_applied = false;
}

void CarrierArcs::apply_range_change(std::span<const RangeChangeRowResult> results,
                                     ArcEpoch* epoch) {
  Storage& s = *storage_;
  s.range_change_applied = true;
  for (std::size_t i = 0; i < s.current.size(); ++i) {
    Storage::Current& entry = s.current[i];
    CarrierStatus* status = i < epoch->satellites.size() ? &epoch->satellites[i] : nullptr;
    if (entry.detectors == nullptr || status == nullptr || status->started) continue;
    const ArcEvidence evidence{entry.sample, entry.findings, status->suspected,
                               entry.doppler_tested, epoch->clock_jump.any()};
    const ArcDecision decision =
        decide_arc(s.config, evidence, i < results.size() ? &results[i] : nullptr);
    if (decision.cleared) {
      if (status->suspected.any()) entry.detectors->update_wide_lane(s.config);
      status->suspected = {};
      continue;
    }
    if (!decision.causes.any()) continue;
    entry.detectors->restart(s.config);
    s.begin(&entry, decision.causes, status);
  }
}

CarrierStatus CarrierArcs::end_arc(SatelliteId satellite, SlipCause cause) {
  CarrierStatus status;
  Storage& s = *storage_;
  if (!is_valid(satellite) || index_of(satellite.system) >= kSystemCount) return status;
  const std::size_t index = table_index_of(satellite);
  if (index >= s.detectors_of.size() || !s.seen[index]) return status;
  Storage::Current entry;
  entry.detectors = &s.detectors_of[index];
  entry.detectors->restart(s.config);
  s.begin(&entry, cause, &status);
  return status;
}

double CarrierArcs::gap_limit_s(System system, GpsTime time) const {
  const Storage& s = *storage_;
  // The first interval is the nominal one until more are observed.
  const bool first = s.nominal.seconds() == 0.0 && s.time.is_set();
  return s.gap_limit_s(system, first ? seconds_between(time, s.time) : s.nominal.seconds());
}

void CarrierArcs::reset() {
  for (ArcDetectors& detectors : storage_->detectors_of) detectors.clear();
  storage_->current.clear();
  storage_->seen.fill(false);
  storage_->time = {};
  storage_->nominal = {};
  storage_->range_change_applied = true;
}

}  // namespace leonav
