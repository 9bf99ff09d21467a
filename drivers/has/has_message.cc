#include "drivers/has/has_message.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/gnss/signals/signal.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/week_time.h"

namespace leonav {
namespace {

constexpr std::int64_t kHour_s = 3600;

// By index of the validity interval; the last one is reserved. Source: ICD, table 23.
constexpr std::array<double, 15> kValidity_s = {5,   10,  15,  20,  30,  60,   90,  120,
                                                180, 240, 300, 600, 900, 1800, 3600};

// Reads the blocks of one message behind its mask.
class Blocks {
 public:
  Blocks(BitReader* bits, const HasMask& mask, const SsrMessage& head,
         std::vector<SsrMessage>* result, HasLeftOut* left_out)
      : bits_(bits), mask_(mask), head_(head), result_(result), left_out_(left_out) {}

  HasStatus read_orbits();
  HasStatus read_clocks();
  HasStatus read_clock_subset();
  HasStatus read_code_biases() { return read_biases(SsrKind::kCodeBias); }
  HasStatus read_phase_biases() { return read_biases(SsrKind::kPhaseBias); }

 private:
  HasStatus read_biases(SsrKind kind);
  void take_bias(SsrKind kind, System system, const std::optional<SignalCode>& code,
                 SsrSatellite* satellite);
  bool take_validity();
  std::optional<double> take_value(int count, double unit);
  void take_clock(double multiplier, SsrSatellite* satellite);
  SsrMessage message(SsrKind kind, const HasSystemMask& of) const;
  void add(SsrMessage message, const HasSystemMask& of);

  BitReader* bits_;
  const HasMask& mask_;
  SsrMessage head_;
  std::vector<SsrMessage>* result_;
  HasLeftOut* left_out_;
};

bool Blocks::take_validity() {
  const std::uint32_t index = bits_->take(4);
  if (index >= kValidity_s.size()) return false;
  head_.validity_s = kValidity_s[index];
  return true;
}

// The most negative number stands for "not available".
std::optional<double> Blocks::take_value(int count, double unit) {
  const std::int32_t value = bits_->take_signed(count);
  if (value == -(std::int32_t{1} << (count - 1))) return std::nullopt;
  return value * unit;
}

SsrMessage Blocks::message(SsrKind kind, const HasSystemMask& of) const {
  SsrMessage m = head_;
  m.kind = kind;
  m.system = of.system;
  return m;
}

void Blocks::add(SsrMessage message, const HasSystemMask& of) {
  const bool has_states = message.kind == SsrKind::kOrbit || message.kind == SsrKind::kClock;
  if (has_states && of.navigation_message != 0) {
    left_out_->other_navigation += message.satellites.size();
    return;
  }
  if (!message.satellites.empty()) result_->push_back(std::move(message));
}

HasStatus Blocks::read_orbits() {
  if (!take_validity()) return HasStatus::kBadValidity;
  for (const HasSystemMask& of : mask_) {
    SsrMessage m = message(SsrKind::kOrbit, of);
    const int issue_bits = of.system == System::kGalileo ? 10 : 8;
    for (const SatelliteId id : of.satellites) {
      SsrSatellite& satellite = m.satellites.emplace_back();
      satellite.satellite = id;
      SsrOrbit orbit;
      orbit.issue = static_cast<std::uint16_t>(bits_->take(issue_bits));
      const auto radial = take_value(13, 0.0025);
      const auto along = take_value(12, 0.008);
      const auto across = take_value(12, 0.008);
      satellite.orbit_ends = !radial || !along || !across;
      left_out_->unavailable += satellite.orbit_ends;
      if (satellite.orbit_ends) continue;
      orbit.delta_rac_m = {-*radial, -*along, -*across};
      satellite.orbit = orbit;
    }
    add(std::move(m), of);
  }
  return HasStatus::kOk;
}

void Blocks::take_clock(double multiplier, SsrSatellite* satellite) {
  constexpr double kUnit_m = 0.0025;
  constexpr int kCount = 13;
  constexpr std::int32_t kUnavailable = -(1 << (kCount - 1)), kDoNotUse = (1 << (kCount - 1)) - 1;
  const std::int32_t value = bits_->take_signed(kCount);
  left_out_->unavailable += value == kUnavailable;
  left_out_->do_not_use += value == kDoNotUse;
  satellite->clock_ends = value == kUnavailable || value == kDoNotUse;
  if (!satellite->clock_ends) satellite->clock = SsrClock{value * kUnit_m * multiplier, 0.0, 0.0};
}

HasStatus Blocks::read_clocks() {
  if (!take_validity()) return HasStatus::kBadValidity;
  std::vector<double> multipliers;
  for (std::size_t i = 0; i < mask_.size(); ++i) multipliers.push_back(bits_->take(2) + 1.0);
  for (std::size_t i = 0; i < mask_.size(); ++i) {
    SsrMessage m = message(SsrKind::kClock, mask_[i]);
    for (const SatelliteId id : mask_[i].satellites) {
      m.satellites.emplace_back().satellite = id;
      take_clock(multipliers[i], &m.satellites.back());
    }
    add(std::move(m), mask_[i]);
  }
  return HasStatus::kOk;
}

// Clocks of some of the mask's satellites; those of others go on.
HasStatus Blocks::read_clock_subset() {
  if (!take_validity()) return HasStatus::kBadValidity;
  const std::uint32_t systems = bits_->take(4);
  for (std::uint32_t i = 0; i < systems; ++i) {
    const std::optional<System> system = system_from_has(bits_->take(4));
    const auto of = std::find_if(mask_.begin(), mask_.end(), [&](const HasSystemMask& one) {
      return system && one.system == *system;
    });
    if (of == mask_.end()) return HasStatus::kBadSubset;
    const double multiplier = bits_->take(2) + 1.0;
    SsrMessage m = message(SsrKind::kClock, *of);
    for (const SatelliteId id : of->satellites) {
      if (bits_->take(1) != 0) m.satellites.emplace_back().satellite = id;
    }
    for (SsrSatellite& satellite : m.satellites) take_clock(multiplier, &satellite);
    add(std::move(m), *of);
  }
  return HasStatus::kOk;
}

HasStatus Blocks::read_biases(SsrKind kind) {
  if (!take_validity()) return HasStatus::kBadValidity;
  for (const HasSystemMask& of : mask_) {
    SsrMessage m = message(kind, of);
    for (std::size_t s = 0; s < of.satellites.size(); ++s) {
      SsrSatellite& satellite = m.satellites.emplace_back();
      satellite.satellite = of.satellites[s];
      for (std::size_t i = 0; i < of.signals.size(); ++i) {
        if (((of.cells[s] >> i) & 1u) != 0) take_bias(kind, of.system, of.signals[i], &satellite);
      }
    }
    add(std::move(m), of);
  }
  return HasStatus::kOk;
}

void Blocks::take_bias(SsrKind kind, System system, const std::optional<SignalCode>& code,
                       SsrSatellite* satellite) {
  const bool is_phase = kind == SsrKind::kPhaseBias;
  const auto value = take_value(11, is_phase ? 0.01 : 0.02);  // cycles, or m
  SsrBias bias;
  if (is_phase) bias.discontinuities = static_cast<std::uint8_t>(bits_->take(2));
  left_out_->unavailable += !value;
  left_out_->reserved_signals += !code;
  if (!value || !code) return;
  bias.code = *code;
  bias.bias_m = is_phase ? *value * wavelength_m(system, code->band) : *value;
  (is_phase ? satellite->phase_biases : satellite->code_biases).push_back(bias);
}

}  // namespace

HasStatus HasMessages::decode(std::span<const std::uint8_t> octets, GpsTime received,
                              std::vector<SsrMessage>* result, HasLeftOut* left_out) {
  BitReader bits(octets);
  const std::uint32_t toh_s = bits.take(12);
  const bool has_mask = bits.take(1) != 0, has_orbits = bits.take(1) != 0;
  const bool has_clocks = bits.take(1) != 0, has_clock_subset = bits.take(1) != 0;
  const bool has_code_biases = bits.take(1) != 0, has_phase_biases = bits.take(1) != 0;
  bits.skip(4);
  const std::uint32_t mask_id = bits.take(5), issue = bits.take(5);
  if (toh_s >= kHour_s) return HasStatus::kBadTime;

  Known known = masks_[mask_id];
  if (has_mask) {
    std::optional<HasMask> mask = read_has_mask(&bits);
    if (!mask) return HasStatus::kBadMask;
    known = {received, std::move(*mask)};
  }
  if (!known.received.is_set() ||
      std::abs(seconds_between(received, known.received)) > kLongestMaskLife_s) {
    return HasStatus::kWithoutMask;
  }
  SsrMessage head;
  head.service = SsrService::kGalileoHas;
  head.time = nearest_instant_of_period(toh_s * kNanosecondsPerSecond,
                                        kHour_s * kNanosecondsPerSecond, received);
  head.at_antenna = true;
  head.issue = static_cast<std::uint8_t>(issue);
  head.solution = static_cast<std::uint8_t>(mask_id);

  std::vector<SsrMessage> messages;
  HasLeftOut counts = *left_out;
  Blocks blocks(&bits, known.mask, head, &messages, &counts);
  const std::pair<bool, HasStatus (Blocks::*)()> readers[] = {
      {has_orbits, &Blocks::read_orbits},
      {has_clocks, &Blocks::read_clocks},
      {has_clock_subset, &Blocks::read_clock_subset},
      {has_code_biases, &Blocks::read_code_biases},
      {has_phase_biases, &Blocks::read_phase_biases}};
  for (const auto& [is_there, read] : readers) {
    if (!is_there) continue;
    const HasStatus status = (blocks.*read)();
    if (bits.overrun()) return HasStatus::kBadLength;
    if (status != HasStatus::kOk) return status;
  }
  if (bits.overrun()) return HasStatus::kBadLength;
  masks_[mask_id] = std::move(known);
  *left_out = counts;
  result->insert(result->end(), messages.begin(), messages.end());
  return HasStatus::kOk;
}

}  // namespace leonav
