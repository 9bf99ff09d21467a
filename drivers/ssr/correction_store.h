// The CorrectionStore holds the newest corrections and broadcast elements of every satellite and
// makes states of them.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/gnss/orbits/corrected_state.h"
#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "drivers/ssr/orbit_correction.h"
#include "drivers/ssr/ssr_correction.h"

namespace leonav {

struct CorrectionOptions {
  // Which point of a satellite the corrected positions are, where a message does not say it. Of
  // RTCM and the IGS providers state it of a stream (of the IGS' combined ones SSRA is the antenna
  // phase centre, SSRC the centre of mass).
  bool at_antenna = true;
  // Galileo sends each issue in two messages, whose clocks differ.
  NavigationMessage galileo_message = NavigationMessage::kGalileoInav;
  // A correction farther from its reference time than this is not used. HAS and B2b say themselves
  // for how long one holds, which counts instead.
  double max_orbit_age_s = 180.0;
  double max_clock_age_s = 60.0;
  double max_high_rate_age_s = 10.0;
  // 1 sigma of orbit and clock along the line of sight where the stream gives none: 5 cm of orbit
  // and 0.2 ns of clock, as IGS' real-time products.
  double default_sigma_m = 0.08;
};

// What became of the satellites of the messages that states were asked for.
struct CorrectionCounters {
  std::uint64_t states = 0;
  std::uint64_t without_orbit = 0;  // a clock's correction alone
  std::uint64_t without_clock = 0;  // an orbit's correction alone
  std::uint64_t without_ephemeris =
      0;                             // the issue that is corrected has not come, or went long ago
  std::uint64_t without_bcnav1 = 0;  // the same, of B2b's corrections of BeiDou (B-CNAV1)
  std::uint64_t of_other_issue = 0;  // orbit and clock of different IOD SSR, solution, provider
  std::uint64_t too_old = 0;
  std::uint64_t not_reliable = 0;       // the service says that its error may be of any size
  std::uint64_t in_regional_frame = 0;  // satellites of messages in another frame than the ITRF
};

// Adds the counts of another store.
CorrectionCounters& operator+=(CorrectionCounters& sum, const CorrectionCounters& other);

class CorrectionStore {
 public:
  explicit CorrectionStore(const CorrectionOptions& options = {}) : options_(options) {}

  // Keeps the last kIssuesKept of each satellite by arrival. Elements that are not sane, or of a
  // Galileo message that the stream does not refer to, are left out.
  void add(const Ephemeris& ephemeris);
  // The newest correction of its kind replaces that of the same satellite, whatever its time. An
  // orbit that refers to another issue than the one before ends a clock that was sent earlier. Of
  // B2b, whose clocks name the orbits that they belong to, the last clock with another IOD Corr is
  // kept too, for an orbit that has not come yet.
  void add(const SsrMessage& message);

  // Makes the states at `time` of the satellites of a message that was added. A satellite without
  // clock, orbit or the corrected issue, or whose corrections are too old, has none and is counted.
  std::vector<CorrectedState> states(const SsrMessage& message, GpsTime time);
  const CorrectionCounters& counters() const { return counters_; }

  static constexpr std::size_t kIssuesKept = 8;

 private:
  struct Correction {
    GpsTime sent,
        reference;  // the message's time, and the instant its polynomials are counted from
    CorrectionSource source;
    SsrService service = SsrService::kRtcm;
    std::optional<double> validity_s;
    std::optional<bool> at_antenna;
  };
  struct Clock {
    SsrClock values;
    Correction is;
  };
  struct Satellite {
    std::vector<Ephemeris> ephemerides;  // in the order of arrival
    Correction orbit_is, high_rate_is;   // reference unset: none
    SsrOrbit orbit;
    Clock clock, earlier_clock;  // earlier: with another IOD Corr than `clock`
    double high_rate_m = 0.0;
    std::uint8_t accuracy_index = 0;  // 0: the stream says nothing
  };

  static bool go_together(const Satellite& satellite, const Clock& clock);
  std::optional<CorrectedState> state(SatelliteId id, const Satellite& satellite, GpsTime time);
  const Ephemeris* corrected_ephemeris(const Satellite& satellite, GpsTime time) const;

  CorrectionOptions options_;
  CorrectionCounters counters_;
  std::map<SatelliteId, Satellite> satellites_;
};

// Returns who made a message.
CorrectionSource source_of(const SsrMessage& message);
// Returns whether states are to be made after a message: it has clocks. Orbits come before the
// clocks of the same time, and only with them are they of one issue.
bool has_clocks(const SsrMessage& message);
// Returns the biases of a message as delays to be subtracted, received at `time`. That of L2 P of
// GPS in HAS, which has no number for P(Y), serves 2P and 2W: the P code is encrypted, and what
// stations measured is P(Y) tracked without the key, which RINEX names 2W. RTCM and IGS number
// both.
std::vector<SignalBias> biases_of(const SsrMessage& message, GpsTime time);

}  // namespace leonav
