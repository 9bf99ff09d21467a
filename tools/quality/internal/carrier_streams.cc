#include "tools/quality/internal/carrier_streams.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace leonav {
namespace {

// Returns the satellite's signal with this code if its carrier was measured; otherwise nullptr.
const SignalObservation* carrier_in(const RawEpoch& raw, SatelliteId satellite, SignalCode code) {
  const auto before = [](const SignalObservation& o,
                         const std::pair<SatelliteId, SignalCode>& key) {
    return std::pair(o.satellite, o.code) < key;
  };
  const auto found = std::lower_bound(raw.observations.begin(), raw.observations.end(),
                                      std::pair(satellite, code), before);
  const bool there = found != raw.observations.end() && found->satellite == satellite &&
                     found->code == code && std::isfinite(found->carrier_cycles);
  return there ? &*found : nullptr;
}

void add_signal(SignalCode code, std::vector<SignalCode>* signals) {
  if (std::find(signals->begin(), signals->end(), code) == signals->end()) signals->push_back(code);
}

}  // namespace

bool is_slip(SlipCauses causes) {
  constexpr std::uint16_t kNone = static_cast<std::uint16_t>(SlipCause::kGap) |
                                  static_cast<std::uint16_t>(SlipCause::kSignalChanged) |
                                  static_cast<std::uint16_t>(SlipCause::kClockJump) |
                                  static_cast<std::uint16_t>(SlipCause::kUntested);
  return (causes.bits() & ~kNone) != 0;
}

bool is_flagged_by_receiver(SlipCauses causes) {
  return causes.has(SlipCause::kLossOfLock) || causes.has(SlipCause::kLockTime);
}

// One set of arcs. `own` marks satellites of this stream. For the others their best pair is used,
// so that effects common to all satellites (clock jumps, geometry) are detected as well as in the
// first stream.
struct CarrierStreams::Stream {
  explicit Stream(const GnssConfig& config)
      : arcs(config.cycle_slips, config.bands), range_test(config.cycle_slips, config.bands) {}

  CarrierArcs arcs;
  RangeTest range_test;
  std::vector<CarrierInput> inputs;
  std::vector<bool> own;
  ArcEpoch epoch;
  std::map<SatelliteId, std::size_t> place;  // index in `inputs`, for own satellites
};

CarrierStreams::CarrierStreams(std::map<SatelliteId, CarrierPlan> plans, const GnssConfig& config)
    : plans_(std::move(plans)), bands_(config.bands) {
  std::size_t most = 1;
  for (const auto& [satellite, plan] : plans_) most = std::max(most, plan.others.size());
  for (std::size_t i = 0; i < most; ++i) streams_.push_back(std::make_unique<Stream>(config));
}

CarrierStreams::~CarrierStreams() = default;

void CarrierStreams::collect(const RawEpoch& raw, const Sky& sky, std::size_t place) {
  Stream& stream = *streams_[place];
  stream.inputs.clear();
  stream.own.clear();
  stream.place.clear();
  for (const auto& [satellite, plan] : plans_) {
    const bool own = place < std::max<std::size_t>(plan.others.size(), 1);
    CarrierInput input;
    input.first = carrier_in(raw, satellite, plan.reference);
    if (input.first == nullptr) continue;
    if (!plan.others.empty()) {
      input.second = carrier_in(raw, satellite, plan.others[own ? place : 0]);
      if (input.second == nullptr) continue;  // its arc survives a short gap
    }
    const SatelliteInView* view = sky.find(satellite);
    if (view != nullptr && has_direction(*view, sky.has_position()))
      input.elevation = view->elevation;
    if (own) stream.place[satellite] = stream.inputs.size();
    stream.inputs.push_back(input);
    stream.own.push_back(own);
  }
}

const std::vector<ArcBreak>& CarrierStreams::process(const RawEpoch& raw, const Sky& sky) {
  std::map<SatelliteId, ArcBreak> breaks;
  for (std::size_t place = 0; place < streams_.size(); ++place) {
    collect(raw, sky, place);
    Stream& stream = *streams_[place];
    stream.arcs.process(raw.time, stream.inputs, &stream.epoch);
    if (place == 0 && stream.epoch.clock_jump.any()) ++clock_jumps_;
    const auto results = stream.range_test.test(stream.inputs, stream.epoch, sky);
    stream.arcs.apply_range_change(results, &stream.epoch);
    stream.range_test.remember(stream.inputs, stream.epoch, sky);
    for (const auto& [satellite, i] : stream.place) {
      const CarrierStatus& status = stream.epoch.satellites[i];
      if (!status.started || !status.causes.any()) continue;
      ArcBreak& one = breaks[satellite];
      one.time = raw.time;
      one.satellite = satellite;
      one.causes |= status.causes;
      const SatelliteInView* view = sky.find(satellite);
      one.elevation = view != nullptr && has_direction(*view, sky.has_position())
                          ? view->elevation
                          : std::numeric_limits<double>::quiet_NaN();
      add_signal(stream.inputs[i].first->code, &one.signals);
      if (stream.inputs[i].second != nullptr)
        add_signal(stream.inputs[i].second->code, &one.signals);
    }
  }
  breaks_.clear();
  for (auto& [satellite, one] : breaks) breaks_.push_back(std::move(one));
  return breaks_;
}

const CarrierStatus* CarrierStreams::status_of(SatelliteId satellite, std::size_t place) const {
  if (place >= streams_.size()) return nullptr;
  const Stream& stream = *streams_[place];
  const auto found = stream.place.find(satellite);
  if (found == stream.place.end() || found->second >= stream.epoch.satellites.size())
    return nullptr;
  const CarrierStatus& status = stream.epoch.satellites[found->second];
  return status.arc != 0 ? &status : nullptr;
}

PairedCarriers CarrierStreams::carriers_of(SatelliteId satellite, char band) const {
  PairedCarriers carriers;
  const auto plan = plans_.find(satellite);
  if (plan == plans_.end() || plan->second.others.empty()) return carriers;
  const auto& others = plan->second.others;
  const char reference = plan->second.reference.band;
  const auto other = std::find_if(others.begin(), others.end(),
                                  [&](SignalCode code) { return code.band == band; });
  if (band != reference && other == others.end()) return carriers;
  const auto place =
      band == reference ? 0 : static_cast<std::size_t>(std::distance(others.begin(), other));
  const CarrierStatus* status = status_of(satellite, place);
  if (status == nullptr || !std::isfinite(status->second_m)) return carriers;
  carriers.arc = std::uint64_t{status->arc} * streams_.size() + place + 1;
  carriers.own_m = band == reference ? status->first_m : status->second_m;
  carriers.other_m = band == reference ? status->second_m : status->first_m;
  carriers.own_hz = bands_.frequency_hz(satellite.system, band);
  carriers.other_hz =
      bands_.frequency_hz(satellite.system, band == reference ? others[place].band : reference);
  return carriers;
}

bool CarrierStreams::is_followed(SatelliteId satellite) const {
  for (std::size_t place = 0; place < streams_.size(); ++place)
    if (status_of(satellite, place) != nullptr) return true;
  return false;
}

bool CarrierStreams::half_cycle_unresolved(SatelliteId satellite) const {
  for (std::size_t place = 0; place < streams_.size(); ++place) {
    const CarrierStatus* status = status_of(satellite, place);
    if (status != nullptr && status->half_cycle_unresolved) return true;
  }
  return false;
}

bool CarrierStreams::has_pair(SatelliteId satellite) const {
  const auto plan = plans_.find(satellite);
  return plan != plans_.end() && !plan->second.others.empty();
}

}  // namespace leonav
