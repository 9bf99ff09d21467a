// This unit decodes BeiDou's precise point positioning service from the pages of PPP-B2b.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "core/base/gps_time.h"
#include "drivers/b2b/b2b_signal.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/correction_page.h"
#include "drivers/ssr/ssr_correction.h"

namespace leonav {

// Counts of pages, each of which is a message.
struct B2bCounters {
  std::uint64_t messages = 0;  // of types 1 to 4, used
  std::uint64_t bad_checksums = 0;
  std::uint64_t bad_satellites = 0;  // another system's, or no valid number
  std::uint64_t without_time = 0;
  std::uint64_t empty = 0;     // type 63
  std::uint64_t repeated = 0;  // another satellite, or the same one, sent it a moment ago
  std::map<std::uint8_t, std::uint64_t> other_types;  // by type: 5 to 7 and reserved ones
  std::uint64_t bad_time = 0;                         // beyond the day
  std::uint64_t without_mask = 0;   // a clock whose mask (IODP, IOD SSR) has not come
  std::uint64_t bad_length = 0;     // more biases than a page has room for
  std::uint64_t unavailable = 0;    // orbits, clocks and biases marked so
  std::uint64_t other_systems = 0;  // GLONASS' satellites, and reserved slots
  std::uint64_t reserved_signals = 0;
};

// The decoder takes pages of all satellites in the order of their arrival. Memory is bounded.
//
// Message types 1 (mask), 2 (orbit and URA), 3 (code biases) and 4 (clock). A clock's satellites
// are those of the mask with its IODP and IOD SSR. Corrections with the same IOD SSR go together,
// and of one satellite orbit and clock with the same IOD Corr. Clocks have the opposite sign of
// those sent, and so have biases. Source: BDS-SIS-ICD-PPP-B2b-1.0, 6 and 7.
class B2bDecoder {
 public:
  // Returns the corrections of a page, one message for each system.
  std::vector<SsrMessage> add(const CorrectionPage& page);
  const B2bCounters& counters() const { return counters_; }

  static constexpr double kOrbitValidity_s = 96.0, kClockValidity_s = 12.0;
  static constexpr double kLongestMaskLife_s = 3600.0;

 private:
  struct Mask {
    GpsTime received;  // unset: none
    std::uint8_t issue = 0;
    std::vector<std::uint16_t> slots;
  };

  bool is_repeated(const CorrectionPage& page);
  bool take_head(BitReader* bits, GpsTime received, SsrMessage* head);
  void read_mask(BitReader* bits, const SsrMessage& head, GpsTime received);
  std::vector<SsrSatellite> read_orbits(BitReader* bits);
  std::vector<SsrSatellite> read_biases(BitReader* bits);
  std::vector<SsrSatellite> read_clocks(BitReader* bits, const Mask& mask);
  std::optional<SatelliteId> satellite_of(std::uint32_t slot);

  std::array<Mask, 16> masks_;                 // by IODP
  std::array<CorrectionPage, 16> last_pages_;  // a ring of the last ones that were no repetition
  std::size_t next_page_ = 0;
  B2bCounters counters_;
};

}  // namespace leonav
