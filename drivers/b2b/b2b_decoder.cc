#include "drivers/b2b/b2b_decoder.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/calendar.h"
#include "drivers/binary/week_time.h"

namespace leonav {
namespace {

constexpr std::uint8_t kMask = 1, kOrbits = 2, kBiases = 3, kClocks = 4, kEmpty = 63;
constexpr std::int64_t kDay_s = 86'400;

// Takes a signed number. The two most negative ones mark a value that is not available.
std::optional<double> take_value(BitReader* bits, int count, double unit) {
  const std::int32_t value = bits->take_signed(count);
  if (value <= -(std::int32_t{1} << (count - 1)) + 1) return std::nullopt;
  return value * unit;
}

SsrKind kind_of(std::uint8_t type) {
  if (type == kOrbits) return SsrKind::kOrbit;
  return type == kBiases ? SsrKind::kCodeBias : SsrKind::kClock;
}

// Returns a message for each system of the satellites.
std::vector<SsrMessage> by_system(const SsrMessage& head, std::vector<SsrSatellite> satellites) {
  std::vector<SsrMessage> messages;
  for (SsrSatellite& satellite : satellites) {
    const System system = satellite.satellite.system;
    auto of = std::find_if(messages.begin(), messages.end(),
                           [system](const SsrMessage& m) { return m.system == system; });
    if (of == messages.end()) {
      of = messages.insert(messages.end(), head);
      of->system = system;
    }
    of->satellites.push_back(std::move(satellite));
  }
  return messages;
}

}  // namespace

std::vector<SsrMessage> B2bDecoder::add(const CorrectionPage& page) {
  const auto refuse = [](std::uint64_t* counter) {
    ++*counter;
    return std::vector<SsrMessage>();
  };
  if (page.satellite.system != System::kBeidou || !is_valid(page.satellite)) {
    return refuse(&counters_.bad_satellites);
  }
  if (!page.received.is_set()) return refuse(&counters_.without_time);
  if (!is_intact(page)) return refuse(&counters_.bad_checksums);
  BitReader bits(page.bits);
  const auto type = static_cast<std::uint8_t>(bits.take(6));
  if (type == kEmpty) return refuse(&counters_.empty);
  if (type < kMask || type > kClocks) return refuse(&counters_.other_types[type]);
  if (is_repeated(page)) return refuse(&counters_.repeated);

  SsrMessage head;
  if (!take_head(&bits, page.received, &head)) return refuse(&counters_.bad_time);
  head.kind = kind_of(type);
  std::vector<SsrSatellite> satellites;
  if (type == kMask) {
    read_mask(&bits, head, page.received);
  } else if (type == kOrbits) {
    head.validity_s = kOrbitValidity_s;
    satellites = read_orbits(&bits);
  } else if (type == kBiases) {
    satellites = read_biases(&bits);
  } else {
    const auto iodp = bits.take(4);
    const Mask& mask = masks_[iodp];
    const bool is_known =
        mask.received.is_set() && mask.issue == head.issue &&
        std::abs(seconds_between(page.received, mask.received)) <= kLongestMaskLife_s;
    if (!is_known) return refuse(&counters_.without_mask);
    head.validity_s = kClockValidity_s;
    satellites = read_clocks(&bits, mask);
  }
  if (bits.position() > CorrectionPage::kContentBits) return refuse(&counters_.bad_length);
  ++counters_.messages;
  return by_system(head, std::move(satellites));
}

// All satellites send the same messages within a second or so.
bool B2bDecoder::is_repeated(const CorrectionPage& page) {
  constexpr double kMoment_s = 4.0;
  const bool is_there =
      std::any_of(last_pages_.begin(), last_pages_.end(), [&page](const CorrectionPage& last) {
        return last.bits == page.bits && last.received.is_set() &&
               std::abs(seconds_between(page.received, last.received)) <= kMoment_s;
      });
  if (is_there) return true;
  last_pages_[next_page_] = page;
  next_page_ = (next_page_ + 1) % last_pages_.size();
  return false;
}

// Takes the time of the day, BeiDou's own, and the issue. Returns false for an impossible time.
bool B2bDecoder::take_head(BitReader* bits, GpsTime received, SsrMessage* head) {
  const std::uint32_t tod_s = bits->take(17);
  bits->skip(4);
  head->service = SsrService::kBeidouB2b;
  head->issue = static_cast<std::uint8_t>(bits->take(2));
  head->at_antenna = true;
  head->time = nearest_instant_of_period(
      (std::int64_t{tod_s} - kBeidouMinusGpsSeconds) * kNanosecondsPerSecond,
      kDay_s * kNanosecondsPerSecond, received);
  return tod_s < kDay_s;
}

void B2bDecoder::read_mask(BitReader* bits, const SsrMessage& head, GpsTime received) {
  Mask& mask = masks_[bits->take(4)];
  mask = {received, head.issue, {}};
  for (std::uint16_t slot = 1; slot <= kB2bSlots; ++slot) {
    if (bits->take(1) != 0) mask.slots.push_back(slot);
  }
}

std::optional<SatelliteId> B2bDecoder::satellite_of(std::uint32_t slot) {
  const std::optional<SatelliteId> satellite = satellite_from_b2b(slot);
  counters_.other_systems += !satellite;
  return satellite;
}

std::vector<SsrSatellite> B2bDecoder::read_orbits(BitReader* bits) {
  constexpr int kSatellites = 6;
  std::vector<SsrSatellite> satellites;
  for (int i = 0; i < kSatellites; ++i) {
    const std::uint32_t slot = bits->take(9);
    SsrOrbit orbit;
    orbit.axes = OrbitAxes::kRadial;
    orbit.issue = static_cast<std::uint16_t>(bits->take(10));
    orbit.correction_issue = static_cast<std::uint8_t>(bits->take(3));
    const auto radial = take_value(bits, 15, 0.0016);
    const auto along = take_value(bits, 13, 0.0064);
    const auto across = take_value(bits, 13, 0.0064);
    const auto accuracy = static_cast<std::uint8_t>(bits->take(6));
    if (slot == 0) continue;  // fewer satellites than there is room for
    const std::optional<SatelliteId> id = satellite_of(slot);
    if (!id) continue;
    // Of GPS and BeiDou it is the IODC, whose lowest eight bits are the IODE.
    if (id->system != System::kGalileo) orbit.issue &= 0xFF;
    SsrSatellite& satellite = satellites.emplace_back();
    satellite.satellite = *id;
    satellite.accuracy_index = accuracy;
    satellite.orbit_ends = !radial || !along || !across;
    counters_.unavailable += satellite.orbit_ends;
    if (satellite.orbit_ends) continue;
    orbit.delta_rac_m = {*radial, *along, *across};
    satellite.orbit = orbit;
  }
  return satellites;
}

std::vector<SsrSatellite> B2bDecoder::read_biases(BitReader* bits) {
  std::vector<SsrSatellite> satellites;
  const std::uint32_t count = bits->take(5);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t slot = bits->take(9), signals = bits->take(4);
    SsrSatellite satellite;
    const std::optional<SatelliteId> id = satellite_of(slot);
    for (std::uint32_t k = 0; k < signals; ++k) {
      const std::uint32_t mode = bits->take(4);
      const auto bias = take_value(bits, 12, 0.017);
      if (!id) continue;
      const std::optional<SignalCode> code = signal_from_b2b(id->system, mode);
      counters_.unavailable += !bias;
      counters_.reserved_signals += !code;
      if (bias && code) satellite.code_biases.push_back({*code, -*bias, false, 0, 0});
    }
    if (!id) continue;
    satellite.satellite = *id;
    satellites.push_back(std::move(satellite));
  }
  return satellites;
}

std::vector<SsrSatellite> B2bDecoder::read_clocks(BitReader* bits, const Mask& mask) {
  constexpr std::uint32_t kClocksOfMessage = 23;
  std::vector<SsrSatellite> satellites;
  const std::uint32_t first = bits->take(5) * kClocksOfMessage;
  for (std::uint32_t i = first; i < first + kClocksOfMessage; ++i) {
    SsrClock clock;
    clock.correction_issue = static_cast<std::uint8_t>(bits->take(3));
    const auto c0 = take_value(bits, 15, 0.0016);
    if (i >= mask.slots.size()) continue;
    const std::optional<SatelliteId> id = satellite_of(mask.slots[i]);
    if (!id) continue;
    SsrSatellite& satellite = satellites.emplace_back();
    satellite.satellite = *id;
    satellite.clock_ends = !c0;
    counters_.unavailable += satellite.clock_ends;
    if (satellite.clock_ends) continue;
    clock.c0_m = -*c0;
    satellite.clock = clock;
  }
  return satellites;
}

}  // namespace leonav
