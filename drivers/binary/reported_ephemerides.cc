#include "drivers/binary/reported_ephemerides.h"

#include <array>

namespace leonav {
namespace {

// Returns whether both have the same contents, whenever they were sent.
bool say_the_same(const Ephemeris& a, const Ephemeris& b) {
  const auto elements = [](const Ephemeris& e) {
    return std::array{e.sqrt_a,
                      e.eccentricity,
                      e.m0,
                      e.delta_n,
                      e.omega0,
                      e.omega_dot,
                      e.i0,
                      e.i_dot,
                      e.omega,
                      e.cuc,
                      e.cus,
                      e.crc,
                      e.crs,
                      e.cic,
                      e.cis,
                      e.a_dot,
                      e.delta_n_dot,
                      e.af0,
                      e.af1,
                      e.af2,
                      e.accuracy_m,
                      e.group_delay_s[0],
                      e.group_delay_s[1]};
  };
  return a.toe == b.toe && a.toc == b.toc && a.issue == b.issue && a.issue_clock == b.issue_clock &&
         a.health == b.health && elements(a) == elements(b);
}

}  // namespace

bool ReportedEphemerides::is_new(const Ephemeris& ephemeris) {
  const auto [last, is_first] =
      last_.try_emplace({ephemeris.message, ephemeris.satellite}, ephemeris);
  if (!is_first && say_the_same(last->second, ephemeris)) return false;
  last->second = ephemeris;
  return true;
}

}  // namespace leonav
