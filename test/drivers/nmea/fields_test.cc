// Times, angles and numbers as fields: where rounding carries, days and years change, UTC leaps.
#include "drivers/nmea/fields.h"

#include <limits>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "drivers/nmea/sentence.h"
#include "solution_of.h"
#include "support/catch.h"

namespace leonav {
namespace {

// GPS time by its calendar, which has no leap seconds.
UtcFields utc(int year, int month, int day, int hour, int minute, double second) {
  return utc_fields(from_calendar({year, month, day, hour, minute, second}));
}

std::string all(const PlaceFields& place) { return place.angle + place.hemisphere; }

}  // namespace

TEST_CASE("The checksum is that of a sentence of the standard's literature", "[nmea]") {
  CHECK(nmea_checksum("GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,") == 0x47);
  CHECK(Sentence("GNHDT").field("").field("T").line() == "$GNHDT,,T*05\r\n");
}

TEST_CASE("UTC is GPS time less the leap seconds of that day", "[nmea]") {
  const UtcFields fields = utc(2020, 6, 25, 12, 35, 37.25);
  CHECK(fields.time == "123519.25");
  CHECK(fields.date() == "250620");
  CHECK(fields.year == "2020");
  // A third decimal only where it says something.
  CHECK(utc(2020, 6, 25, 12, 35, 37.255).time == "123519.255");
  CHECK(utc(2020, 6, 25, 12, 35, 37.2504).time == "123519.25");
  CHECK(utc(2020, 6, 25, 12, 35, 37.001).time == "123519.001");
  // 13 seconds until the end of 2005, 14 afterwards.
  CHECK(utc(2005, 6, 1, 0, 0, 13.0).time == "000000.00");
  CHECK(utc(2006, 6, 1, 0, 0, 14.0).time == "000000.00");
}

TEST_CASE("Rounding carries into minutes, days and years", "[nmea]") {
  const UtcFields before = utc(2020, 1, 1, 0, 0, 17.9994);
  CHECK(before.time == "235959.999");
  CHECK(before.date() == "311219");
  const UtcFields after = utc(2020, 1, 1, 0, 0, 17.9996);
  CHECK(after.time == "000000.00");
  CHECK(after.date() == "010120");
  CHECK(utc(2020, 2, 29, 0, 0, 17.0).date() == "280220");
  CHECK(utc(2020, 3, 1, 0, 0, 17.0).date() == "290220");
}

TEST_CASE("The leap second of 2016 is second 60 of its day", "[nmea]") {
  // 17 leap seconds before; the inserted second begins at 2017-01-01 00:00:17 GPS time.
  CHECK(utc(2017, 1, 1, 0, 0, 16.99).time == "235959.99");
  const UtcFields inserted = utc(2017, 1, 1, 0, 0, 17.25);
  CHECK(inserted.time == "235960.25");
  CHECK(inserted.date() == "311216");
  CHECK(utc(2017, 1, 1, 0, 0, 17.9994).time == "235960.999");
  CHECK(utc(2017, 1, 1, 0, 0, 17.9996).time == "000000.00");
  const UtcFields next = utc(2017, 1, 1, 0, 0, 18.0);
  CHECK(next.time == "000000.00");
  CHECK(next.date() == "010117");
}

TEST_CASE("Angles never show sixty minutes", "[nmea]") {
  CHECK(all(latitude_fields((48.0 + 59.9999 / 60.0) * kDegree)) == "4859.999900N");
  CHECK(all(latitude_fields((48.0 + 59.99999949 / 60.0) * kDegree)) == "4859.999999N");
  CHECK(all(latitude_fields((48.0 + 59.9999996 / 60.0) * kDegree)) == "4900.000000N");
  CHECK(all(longitude_fields(-(179.0 + 59.9999999 / 60.0) * kDegree)) == "18000.000000W");
}

TEST_CASE("Hemispheres have letters, not signs", "[nmea]") {
  CHECK(all(latitude_fields(-33.5 * kDegree)) == "3330.000000S");
  CHECK(all(longitude_fields(-0.25 * kDegree)) == "00015.000000W");
  CHECK(all(longitude_fields(151.75 * kDegree)) == "15145.000000E");
  CHECK(all(latitude_fields(-1e-12)) == "0000.000000N");
  CHECK(all(latitude_fields(-90.0 * kDegree)) == "9000.000000S");
}

TEST_CASE("Bearings are from 0 to 359.99", "[nmea]") {
  CHECK(bearing_field(-90.0 * kDegree) == "270.00");
  CHECK(bearing_field(359.996 * kDegree) == "0.00");
  CHECK(bearing_field(-0.004 * kDegree) == "0.00");
  CHECK(bearing_field(5.125001 * kDegree) == "5.13");
}

TEST_CASE("What is not known is empty, and zero has no sign", "[nmea]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(number_field(nan, 2).empty());
  CHECK(number_field(std::numeric_limits<double>::infinity(), 2).empty());
  CHECK(bearing_field(nan).empty());
  CHECK(all(latitude_fields(nan)).empty());
  CHECK(number_field(-0.001, 2) == "0.00");
  CHECK(number_field(-0.01, 2) == "-0.01");
}

TEST_CASE("A text keeps to the characters and the length of the standard", "[nmea]") {
  const std::string line = text_sentence("a,b*c$d\n" + std::string(100, 'x'));
  CHECK(line.starts_with("$GNTXT,01,01,01,a b c d xxx"));
  CHECK(line.size() <= 82);
}

}  // namespace leonav
