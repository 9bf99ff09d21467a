#include "drivers/ubx/rxm_sfrbx.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/gnss/orbits/satellite_state.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/cnav_delays.h"
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

// Group delays are reported again after this time, so that a program that starts later gets them.
constexpr double kDelayRepeat_s = 3600.0;

using Words = std::span<const std::uint32_t>;

SubframeStatus status_of(CnavStatus status) {
  switch (status) {
    case CnavStatus::kDelays:
      return SubframeStatus::kUsed;
    case CnavStatus::kOtherType:
      return SubframeStatus::kOtherMessage;
    case CnavStatus::kBadChecksum:
      return SubframeStatus::kBadParity;
    case CnavStatus::kWrongSatellite:
      return SubframeStatus::kWrongSatellite;
  }
  return SubframeStatus::kOtherMessage;
}

// Reads the delays of a message of CNAV or B-CNAV, whose bits fill the words from the first on.
template <typename Read>
SubframeStatus add_delays(Read read, Words words, const SubframeOrigin& origin,
                          NavigationUpdate* update) {
  BitWriter<kMaxWords * sizeof(std::uint32_t)> writer;
  for (const std::uint32_t word : words) writer.put(word, 32);
  const auto bits = std::span<const std::uint8_t>(writer.bytes()).first(words.size_bytes());
  return status_of(read(bits, origin.satellite, origin.now, &update->biases));
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
  // Of each satellite's signal the delay reported last, and when.
  std::map<std::pair<SatelliteId, SignalCode>, std::pair<double, GpsTime>> reported_delays;

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
  constexpr std::uint8_t kL2Cl = 3, kL2Cm = 4, kL5I = 6, kL5Q = 7;
  constexpr std::size_t kCnavWords = 10;
  const bool is_cnav =
      signal_id == kL2Cl || signal_id == kL2Cm || signal_id == kL5I || signal_id == kL5Q;
  if (is_cnav && words.size() == kCnavWords) {
    return add_delays(read_gps_cnav_delays, words, origin, update);
  }
  if (signal_id != 0 || words.size() != GpsLnav::kWords) return SubframeStatus::kOtherMessage;
  return gps_lnav[origin.satellite.number].add(words.first<GpsLnav::kWords>(), origin, update);
}

SubframeStatus RxmSfrbxDecoder::State::add_galileo(std::uint8_t signal_id, Words words,
                                                   const SubframeOrigin& origin,
                                                   NavigationUpdate* update) {
  constexpr std::uint8_t kE1B = 1, kE5aI = 3, kE5bI = 5;
  const std::size_t number = origin.satellite.number;
  if ((signal_id == kE1B || signal_id == kE5bI) && words.size() == GalileoInav::kWords) {
    return galileo_inav[number].add(words.first<GalileoInav::kWords>(), origin, update);
  }
  if (signal_id == kE5aI && words.size() == GalileoFnav::kWords) {
    return galileo_fnav[number].add(words.first<GalileoFnav::kWords>(), origin, update);
  }
  return SubframeStatus::kOtherMessage;  // E6-B: the high accuracy service
}

SubframeStatus RxmSfrbxDecoder::State::add_beidou(std::uint8_t signal_id, Words words,
                                                  const SubframeOrigin& origin,
                                                  NavigationUpdate* update) {
  constexpr std::uint8_t kB1Cp = 5, kB1Cd = 6, kB2ap = 7, kB2ad = 8;
  constexpr std::size_t kSubframe2Words = 19, kBcnav2Words = 9;
  if ((signal_id == kB1Cp || signal_id == kB1Cd) && words.size() == kSubframe2Words) {
    return add_delays(read_bcnav1_delays, words, origin, update);
  }
  if ((signal_id == kB2ap || signal_id == kB2ad) && words.size() == kBcnav2Words) {
    return add_delays(read_bcnav2_delays, words, origin, update);
  }
  // B1I, B2I and B3I carry D1 or D2, by the satellite's orbit.
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
  if (!are_new(update.biases, now)) update.biases.clear();
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

bool RxmSfrbxDecoder::are_new(const std::vector<SignalBias>& biases, GpsTime now) {
  const bool any_new = std::any_of(biases.begin(), biases.end(), [&](const SignalBias& bias) {
    const auto last = state_->reported_delays.find({bias.satellite, bias.code});
    return last == state_->reported_delays.end() || last->second.first != bias.bias_m ||
           seconds_between(now, last->second.second) >= kDelayRepeat_s;
  });
  if (!any_new) return false;
  for (const SignalBias& bias : biases) {
    state_->reported_delays[{bias.satellite, bias.code}] = {bias.bias_m, now};
  }
  ++counters_.delays;
  return true;
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
