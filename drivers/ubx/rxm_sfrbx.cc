#include "drivers/ubx/rxm_sfrbx.h"

#include <array>

#include "drivers/binary/bit_field.h"
#include "drivers/binary/little_endian.h"
#include "drivers/ubx/ubx_signal.h"

namespace leonav {
namespace {

constexpr std::size_t kSfrbxHeaderSize = 8;
constexpr std::uint8_t kSfrbxVersion = 2;
constexpr std::size_t kMaxWords = 19;  // BeiDou B-CNAV1, the longest there is

using Words = std::span<const std::uint32_t>;

constexpr std::size_t kCnavWords = 10, kPageWords = 16, kBcnav1Words = 19, kBcnav2Words = 9;

// The bits of a message that fill its words from the first on.
std::vector<std::uint8_t> bits_of(Words words) {
  BitWriter<kMaxWords * sizeof(std::uint32_t)> writer;
  for (const std::uint32_t word : words) writer.put(word, 32);
  const auto bytes = std::span<const std::uint8_t>(writer.bytes()).first(words.size_bytes());
  return {bytes.begin(), bytes.end()};
}

// Makes a page of the words of E6-B: 486 bits from the highest one of the first word, then tail and
// padding.
CorrectionPage read_page(Words words, const SubframeOrigin& origin) {
  CorrectionPage page;
  page.satellite = origin.satellite;
  page.received = origin.now;
  for (std::size_t i = 0; i < page.bits.size(); ++i) {
    page.bits[i] = static_cast<std::uint8_t>(words[i / 4] >> (24 - 8 * (i % 4)));
  }
  return page;
}

}  // namespace

RxmSfrbxDecoder::RxmSfrbxDecoder() : collector_(std::make_unique<NavigationCollector>()) {}
RxmSfrbxDecoder::~RxmSfrbxDecoder() = default;

NavigationUpdate RxmSfrbxDecoder::decode(std::span<const std::uint8_t> payload, GpsTime now) {
  if (payload.size() < kSfrbxHeaderSize || payload[4] > kMaxWords ||
      payload.size() != kSfrbxHeaderSize + payload[4] * sizeof(std::uint32_t)) {
    ++counters_.bad_length;
    return {};
  }
  if (payload[6] != kSfrbxVersion) {
    ++counters_.bad_version;
    return {};
  }
  const std::optional<System> system = system_from_ubx(payload[0]);
  if (!system) {
    ++counters_.other_system;
    return {};
  }
  const SubframeOrigin origin{{*system, payload[1]}, now};
  if (!is_valid(origin.satellite) || origin.satellite.number >= NavigationCollector::kSatellites) {
    ++counters_.bad_satellite;
    return {};
  }
  if (!now.is_set()) {
    ++counters_.without_time;
    return {};
  }
  std::array<std::uint32_t, kMaxWords> buffer{};
  for (std::size_t i = 0; i < payload[4]; ++i) {
    buffer[i] = read_u4(payload.data() + kSfrbxHeaderSize + i * sizeof(std::uint32_t));
  }
  return add(payload[2], Words(buffer).first(payload[4]), origin);
}

NavigationUpdate RxmSfrbxDecoder::add(std::uint8_t signal_id, Words words,
                                      const SubframeOrigin& origin) {
  constexpr std::uint8_t kL1Ca = 0, kL2Cl = 3, kL2Cm = 4, kL5I = 6, kL5Q = 7;
  constexpr std::uint8_t kB1Cp = 5, kB1Cd = 6, kB2ap = 7, kB2ad = 8;
  constexpr std::uint8_t kE1B = 1, kE5aI = 3, kE5bI = 5, kE6B = 8;
  switch (origin.satellite.system) {
    case System::kGps: {
      const bool is_cnav =
          signal_id == kL2Cl || signal_id == kL2Cm || signal_id == kL5I || signal_id == kL5Q;
      if (is_cnav && words.size() == kCnavWords) {
        return collector_->add_gps_cnav(bits_of(words), origin);
      }
      if (signal_id != kL1Ca || words.size() != GpsLnav::kWords) break;
      return collector_->add_gps_lnav(words.first<GpsLnav::kWords>(), origin);
    }
    case System::kGalileo:
      if ((signal_id == kE1B || signal_id == kE5bI) && words.size() == GalileoInav::kWords) {
        return collector_->add_galileo_inav(words.first<GalileoInav::kWords>(), origin);
      }
      if (signal_id == kE6B && words.size() == kPageWords) return add_page(words, origin);
      if (signal_id != kE5aI || words.size() != GalileoFnav::kWords) break;
      return collector_->add_galileo_fnav(words.first<GalileoFnav::kWords>(), origin);
    case System::kBeidou: {
      if ((signal_id == kB1Cp || signal_id == kB1Cd) && words.size() == kBcnav1Words) {
        return collector_->add_bcnav1(bits_of(words), origin);
      }
      if ((signal_id == kB2ap || signal_id == kB2ad) && words.size() == kBcnav2Words) {
        return collector_->add_bcnav2(bits_of(words), origin);
      }
      // B1I, B2I and B3I carry D1 or D2.
      const bool is_d1_or_d2 = signal_id <= 4 || signal_id == 10;
      if (!is_d1_or_d2 || words.size() != kBeidouWords) break;
      return collector_->add_beidou(words.first<kBeidouWords>(), origin);
    }
    case System::kLeo:
      break;
  }
  collector_->count_other_message();
  return {};
}

NavigationUpdate RxmSfrbxDecoder::add_page(Words words, const SubframeOrigin& origin) {
  NavigationUpdate update;
  const CorrectionPage page = read_page(words, origin);
  if (is_intact(page)) {
    ++counters_.pages;
    update.page = page;
  } else {
    ++bad_pages_;
  }
  return update;
}

RxmSfrbxCounters RxmSfrbxDecoder::counters() const {
  RxmSfrbxCounters counters = counters_;
  static_cast<NavigationCounters&>(counters) = collector_->counters();
  counters.bad_parity += bad_pages_;
  return counters;
}

}  // namespace leonav
