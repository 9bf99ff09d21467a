#include "drivers/vectornav/vectornav_decoder.h"

#include <algorithm>
#include <cmath>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "drivers/binary/little_endian.h"

namespace leonav {
namespace {

using Vector = VectornavMeasurement::Vector;

// Beyond what the sensors measure; the service refuses larger ones too.
constexpr double kMaxRate_rad_s = 35.0, kMaxForce_m_s2 = 500.0, kMaxInterval_s = 0.1;
// Before it has the time the sensor counts from zero.
constexpr int kFirstWeek = 1024;

// Bits of TimeStatus.
constexpr std::uint8_t kTimeOk = 1, kDateOk = 2, kUtcOk = 4;

// Bits of the groups' masks.
enum CommonField {
  kCStartup,
  kCGps,
  kCSyncIn,
  kCRate = 5,
  kCForce = 8,
  kCImu,
  kCDelta = 11,
  kCSyncInCount = 13
};
enum TimeField {
  kTStartup,
  kTGps,
  kTTow,
  kTWeek,
  kTSyncIn,
  kTUtc = 6,
  kTSyncInCount,
  kTStatus = 9
};
enum ImuField { kIRawForce = 2, kIRawRate, kIDeltaTheta = 6, kIDeltaVelocity, kIForce = 9, kIRate };

// Where the fields of one message begin; nullptr: absent.
class Fields {
 public:
  explicit Fields(const VectornavMessage& message) {
    const std::uint8_t* masks = message.bytes.data() + 2;
    const std::uint8_t* field_at = message.bytes.data() + message.extent.header_bytes;
    for (std::size_t group = 0; group < kVectornavGroups; ++group) {
      if ((message.bytes[1] >> group & 1) == 0) continue;
      const std::uint16_t mask = read_u2(masks);
      masks += 2;
      for (std::size_t field = 0; field < kVectornavFields; ++field) {
        if ((mask >> field & 1) == 0) continue;
        at_[group][field] = field_at;
        field_at += vectornav_field_bytes(static_cast<VectornavGroup>(group), field);
      }
    }
  }
  const std::uint8_t* common(CommonField field) const { return at_[0][field]; }
  const std::uint8_t* time(TimeField field) const { return at_[1][field]; }
  const std::uint8_t* imu(ImuField field) const { return at_[2][field]; }

 private:
  std::array<std::array<const std::uint8_t*, kVectornavFields>, kVectornavGroups> at_{};
};

const std::uint8_t* first_of(const std::uint8_t* a, const std::uint8_t* b) {
  return a != nullptr ? a : b;
}

Vector read_vector(const std::uint8_t* at, double unit = 1.0) {
  return {read_r4(at) * unit, read_r4(at + 4) * unit, read_r4(at + 8) * unit};
}

bool are_within(const Vector& values, double limit) {
  return std::all_of(values.begin(), values.end(),
                     [limit](double value) { return std::abs(value) <= limit; });  // false of NaN
}

std::optional<GpsTime> gps_time(std::uint64_t nanoseconds) {
  constexpr auto week_ns = static_cast<std::uint64_t>(kNanosecondsPerWeek);
  const std::uint64_t week = nanoseconds / week_ns;
  if (week < kFirstWeek || week > kLastGpsWeek) return std::nullopt;
  return GpsTime::from_nanoseconds(static_cast<std::int64_t>(nanoseconds));
}

std::optional<GpsTime> read_gps_time(const Fields& fields) {
  if (const auto* at = first_of(fields.common(kCGps), fields.time(kTGps))) {
    return gps_time(read_u8(at));
  }
  const std::uint8_t* week = fields.time(kTWeek);
  const std::uint8_t* tow = fields.time(kTTow);
  if (week == nullptr || tow == nullptr) return std::nullopt;
  const std::uint64_t tow_ns = read_u8(tow);
  if (tow_ns >= static_cast<std::uint64_t>(kNanosecondsPerWeek)) return std::nullopt;
  return gps_time(read_u2(week) * static_cast<std::uint64_t>(kNanosecondsPerWeek) + tow_ns);
}

// Years since 2000, month, day, hour, minute, second, then milliseconds in two bytes.
std::optional<GpsTime> read_utc(const std::uint8_t* at) {
  if (at == nullptr) return std::nullopt;
  const int ms = read_u2(at + 6);
  const auto year = static_cast<std::int8_t>(at[0]);
  if (at[1] < 1 || at[1] > 12 || at[2] < 1 || at[2] > 31 || at[3] > 23 || at[4] > 59 ||
      at[5] > 60 || ms > 999 || year < 10) {
    return std::nullopt;
  }
  return gps_from_utc(from_calendar({2000 + year, at[1], at[2], at[3], at[4], at[5] + ms * 1e-3}));
}

void read_times(const Fields& fields, VectornavMeasurement* m) {
  const std::uint8_t* status = fields.time(kTStatus);
  const auto is_valid = [status](std::uint8_t bits) {
    return status == nullptr || (*status & bits) == bits;
  };
  if (is_valid(kTimeOk | kDateOk)) m->gps_time = read_gps_time(fields);
  if (is_valid(kUtcOk)) m->utc_time = read_utc(fields.time(kTUtc));
  if (const auto* at = first_of(fields.common(kCStartup), fields.time(kTStartup))) {
    m->startup_ns = read_u8(at);
  }
  if (const auto* at = first_of(fields.common(kCSyncIn), fields.time(kTSyncIn))) {
    m->since_pulse_ns = read_u8(at);
  }
  if (const auto* at = first_of(fields.common(kCSyncInCount), fields.time(kTSyncInCount))) {
    m->pulses = read_u4(at);
  }
}

std::optional<VectornavMeasurement::Increments> read_increments(const Fields& fields) {
  if (const auto* at = fields.common(kCDelta)) {
    return {{read_r4(at), read_vector(at + 4, kDegree), read_vector(at + 16)}};
  }
  const std::uint8_t* theta = fields.imu(kIDeltaTheta);
  const std::uint8_t* velocity = fields.imu(kIDeltaVelocity);
  if (theta == nullptr || velocity == nullptr) return std::nullopt;
  return {{read_r4(theta), read_vector(theta + 4, kDegree), read_vector(velocity)}};
}

// The navigator estimates biases itself, so values that the sensor has not corrected come first:
// a correction that wanders would be a second estimate of the same thing.
std::optional<VectornavMeasurement::Rates> read_rates(const Fields& fields) {
  const std::uint8_t* force = fields.imu(kIRawForce);
  const std::uint8_t* rate = fields.imu(kIRawRate);
  if (const auto* at = fields.common(kCImu)) {
    force = at;
    rate = at + 12;
  } else if (force == nullptr || rate == nullptr) {
    force = first_of(fields.imu(kIForce), fields.common(kCForce));
    rate = first_of(fields.imu(kIRate), fields.common(kCRate));
  }
  if (force == nullptr || rate == nullptr) return std::nullopt;
  return {{read_vector(rate), read_vector(force)}};
}

bool is_possible(const VectornavMeasurement::Increments& i) {
  return i.interval_s > 0.0 && i.interval_s <= kMaxInterval_s &&
         are_within(i.delta_theta_rad, kMaxRate_rad_s * i.interval_s) &&
         are_within(i.delta_velocity_m_s, kMaxForce_m_s2 * i.interval_s);
}

bool is_possible(const VectornavMeasurement::Rates& r) {
  return are_within(r.angular_rate_rad_s, kMaxRate_rad_s) &&
         are_within(r.specific_force_m_s2, kMaxForce_m_s2);
}

}  // namespace

void VectornavDecoder::feed(std::span<const std::uint8_t> bytes, VectornavHandler* handler) {
  while (!bytes.empty()) {
    bytes = bytes.subspan(framer_.append(bytes));
    drain(handler);
  }
}

void VectornavDecoder::finish(VectornavHandler* handler) {
  framer_.finish();
  drain(handler);
}

void VectornavDecoder::drain(VectornavHandler* handler) {
  const auto take = [this](auto read, auto* to) {
    if (!read) return;
    if (is_possible(*read)) {
      *to = read;
    } else {
      ++counters_.bad_values;
    }
  };
  VectornavMessage message;
  while (framer_.next(&message)) {
    const Fields fields(message);
    VectornavMeasurement measurement;
    read_times(fields, &measurement);
    const auto increments = read_increments(fields);
    const auto rates = read_rates(fields);
    take(increments, &measurement.increments);
    take(rates, &measurement.rates);
    if (!measurement.increments && !measurement.rates) {
      if (!increments && !rates) ++counters_.without_motion;
      continue;
    }
    ++counters_.measurements;
    handler->on_measurement(measurement);
  }
}

VectornavCounters VectornavDecoder::counters() const {
  VectornavCounters counters = counters_;
  counters.framer = framer_.counters();
  return counters;
}

}  // namespace leonav
