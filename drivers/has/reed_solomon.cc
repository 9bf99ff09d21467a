#include "drivers/has/reed_solomon.h"

#include <algorithm>
#include <utility>

namespace leonav {
namespace {

constexpr std::size_t kInformation = kMaxHasPages, kParity = 255 - kInformation;

// Powers of the root and their logarithms. A power may be up to twice 254.
struct Field {
  std::array<std::uint8_t, 510> power{};
  std::array<std::uint8_t, 256> logarithm{};
};

constexpr Field make_field() {
  constexpr unsigned kPolynomial = 0x11D;
  Field field;
  unsigned value = 1;
  for (std::size_t i = 0; i < 255; ++i) {
    field.power[i] = field.power[i + 255] = static_cast<std::uint8_t>(value);
    field.logarithm[value] = static_cast<std::uint8_t>(i);
    value <<= 1;
    if (value & 0x100) value ^= kPolynomial;
  }
  return field;
}
constexpr Field kField = make_field();

constexpr std::uint8_t product(std::uint8_t a, std::uint8_t b) {
  if (a == 0 || b == 0) return 0;
  return kField.power[std::size_t{kField.logarithm[a]} + kField.logarithm[b]];
}

constexpr std::uint8_t inverse(std::uint8_t a) { return kField.power[255u - kField.logarithm[a]]; }

using ParityRow = std::array<std::uint8_t, kInformation>;

// Returns, for each octet of parity, its factors of the octets of information.
std::array<ParityRow, kParity> make_parity() {
  std::array<std::uint8_t, kParity> generator{};  // without its leading 1, highest power first
  std::size_t degree = 0;
  for (std::size_t i = 1; i <= kParity; ++i, ++degree) {
    const std::uint8_t root = kField.power[i];
    for (std::size_t j = degree; j > 0; --j) generator[j] ^= product(generator[j - 1], root);
    generator[0] ^= root;
  }
  // The last octet of information gives x^223, and the one before x times the remainder after it.
  std::array<ParityRow, kParity> parity{};
  std::array<std::uint8_t, kParity> remainder = generator;
  for (std::size_t column = kInformation; column-- > 0;) {
    for (std::size_t row = 0; row < kParity; ++row) parity[row][column] = remainder[row];
    const std::uint8_t leading = remainder[0];
    std::rotate(remainder.begin(), remainder.begin() + 1, remainder.end());
    remainder.back() = 0;
    for (std::size_t row = 0; row < kParity; ++row) {
      remainder[row] ^= product(leading, generator[row]);
    }
  }
  return parity;
}

// One equation: factors of the unknown octets, and the octets of the page.
struct Equation {
  ParityRow factors{};
  HasPageOctets octets{};

  void scale(std::uint8_t by) {
    for (std::uint8_t& f : factors) f = product(f, by);
    for (std::uint8_t& o : octets) o = product(o, by);
  }
  void add(const Equation& other, std::uint8_t times) {
    for (std::size_t i = 0; i < factors.size(); ++i) factors[i] ^= product(other.factors[i], times);
    for (std::size_t i = 0; i < octets.size(); ++i) octets[i] ^= product(other.octets[i], times);
  }
};

Equation equation_of(const EncodedPage& page) {
  static const std::array<ParityRow, kParity> kParityRows = make_parity();
  Equation equation;
  if (page.id <= kInformation) {
    equation.factors[page.id - 1u] = 1;
  } else {
    equation.factors = kParityRows[page.id - 1u - kInformation];
  }
  equation.octets = page.octets;
  return equation;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> decode_reed_solomon(std::span<const EncodedPage> pages) {
  const std::size_t count = pages.size();
  if (count == 0 || count > kMaxHasPages) return std::nullopt;
  std::vector<Equation> equations;
  for (const EncodedPage& page : pages) {
    if (page.id == 0) return std::nullopt;
    equations.push_back(equation_of(page));
  }
  // Gauss and Jordan. The code is maximum distance separable: pages of different numbers that can
  // be sent always have a solution.
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t pivot = i;
    while (pivot < count && equations[pivot].factors[i] == 0) ++pivot;
    if (pivot == count) return std::nullopt;
    std::swap(equations[i], equations[pivot]);
    equations[i].scale(inverse(equations[i].factors[i]));
    for (std::size_t k = 0; k < count; ++k) {
      if (k != i && equations[k].factors[i] != 0) {
        equations[k].add(equations[i], equations[k].factors[i]);
      }
    }
  }
  std::vector<std::uint8_t> message;
  for (const Equation& equation : equations) {
    message.insert(message.end(), equation.octets.begin(), equation.octets.end());
  }
  return message;
}

}  // namespace leonav
