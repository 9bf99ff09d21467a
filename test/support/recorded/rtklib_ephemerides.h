// Which broadcast elements RTKLIB 2.4.3 b34 uses at a time, put into an ephemeris store of leonav,
// so that the two can be compared with nothing but the models between them. The rules were read in
// RTKLIB's ephemeris.c, rtkcmn.c and pntpos.c; where they differ from leonav's they are Galileo's:
//  - I/NAV alone, and only with a reference time before the epoch (leonav: the nearest one);
//  - BGDs of the satellite's record that was sent first, of either message and however old. F/NAV
//    has no BGD E5b/E1: where it was the first, E1 is left without a delay against I/NAV's clock,
//    which the Galileo OS-SIS-ICD (5.1.5) asks for.
#pragma once
#include <array>
#include <map>
#include <tuple>

#include "support/recorded/dataset.h"

namespace leonav::test {

inline std::vector<Ephemeris> ephemerides_as_rtklib_reads(const std::vector<Ephemeris>& all) {
  const auto sent = [](const Ephemeris& e) { return std::tie(e.transmission_time, e.toe); };
  std::map<SatelliteId, const Ephemeris*> first;
  for (const Ephemeris& e : all) {
    const Ephemeris*& place = first[e.satellite];
    if (place == nullptr || sent(e) < sent(*place)) place = &e;
  }
  std::vector<Ephemeris> kept;
  for (const Ephemeris& e : all) {
    if (e.message == NavigationMessage::kGalileoFnav) continue;
    kept.push_back(e);
    if (e.satellite.system != System::kGalileo) continue;
    kept.back().group_delay_s = first.at(e.satellite)->group_delay_s;
  }
  return kept;
}

class RtklibFeed {
 public:
  RtklibFeed(const Dataset& data, const EphemerisConfig& options)
      : ephemerides_(ephemerides_as_rtklib_reads(data.ephemerides)), ephemeris_store_(options) {
    ephemeris_store_.set_klobuchar(data.klobuchar);
  }
  // Called with growing times.
  const EphemerisStore& at(GpsTime time) {
    for (const System system : kSystems) {
      const double ahead_s = system == System::kGalileo ? -1.0e-9 : 3600.0;
      for (std::size_t& i = next_[index_of(system)]; i < ephemerides_.size(); ++i) {
        if (seconds_between(ephemerides_[i].toe, time) > ahead_s) break;
        if (ephemerides_[i].satellite.system == system) ephemeris_store_.add(ephemerides_[i]);
      }
    }
    return ephemeris_store_;
  }

 private:
  std::vector<Ephemeris> ephemerides_;  // by toe
  EphemerisStore ephemeris_store_;
  std::array<std::size_t, kSystemCount> next_{};
};

}  // namespace leonav::test
