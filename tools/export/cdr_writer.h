// The CdrWriter encodes the members of a ROS 2 message.
//
// Format: OMG DDSI-RTPS 2.5, 10 (encapsulation CDR_LE), with the alignment of OMG CORBA 3.3 part 2,
// 9.3: a primitive begins at a multiple of its size, counted from behind the four bytes of the
// encapsulation.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace leonav {

class CdrWriter {
 public:
  template <typename T>
  CdrWriter& put(T value) {
    static_assert(std::is_arithmetic_v<T> && std::endian::native == std::endian::little);
    const std::size_t beyond = (bytes_.size() - kEncapsulationBytes) % sizeof(T);
    if (beyond != 0) bytes_.append(sizeof(T) - beyond, '\0');
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
    return *this;
  }
  CdrWriter& text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1)).bytes_ += text;
    bytes_ += '\0';
    return *this;
  }
  CdrWriter& array(std::span<const double> values) {
    for (const double value : values) put(value);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kEncapsulationBytes = 4;
  std::string bytes_{'\0', '\1', '\0', '\0'};
};

}  // namespace leonav
