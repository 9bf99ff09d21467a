#include "drivers/ubx/rxm_sfrbx.h"

#include <array>

#include "core/gnss/orbits/satellite_state.h"
#include "drivers/binary/little_endian.h"
#include "drivers/binary/reported_ephemerides.h"
#include "drivers/ubx/beidou_d1.h"
#include "drivers/ubx/beidou_d2.h"
#include "drivers/ubx/galileo_fnav.h"
#include "drivers/ubx/galileo_inav.h"
#include "drivers/ubx/gps_lnav.h"
#include "drivers/ubx/ubx_signal.h"

namespace leonav {
namespace {

constexpr std::size_t kHeaderSize = 8;
constexpr std::uint8_t kVersion = 2;
constexpr std::size_t kMaxWords = 19;  // BeiDou B-CNAV1, the longest there is
constexpr std::size_t kSatellites = 64;

using Words = std::span<const std::uint32_t>;

// Makes a page of the words of E6-B: 486 bits from the highest one of the first word, then tail and
// padding.
SubframeStatus read_page(Words words, const SubframeOrigin& origin, NavigationUpdate* update) {
  CorrectionPage page;
  page.satellite = origin.satellite;
  page.received = origin.now;
  for (std::size_t i = 0; i < page.bits.size(); ++i) {
    page.bits[i] = static_cast<std::uint8_t>(words[i / 4] >> (24 - 8 * (i % 4)));
  }
  if (!is_intact(page)) return SubframeStatus::kBadParity;
  update->page = page;
  return SubframeStatus::kPage;
}

}  // namespace

// There is one collector per satellite and message; a satellite number is below kSatellites.
struct RxmSfrbxDecoder::State {
  std::array<GpsLnav, kSatellites> gps_lnav;
  std::array<GalileoInav, kSatellites> galileo_inav;
  std::array<GalileoFnav, kSatellites> galileo_fnav;
  std::array<BeidouD1, kSatellites> beidou_d1;
  std::array<BeidouD2, kSatellites> beidou_d2;
  ReportedEphemerides reported;

  SubframeStatus add_gps(std::uint8_t signal_id, Words words, const SubframeOrigin& origin,
                         NavigationUpdate* update);
  SubframeStatus add_galileo(std::uint8_t signal_id, Words words, const SubframeOrigin& origin,
                             NavigationUpdate* update);
  SubframeStatus add_beidou(std::uint8_t signal_id, Words words, const SubframeOrigin& origin,
                            NavigationUpdate* update);
};

SubframeStatus RxmSfrbxDecoder::State::add_gps(std::uint8_t signal_id, Words words,
                                               const SubframeOrigin& origin,
                                               NavigationUpdate* update) {
  // L2C and L5 carry CNAV.
  if (signal_id != 0 || words.size() != GpsLnav::kWords) return SubframeStatus::kOtherMessage;
  return gps_lnav[origin.satellite.number].add(words.first<GpsLnav::kWords>(), origin, update);
}

SubframeStatus RxmSfrbxDecoder::State::add_galileo(std::uint8_t signal_id, Words words,
                                                   const SubframeOrigin& origin,
                                                   NavigationUpdate* update) {
  constexpr std::uint8_t kE1B = 1, kE5aI = 3, kE5bI = 5, kE6B = 8;
  constexpr std::size_t kPageWords = 16;
  const std::size_t number = origin.satellite.number;
  if ((signal_id == kE1B || signal_id == kE5bI) && words.size() == GalileoInav::kWords) {
    return galileo_inav[number].add(words.first<GalileoInav::kWords>(), origin, update);
  }
  if (signal_id == kE5aI && words.size() == GalileoFnav::kWords) {
    return galileo_fnav[number].add(words.first<GalileoFnav::kWords>(), origin, update);
  }
  if (signal_id == kE6B && words.size() == kPageWords) return read_page(words, origin, update);
  return SubframeStatus::kOtherMessage;
}

SubframeStatus RxmSfrbxDecoder::State::add_beidou(std::uint8_t signal_id, Words words,
                                                  const SubframeOrigin& origin,
                                                  NavigationUpdate* update) {
  // B1C and B2a (5 to 8) carry B-CNAV. B1I, B2I and B3I carry D1 or D2, by the satellite's orbit.
  const bool is_d1_or_d2 = signal_id <= 4 || signal_id == 10;
  if (!is_d1_or_d2 || words.size() != kBeidouWords) return SubframeStatus::kOtherMessage;
  const std::size_t number = origin.satellite.number;
  const auto ten = words.first<kBeidouWords>();
  return is_beidou_geostationary(origin.satellite) ? beidou_d2[number].add(ten, origin, update)
                                                   : beidou_d1[number].add(ten, origin, update);
}

RxmSfrbxDecoder::RxmSfrbxDecoder() : state_(std::make_unique<State>()) {}
RxmSfrbxDecoder::~RxmSfrbxDecoder() = default;

NavigationUpdate RxmSfrbxDecoder::decode(std::span<const std::uint8_t> payload, GpsTime now) {
  NavigationUpdate update;
  if (payload.size() < kHeaderSize || payload[4] > kMaxWords ||
      payload.size() != kHeaderSize + payload[4] * sizeof(std::uint32_t)) {
    ++counters_.bad_length;
    return update;
  }
  if (payload[6] != kVersion) {
    ++counters_.bad_version;
    return update;
  }
  const std::optional<System> system = system_from_ubx(payload[0]);
  if (!system) {
    ++counters_.other_system;
    return update;
  }
  const SubframeOrigin origin{{*system, payload[1]}, now};
  if (!is_valid(origin.satellite) || origin.satellite.number >= kSatellites) {
    ++counters_.bad_satellite;
    return update;
  }
  if (!now.is_set()) {
    ++counters_.without_time;
    return update;
  }
  std::array<std::uint32_t, kMaxWords> buffer{};
  for (std::size_t i = 0; i < payload[4]; ++i) {
    buffer[i] = read_u4(payload.data() + kHeaderSize + i * sizeof(std::uint32_t));
  }
  count(add(payload[2], Words(buffer).first(payload[4]), origin, &update));
  if (update.ephemeris && !is_new_issue(*update.ephemeris)) update.ephemeris.reset();
  return update;
}

SubframeStatus RxmSfrbxDecoder::add(std::uint8_t signal_id, std::span<const std::uint32_t> words,
                                    const SubframeOrigin& origin, NavigationUpdate* update) {
  switch (origin.satellite.system) {
    case System::kGps:
      return state_->add_gps(signal_id, words, origin, update);
    case System::kGalileo:
      return state_->add_galileo(signal_id, words, origin, update);
    case System::kBeidou:
      return state_->add_beidou(signal_id, words, origin, update);
    case System::kLeo:
      break;
  }
  return SubframeStatus::kOtherMessage;
}

void RxmSfrbxDecoder::count(SubframeStatus status) {
  switch (status) {
    case SubframeStatus::kUsed:
      ++counters_.subframes;
      break;
    case SubframeStatus::kPage:
      ++counters_.pages;
      break;
    case SubframeStatus::kOtherMessage:
      ++counters_.other_message;
      break;
    case SubframeStatus::kBadParity:
      ++counters_.bad_parity;
      break;
    case SubframeStatus::kBadWeek:
      ++counters_.bad_week;
      break;
    case SubframeStatus::kWrongSatellite:
      ++counters_.wrong_satellite;
      break;
  }
}

bool RxmSfrbxDecoder::is_new_issue(const Ephemeris& ephemeris) {
  if (!is_sane(ephemeris)) {
    ++counters_.not_sane;
    return false;
  }
  if (!state_->reported.is_new(ephemeris)) return false;
  ++counters_.ephemerides;
  return true;
}

}  // namespace leonav
