// leonav-fuzz: one target under libFuzzer, which brings main() and its own options.
//
//   LEONAV_FUZZ_TARGET=ubx leonav-fuzz [OPTION...] [CORPUS...]
//
// A symbolic link whose name is a target's chooses it too. Without either it lists the targets.
// With LEONAV_FUZZ_EVERY=1 every input is chosen for the checks that cost most (is_chosen()), as it
// must be while a finding of theirs is minimized.
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "test/fuzz/fuzz_target.h"

namespace {

const leonav::test::FuzzTarget* target = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char*** arguments) {
  const char* chosen = std::getenv("LEONAV_FUZZ_TARGET");
  std::string_view name = chosen != nullptr ? chosen : **arguments;
  name.remove_prefix(name.rfind('/') + 1);
  target = leonav::test::find_fuzz_target(name);
  if (std::getenv("LEONAV_FUZZ_EVERY") != nullptr) leonav::test::choose_every_input(true);
  if (target != nullptr) return 0;
  for (const auto& one : leonav::test::fuzz_targets()) {
    std::printf("%.*s\n", static_cast<int>(one.name.size()), one.name.data());
  }
  std::exit(chosen != nullptr ? 2 : 0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target->run({data, size});
  return 0;
}
