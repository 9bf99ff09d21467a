// SHA-256 (FIPS 180-4): one number that stands for all outputs of a run.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace leonav {

class Sha256 {
 public:
  void add(std::span<const std::uint8_t> bytes);
  // Ends the hash; 64 hexadecimal digits.
  std::string hex_digest();

 private:
  void compress();

  // Square roots' fractions of the first eight primes (5.3.3).
  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::size_t filled_ = 0;
  std::uint64_t bits_ = 0;
};

}  // namespace leonav
