// Live sources over a real pseudo-terminal and a real socket.
#include "drivers/transport/live_sources.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "collector.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

namespace asio = boost::asio;
using test::Collector;
using test::run_until;

// The side of a pseudo-terminal at which a sensor would be. Its port is a link that goes when it is
// unplugged, because another program may get the terminal's name from then on.
class Sensor {
 public:
  Sensor() : descriptor_(posix_openpt(O_RDWR | O_NOCTTY)), port_(folder_.beside("port")) {
    REQUIRE(descriptor_ >= 0);
    REQUIRE(grantpt(descriptor_) == 0);
    REQUIRE(unlockpt(descriptor_) == 0);
    std::filesystem::create_symlink(ptsname(descriptor_), port_);
  }
  ~Sensor() { unplug(); }
  const std::string& port() const { return port_; }
  void send(const std::string& text) const {
    REQUIRE(write(descriptor_, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  void unplug() {
    std::filesystem::remove(port_);
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
  }

 private:
  test::TemporaryFile folder_{"unused", ""};
  int descriptor_;
  std::string port_;
};

}  // namespace

TEST_CASE("A serial port delivers every byte as it is, and says when it is gone", "[transport]") {
  asio::io_context io;
  const ArrivalClock clock;
  Sensor sensor;
  const auto source = make_serial_source(&io, &clock, {sensor.port(), 115'200});
  Collector sink;
  source->start(&sink);
  REQUIRE(run_until(&io, [&] { return sink.opened == 1; }));
  // What a terminal would change: carriage return, end of file, interrupt, flow control.
  const std::string odd("\r\n\x03\x04\x11\x13\0\xFF", 8);
  const std::int64_t before_ns = clock.now_ns();
  sensor.send(odd);
  REQUIRE(run_until(&io, [&] { return sink.text.size() == odd.size(); }));
  CHECK(sink.text == odd);
  CHECK(sink.last_arrival_ns >= before_ns);
  CHECK(sink.last_arrival_ns <= clock.now_ns());
  sensor.unplug();
  REQUIRE(run_until(&io, [&] { return sink.failures.size() >= 2; }));
  CHECK_THAT(sink.failures[0], Catch::Contains("is gone"));
  CHECK(sink.waits_s[1] > sink.waits_s[0]);
  CHECK(sink.ends.empty());
}

TEST_CASE("A port that is not there, or none at all, is told with a remedy", "[transport]") {
  asio::io_context io;
  const ArrivalClock clock;
  Collector absent, no_port;
  const auto first = make_serial_source(&io, &clock, {"/dev/there_is_none", 115'200});
  const auto second = make_serial_source(&io, &clock, {"/dev/null", 115'200});
  first->start(&absent);
  second->start(&no_port);
  REQUIRE(run_until(&io, [&] { return !absent.failures.empty() && !no_port.failures.empty(); }));
  CHECK_THAT(absent.failures[0], Catch::Contains("is it plugged in?"));
  CHECK_THAT(no_port.failures[0], Catch::Contains("no serial port"));
  CHECK(absent.opened == 0);
}

TEST_CASE("A server's bytes come, and a connection that it closes is made anew", "[transport]") {
  using asio::ip::tcp;
  asio::io_context io;
  const ArrivalClock clock;
  tcp::acceptor acceptor(io, {asio::ip::address_v4::loopback(), 0});
  const std::uint16_t port = acceptor.local_endpoint().port();
  std::vector<tcp::socket> peers;
  std::function<void()> accept = [&] {
    acceptor.async_accept([&](const boost::system::error_code& error, tcp::socket peer) {
      if (error) return;
      asio::write(peer, asio::buffer("bytes", 5));
      peers.push_back(std::move(peer));
      accept();
    });
  };
  accept();
  Collector sink;
  const auto source = make_tcp_source(&io, &clock, {"127.0.0.1", port});
  source->start(&sink);
  REQUIRE(run_until(&io, [&] { return sink.text == "bytes"; }));
  peers.clear();
  REQUIRE(run_until(&io, [&] { return sink.text == "bytesbytes"; }));
  CHECK(sink.opened == 2);
  REQUIRE(sink.failures.size() == 1);
  CHECK_THAT(sink.failures[0], Catch::Contains("closed the connection"));
  source->reconnect("asked for");
  REQUIRE(run_until(&io, [&] { return sink.text == "bytesbytesbytes"; }));
  CHECK(sink.failures[1] == "asked for");
  acceptor.close();
  peers.clear();
  REQUIRE(run_until(&io, [&] { return sink.failures.size() == 4; }));
  CHECK_THAT(sink.failures[3], Catch::Contains("nothing listens there"));
}

}  // namespace leonav
