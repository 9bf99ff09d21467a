// The NTRIP source against a caster of the test's own, caster.py, over real sockets and TLS.
#include <sys/stat.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "collector.h"
#include "drivers/transport/ntrip_source.h"
#include "drivers/transport/retry_wait.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using test::Collector;

// The caster, which ends with the object; what it says goes to a file.
class Caster {
 public:
  Caster()
      : folder_("credentials", "me\nopen:sesame\n"), wrong_("credentials", "me\nwrong-password\n") {
    chmod(folder_.path().c_str(), 0600);
    chmod(wrong_.path().c_str(), 0600);
    const std::string command = "exec python3 '" LEONAV_SOURCE_DIR
                                "/test/drivers/transport/caster.py' '" +
                                folder_.beside("work") + "' >'" + folder_.beside("said") + "'";
    process_.reset(popen(command.c_str(), "w"));
    for (int i = 0; i < 600 && said().find("tls ") == std::string::npos; ++i) {
      timespec pause = {0, 50'000'000};
      nanosleep(&pause, nullptr);
    }
  }

  std::string said() const {
    std::ostringstream text;
    text << std::ifstream(folder_.beside("said")).rdbuf();
    return text.str();
  }
  // The options for a mountpoint that work.
  NtripOptions options(const std::string& mountpoint, bool tls = false) const {
    NtripOptions found;
    found.host = tls ? "localhost" : "127.0.0.1";
    found.port = port(tls ? "tls" : "plain");
    found.mountpoint = mountpoint;
    found.tls = tls;
    if (tls) found.ca_file = folder_.beside("work/ca.pem");
    found.credentials_file = folder_.path();
    return found;
  }
  std::string other_ca() const { return folder_.beside("work/other.pem"); }
  const std::string& wrong_credentials() const { return wrong_.path(); }

 private:
  struct Close {
    void operator()(std::FILE* file) const { pclose(file); }
  };
  std::uint16_t port(const std::string& name) const {
    std::istringstream words(said());
    std::string word;
    int number = 0;
    while (words >> word) {
      if (word == name && words >> number) return static_cast<std::uint16_t>(number);
    }
    FAIL("the caster has not started");
    return 0;
  }

  test::TemporaryFile folder_, wrong_;
  std::unique_ptr<std::FILE, Close> process_;
};

bool can_run() {
  if (std::system("command -v openssl >/dev/null && command -v python3 >/dev/null") == 0) {
    return true;
  }
  std::cout << "SKIPPED: no openssl or no python3\n";
  return false;
}

// Runs the source until `done(sink)`, or for so many seconds.
template <typename Done>
Collector run(const NtripOptions& options, int seconds, Done done) {
  boost::asio::io_context io;
  const ArrivalClock clock;
  Collector sink;
  const auto source = make_ntrip_source(&io, &clock, options);
  source->start(&sink);
  for (int i = 0; i < 100 * seconds && !done(sink); ++i) {
    io.restart();
    io.run_for(std::chrono::milliseconds(10));
  }
  for (const std::string& why : sink.failures) {
    CHECK_THAT(why, !Catch::Contains("sesame") && !Catch::Contains("wrong-password"));
    CHECK_THAT(why, !Catch::Contains("bWU6"));  // the same in base64
  }
  return sink;
}

Collector until_failed(const NtripOptions& options) {
  Collector sink = run(options, 20, [](const Collector& now) { return !now.failures.empty(); });
  REQUIRE(!sink.failures.empty());
  CHECK(sink.text.empty());
  return sink;
}

// Every message of the caster has 18 bytes, of which the seventh to ninth count.
void check_messages(const std::string& stream) {
  REQUIRE(stream.size() >= 18);
  for (std::size_t i = 0; i + 18 <= stream.size(); i += 18) {
    CHECK(stream.substr(i, 3) == std::string("\xD3\x00\x0C", 3));
    CHECK(static_cast<unsigned char>(stream[i + 8]) == (i / 18) % 256);
  }
}

constexpr std::size_t kTenMessages = 180;

}  // namespace

TEST_CASE("A caster's stream comes whole, in both versions and through TLS", "[ntrip]") {
  if (!can_run()) return;
  const Caster caster;
  const auto ten = [](const Collector& now) { return now.text.size() >= kTenMessages; };
  for (const bool tls : {false, true}) {
    for (const char* mountpoint : {"CHUNKS", "ICY"}) {
      for (const NtripVersion version : {NtripVersion::kAuto, NtripVersion::k1, NtripVersion::k2}) {
        NtripOptions options = caster.options(mountpoint, tls);
        options.version = version;
        const Collector sink = run(options, 20, ten);
        CAPTURE(mountpoint, tls, sink.failures);
        CHECK(sink.failures.empty());
        check_messages(sink.text);
      }
    }
  }
  for (const bool tls : {false, true}) {
    CAPTURE(tls);
    const Collector old = run(caster.options("V1ONLY", tls), 20, ten);
    REQUIRE(old.failures.size() == 1);
    CHECK_THAT(old.failures[0], Catch::Contains("without an answer"));
    check_messages(old.text);
  }
}

TEST_CASE("A refusal is told with its remedy, and not repeated soon", "[ntrip]") {
  if (!can_run()) return;
  const Caster caster;
  NtripOptions wrong = caster.options("CHUNKS");
  wrong.credentials_file = caster.wrong_credentials();
  Collector sink = run(wrong, 3, [](const Collector&) { return false; });
  REQUIRE(sink.failures.size() == 1);
  CHECK_THAT(sink.failures[0], Catch::Contains("refuses the user or the password (401)"));
  CHECK(sink.waits_s[0] == RetryWait::kLongest_s);
  CHECK(caster.said().find("asked CHUNKS") == caster.said().rfind("asked CHUNKS"));
  wrong.credentials_file.clear();
  CHECK_THAT(until_failed(wrong).failures[0], Catch::Contains("without user and password"));
  NtripOptions absent = caster.options("NOWHERE");
  CHECK_THAT(until_failed(absent).failures[0], Catch::Contains("no mountpoint NOWHERE"));
  absent.version = NtripVersion::k1;  // the source table
  CHECK_THAT(until_failed(absent).failures[0], Catch::Contains("no mountpoint NOWHERE"));
}

TEST_CASE("A certificate that cannot be trusted is told, and no user is sent", "[ntrip]") {
  if (!can_run()) return;
  const Caster caster;
  NtripOptions options = caster.options("CHUNKS", true);
  options.ca_file = caster.other_ca();
  CHECK_THAT(until_failed(options).failures[0],
             Catch::Contains("cannot be trusted") && Catch::Contains("ca_file"));
  options.ca_file.clear();  // the system's
  CHECK_THAT(until_failed(options).failures[0], Catch::Contains("cannot be trusted"));
  options = caster.options("CHUNKS", true);
  options.host = "127.0.0.1";
  CHECK_THAT(until_failed(options).failures[0], Catch::Contains("for another name"));
  CHECK(caster.said().find("asked") == std::string::npos);
  options = caster.options("CHUNKS");
  options.tls = true;
  CHECK_THAT(until_failed(options).failures[0], Catch::Contains("TLS"));
  options = caster.options("CHUNKS", true);
  options.tls = false;
  CHECK_FALSE(until_failed(options).failures[0].empty());
  options = caster.options("CHUNKS", true);
  options.ca_file = options.credentials_file;
  CHECK_THAT(problem_of_authority(options), Catch::Contains("PEM"));
}

TEST_CASE("A caster that drops out, sends nothing or never ends is told of", "[ntrip]") {
  if (!can_run()) return;
  const Caster caster;
  const Collector dropped = run(caster.options("DROP"), 20,
                                [](const Collector& now) { return now.text.size() >= 3 * 18; });
  CHECK(dropped.opened == 3);
  REQUIRE(dropped.failures.size() >= 2);
  CHECK_THAT(dropped.failures[0], Catch::Contains("closed the connection"));
  CHECK(dropped.waits_s[1] > dropped.waits_s[0]);
  CHECK_THAT(until_failed(caster.options("MUTE")).failures[0], Catch::Contains("does not answer"));
  CHECK_THAT(until_failed(caster.options("ENDLESS")).failures[0],
             Catch::Contains("no answer of NTRIP"));
  const Collector silent = run(caster.options("SILENT"), 1, [](const Collector&) { return false; });
  CHECK(silent.opened == 1);
  CHECK(silent.text.empty());
}

TEST_CASE("The position goes to the caster again and again", "[ntrip]") {
  if (!can_run()) return;
  const Caster caster;
  NtripOptions options = caster.options("POSITION", true);
  options.position_line = [] { return std::string("$GPGGA,test*00\r\n"); };
  options.position_interval_s = 0.1;
  const Collector sink =
      run(options, 20, [](const Collector& now) { return now.text.size() >= 3 * 18; });
  check_messages(sink.text);
  const std::string said = caster.said();
  CHECK(said.find("position $GPGGA,test*00") != said.rfind("position $GPGGA,test*00"));
}

}  // namespace leonav
