// What the daemon promises of memory: its threads allocate nothing once they have begun, and its
// resident size does not grow.
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "daemon/engine/engine.h"
#include "daemon/health/health_monitor.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
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

TEST_CASE("over a whole drive no thread allocates anything once it has begun") {
  const test::TemporaryFile folder("unused", "");
  const bool smooths = GENERATE(false, true);
  INFO("smoother: " << smooths);
  DaemonConfig config = test::drive_config();
  config.journal.path = folder.beside("journal.lcmlog");
  config.checkpoint.path = folder.beside("checkpoint.yaml");
  config.checkpoint.interval_s = 0.2;  // of the clock, which a drive is far ahead of
  if (smooths) config.navigator.estimator = Estimator::kSmoother;
  // As they came, so that nothing is made in the thread that stands for `io`.
  std::vector<std::pair<Channel, std::vector<std::uint8_t>>> messages;
  test::feed_messages(test::synthetic_drive(test::noisy_drive(120.0)),
                      [&](Channel channel, ByteSpan bytes) {
                        messages.emplace_back(channel, std::vector(bytes.begin(), bytes.end()));
                      });
  CountingTarget target;
  const auto before = thread_allocations();
  Engine engine(config, &target);
  HealthMonitor health(&engine, config.navigator);
  engine.start();
  // Once a second of the drive, as `main` does.
  std::atomic<int> seconds{0}, looks{0};
  std::atomic<bool> ends{false};
  RealtimeThread main;
  main.start("main", {}, [&] {
    while (!ends) {
      if (looks == seconds) {
        usleep(100);
        continue;
      }
      engine.publish(Channel::kHealth, health.next(looks + 1.0));
      ++looks;
    }
  });
  RealtimeThread io;
  io.start("io", {}, [&] {
    std::uint64_t number = 0;
    for (const auto& [channel, bytes] : messages) {
      engine.receive(channel, bytes, 1);
      if (++number % 1000 == 0) engine.receive(channel, ByteSpan(bytes).first(bytes.size() / 2), 1);
      if (channel != Channel::kGnssEpoch) continue;
      // A busy machine must not turn every epoch into a miss: there would be no answer to count.
      while (!engine.idle()) usleep(100);
      ++seconds;
      while (looks < seconds) usleep(100);
    }
  });
  io.join();
  ends = true;
  main.join();
  while (!std::filesystem::exists(config.checkpoint.path)) usleep(1000);
  const auto after = thread_allocations();
  REQUIRE(engine.finish());
  std::cout << "allocations over " << target.solutions << " solutions and " << target.epochs
            << " epochs: ins " << after.inertial - before.inertial << ", gnss "
            << after.gnss - before.gnss << ", smoother " << after.smoother - before.smoother
            << ", out " << after.out - before.out << ", journal " << after.journal - before.journal
            << ", file " << after.file - before.file << ", io " << after.io - before.io << ", main "
            << after.main - before.main << "\n";
  CHECK(target.solutions > 20'000);
  CHECK(target.epochs > 115);
  CHECK(after.inertial == before.inertial);
  CHECK(after.gnss == before.gnss);
  CHECK(after.smoother == before.smoother);
  CHECK(after.out == before.out);
  CHECK(after.journal == before.journal);
  CHECK(after.file == before.file);
  CHECK(after.io == before.io);
  CHECK(after.main == before.main);
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
