#include <algorithm>

#include "test/fuzz/byte_script.h"
#include "test/fuzz/fuzz_target.h"
#include "test/fuzz/target_groups.h"

namespace leonav::test {
namespace {

std::vector<FuzzTarget> all_targets() {
  std::vector<FuzzTarget> all;
  for (const auto& group : {wire_targets(), file_targets(), message_targets(), log_targets(),
                            config_targets(), caster_targets(), sequencer_targets()}) {
    all.insert(all.end(), group.begin(), group.end());
  }
  return all;
}

bool every_input_is_chosen = false;

}  // namespace

const std::vector<FuzzTarget>& fuzz_targets() {
  static const std::vector<FuzzTarget> targets = all_targets();
  return targets;
}

const FuzzTarget* find_fuzz_target(std::string_view name) {
  const auto& targets = fuzz_targets();
  const auto found = std::find_if(targets.begin(), targets.end(),
                                  [&](const FuzzTarget& one) { return one.name == name; });
  return found == targets.end() ? nullptr : &*found;
}

bool is_chosen(FuzzBytes bytes, std::uint64_t one_in) {
  return every_input_is_chosen || (hash_of(bytes) >> 20) % one_in == 0;
}

void choose_every_input(bool is_on) { every_input_is_chosen = is_on; }

}  // namespace leonav::test
