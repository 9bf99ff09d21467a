// This header gives the checksum of a piece of a stream from those of the stream itself.
#pragma once
#include <array>
#include <cstddef>

namespace leonav {

// A CRC is linear: the checksum of all bytes before the piece, moved on by its length, is what
// these contribute to the checksum of all bytes to its end. A piece therefore costs the same
// whatever its length is, which is below 65,536. `kNext` continues a checksum by a byte, `kProduct`
// multiplies two, `kOne` is the checksum that stands for 1.
template <auto kNext, auto kProduct, auto kOne>
class CrcOfPiece {
 public:
  using Crc = decltype(kNext(kOne, 0));

  static constexpr Crc get(Crc before, Crc behind, std::size_t bytes) {
    const Crc moved = kProduct(before, kPowers.ones[bytes % 256]);
    return behind ^ kProduct(moved, kPowers.pages[bytes / 256]);
  }

 private:
  // What 1 becomes by n and by 256 n bytes of zeros.
  struct Powers {
    std::array<Crc, 256> ones{}, pages{};
  };
  static constexpr Powers make_powers() {
    Powers powers;
    powers.ones[0] = powers.pages[0] = kOne;
    for (std::size_t n = 1; n < 256; ++n) powers.ones[n] = kNext(powers.ones[n - 1], 0);
    const Crc page = kNext(powers.ones[255], 0);
    for (std::size_t n = 1; n < 256; ++n) powers.pages[n] = kProduct(powers.pages[n - 1], page);
    return powers;
  }
  static constexpr Powers kPowers = make_powers();
};

}  // namespace leonav
