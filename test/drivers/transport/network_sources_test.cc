// Clients of a server and datagrams, over real sockets.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>
#include <string>
#include <vector>

#include "collector.h"
#include "drivers/transport/live_sources.h"
#include "drivers/transport/retry_wait.h"
#include "support/catch.h"

namespace leonav {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;
using test::Collector;
using test::run_until;

const asio::ip::address kLoopback = asio::ip::address_v4::loopback();

// A port that was free a moment ago.
template <typename Protocol>
std::uint16_t free_port(asio::io_context* io) {
  typename Protocol::socket socket(*io, typename Protocol::endpoint(kLoopback, 0));
  return socket.local_endpoint().port();
}

}  // namespace

TEST_CASE("Waits double within their bounds, and begin anew after a reset", "[transport]") {
  RetryWait wait;
  CHECK(wait.next_s() == 0.5);
  CHECK(wait.next_s() == 1.0);
  CHECK(wait.next_s({.least_s = 30.0, .most_s = 30.0}) == 30.0);
  CHECK(wait.next_s({.least_s = 0.0, .most_s = 0.1}) == 0.1);
  for (int i = 0; i < 5; ++i) wait.next_s();
  CHECK(wait.next_s() == 30.0);
  wait.reset();
  CHECK(wait.next_s() == 0.5);
}

TEST_CASE("Clients of a server are read one after the other", "[transport]") {
  asio::io_context io;
  const ArrivalClock clock;
  const std::uint16_t port = free_port<tcp>(&io);
  Collector sink;
  const auto source = make_tcp_server_source(&io, &clock, {"127.0.0.1", port});
  source->start(&sink);
  REQUIRE(run_until(&io, [&] { return !sink.waiting.empty(); }));
  CHECK_THAT(sink.waiting[0], Catch::Contains("no client is connected"));
  run_until(&io, [] { return false; });  // longer than an attempt to connect may take
  CHECK(sink.failures.empty());
  CHECK(sink.waiting.size() == 1);
  tcp::socket first(io), second(io);
  first.connect({kLoopback, port});
  asio::write(first, asio::buffer("first", 5));
  REQUIRE(run_until(&io, [&] { return sink.text == "first"; }));
  second.connect({kLoopback, port});
  asio::write(second, asio::buffer("second", 6));
  asio::write(first, asio::buffer("again", 5));
  REQUIRE(run_until(&io, [&] { return sink.text == "firstagain"; }));
  first.close();
  REQUIRE(run_until(&io, [&] { return sink.text == "firstagainsecond"; }));
  REQUIRE(sink.failures.size() == 1);
  CHECK_THAT(sink.failures[0], Catch::Contains("the client closed the connection"));
  source->reconnect("asked for");
  tcp::socket third(io);
  third.connect({kLoopback, port});
  asio::write(third, asio::buffer("third", 5));
  REQUIRE(run_until(&io, [&] { return sink.text == "firstagainsecondthird"; }));
  CHECK(sink.opened == 3);
}

TEST_CASE("A port that another program has is told, and taken when it is free", "[transport]") {
  asio::io_context io;
  const ArrivalClock clock;
  tcp::acceptor other(io, {kLoopback, 0});
  const std::uint16_t port = other.local_endpoint().port();
  udp::socket other_udp(io, {kLoopback, 0});
  Collector tcp_sink, udp_sink, no_address;
  const auto one = make_tcp_server_source(&io, &clock, {"127.0.0.1", port});
  const auto two = make_udp_source(&io, &clock, {"127.0.0.1", other_udp.local_endpoint().port()});
  const auto three = make_udp_source(&io, &clock, {"192.0.2.1", 4000});
  one->start(&tcp_sink);
  two->start(&udp_sink);
  three->start(&no_address);
  REQUIRE(run_until(&io, [&] {
    return !tcp_sink.failures.empty() && !udp_sink.failures.empty() && !no_address.failures.empty();
  }));
  CHECK_THAT(tcp_sink.failures[0], Catch::Contains("another program has this port"));
  CHECK_THAT(udp_sink.failures[0], Catch::Contains("another program has this port"));
  CHECK_THAT(no_address.failures[0], Catch::Contains("no such address"));
  other.close();
  other_udp.close();
  REQUIRE(run_until(&io, [&] { return udp_sink.opened == 1; }));
}

TEST_CASE("Datagrams of every length come whole, one after the other", "[transport]") {
  asio::io_context io;
  const ArrivalClock clock;
  const std::uint16_t port = free_port<udp>(&io);
  Collector sink;
  const auto source = make_udp_source(&io, &clock, {"127.0.0.1", port});
  source->start(&sink);
  REQUIRE(run_until(&io, [&] { return sink.opened == 1; }));
  udp::socket sender(io, udp::v4());
  std::string expected;
  for (const std::size_t length : {1, 0, 1400, 9000, 65'507}) {
    const std::string datagram(length, static_cast<char>('a' + length % 26));
    expected += datagram;
    sender.send_to(asio::buffer(datagram), {kLoopback, port});
  }
  REQUIRE(run_until(&io, [&] { return sink.text.size() == expected.size(); }));
  CHECK(sink.text == expected);
  CHECK(sink.sizes == std::vector<std::size_t>{1, 1400, 9000, 65'507});
  source->reconnect("nobody is connected");
  CHECK(sink.failures.empty());
}

}  // namespace leonav
