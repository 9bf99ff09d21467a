// Which solutions are written, what a slow reader gets, what a wrong configuration says.
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>

#include "daemon/config/load_config.h"
#include "drivers/lcm/encode.h"
#include "support/catch.h"
#include "support/temporary_file.h"
#include "tools/serve/pty_outlet.h"
#include "tools/serve/sentence_feed.h"
#include "tools/serve/udp_outlet.h"

namespace leonav {
namespace {

const GpsTime kStart = GpsTime::from_week_and_tow(2136, 345'600.0);

std::string problem(const std::vector<std::string>& overrides, const std::string& path = "") {
  try {
    load_serve_config(path, overrides);
    return "none";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("One instant a second of the solution's time is written", "[serve]") {
  OutputPace pace(1.0);
  int due = 0;
  for (int i = 0; i < 1000; ++i) due += pace.is_due(kStart.plus_nanoseconds(i * 5'000'000LL));
  CHECK(due == 5);
  CHECK(pace.is_due(kStart.plus_nanoseconds(4'999'999'500)));  // half a microsecond early
  CHECK_FALSE(pace.is_due(kStart.plus_seconds(5.0)));
  CHECK_FALSE(pace.is_due(kStart.plus_seconds(1.0)));  // out of order
  CHECK(pace.is_due(kStart.plus_seconds(-100.0)));     // another run
}

TEST_CASE("A slow reader loses whole instants and is told how many sentences", "[serve]") {
  OutputQueue queue;
  auto batch = std::make_shared<Batch>();
  batch->text = std::string(6'000, 'x');
  batch->sentences = 8;
  CHECK(queue.offer(batch));
  CHECK(queue.offer(batch));
  CHECK_FALSE(queue.offer(batch));
  CHECK(queue.lost_sentences() == 8);
  queue.consume(10);
  CHECK(queue.size() == 5'990);
  queue.consume(5'990);
  CHECK(queue.offer(batch));
  queue.consume(6'000);
  CHECK(std::string(queue.data(), queue.size()).find("8 sentences lost") != std::string::npos);
  queue.consume(queue.size());
  CHECK(queue.size() == 6'000);
  queue.consume(queue.size());
  CHECK(queue.is_empty());
}

TEST_CASE("Datagrams hold whole sentences, and all of them", "[serve]") {
  std::string text;
  for (int i = 0; i < 100; ++i)
    text += "$GPGSV," + std::string(40, 'x') + std::to_string(i) + "\r\n";
  std::string joined;
  const auto datagrams = datagrams_of(text);
  CHECK(datagrams.size() == 4);
  for (const std::string_view one : datagrams) {
    CHECK(one.size() <= 1'400);
    CHECK(one.starts_with("$"));
    CHECK(one.ends_with("\r\n"));
    joined += one;
  }
  CHECK(joined == text);
  CHECK(datagrams_of("$GPZDA\r\n").size() == 1);
}

TEST_CASE("An instant arrives as a datagram where it was sent to", "[serve]") {
  boost::asio::io_context io;
  using boost::asio::ip::udp;
  udp::socket reader(io, udp::endpoint(boost::asio::ip::make_address("127.0.0.1"), 0));
  UdpOutlet outlet(&io, {"127.0.0.1", reader.local_endpoint().port()});
  auto batch = std::make_shared<Batch>();
  batch->text = "$GNZDA,1*00\r\n$GNVTG*00\r\n";
  batch->sentences = 2;
  outlet.send(batch);
  std::array<char, 2'000> bytes{};
  const std::size_t size = reader.receive(boost::asio::buffer(bytes));
  CHECK(std::string(bytes.data(), size) == batch->text);
  CHECK(outlet.status().ends_with("1 datagrams sent, 0 lost"));
}

TEST_CASE("Datagrams that cannot be sent are told once, also where others of the instant can",
          "[serve]") {
  boost::asio::io_context io;
  using boost::asio::ip::udp;
  const udp::socket reader(io, udp::endpoint(boost::asio::ip::make_address("127.0.0.1"), 0));
  UdpOutlet outlet(&io, {"127.0.0.1", reader.local_endpoint().port()});
  // No datagram can be so long as the second line.
  const std::string sentence = "$GNZDA,1*00\r\n", much(70'000, 'x');
  const auto long_one = std::make_shared<Batch>(), short_one = std::make_shared<Batch>();
  long_one->text = sentence + much + "\r\n";
  short_one->text = sentence;

  std::ostringstream log;
  const auto usual = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
  for (int k = 0; k < 5; ++k) outlet.send(long_one);
  for (int k = 0; k < 5; ++k) outlet.send(short_one);
  spdlog::set_default_logger(usual);
  CHECK(outlet.status().ends_with("10 datagrams sent, 5 lost"));
  const std::string text = log.str();
  CAPTURE(text);
  CHECK(std::count(text.begin(), text.end(), '\n') == 2);
  CHECK_THAT(text, Catch::Contains("cannot be sent") && Catch::Contains("sent again; 5 datagrams"));
}

TEST_CASE("The heading is served only where it is asked for, because of gpsd", "[serve]") {
  const auto has_heading = [](const ServeConfig& config) {
    return std::find(config.sentences.begin(), config.sentences.end(), SentenceKind::kHdt) !=
           config.sentences.end();
  };
  const ServeConfig usual = load_serve_config("", {"tcp.port=1"});
  CHECK(usual.sentences.size() == 7);
  CHECK_FALSE(has_heading(usual));
  CHECK(has_heading(load_serve_config("", {"tcp.port=1", "sentences=[GGA, HDT]"})));
  CHECK(load_serve_config(LEONAV_SOURCE_DIR "/config/serve.yaml", {}).sentences == usual.sentences);
}

TEST_CASE("A link to another device is left alone, one to a pseudo-terminal replaced", "[serve]") {
  boost::asio::io_context io;
  namespace fs = std::filesystem;
  if (!fs::exists("/dev/ptmx")) return;
  const test::TemporaryFile place("unused", "");
  const std::string link = place.beside("nmea");
  fs::create_symlink("/dev/null", link);
  CHECK_THROWS_WITH(PtyOutlet(&io, link), Catch::Contains("/dev/null and is left alone"));
  CHECK(fs::read_symlink(link) == "/dev/null");
  fs::remove(link);
  fs::create_symlink("/dev/pts/999999", link);  // of a run that was killed
  {
    const PtyOutlet outlet(&io, link);
    CHECK(fs::read_symlink(link) != "/dev/pts/999999");
  }
  CHECK_FALSE(fs::is_symlink(link));
}

TEST_CASE("Messages become sentences, damaged ones are counted", "[serve]") {
  const ServeConfig config = load_serve_config("", {"tcp.port=1", "sentences=[GGA, GSA]"});
  SentenceFeed feed(config);
  Encoder encoder;
  EpochReport epoch;
  epoch.time = kStart;
  epoch.satellites_used = 1;
  epoch.hdop = 1.5;
  epoch.satellites.push_back({});
  epoch.satellites[0].satellite = {System::kGalileo, 7};
  const auto encoded = encoder.encode(epoch);
  feed.on_epoch(encoded);
  feed.on_epoch(encoded.subspan(0, encoded.size() - 1));
  std::vector<std::uint8_t> damaged(encoded.begin(), encoded.end());
  damaged[28] = 0x7F;  // the first count
  feed.on_epoch(damaged);
  CHECK(feed.refused() == 2);
  Solution solution;
  solution.time = kStart;
  solution.source = Source::kSmoother;
  const auto batch = feed.on_solution(encoder.encode(solution));
  REQUIRE(batch);
  CHECK(batch->sentences == 2);
  CHECK(batch->text.find(",1,01,1.50,") != std::string::npos);
  CHECK(batch->text.find("$GAGSA,A,3,07,") != std::string::npos);
  CHECK_FALSE(feed.on_solution(encoder.encode(solution)));  // the same instant
  solution.time = kStart.plus_seconds(1.0);
  solution.latitude = 2.0;
  CHECK_FALSE(feed.on_solution(encoder.encode(solution)));
  solution.latitude = std::nan("");
  CHECK_FALSE(feed.on_solution(encoder.encode(solution)));
  CHECK(feed.refused() == 4);
  // Satellites of an epoch long ago are not told.
  solution.latitude = 0.0;
  solution.time = kStart.plus_seconds(6.0);
  const auto later = feed.on_solution(encoder.encode(solution));
  REQUIRE(later);
  CHECK(later->text.find(",1,00,,") != std::string::npos);
}

TEST_CASE("The example configuration is good, and mistakes are told with the remedy", "[serve]") {
  CHECK(problem({}, LEONAV_SOURCE_DIR "/config/serve.yaml") == "none");
  CHECK_THAT(problem({"rate_hz=1"}), Catch::Contains("there is no output"));
  CHECK_THAT(problem({"tcp.port=1", "sentences=[GLL]"}), Catch::Contains("'GLL' is none"));
  CHECK_THAT(problem({"tcp.port=1", "tcp.address=here"}), Catch::Contains("127.0.0.1"));
  CHECK_THAT(problem({"udp.port=1", "udp.address=here"}), Catch::Contains("broadcast"));
  CHECK(problem({"udp.port=1", "udp.address=192.168.1.255"}) == "none");
  CHECK_THAT(problem({"tcp.prot=1"}), Catch::Contains("tcp.prot"));
  // All of them at once.
  CHECK(problem({"sentences=[GLL, GGA, GLM]", "udp.address=here", "udp.prot=1", "rate_hs=1",
                 "lcm.url=\"\"", "lcm.prefix=A B"}) ==
        "--set lcm.url: must not be empty\n"
        "--set sentences: 'GLL' is none; known are GGA, RMC, VTG, GST, GSA, GSV, HDT, ZDA\n"
        "--set sentences: 'GLM' is none; known are GGA, RMC, VTG, GST, GSA, GSV, HDT, ZDA\n"
        "--set udp.address: 'here' is no numeric address; use that of the reader, 127.0.0.1 for "
        "one on this host, or the network's broadcast address\n"
        "--set udp.prot: unknown key; did you mean 'port'?\n"
        "--set tcp: there is no output; give tcp.port, udp.port, serial.device or pty.link\n"
        "--set rate_hs: unknown key; did you mean 'rate_hz'?");
}

}  // namespace leonav
