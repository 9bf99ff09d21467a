// A run whose IMU is silent for fifteen seconds: the threads, Navigator and the journal agree on
// the answers from GNSS alone.
#include <cmath>
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

// Times of the solutions while the IMU is silent, seconds after the start.
std::vector<double> answers_in_silence(const test::Collector& outputs) {
  std::vector<double> times;
  for (const test::Bytes& bytes : outputs.groups[0]) {
    solution_t solution;
    REQUIRE(solution.decode(bytes.data(), 0, static_cast<int>(bytes.size())) > 0);
    const double t = seconds_between(GpsTime::from_nanoseconds(solution.time_ns), test::kSkyEpoch);
    if (t <= 30.0 || t > 45.0) continue;
    CHECK(solution.source == solution_t::SOURCE_ALIGNING);
    times.push_back(t);
  }
  return times;
}

}  // namespace

TEST_CASE("answers while the IMU is silent are the same live, in one thread and replayed") {
  const std::vector<test::Input> list = drive_with_silence();
  const test::Collector reference = test::run_navigator(list, {});
  // The silence is noticed after some seconds; then each epoch is an answer.
  const std::vector<double> times = answers_in_silence(reference);
  REQUIRE(times.size() >= 8);
  CHECK(times.size() <= 15);
  CHECK(times.back() > 44.0);
  for (std::size_t i = 1; i < times.size(); ++i)
    CHECK(std::abs(times[i] - times[i - 1] - 1.0) < 1e-3);
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
