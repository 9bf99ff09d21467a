#include "tools/connect/position_line.h"

#include "drivers/nmea/fields.h"
#include "drivers/nmea/sentence.h"
#include "tools/connect/stamps/host_clock.h"

namespace leonav {

std::string position_line(const ReportedPosition& position, GpsTime time) {
  const PlaceFields latitude = latitude_fields(position.latitude);
  const PlaceFields longitude = longitude_fields(position.longitude);
  return Sentence("GPGGA")
      .field(utc_fields(time).time)
      .field(latitude.angle)
      .field(latitude.hemisphere)
      .field(longitude.angle)
      .field(longitude.hemisphere)
      .field("1")
      .field("12")
      .field("1.0")
      .field(number_field(position.height_m, 3))
      .field("M")
      .field("0.0")
      .field("M")
      .field("")
      .field("")
      .line();
}

std::string position_line_now(const ReportedPosition& position) {
  const std::int64_t now_ns = HostClock::wall_ns();
  return position_line(position, HostClock(now_ns).at(now_ns));
}

}  // namespace leonav
