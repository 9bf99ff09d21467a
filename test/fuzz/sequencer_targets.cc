// After any inputs good ones bring epochs with IMU samples to the stages: there is no dead end.
#include "test/fuzz/byte_script.h"
#include "test/fuzz/good_input.h"
#include "test/fuzz/sequencer_script.h"
#include "test/fuzz/target_groups.h"

namespace leonav::test {
namespace {

void require_answer(FuzzBytes bytes, bool is_whole) {
  const SequencerScript script = script_from(bytes, is_whole);
  CheckedStages stages;
  Sequencer sequencer(script.config, &stages);
  try {
    const GpsTime end = play(script, &sequencer);
    require_recovery(script.config, &sequencer, &stages,
                     hidden_good_input(end, hash_of(bytes), is_whole));
  } catch (const Finding& finding) {
    throw Finding(std::string(finding.what()) + "\n" + text_of(script));
  }
}

// Most scripts are played in the form that takes a quarter of the time. Blocks that are full and
// sensors known to be frozen need more samples than that form has.
void run_script(FuzzBytes bytes) {
  require_answer(bytes, false);
  if (is_chosen(bytes, 16)) require_answer(bytes, true);
}

}  // namespace

std::vector<FuzzTarget> sequencer_targets() { return {{"sequencer", run_script}}; }

}  // namespace leonav::test
