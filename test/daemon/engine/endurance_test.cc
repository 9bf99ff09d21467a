// What the daemon promises of memory: its inertial and GNSS threads allocate nothing, and its
// resident size does not grow.
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "daemon/engine/engine.h"
#include "support/catch.h"
#include "support/drive_inputs.h"
#include "support/temporary_file.h"
#include "tools/common/allocations/allocation_counter.h"

namespace {

using namespace leonav;

struct CountingTarget final : MessageTarget {
  std::uint64_t solutions = 0, epochs = 0;
  void take(Channel channel, ByteSpan) override {
    if (channel == Channel::kSolution) ++solutions;
    if (channel == Channel::kEpoch) ++epochs;
  }
};

// kB.
long resident_size() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    long size = 0;
    if (word == "VmRSS:" && status >> size) return size;
  }
  return 0;
}

}  // namespace

TEST_CASE("the counter of allocations sees those of a thread by its role") {
  const auto before = thread_allocations();
  RealtimeThread thread;
  std::unique_ptr<int> number;
  thread.start("ins", {}, [&] { number = std::make_unique<int>(7); });
  thread.join();
  CHECK(*number == 7);
  CHECK(thread_allocations().inertial == before.inertial + 1);
  CHECK(thread_allocations().gnss == before.gnss);
}

TEST_CASE("over a whole drive the threads of the stages and of the journal allocate nothing") {
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = test::drive_config();
  config.journal.path = folder.beside("journal.lcmlog");
  const test::SyntheticDrive drive = test::synthetic_drive(test::noisy_drive(120.0));
  CountingTarget target;
  const auto before = thread_allocations();
  Engine engine(config, &target);
  engine.start();
  std::uint64_t messages = 0;
  test::feed_messages(drive, [&](Channel channel, ByteSpan bytes) {
    engine.receive(channel, bytes, 1);
    if (++messages % 1000 == 0) engine.receive(channel, bytes.first(bytes.size() / 2), 1);
    // A busy machine must not turn every epoch into a miss: there would be no answer to count.
    while (channel == Channel::kGnssEpoch && !engine.idle()) usleep(100);
  });
  REQUIRE(engine.finish());
  const auto after = thread_allocations();
  std::cout << "allocations over " << target.solutions << " solutions and " << target.epochs
            << " epochs: ins " << after.inertial - before.inertial << ", gnss "
            << after.gnss - before.gnss << "\n";
  CHECK(target.solutions > 20'000);
  CHECK(target.epochs > 115);
  CHECK(after.inertial == before.inertial);
  CHECK(after.gnss == before.gnss);
  CHECK(after.journal == before.journal);
}

TEST_CASE("the resident size stays flat over twenty drives' length") {
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = test::drive_config();
  config.journal.path = folder.beside("journal.lcmlog");
  const test::SyntheticDrive drive = test::synthetic_drive(test::noisy_drive(2400.0));
  CountingTarget target;
  Engine engine(config, &target);
  engine.start();
  const auto tenth = drive.imu.size() / 10;
  std::size_t samples = 0;
  long early = 0;
  test::feed_messages(drive, [&](Channel channel, ByteSpan bytes) {
    engine.receive(channel, bytes, 1);
    if (channel == Channel::kImu && ++samples == tenth) early = resident_size();
  });
  while (!engine.idle()) usleep(1000);
  const long late = resident_size();
  REQUIRE(engine.finish());
  std::cout << "resident size after 10 % of " << drive.options.duration_s << " s: " << early
            << " kB, at the end " << late << " kB; " << target.epochs << " epochs\n";
  CHECK(target.epochs > 2390);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their own tables grow
  CHECK(std::abs(late - early) < 1024);
#endif
}
