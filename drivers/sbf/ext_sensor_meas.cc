#include "drivers/sbf/ext_sensor_meas.h"

#include <algorithm>
#include <cmath>

#include "core/base/angle.h"
#include "drivers/binary/little_endian.h"

namespace leonav {
namespace {

constexpr std::size_t kSensorHeadSize = 2;  // number and length of the sub-blocks
constexpr std::size_t kSubBlockSize = 28;   // source, model, type, information, three reals
constexpr std::uint8_t kAcceleration = 0, kAngularRate = 1;
constexpr double kUnknown = -2e10;

// A vector with the connection that its sensor is at.
struct Reading {
  std::uint8_t source = 0;
  ExtSensorRates::Vector vector{};
};

Reading reading_at(const std::uint8_t* p, double unit) {
  Reading reading{p[0], {}};
  for (std::size_t i = 0; i < 3; ++i) reading.vector[i] = read_r8(p + 4 + 8 * i) * unit;
  return reading;
}

bool is_known(const ExtSensorRates::Vector& vector, double unit) {
  return std::all_of(vector.begin(), vector.end(), [unit](double value) {
    return std::isfinite(value) && value > kUnknown * unit / 2;
  });
}

}  // namespace

std::optional<ExtSensorRates> ExtSensorReader::read(GpsTime time,
                                                    std::span<const std::uint8_t> payload) {
  const std::size_t count = payload.size() < kSensorHeadSize ? 0 : payload[0];
  const std::size_t size = payload.size() < kSensorHeadSize ? 0 : payload[1];
  if (payload.size() < kSensorHeadSize + count * size || size < kSubBlockSize) {
    ++counters_.bad_length;
    return std::nullopt;
  }
  std::optional<Reading> acceleration, rate;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* p = payload.data() + kSensorHeadSize + i * size;
    if (p[2] == kAcceleration && !acceleration) acceleration = reading_at(p, 1.0);
    if (p[2] == kAngularRate && !rate) rate = reading_at(p, kDegree);
  }
  if (!acceleration || !rate || acceleration->source != rate->source) {
    ++counters_.without_motion;
    return std::nullopt;
  }
  if (!is_known(acceleration->vector, 1.0) || !is_known(rate->vector, kDegree)) {
    ++counters_.bad_value;
    return std::nullopt;
  }
  if (!time.is_set()) {
    ++counters_.without_time;
    return std::nullopt;
  }
  ++counters_.samples;
  return ExtSensorRates{time, rate->vector, acceleration->vector};
}

}  // namespace leonav
