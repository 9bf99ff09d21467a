// This unit reads the GNSS messages of an LCM log, for both passes of a quality analysis.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>

#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/signals/observation.h"
#include "drivers/lcm/channels.h"

namespace leonav {

// Counts over one reading of the whole log.
struct InputCounts {
  std::array<std::uint64_t, kChannelCount> messages{};  // by channel
  std::uint64_t epochs = 0;                             // GNSS epochs handed on
  std::uint64_t disordered_epochs = 0;                  // out of order in time: left out
  std::uint64_t refused_epochs = 0;                     // malformed: counted and left out
  std::uint64_t incomplete_epochs = 0;  // single observations in them were malformed
  std::uint64_t refused_products = 0;   // ephemerides, orbits and clocks, ionosphere
  std::string other_prefix;  // of a channel GNSS_EPOCH under another prefix; empty: none seen
  bool truncated = false;    // the last event is cut short
  std::string damage;        // where the log became unreadable, in words; empty: nowhere
};

// Receivers of what is read.
struct InputHandlers {
  std::function<void(const RawEpoch&)> epoch;
  // nullptr: products are not decoded.
  EphemerisStore* ephemeris_store = nullptr;
};

// Reads the log to the end, or to where it is damaged; everything before the damage counts.
//
// Epochs are handed on in order of time, one epoch late. If two contradict each other, the first is
// wrong if it lay more than 10 s ahead (one damaged time must not remove the rest of the log),
// otherwise the second. Progress goes to `progress` (nullptr: none) in steps of a tenth of a log
// above 5 MB, with `what` as the name of the pass. Throws EventLogError if the file cannot be
// opened, is empty, or is no log from its first byte on.
InputCounts read_inputs(const std::string& path, const std::string& prefix,
                        const InputHandlers& handlers, std::ostream* progress,
                        const std::string& what = "");

}  // namespace leonav
