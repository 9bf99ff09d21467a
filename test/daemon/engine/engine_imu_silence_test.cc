// A run whose IMU is silent for fifteen seconds: the threads, Navigator and the journal agree on
// the answers from GNSS alone.
#include <algorithm>
#include <leonav/solution_t.hpp>
#include <vector>

#include "daemon/engine/engine.h"
#include "engine_runs.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;

std::vector<test::Input> drive_with_silence() {
  int samples = 0;
  return test::drive_messages([&](Channel channel) {
    if (channel != Channel::kImu) return true;
    ++samples;  // 200 a second
    return samples <= 6000 || samples > 9000;
  });
}

test::Collector run(const std::vector<test::Input>& list, bool in_step,
                    const std::string& journal) {
  DaemonConfig config = test::drive_config();
  config.journal.path = journal;
  test::Collector outputs;
  Engine engine(config, &outputs);
  engine.start();
  std::int64_t stamp = 0;
  for (const test::Input& input : list) {
    engine.receive(input.channel, input.bytes, ++stamp);
    while (in_step && !engine.idle()) test::wait_a_moment();
  }
  REQUIRE(engine.finish());
  return outputs;
}

std::size_t answers_from_gnss(const test::Collector& outputs) {
  const std::vector<test::Bytes>& solutions = outputs.groups[0];
  return static_cast<std::size_t>(
      std::count_if(solutions.begin(), solutions.end(), [](const test::Bytes& bytes) {
        solution_t solution;
        REQUIRE(solution.decode(bytes.data(), 0, static_cast<int>(bytes.size())) > 0);
        return solution.source == solution_t::SOURCE_ALIGNING;
      }));
}

}  // namespace

TEST_CASE("answers while the IMU is silent are the same live, in one thread and replayed") {
  const std::vector<test::Input> list = drive_with_silence();
  const test::Collector reference = test::run_navigator(list, {});
  // The silence is noticed after some seconds, and there is an epoch each second.
  CHECK(answers_from_gnss(reference) >= 8);
  const test::TemporaryFile folder("unused", "");
  const std::string journal = folder.beside("journal.lcmlog");
  SECTION("in step") {
    const test::Collector live = run(list, true, journal);
    CHECK(test::missed_epochs(live).empty());
    check_same(reference, live);
    check_same(test::run_navigator(test::read_journal_inputs(journal), {}), live);
  }
  SECTION("flat out") {
    const test::Collector live = run(list, false, journal);
    const auto missed = test::missed_epochs(live);
    check_same(test::run_navigator(test::read_journal_inputs(journal), missed), live);
  }
}
