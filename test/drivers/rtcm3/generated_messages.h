// Messages with random fields behind plausible counts and masks, for the types that no recording
// has: they hold nothing that a satellite would say, but every bit has its place.
#pragma once
#include <array>
#include <random>
#include <string_view>
#include <vector>

#include "drivers/binary/bit_field.h"
#include "rtcm3_streams.h"

namespace leonav::test {

class MessageGenerator {
 public:
  explicit MessageGenerator(unsigned seed) : random_(seed) {}

  // MSM of format 4 to 7: up to eight satellites, up to four signals, a random cell mask.
  std::vector<std::uint8_t> msm(std::uint16_t number, std::uint32_t highest_satellite,
                                std::span<const int> signals) {
    BitWriter<1023> bits;
    bits.put(number, 12);
    bits.put(below(4096), 12);
    bits.put(below(604'800'000), 30);
    bits.put(below(1 << 19), 19);  // from the multiple message bit to the smoothing interval
    std::uint64_t satellite_mask = 0;
    for (int i = 0; i < 8; ++i) satellite_mask |= 1ull << (64 - 1 - below(highest_satellite));
    std::uint32_t signal_mask = 0;
    for (int i = 0; i < 4; ++i) {
      signal_mask |= 1u << (32 - signals[below(static_cast<std::uint32_t>(signals.size()))]);
    }
    bits.put(static_cast<std::uint32_t>(satellite_mask >> 32), 32);
    bits.put(static_cast<std::uint32_t>(satellite_mask), 32);
    bits.put(signal_mask, 32);
    while (bits.position() < 8 * 600) bits.put(below(2), 1);
    return framed(std::span(bits.bytes()).first(600));
  }

  // An SSR message of one or two satellites; `count_at` is where the number of satellites stands.
  std::vector<std::uint8_t> ssr(std::uint16_t number, std::uint32_t igs_subtype,
                                std::size_t count_at) {
    BitWriter<1023> bits;
    bits.put(number, 12);
    if (igs_subtype != 0) bits.put(3, 3), bits.put(igs_subtype, 8);
    bits.put(below(604'800), 20);
    while (bits.position() < count_at) bits.put(below(2), 1);
    bits.put(1 + below(2), 6);
    while (bits.position() < 8 * 400) bits.put(below(2), 1);
    return framed(std::span(bits.bytes()).first(400));
  }

 private:
  std::uint32_t below(std::uint32_t limit) { return static_cast<std::uint32_t>(random_() % limit); }
  std::mt19937_64 random_;
};

// Signals of the mask that both sides know.
inline constexpr std::array kGpsMask = {2, 3, 4, 8, 9, 10, 15, 16, 17, 22, 23, 24, 30, 31, 32};
inline constexpr std::array kGalileoMask = {2,  3,  4,  5,  6,  8,  9,  10, 11, 12,
                                            14, 15, 16, 18, 19, 20, 22, 23, 24};
inline constexpr std::array kBeidouMask = {2,  3,  4,  8,  9,  10, 14, 15,
                                           16, 22, 23, 24, 25, 30, 31, 32};

inline std::vector<std::uint8_t> generated_msm(int of_each) {
  MessageGenerator generator(1);
  std::vector<std::uint8_t> stream;
  for (int i = 0; i < of_each; ++i) {
    for (const int format : {4, 5, 6, 7}) {
      const auto number = [format](int first) {
        return static_cast<std::uint16_t>(first + format);
      };
      append(&stream, generator.msm(number(1070), 63, kGpsMask));
      append(&stream, generator.msm(number(1090), 50, kGalileoMask));
      append(&stream, generator.msm(number(1120), 63, kBeidouMask));
    }
  }
  return stream;
}

inline std::vector<std::uint8_t> generated_ssr(int of_each) {
  // Header bits up to the number of satellites; orbits have a bit of the frame, phases two more.
  constexpr std::size_t kHeader = 12 + 20 + 4 + 1 + 4 + 16 + 4, kIgsHeader = kHeader + 3 + 8;
  MessageGenerator generator(2);
  std::vector<std::uint8_t> stream;
  for (int i = 0; i < of_each; ++i) {
    for (const std::uint16_t first : {1057, 1240, 1258}) {
      for (const std::uint16_t kind : {0, 1, 2, 3, 4, 5}) {
        append(&stream, generator.ssr(static_cast<std::uint16_t>(first + kind), 0,
                                      kHeader + (kind == 0 || kind == 3)));
      }
    }
    for (const std::uint32_t first : {20u, 60u, 100u}) {
      // pyrtcm reads the fields of subtype 1, orbits alone, in another order than the IGS's text.
      for (const std::uint32_t kind : {2u, 3u, 4u, 5u, 6u, 7u}) {
        const std::size_t more = kind == 3 ? 1 : kind == 6 ? 2 : 0;
        append(&stream, generator.ssr(4076, first + kind, kIgsHeader + more));
      }
    }
  }
  return stream;
}

}  // namespace leonav::test
