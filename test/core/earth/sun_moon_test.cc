#include "core/earth/sun_moon.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/calendar.h"
#include "support/catch.h"

namespace leonav {
namespace {

GpsTime from_utc(int year, int month, int day, double hour) {
  return gps_from_utc(from_calendar({year, month, day, 0, 0, hour * 3600.0}));
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

// PyPI pyerfa 2.0.1.5: epv00 (Sun), moon98 (Moon), turned by c2t06a with UT1 = UTC and no polar
// motion. 4000 instants of 1980 to 2060 gave at worst 1.4e-4 rad (Sun), 2.2e-4 rad (Moon), 5.3e-5
// and 7.2e-5 of the distance.
TEST_CASE("Sun and Moon stand where the IAU's standard software has them", "[sun_moon]") {
  struct Row {
    int year, month, day;
    double hour;
    Eigen::Vector3d sun_e, moon_e;
  };
  for (const Row& row : {Row{1995,
                             3,
                             1,
                             6.5,
                             {11190335240, 146447364122, -19961638395},
                             {56705514, 375959795, -31209783}},
                         Row{2004,
                             1,
                             1,
                             0,
                             {-135322963756, -1823930460, -57644975656},
                             {110863597, -380899849, 61367676}},
                         Row{2009,
                             4,
                             13,
                             0,
                             {-148138989244, -411618356, 23512635590},
                             {280723486, 225531211, -169115853}},
                         Row{2012,
                             7,
                             13,
                             0,
                             {-141160009261, -3552228289, 56460717019},
                             {-117666294, 367807361, 120368452}},
                         Row{2020,
                             6,
                             25,
                             3.25,
                             {-93276215383, 103849396720, 60333007476},
                             {-356193900, -20747387, 116986172}},
                         Row{2021,
                             4,
                             28,
                             18,
                             {-1625179203, -145897892410, 37434182012},
                             {-129733836, 311881819, -120254247}},
                         Row{2026,
                             11,
                             21,
                             15,
                             {91979805155, -104039861377, -50551524085},
                             {-585539, 366969480, 71903942}},
                         Row{2040,
                             2,
                             29,
                             21.75,
                             {-117635577668, -88084062076, -19267926468},
                             {198310496, 331228771, 19654182}}}) {
    INFO(row.year << "-" << row.month << "-" << row.day);
    const SunMoon at = sun_moon_positions(from_utc(row.year, row.month, row.day, row.hour));
    CHECK(angle(at.sun_e, row.sun_e) < 1.5e-4);
    CHECK(angle(at.moon_e, row.moon_e) < 2.3e-4);
    CHECK(at.sun_e.norm() == Approx(row.sun_e.norm()).epsilon(6e-5));
    CHECK(at.moon_e.norm() == Approx(row.moon_e.norm()).epsilon(8e-5));
  }
}

TEST_CASE("Sun and Moon move without jumps, across midnight and a leap second too", "[sun_moon]") {
  // One second turns the sky by 7.3e-5 rad; the leap second of 2016-12-31 shows once, since UT1 is
  // taken as UTC.
  const GpsTime start = from_calendar({2017, 1, 1, 0, 0, 10.0});
  SunMoon before = sun_moon_positions(start);
  int held = 0;
  for (int second = 1; second <= 20; ++second) {
    const SunMoon now = sun_moon_positions(start.plus_seconds(second));
    const double turned = angle(before.sun_e, now.sun_e);
    CHECK(turned < 7.3e-5);
    if (turned < 3e-5) ++held;
    before = now;
  }
  CHECK(held == 1);
}

}  // namespace leonav
