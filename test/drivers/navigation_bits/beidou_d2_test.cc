// No geostationary satellite is in the recordings, so D2 is tested with pages encoded here. The
// encoder places each field by the bit numbers of the interface document's figures 5-14-1 to
// 5-14-10 (counted from 0 in the 300 bits of a subframe); the decoder reads runs instead.
#include "drivers/navigation_bits/beidou_d2.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/base/calendar.h"
#include "support/catch.h"

namespace leonav {
namespace {

struct Piece {
  int page, start, count;
};

class D2Encoder {
 public:
  // Most significant piece first.
  void put(std::int64_t value, const std::vector<Piece>& pieces) {
    int left = 0;
    for (const Piece& piece : pieces) left += piece.count;
    for (const Piece& piece : pieces) {
      for (int i = 0; i < piece.count; ++i) {
        --left;
        bits_[piece.page - 1][piece.start + i] = (value >> left) & 1;
      }
    }
  }
  std::array<std::uint32_t, kBeidouWords> words(int page, int sow_s) {
    put(0b11100010010, {{page, 0, 11}});
    put(1, {{page, 15, 3}});
    put(sow_s, {{page, 18, 8}, {page, 30, 12}});
    put(page, {{page, 42, 4}});
    std::array<std::uint32_t, kBeidouWords> out{};
    for (int w = 0; w < 10; ++w) {
      const bool* word = &bits_[page - 1][30 * w];
      const auto number = [word](int first, int count) {
        std::uint32_t value = 0;
        for (int i = first; i < first + count; ++i) value = value * 2 + word[i];
        return value;
      };
      out[w] = w == 0 ? (number(0, 26) << 4) | remainder(number(15, 11))
                      : (number(0, 22) << 8) | (remainder(number(0, 11)) << 4) |
                            remainder(number(11, 11));
    }
    return out;
  }

 private:
  // Long division of information * x^4 by x^4 + x + 1.
  static std::uint32_t remainder(std::uint32_t information) {
    std::uint32_t dividend = information << 4;
    for (int bit = 14; bit >= 4; --bit) {
      if (dividend & (1u << bit)) dividend ^= 0b10011u << (bit - 4);
    }
    return dividend;
  }
  bool bits_[10][300] = {};
};

constexpr int kBeidouWeek = 1024;
constexpr int kSow = 403200;

D2Encoder encode() {
  D2Encoder e;
  e.put(1, {{1, 46, 1}});                         // SatH1
  e.put(9, {{1, 47, 5}});                         // AODC
  e.put(3, {{1, 60, 4}});                         // URAI
  e.put(kBeidouWeek, {{1, 64, 13}});              // WN
  e.put(kSow / 8, {{1, 77, 5}, {1, 90, 12}});     // toc
  e.put(-123, {{1, 102, 10}});                    // TGD1
  e.put(456, {{1, 120, 10}});                     // TGD2
  e.put(-7654321, {{3, 100, 12}, {3, 120, 12}});  // a0
  e.put(1234567, {{3, 132, 4}, {4, 46, 6}, {4, 60, 12}});
  e.put(-777, {{4, 72, 10}, {4, 90, 1}});                                // a2
  e.put(17, {{4, 91, 5}});                                               // AODE
  e.put(-20202, {{4, 96, 16}});                                          // delta n
  e.put(100001, {{4, 120, 14}, {5, 46, 4}});                             // Cuc
  e.put(-1500000001, {{5, 50, 2}, {5, 60, 22}, {5, 90, 8}});             // M0
  e.put(-99999, {{5, 98, 14}, {5, 120, 4}});                             // Cus
  e.put(5000001, {{5, 124, 10}, {6, 46, 6}, {6, 60, 16}});               // e
  e.put(3404410881, {{6, 76, 6}, {6, 90, 22}, {6, 120, 4}});             // sqrt A
  e.put(54321, {{6, 124, 10}, {7, 46, 6}, {7, 60, 2}});                  // Cic
  e.put(-65432, {{7, 62, 18}});                                          // Cis
  e.put((kSow + 3600) / 8, {{7, 80, 2}, {7, 90, 15}});                   // toe
  e.put(68181001, {{7, 105, 7}, {7, 120, 14}, {8, 46, 6}, {8, 60, 5}});  // i0
  e.put(-30303, {{8, 65, 17}, {8, 90, 1}});                              // Crc
  e.put(40404, {{8, 91, 18}});                                           // Crs
  e.put(-654321, {{8, 109, 3}, {8, 120, 16}, {9, 46, 5}});               // Omega dot
  e.put(1700000003, {{9, 51, 1}, {9, 60, 22}, {9, 90, 9}});              // Omega0
  e.put(-1600000007, {{9, 99, 13}, {9, 120, 14}, {10, 46, 5}});          // omega
  e.put(-8001, {{10, 51, 1}, {10, 60, 13}});                             // i dot
  return e;
}

GpsTime gps(int sow_s) {
  return GpsTime::from_week_and_tow(kBeidouWeek + kBeidouWeekZeroInGpsWeeks, sow_s + 14.0);
}

}  // namespace

TEST_CASE("Ten D2 pages of one round give the elements that were encoded") {
  D2Encoder encoder = encode();
  BeidouD2 decoder;
  NavigationUpdate update;
  const SubframeOrigin origin{{System::kBeidou, 3}, gps(kSow + 20)};
  for (int page = 1; page <= 10; ++page) {
    CHECK_FALSE(update.ephemeris.has_value());
    REQUIRE(decoder.add(encoder.words(page, kSow + 3 * (page - 1)), origin, &update) ==
            SubframeStatus::kUsed);
  }
  REQUIRE(update.ephemeris.has_value());
  const Ephemeris& e = *update.ephemeris;
  const double pi = std::numbers::pi;
  CHECK(e.message == NavigationMessage::kBeidouD2);
  CHECK(e.health == 1);
  CHECK(e.issue_clock == 9);
  CHECK(e.issue == 17);
  CHECK(e.accuracy_m == 5.7);
  CHECK(e.toc == gps(kSow));
  CHECK(e.toe == gps(kSow + 3600));
  CHECK(e.group_delay_s[0] == Approx(-12.3e-9));
  CHECK(e.group_delay_s[1] == Approx(45.6e-9));
  CHECK(e.af0 == std::ldexp(-7654321.0, -33));
  CHECK(e.af1 == std::ldexp(1234567.0, -50));
  CHECK(e.af2 == std::ldexp(-777.0, -66));
  CHECK(e.delta_n == std::ldexp(-20202.0, -43) * pi);
  CHECK(e.m0 == std::ldexp(-1500000001.0, -31) * pi);
  CHECK(e.eccentricity == std::ldexp(5000001.0, -33));
  CHECK(e.sqrt_a == std::ldexp(3404410881.0, -19));
  CHECK(e.cuc == std::ldexp(100001.0, -31));
  CHECK(e.cus == std::ldexp(-99999.0, -31));
  CHECK(e.cic == std::ldexp(54321.0, -31));
  CHECK(e.cis == std::ldexp(-65432.0, -31));
  CHECK(e.crc == std::ldexp(-30303.0, -6));
  CHECK(e.crs == std::ldexp(40404.0, -6));
  CHECK(e.i0 == std::ldexp(68181001.0, -31) * pi);
  CHECK(e.omega0 == std::ldexp(1700000003.0, -31) * pi);
  CHECK(e.omega == std::ldexp(-1600000007.0, -31) * pi);
  CHECK(e.omega_dot == std::ldexp(-654321.0, -43) * pi);
  CHECK(e.i_dot == std::ldexp(-8001.0, -43) * pi);
}

TEST_CASE("D2 pages of different rounds, of another week or with a wrong bit are not mixed in") {
  D2Encoder encoder = encode();
  NavigationUpdate update;
  const SubframeOrigin origin{{System::kBeidou, 3}, gps(kSow + 20)};
  SECTION("one page is a round late") {
    BeidouD2 decoder;
    for (int page = 1; page <= 10; ++page) {
      decoder.add(encoder.words(page, kSow + 3 * (page - 1) + (page == 4 ? 30 : 0)), origin,
                  &update);
    }
    CHECK_FALSE(update.ephemeris.has_value());
  }
  SECTION("any single flipped bit is noticed") {
    BeidouD2 decoder;
    const auto good = encoder.words(5, kSow + 12);
    for (std::size_t word = 0; word < good.size(); ++word) {
      for (int bit = 0; bit < 30; ++bit) {
        if (word == 0 && bit >= 15 && bit < 19) continue;  // reserved, under no check
        auto bad = good;
        bad[word] ^= 1u << bit;
        REQUIRE(decoder.add(bad, origin, &update) == SubframeStatus::kBadParity);
      }
    }
  }
  SECTION("the receiver is ten weeks off") {
    BeidouD2 decoder;
    const SubframeOrigin off{{System::kBeidou, 3}, gps(kSow + 20 + 10 * 604800)};
    CHECK(decoder.add(encoder.words(1, kSow), off, &update) == SubframeStatus::kBadWeek);
  }
}

}  // namespace leonav
