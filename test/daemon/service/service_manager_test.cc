// The daemon beside a service manager, whose socket the test itself holds.
#include "daemon/link/service_manager.h"

#include <poll.h>

#include <atomic>
#include <cstddef>
#include <cstring>
#include <optional>
#include <thread>

#include "daemon/health/thread_monitor.h"
#include "daemon/threads/wall_clock.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/programs/daemon_program.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;

class ManagerSocket {
 public:
  // As NOTIFY_SOCKET has it: a path, or "@name".
  explicit ManagerSocket(const std::string& name)
      : descriptor_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    REQUIRE(name.size() < sizeof address.sun_path);
    std::memcpy(address.sun_path, name.data(), name.size());
    socklen_t size = sizeof address;
    if (name[0] == '@') {
      address.sun_path[0] = '\0';
      size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    }
    REQUIRE(bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), size) == 0);
  }
  ~ManagerSocket() { close(descriptor_); }
  ManagerSocket(const ManagerSocket&) = delete;
  ManagerSocket& operator=(const ManagerSocket&) = delete;

  // The next message; "" if none comes in time.
  std::string next(int timeout_ms) const {
    pollfd one{descriptor_, POLLIN, 0};
    if (poll(&one, 1, timeout_ms) != 1) return "";
    std::array<char, 256> text;
    const ssize_t size = recv(descriptor_, text.data(), text.size(), 0);
    return {text.data(), static_cast<std::size_t>(size > 0 ? size : 0)};
  }

 private:
  int descriptor_;
};

// Sets a variable of the environment for its lifetime.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

std::string abstract_name() { return "@leonav-test-" + std::to_string(getpid()); }

struct HeldTarget final : MessageTarget {
  std::atomic<bool> hold{false};
  void take(Channel, ByteSpan) override {
    while (hold) test::wait_a_moment();
  }
};

void wait_until_idle(const Engine& engine) {
  while (!engine.idle()) test::wait_a_moment();
}

}  // namespace

TEST_CASE("leonavd notifies a service manager of its start, its life and its end") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile folder("unused", "");
  for (const std::string& name : {folder.beside("notify"), abstract_name()}) {
    INFO(name);
    const ManagerSocket manager(name);
    test::DaemonProgram daemon({}, {"NOTIFY_SOCKET=" + name, "WATCHDOG_USEC=10000000"});
    CHECK(manager.next(60'000) == "READY=1");
    CHECK(daemon.says("running; LCM"));
    for (int i = 0; i < 3; ++i) CHECK(manager.next(60'000) == "WATCHDOG=1");
    CHECK(daemon.stop() == 0);
    std::string last;
    for (std::string one = manager.next(0); !one.empty(); one = manager.next(0)) last = one;
    CHECK(last == "STOPPING=1");
  }
}

TEST_CASE("a reload is announced to the service manager (RELOADING, READY)") {
  if (!test::have_programs("leonavd")) return;
  const ManagerSocket manager(abstract_name());
  test::DaemonProgram daemon({}, {"NOTIFY_SOCKET=" + abstract_name()});
  CHECK(manager.next(60'000) == "READY=1");
  REQUIRE(daemon.says("running; LCM"));
  const std::int64_t before_us = monotonic_ns() / 1000;
  daemon.signal(SIGHUP);
  const std::string reloading = manager.next(60'000);
  const std::string head = "RELOADING=1\nMONOTONIC_USEC=";
  REQUIRE(reloading.find(head) == 0);
  CHECK(std::stoll(reloading.substr(head.size())) >= before_us);
  CHECK(manager.next(60'000) == "READY=1");
  CHECK(daemon.stop() == 0);
}

TEST_CASE("the watchdog is fed only where it is asked for, and what cannot be obeyed is reported") {
  const ManagerSocket manager(abstract_name());
  const Variable socket_name("NOTIFY_SOCKET", abstract_name());
  const auto fed = [&] {
    const ServiceManager service;
    service.feed_watchdog();
    return manager.next(0) == "WATCHDOG=1";
  };
  const auto problem = [] { return ServiceManager().problem(); };
  CHECK_FALSE(fed());
  {
    const Variable interval("WATCHDOG_USEC", "10000000");
    CHECK(fed());
    CHECK(problem().empty());
    const Variable mine("WATCHDOG_PID", std::to_string(getpid()));
    CHECK(fed());
    const Variable other("WATCHDOG_PID", std::to_string(getppid()));
    CHECK_FALSE(fed());
  }
  {
    const Variable interval("WATCHDOG_USEC", "1500000");
    CHECK(problem().find("use WatchdogSec=2 or more") != std::string::npos);
  }
  {
    const Variable interval("WATCHDOG_USEC", "ten");
    CHECK_FALSE(fed());
    CHECK(problem() == "WATCHDOG_USEC 'ten': not a number of microseconds");
  }
  const Variable bad("NOTIFY_SOCKET", "vsock:2:1");
  CHECK(problem().find("neither a path nor @name") != std::string::npos);
  const Variable too_long("NOTIFY_SOCKET", "/" + std::string(200, 'x'));
  CHECK(problem().find("too long") != std::string::npos);
  const Variable nobody("NOTIFY_SOCKET", "/nowhere/at/all");
  ServiceManager().ready();  // a manager that is gone is no reason to fail
  CHECK(problem().empty());
}

TEST_CASE("a thread that hangs is named; one without work is not") {
  std::atomic<bool> hold_gnss{false};
  EngineHooks hooks;
  hooks.before_epoch = [&](std::uint64_t) {
    while (hold_gnss) test::wait_a_moment();
  };
  HeldTarget target;
  const DaemonConfig config = test::drive_config();
  Engine engine(config, &target, hooks);
  engine.start();
  ThreadMonitor watch(&engine, config.navigator);
  NavigatorConfig without_imu = config.navigator;
  without_imu.motion = MotionModel::kConstantVelocity;
  without_imu.estimator = Estimator::kSmoother;
  without_imu.realtime.epoch_interval_s = 3.0;  // so long a solve may take
  ThreadMonitor patient(&engine, without_imu);
  const auto look = [&] {
    engine.counters().io_rounds.add(1);
    return watch.stalled_threads();
  };
  for (int i = 0; i < 3; ++i) CHECK(look().empty());  // nothing to do, ever
  CHECK(watch.stalled_threads() == "io");             // did not come round

  int epochs = 0;
  std::vector<std::string> said, said_patiently;
  test::feed_messages(test::synthetic_drive(test::noisy_drive(10.0)),
                      [&](Channel channel, ByteSpan bytes) {
                        const bool epoch = channel == Channel::kGnssEpoch && ++epochs == 3;
                        if (epoch) {
                          wait_until_idle(engine);
                          CHECK(look().empty());
                          hold_gnss = true;
                        }
                        engine.receive(channel, bytes, 1);
                        if (!epoch) return;
                        while (!engine.idle_but_gnss()) test::wait_a_moment();
                        said.push_back(look());  // the work is new
                        said.push_back(look());
                        said.push_back(watch.stalled_threads());  // `io` may well wait behind it
                        for (int k = 0; k < 5; ++k)
                          said_patiently.push_back(patient.stalled_threads());
                        hold_gnss = false;
                        wait_until_idle(engine);
                        said.push_back(look());
                        said.push_back(look());
                      });
  CHECK(said == std::vector<std::string>{"", "gnss", "gnss", "", ""});
  CHECK(said_patiently == std::vector<std::string>{"", "", "", "gnss", "gnss"});

  wait_until_idle(engine);
  target.hold = true;
  engine.publish(Channel::kHealth, std::vector<std::uint8_t>(10));
  CHECK(look().empty());
  CHECK(look() == "out");
  target.hold = false;
  wait_until_idle(engine);
  CHECK(look().empty());
  REQUIRE(engine.finish());
}
