// What a reload puts into effect, and that a wrong configuration changes nothing.
#include "daemon/supervision/config_reload.h"

#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <atomic>
#include <fstream>
#include <memory>
#include <string>

#include "daemon/config/load_config.h"
#include "daemon/supervision/log_level.h"
#include "journal/journal_rig.h"
#include "support/catch.h"
#include "support/held_disk.h"
#include "support/temporary_file.h"

namespace {

using namespace leonav;

// A daemon that runs, as far as a reload is concerned.
struct RunningDaemon {
  std::string file = "preset: car\nlog: {level: error}\n";
  DaemonConfig running = load_config_text(file, "mine.yaml");
  Journal journal{running};  // none is written
  ConfigReload reload{[this] { return load_config_text(file, "mine.yaml"); }, &running, &journal};
};

// Looks as `main` does, until what was asked for is done.
void finish(ConfigReload* reload) {
  CHECK(test::await([reload] {
    reload->look();
    return !reload->is_under_way();
  }));
}

void reload_now(ConfigReload* reload) {
  reload->ask();
  finish(reload);
}

// The level is one for the whole process.
class KeptLevel {
 public:
  ~KeptLevel() { spdlog::set_level(level_); }

 private:
  spdlog::level::level_enum level_ = spdlog::get_level();
};

}  // namespace

TEST_CASE("a reload puts the reloadable keys into effect and leaves the others") {
  const KeptLevel kept;
  RunningDaemon rig;
  set_log_level(rig.running.log.level);
  CHECK(spdlog::get_level() == spdlog::level::err);
  const double mask = rig.running.navigator.gnss.elevation_mask;
  rig.file =
      "preset: car\nlog: {level: warning}\ngnss: {elevation_mask_deg: 7}\njournal: {kept_mb: "
      "2077}\n";
  reload_now(&rig.reload);
  CHECK(spdlog::get_level() == spdlog::level::warn);
  CHECK(rig.running.log.level == LogLevel::kWarning);
  CHECK(rig.running.journal.kept_mb == 2077.0);
  CHECK(rig.running.navigator.gnss.elevation_mask == mask);
}

TEST_CASE("a reload of a configuration with errors changes nothing") {
  const KeptLevel kept;
  RunningDaemon rig;
  set_log_level(rig.running.log.level);
  const double kept_mb = rig.running.journal.kept_mb;
  rig.file = "preset: car\nlog: {level: info}\njournal: {kept_mb: 2077, piece_mb: no number}\n";
  reload_now(&rig.reload);
  CHECK(spdlog::get_level() == spdlog::level::err);
  CHECK(rig.running.log.level == LogLevel::kError);
  CHECK(rig.running.journal.kept_mb == kept_mb);
}

TEST_CASE("a reload reads the key for commands again, and keeps the one before where it is wrong") {
  const KeptLevel kept;
  const std::string first(32, 'a'), second(32, 'b');
  const test::TemporaryFile file("command.key", first + "\n");
  chmod(file.path().c_str(), 0600);
  RunningDaemon rig;
  rig.file += "commands: {key_file: " + file.path() + "}\n";
  rig.running = load_config_text(rig.file, "mine.yaml");
  CommandGate gate{CommandKey(first)};
  ConfigReload reload([&] { return load_config_text(rig.file, "mine.yaml"); }, &rig.running,
                      &rig.journal, &gate);
  std::int64_t now_ns = 0;
  const auto takes = [&](const std::string& key) {
    const auto message = gate.due_nonce(now_ns += kNanosecondsPerSecond);
    REQUIRE(message.has_value());
    SignedCommand command;
    command.nonce = *decode_command_nonce(*message);
    command.mac = CommandKey(key).mac_of(command.nonce, command.command);
    return gate.judge(encode_signed_command(command), now_ns) == InputFault::kNone;
  };
  CHECK(takes(first));
  std::ofstream(file.path()) << second << "\n";
  reload_now(&reload);
  CHECK(takes(second));
  CHECK_FALSE(takes(first));
  std::ofstream(file.path()) << "short\n";
  reload_now(&reload);
  CHECK(takes(second));
  // With a configuration that is wrong the key stays, too.
  std::ofstream(file.path()) << first << "\n";
  rig.file += "journal: {piece_mb: no number}\n";
  reload_now(&reload);
  CHECK(takes(second));
}

TEST_CASE("a reload's limits reach the journal that is being written") {
  const KeptLevel kept;
  test::JournalRig rig([](JournalConfig* config) { config->piece_mb = 100.0; });
  rig.journal.open();
  DaemonConfig running = rig.config, read = rig.config;
  read.journal.piece_mb = 0.1;
  ConfigReload reload([&] { return read; }, &running, &rig.journal);
  rig.sender.push_slowly(500);
  CHECK(rig.journal.counters().pieces.get() == 1);
  reload_now(&reload);
  rig.sender.push_slowly(500);
  CHECK(test::await([&] { return rig.journal.counters().pieces.get() > 3; }));
  CHECK(rig.journal.finish());
}

TEST_CASE("a disk that does not answer holds up no look, and what was asked meanwhile is done") {
  const KeptLevel kept;
  const auto disk = std::make_shared<test::HeldDisk>();
  const auto readings = std::make_shared<std::atomic<int>>(0);
  RunningDaemon rig;
  const auto load = [disk, readings, file = rig.file] {
    disk->wait();
    const std::string kept_mb = std::to_string(2000 + ++*readings);
    return load_config_text(file + "journal: {kept_mb: " + kept_mb + "}\n", "mine.yaml");
  };
  ConfigReload reload(load, &rig.running, &rig.journal);
  const double before = rig.running.journal.kept_mb;
  const Stopwatch watch;
  reload.ask();
  for (int i = 0; i < 3; ++i) reload.look();
  reload.ask();
  reload.ask();
  CHECK(watch.nanoseconds() < 10 * kNanosecondsPerSecond);  // and not until the disk answers
  CHECK(reload.is_under_way());
  CHECK(rig.running.journal.kept_mb == before);
  disk->answer();
  finish(&reload);
  CHECK(readings->load() == 2);  // the second is for all that were asked behind the first
  CHECK(rig.running.journal.kept_mb == 2002.0);
}

TEST_CASE("a reload that is not over is left to itself at the end") {
  const auto disk = std::make_shared<test::HeldDisk>();
  RunningDaemon rig;
  const Stopwatch watch;
  {
    const auto load = [disk, running = rig.running] {
      disk->wait();
      return running;
    };
    ConfigReload reload(load, &rig.running, &rig.journal);
    reload.ask();
  }
  CHECK(watch.nanoseconds() < 10 * kNanosecondsPerSecond);  // and not until the disk answers
  disk->answer();
}
