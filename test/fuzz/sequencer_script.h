// A SequencerScript is a list of inputs for the Sequencer, most of them wrong, that is read from
// bytes and printed as text.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/navigator/sequencer/sequencer.h"
#include "test/fuzz/fuzz_target.h"

namespace leonav::test {

// On the wire of the corpus: append only.
enum class ScriptAction : std::uint8_t {
  kDrive,         // good samples, epochs and odometer; time goes on
  kSamples,       // a run of samples
  kEpochs,        // a run of epochs
  kOdometer,      // a run of odometer increments
  kWait,          // nothing comes, or the clock is set back
  kTwoStreams,    // good samples, and between them those of another time
  kExtremeStamp,  // one input at the end of what a stamp can be
  kWrongSamples,  // values that no sensor gives
  kWrongEpochs,   // observations that no receiver makes
  kEphemerides,
  kCommand,
  kCheckpoint,
  kRefused,   // messages that were refused before
  kProducts,  // precise and corrected states, biases, ionosphere, antenna
  kRepeat,    // the last sample or epoch again
  kJitter,    // good samples with stamps that jitter; time goes on
};
inline constexpr std::size_t kScriptActions = 16;

// What the numbers mean depends on the action; see text_of().
struct ScriptStep {
  ScriptAction action = ScriptAction::kDrive;
  std::int64_t count = 0;
  std::int64_t offset_ns = 0;  // from the true time to the first stamp
  std::int64_t step_ns = 0;    // from stamp to stamp
  std::int64_t interval_ns = 0;
  std::uint8_t choice = 0;
};

struct SequencerScript {
  NavigatorConfig config;
  std::int64_t sample_interval_ns = 0;  // of good input
  std::vector<ScriptStep> steps;
};

// The first two bytes choose the configuration; all bytes make a script. `is_whole`: good samples
// come at 200 Hz, and it has up to some 2,500 inputs; otherwise they come at 50 Hz, and it has 800.
SequencerScript script_from(FuzzBytes bytes, bool is_whole = true);
std::string text_of(const SequencerScript& script);

// Feeds the script and returns the true time at its end.
GpsTime play(const SequencerScript& script, Sequencer* sequencer);

}  // namespace leonav::test
