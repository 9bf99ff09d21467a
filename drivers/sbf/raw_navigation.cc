#include "drivers/sbf/raw_navigation.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "drivers/binary/bit_field.h"
#include "drivers/binary/little_endian.h"
#include "drivers/sbf/raw_page.h"
#include "drivers/sbf/sbf_signal.h"

namespace leonav {
namespace {

// A set is broadcast for one to four hours: one that is missing for so long comes no more.
constexpr double kLongestRawAge_s = 7200.0;

constexpr std::uint16_t kGpsRawCa = 4017, kGpsRawL2c = 4018, kGpsRawL5 = 4019, kGalRawFnav = 4022,
                        kGalRawInav = 4023, kGalRawCnav = 4024, kBdsRaw = 4047, kBdsRawB1c = 4218,
                        kBdsRawB2a = 4219, kBdsRawB2b = 4242;
// Satellite, result of the receiver's check, errors, signal, frequency, channel. Of B1C the check
// is that of subframe 2, and that of subframe 3 stands in place of the errors.
constexpr std::size_t kRawHeadSize = 6;

// CNAV: 300 bits with the preamble. B-CNAV2: 576 symbols behind the preamble, of which the first
// 288 are the bits of the message and the others the code LDPC(96,48), by which the receiver has
// corrected them.
constexpr std::size_t kCnavWords = 10, kBcnav2Words = 18;

struct BlockLayout {
  std::uint16_t number;
  System system;
  std::size_t words;  // of 32 bits
};
constexpr BlockLayout kLayouts[] = {
    {kGpsRawCa, System::kGps, GpsLnav::kWords},
    {kGpsRawL2c, System::kGps, kCnavWords},
    {kGpsRawL5, System::kGps, kCnavWords},
    {kGalRawFnav, System::kGalileo, GalileoFnav::kWords},
    {kGalRawInav, System::kGalileo, GalileoInav::kWords},
    {kGalRawCnav, System::kGalileo, kGalileoPageWords},
    {kBdsRaw, System::kBeidou, kBeidouWords},
    {kBdsRawB1c, System::kBeidou, kBcnav1Words},
    {kBdsRawB2a, System::kBeidou, kBcnav2Words},
    {kBdsRawB2b, System::kBeidou, kB2bFrameWords},
};
constexpr std::size_t kMaxWords = kBcnav1Words;
constexpr int kNumberBits = 6;  // of a satellite of BeiDou, at the beginning of a frame

// Returns nullptr for a block of another kind.
const BlockLayout* layout_of(std::uint16_t number) {
  const auto* found =
      std::find_if(std::begin(kLayouts), std::end(kLayouts),
                   [number](const BlockLayout& layout) { return layout.number == number; });
  return found == std::end(kLayouts) ? nullptr : found;
}

template <std::size_t kCount>
std::array<std::uint8_t, 4 * kCount> bytes_of(std::span<const std::uint32_t, kCount> words) {
  BitWriter<4 * kCount> writer;
  for (const std::uint32_t word : words) writer.put(word, 32);
  return writer.bytes();
}

void copy_bits(BitReader* from, int count, auto* to) {
  for (int i = 0; i < count; ++i) to->put(from->take(1), 1);
}

}  // namespace

std::array<std::uint32_t, GpsLnav::kWords> gps_words(
    std::span<const std::uint32_t, GpsLnav::kWords> words) {
  constexpr std::uint32_t kThirtyBits = 0x3FFFFFFF;
  std::array<std::uint32_t, GpsLnav::kWords> result{};
  std::uint32_t before = 0;  // the last word of a subframe ends in two zeros
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint32_t d29_and_d30 = ((before >> 1) ^ before) & 1u;
    result[i] = (d29_and_d30 << 31) | (words[i] & kThirtyBits);
    before = words[i];
  }
  return result;
}

std::array<std::uint32_t, GalileoInav::kWords> galileo_inav_words(
    std::span<const std::uint32_t, GalileoInav::kWords> words) {
  constexpr int kEvenBits = 114, kOddBits = 120, kHalf = 128;
  const auto bytes = bytes_of(words);
  BitReader reader(bytes);
  BitWriter<32> writer;
  copy_bits(&reader, kEvenBits, &writer);
  for (int i = kEvenBits; i < kHalf; ++i) writer.put(0, 1);
  copy_bits(&reader, kOddBits, &writer);
  BitReader page(writer.bytes());
  std::array<std::uint32_t, GalileoInav::kWords> result{};
  for (std::uint32_t& word : result) word = page.take(32);
  return result;
}

std::array<std::uint32_t, kBeidouWords> beidou_words(
    std::span<const std::uint32_t, kBeidouWords> words) {
  const auto bytes = bytes_of(words);
  BitReader reader(bytes);
  std::array<std::uint32_t, kBeidouWords> result{};
  for (std::uint32_t& word : result) word = reader.take(30);
  return result;
}

std::array<std::uint8_t, kBcnav1Bytes> bcnav1_subframe_2(
    std::span<const std::uint32_t, kBcnav1Words> words) {
  constexpr std::size_t kFirstSubframe = 72;
  const auto bytes = bytes_of(words);
  BitReader reader(bytes);
  reader.skip(kFirstSubframe);
  BitWriter<kBcnav1Bytes> writer;
  copy_bits(&reader, 8 * kBcnav1Bytes, &writer);
  return writer.bytes();
}

bool RawNavigationReader::is_raw_navigation(std::uint16_t number) {
  return layout_of(number) != nullptr;
}

bool RawNavigationReader::has(const Ephemeris& ephemeris) const {
  const GpsTime made =
      made_[static_cast<std::size_t>(ephemeris.message)][ephemeris.satellite.number];
  return made.is_set() &&
         std::abs(seconds_between(ephemeris.transmission_time, made)) <= kLongestRawAge_s;
}

NavigationUpdate RawNavigationReader::read(std::uint16_t number, GpsTime time,
                                           std::span<const std::uint8_t> payload,
                                           NavigationCollector* collector) {
  const BlockLayout& layout = *layout_of(number);
  if (payload.size() < kRawHeadSize + layout.words * sizeof(std::uint32_t)) {
    ++counters_.bad_length;
    return {};
  }
  const std::optional<SatelliteId> satellite = satellite_from_sbf(payload[0]);
  if (!satellite || satellite->system != layout.system || !is_valid(*satellite)) {
    ++counters_.bad_satellite;
    return {};
  }
  if (!time.is_set()) {
    ++counters_.without_time;
    return {};
  }
  if (payload[1] == 0) {
    ++counters_.crc_failed;
    return {};
  }
  const NavigationUpdate update =
      add(number, payload.subspan(kRawHeadSize), {*satellite, time}, collector);
  if (update.ephemeris) {
    made_[static_cast<std::size_t>(update.ephemeris->message)][satellite->number] = time;
  }
  return update;
}

NavigationUpdate RawNavigationReader::add(std::uint16_t number, std::span<const std::uint8_t> bits,
                                          const SubframeOrigin& origin,
                                          NavigationCollector* collector) {
  std::array<std::uint32_t, kMaxWords> buffer{};
  for (std::size_t i = 0; i < layout_of(number)->words; ++i) {
    buffer[i] = read_u4(bits.data() + i * sizeof(std::uint32_t));
  }
  const std::span<const std::uint32_t, kMaxWords> words(buffer);
  switch (number) {
    case kGpsRawCa:
      return collector->add_gps_lnav(gps_words(words.first<GpsLnav::kWords>()), origin);
    case kGpsRawL2c:
    case kGpsRawL5:
      return collector->add_gps_cnav(bytes_of(words.first<kCnavWords>()), origin);
    case kGalRawInav:
      return collector->add_galileo_inav(galileo_inav_words(words.first<GalileoInav::kWords>()),
                                         origin);
    case kGalRawFnav:
      return collector->add_galileo_fnav(words.first<GalileoFnav::kWords>(), origin);
    case kGalRawCnav:
      return add_galileo_page(words, origin);
    case kBdsRawB1c:
      return add_beidou_b1c(words, origin, collector);
    case kBdsRawB2a:
      return collector->add_bcnav2(bytes_of(words.first<kBcnav2Words>()), origin);
    case kBdsRawB2b:
      return add_beidou_b2b(words, origin, collector);
    default:
      return collector->add_beidou(beidou_words(words.first<kBeidouWords>()), origin);
  }
}

NavigationUpdate RawNavigationReader::add_galileo_page(std::span<const std::uint32_t> words,
                                                       const SubframeOrigin& origin) {
  return pass_on(galileo_page(words.first<kGalileoPageWords>(), origin));
}

NavigationUpdate RawNavigationReader::add_beidou_b1c(std::span<const std::uint32_t> words,
                                                     const SubframeOrigin& origin,
                                                     NavigationCollector* collector) {
  if (words[0] >> (32 - kNumberBits) != origin.satellite.number) {
    ++counters_.wrong_satellite;
    return {};
  }
  return collector->add_bcnav1(bcnav1_subframe_2(words.first<kBcnav1Words>()), origin);
}

// The geostationary satellites send PPP-B2b on this signal, the others B-CNAV3.
NavigationUpdate RawNavigationReader::add_beidou_b2b(std::span<const std::uint32_t> words,
                                                     const SubframeOrigin& origin,
                                                     NavigationCollector* collector) {
  if (!is_beidou_geostationary(origin.satellite)) {
    collector->count_other_message();
    return {};
  }
  const B2bFrame frame = b2b_frame(words.first<kB2bFrameWords>(), origin);
  if (frame.satellite_number != origin.satellite.number) {
    ++counters_.wrong_satellite;
    return {};
  }
  return pass_on(frame.page);
}

NavigationUpdate RawNavigationReader::pass_on(const CorrectionPage& page) {
  NavigationUpdate update;
  if (is_intact(page)) {
    ++counters_.pages;
    update.page = page;
  } else {
    ++counters_.bad_pages;
  }
  return update;
}

}  // namespace leonav
