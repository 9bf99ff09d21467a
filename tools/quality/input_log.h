// The GNSS side of an LCM log, message by message: what both passes of a quality analysis read.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>

#include "core/gnss/observation.h"
#include "core/gnss/satellite_catalog.h"
#include "drivers/lcm/channels.h"

namespace leonav {

// What a reading of the whole log met.
struct InputCounts {
  std::array<std::uint64_t, kChannelCount> messages{};  // by channel
  std::uint64_t epochs = 0;                             // GNSS epochs handed on
  std::uint64_t disordered_epochs = 0;                  // out of order in time: left out
  std::uint64_t refused_epochs = 0;                     // malformed: counted and left out
  std::uint64_t incomplete_epochs = 0;                  // single observations of it were malformed
  std::uint64_t refused_products = 0;  // ephemerides, orbits and clocks, ionosphere
  std::string other_prefix;  // of a channel GNSS_EPOCH under another prefix; empty: none seen
  bool truncated = false;    // the last event is cut short
  std::string damage;        // where the log became unreadable, in words; empty: nowhere
};

struct InputHandlers {
  std::function<void(const RawEpoch&)> epoch;
  // nullptr: products are not decoded.
  SatelliteCatalog* catalog = nullptr;
};

// Epochs are handed on in order of time, one epoch late: of two that contradict each other the
// first is the wrong one if it lay more than 10 s ahead (one damaged time must not take the rest of
// the log with it), otherwise the second.
//
// Reads to the end, or to where the log is damaged: what stands before is good. Progress goes to
// `progress` (nullptr: none) in steps of a tenth of a log above 5 MB, with `what` is being done.
// Throws EventLogError if the file cannot be opened, is empty, or is no log from its first byte on.
InputCounts read_inputs(const std::string& path, const std::string& prefix,
                        const InputHandlers& handlers, std::ostream* progress,
                        const std::string& what = "");

}  // namespace leonav
