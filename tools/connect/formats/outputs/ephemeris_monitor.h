// The EphemerisMonitor finds systems whose satellites a receiver observes and none of which has an
// ephemeris.
#pragma once
#include <array>
#include <cstddef>
#include <string>

#include "core/gnss/signals/observation.h"
#include "tools/connect/formats/outputs/known_orbits.h"

namespace leonav {

// A receiver whose navigation messages of one system are not switched on looks well: its epochs
// come, and so do the ephemerides of the other systems.
class EphemerisMonitor {
 public:
  // Returns what to switch on in the receiver to get the ephemerides of a system.
  using Remedy = const char* (*)(System);
  // So long, by the time of the epochs, satellites are observed before a system is told. Galileo's
  // F/NAV needs 50 s for an ephemeris, twice that if a page is lost; senders of RTCM 3 may pause
  // for two minutes.
  static constexpr double kPatience_s = 150.0;
  // Epochs that are further apart are a pause, which does not count. After such a pause, as of an
  // antenna without a sky, systems are waited for anew.
  static constexpr double kLongestInterval_s = 60.0;

  // `orbits`, of all streams, must outlive this object. nullptr as `remedy`: nothing is ever told.
  EphemerisMonitor(const KnownOrbits* orbits, Remedy remedy) : orbits_(orbits), remedy_(remedy) {}

  void on_epoch(const RawEpoch& epoch);
  // The receiver's time has stepped: systems are waited for anew.
  void start_over();
  // Returns how many satellites of which systems have no ephemeris, with the remedy; empty: all is
  // well.
  std::string text() const;
  // Returns the text once after a system has come to be without ephemerides; empty otherwise.
  std::string take_news();

 private:
  struct OfSystem {
    std::size_t satellites = 0;  // in the last epoch
    GpsTime observed;            // time of the last epoch with satellites
    double waited_s = 0.0;       // while they were observed without an ephemeris
    bool is_without = false;     // for kPatience_s, and they still are
    bool is_told = false;
  };
  void look_at(System system, std::size_t satellites, GpsTime time);

  const KnownOrbits* orbits_;
  Remedy remedy_;
  std::array<OfSystem, kSystemCount> systems_;
};

}  // namespace leonav
