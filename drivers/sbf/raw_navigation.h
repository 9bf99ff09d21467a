// This unit reads the blocks with raw navigation bits: GPSRawCA (4017), GPSRawL2C (4018),
// GPSRawL5 (4019), GALRawFNAV (4022), GALRawINAV (4023), GALRawCNAV (4024), BDSRaw (4047),
// BDSRawB1C (4218), BDSRawB2a (4219) and BDSRawB2b (4242).
// Source: mosaic-X5 Reference Guide, chapters of these names.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/gps_time.h"
#include "drivers/navigation_bits/navigation_collector.h"

namespace leonav {

// Counts of pages of corrections, and of blocks that gave no subframe and no page.
struct RawNavigationCounters {
  std::uint64_t pages = 0;  // of corrections (E6-B, PPP-B2b), passed on
  std::uint64_t bad_length = 0;
  std::uint64_t bad_satellite = 0;
  std::uint64_t without_time = 0;     // the receiver did not know the time
  std::uint64_t crc_failed = 0;       // by the receiver's own check
  std::uint64_t bad_pages = 0;        // by the page's own checksum
  std::uint64_t wrong_satellite = 0;  // B1C, B2b: the frame names another one than the block
};

// The reader turns the bits of a block into the words that the collector takes, or into a page of
// corrections.
class RawNavigationReader {
 public:
  static bool is_raw_navigation(std::uint16_t number);
  // Precondition: is_raw_navigation(number).
  NavigationUpdate read(std::uint16_t number, GpsTime time, std::span<const std::uint8_t> payload,
                        NavigationCollector* collector);
  // Returns whether a set of this satellite and message was made of bits within the last two hours,
  // so that what the receiver itself has decoded of it is not needed.
  bool has(const Ephemeris& ephemeris) const;
  const RawNavigationCounters& counters() const { return counters_; }

 private:
  NavigationUpdate add(std::uint16_t number, std::span<const std::uint8_t> bits,
                       const SubframeOrigin& origin, NavigationCollector* collector);
  NavigationUpdate add_galileo_page(std::span<const std::uint32_t> words,
                                    const SubframeOrigin& origin);
  NavigationUpdate add_beidou_b1c(std::span<const std::uint32_t> words,
                                  const SubframeOrigin& origin, NavigationCollector* collector);
  NavigationUpdate add_beidou_b2b(std::span<const std::uint32_t> words,
                                  const SubframeOrigin& origin, NavigationCollector* collector);
  NavigationUpdate pass_on(const CorrectionPage& page);

  // When the last set was made.
  std::array<std::array<GpsTime, NavigationCollector::kSatellites>, kNavigationMessages> made_;
  RawNavigationCounters counters_;
};

// Return the collector's words of the words of a block. They share no sequence of their own: each
// has 30 bits of GPS and BeiDou, right-aligned, or is a page of Galileo, left-aligned.
//
// GPS: the receiver gives data bits upright and each parity bit with D30* of the word before, so
// that D29 xor D30 of that word, D29* xor D30*, is what a parity bit may still depend on.
std::array<std::uint32_t, GpsLnav::kWords> gps_words(
    std::span<const std::uint32_t, GpsLnav::kWords> words);
// Galileo I/NAV: 114 bits of the even part, without its tail, and 120 of the odd one.
std::array<std::uint32_t, GalileoInav::kWords> galileo_inav_words(
    std::span<const std::uint32_t, GalileoInav::kWords> words);
// B-CNAV1: of 1800 symbols, whose interleaving the receiver has undone, the first 6 are the number
// of the satellite. Subframe 2 begins with symbol 72: its 600 bits, left-aligned, then as many
// symbols of the code LDPC(200,100), by which the receiver has corrected them.
inline constexpr std::size_t kBcnav1Words = 57, kBcnav1Bytes = 75;
std::array<std::uint8_t, kBcnav1Bytes> bcnav1_subframe_2(
    std::span<const std::uint32_t, kBcnav1Words> words);
// BeiDou: 300 bits in a row.
std::array<std::uint32_t, kBeidouWords> beidou_words(
    std::span<const std::uint32_t, kBeidouWords> words);

}  // namespace leonav
