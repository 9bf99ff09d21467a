#include "drivers/xsens/xsens_decoder.h"

#include <algorithm>
#include <cmath>

#include "core/base/calendar.h"
#include "drivers/xsens/data_groups.h"
#include "drivers/xsens/fixed_point.h"

namespace leonav {
namespace {

using Vector = XsensMeasurement::Vector;
using Quaternion = std::array<double, 4>;

constexpr std::uint8_t kMtData = 0x32;

enum Kind : std::uint16_t {
  kTemperature = 0x0810,
  kUtcTime = 0x1010,
  kPacketCounter = 0x1020,
  kSampleTimeFine = 0x1060,
  kSampleTimeCoarse = 0x1070,
  kDeltaV = 0x4010,
  kAcceleration = 0x4020,
  kRateOfTurn = 0x8020,
  kDeltaQ = 0x8030,
  kStatusWord = 0xE020
};

// Beyond what the sensors measure; the service refuses larger ones too. Increments are of 0.1 s at
// the most.
constexpr double kMaxRate_rad_s = 35.0, kMaxForce_m_s2 = 500.0, kMaxInterval_s = 0.1;
// A quaternion in the coarsest precision, steps of 2^-20, is much nearer to length one.
constexpr double kMaxNormError = 1e-3;

bool are_within(const Vector& values, double limit) {
  return std::all_of(values.begin(), values.end(),
                     [limit](double value) { return std::abs(value) <= limit; });  // false of NaN
}

// Nanoseconds in four bytes, year in two, month, day, hour, minute, second, flags: valid time of
// week, week, UTC.
std::optional<GpsTime> read_utc(std::span<const std::uint8_t> data) {
  constexpr std::uint8_t kValid = 7;
  const std::uint32_t ns = read_big_u4(data.data());
  const int year = read_big_u2(data.data() + 4);
  const std::uint8_t* p = data.data() + 6;
  if ((p[5] & kValid) != kValid || ns >= 1'000'000'000 || year < 2010 || year > 2137 || p[0] < 1 ||
      p[0] > 12 || p[1] < 1 || p[1] > 31 || p[2] > 23 || p[3] > 59 || p[4] > 60) {
    return std::nullopt;
  }
  return gps_from_utc(from_calendar({year, p[0], p[1], p[2], p[3], static_cast<double>(p[4])})
                          .plus_nanoseconds(static_cast<std::int64_t>(ns)));
}

// Returns the rotation vector of a unit quaternion (q0, q1, q2, q3): with v the length of (q1, q2,
// q3) it has the angle 2 atan2(v, q0) about them, taken to be at most half a turn. nullopt: the
// quaternion's length is not one.
std::optional<Vector> rotation_vector(const Quaternion& q) {
  const double v = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::abs(std::hypot(q[0], v) - 1.0) <= kMaxNormError)) return std::nullopt;
  const double sign = q[0] < 0.0 ? -1.0 : 1.0;
  const double factor = v > 0.0 ? sign * 2.0 * std::atan2(v, sign * q[0]) / v : 0.0;
  return Vector{factor * q[1], factor * q[2], factor * q[3]};
}

// The motion of one message before its parts are put together.
struct Motion {
  bool has_delta_q = false, has_delta_v = false;  // whatever they hold
  std::optional<Quaternion> delta_q;
  std::optional<Vector> delta_v, acceleration, rate;
};

// Reads one group; returns false where its length is not that of its kind. Groups that are not
// known have any length.
bool read_group(const DataGroup& group, XsensMeasurement* m, Motion* motion) {
  const std::uint8_t* p = group.data.data();
  const auto has = [&group](std::size_t size) { return group.data.size() == size; };
  const auto vector = [&group](std::optional<Vector>* to) {
    *to = read_xsens_numbers<3>(group.data, group.precision());
    return to->has_value();
  };
  switch (group.kind()) {
    case kTemperature:
      if (const auto value = read_xsens_numbers<1>(group.data, group.precision())) {
        m->temperature_c = (*value)[0];
      }
      return m->temperature_c.has_value();
    case kUtcTime:
      if (has(12)) m->utc_time = read_utc(group.data);
      return has(12);
    case kPacketCounter:
      if (has(2)) m->packet_counter = read_big_u2(p);
      return has(2);
    case kSampleTimeFine:
      if (has(4)) m->sample_time_fine = read_big_u4(p);
      return has(4);
    case kSampleTimeCoarse:
      if (has(4)) m->sample_time_coarse = read_big_u4(p);
      return has(4);
    case kDeltaV:
      motion->has_delta_v = true;
      return vector(&motion->delta_v);
    case kAcceleration:
      return vector(&motion->acceleration);
    case kRateOfTurn:
      return vector(&motion->rate);
    case kDeltaQ:
      motion->has_delta_q = true;
      motion->delta_q = read_xsens_numbers<4>(group.data, group.precision());
      return motion->delta_q.has_value();
    case kStatusWord:
      if (has(4)) m->status = read_big_u4(p);
      return has(4);
    default:
      return true;
  }
}

std::optional<XsensMeasurement::Increments> increments_of(const Motion& motion) {
  const auto theta = rotation_vector(*motion.delta_q);
  if (!theta || !are_within(*theta, kMaxRate_rad_s * kMaxInterval_s) ||
      !are_within(*motion.delta_v, kMaxForce_m_s2 * kMaxInterval_s)) {
    return std::nullopt;
  }
  return {{*theta, *motion.delta_v}};
}

std::optional<XsensMeasurement::Rates> rates_of(const Motion& motion) {
  if (!are_within(*motion.rate, kMaxRate_rad_s) ||
      !are_within(*motion.acceleration, kMaxForce_m_s2)) {
    return std::nullopt;
  }
  return {{*motion.rate, *motion.acceleration}};
}

}  // namespace

void XsensDecoder::feed(std::span<const std::uint8_t> bytes, XsensHandler* handler) {
  while (!bytes.empty()) {
    bytes = bytes.subspan(framer_.append(bytes));
    drain(handler);
  }
}

void XsensDecoder::finish(XsensHandler* handler) {
  framer_.finish();
  drain(handler);
}

void XsensDecoder::drain(XsensHandler* handler) {
  for (XsensMessage message; framer_.next(&message);) {
    if (message.id == XsensFraming::kMtData2) {
      decode(message.payload, handler);
    } else {
      ++counters_.other_messages;
      counters_.old_data += message.id == kMtData;
    }
  }
}

void XsensDecoder::decode(std::span<const std::uint8_t> payload, XsensHandler* handler) {
  XsensMeasurement measurement;
  Motion motion;
  DataGroups groups(payload);
  for (DataGroup group; groups.next(&group);) {
    if (!read_group(group, &measurement, &motion)) ++counters_.bad_lengths;
  }
  counters_.unpaired += motion.has_delta_q != motion.has_delta_v;
  const bool has_increments = motion.delta_q && motion.delta_v;
  const bool has_rates = motion.rate && motion.acceleration;
  if (!has_increments && !has_rates) {
    ++counters_.without_motion;
    return;
  }
  if (has_increments) measurement.increments = increments_of(motion);
  if (has_rates) measurement.rates = rates_of(motion);
  counters_.bad_values += has_increments && !measurement.increments;
  counters_.bad_values += has_rates && !measurement.rates;
  if (!measurement.increments && !measurement.rates) return;
  ++counters_.measurements;
  counters_.clipped += measurement.is_clipped();
  handler->on_measurement(measurement);
}

XsensCounters XsensDecoder::counters() const {
  XsensCounters counters = counters_;
  counters.framer = framer_.counters();
  return counters;
}

}  // namespace leonav
