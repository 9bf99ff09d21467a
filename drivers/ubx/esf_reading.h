// An EsfReading is one sample of the inertial sensor of a u-blox receiver, and the EsfAssembly puts
// it together from the values of single axes.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

namespace leonav {

// In the axes of the sensor, which the module's integration manual draws: how it is turned against
// the vehicle is for the mounting to say.
struct EsfReading {
  using Vector = std::array<double, 3>;
  // The message that it comes from: each has a clock of its own.
  enum class Source : std::uint8_t { kMeas, kRaw };

  Source source = Source::kMeas;
  std::int64_t clock_ns = 0;  // of the sensor's time tags, continued where they wrap
  std::int64_t sent_ns = 0;   // of the last sample in the same message, which is sent after it
  Vector angular_rate_rad_s{};
  Vector specific_force_m_s2{};
  std::optional<double> temperature_c;  // of the gyroscope: the last one before the sixth axis
};

// The kinds of values that make a sample; others are those of odometers.
enum class EsfType : std::uint8_t {
  kGyroZ = 5,
  kTemperature = 12,
  kGyroY = 13,
  kGyroX = 14,
  kAccelX = 16,
  kAccelY = 17,
  kAccelZ = 18
};

// One value, as both messages pack it: 24 bits of value and the type above them.
struct EsfValue {
  std::uint8_t type = 0;
  std::int32_t value = 0;
};
// `word`: the four bytes; `type_mask`: 0x3F in UBX-ESF-MEAS, 0xFF in UBX-ESF-RAW.
EsfValue esf_value(std::uint32_t word, std::uint32_t type_mask);

// Puts samples together. Six values whose clocks are within `tolerance_ns` of the first are one,
// with the clock of the first; a value that is there already, or later, begins the next.
class EsfAssembly {
 public:
  explicit EsfAssembly(EsfReading::Source source, std::int64_t tolerance_ns);

  // Returns the sample that the value completes. One with a type that does not belong to samples
  // changes nothing.
  std::optional<EsfReading> add(const EsfValue& value, std::int64_t clock_ns);
  // Begins anew; what is not complete is counted.
  void clear();
  std::uint64_t incomplete() const { return incomplete_; }

 private:
  EsfReading::Source source_;
  std::int64_t tolerance_ns_;
  EsfReading reading_;
  unsigned present_ = 0;  // a bit for each axis
  std::optional<double> temperature_c_;
  std::uint64_t incomplete_ = 0;
};

}  // namespace leonav
