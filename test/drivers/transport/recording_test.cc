// Recordings: written, read, cut short, damaged; and files played at their pace.
#include "drivers/transport/recording.h"

#include <boost/asio/io_context.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "drivers/text/parse.h"
#include "drivers/transport/file_source.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using Bytes = std::vector<std::uint8_t>;

void write_three(const std::string& path) {
  RecordingWriter writer(path);
  const Bytes one = {1, 2, 3}, two(5000, 9), three = {};
  REQUIRE(writer.write(1'000'000'000, one));
  REQUIRE(writer.write(1'050'000'000, two));
  REQUIRE(writer.write(1'100'000'000, three));
  REQUIRE(writer.flush());
}

class Collector : public ByteSink {
 public:
  using Steady = ArrivalClock::Steady;
  void on_open() override { opened = Steady::now(); }
  void on_bytes(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override {
    count += bytes.size();
    arrivals_ns.push_back(arrival_ns);
    times.push_back(Steady::now());
  }
  void on_failure(const std::string&, double) override {}
  void on_end(const std::string& why) override { end = why.empty() ? "end" : why; }

  Steady::time_point opened;
  std::size_t count = 0;
  std::vector<std::int64_t> arrivals_ns;
  std::vector<Steady::time_point> times;
  std::string end;
};

Collector play(const std::string& path, double speed) {
  boost::asio::io_context io;
  const ArrivalClock clock;
  PlaybackClocks clocks(speed, &clock);
  const auto source = make_file_source(&io, &clocks, path);
  Collector sink;
  source->start(&sink);
  io.run();
  return sink;
}

}  // namespace

TEST_CASE("A recording gives back every byte with its arrival", "[transport]") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("a.leoraw");
  write_three(path);
  BlockReader reader(path);
  REQUIRE(reader.is_recording());
  BlockReader::Block block;
  REQUIRE(reader.next(&block));
  CHECK(block.arrival_ns == 1'000'000'000);
  CHECK(block.bytes == Bytes{1, 2, 3});
  REQUIRE(reader.next(&block));
  CHECK(block.bytes.size() == 5000);
  REQUIRE(reader.next(&block));
  CHECK(block.bytes.empty());
  CHECK_FALSE(reader.next(&block));
}

TEST_CASE("A recording that exists is kept, and one that is cut short ends there", "[transport]") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("a.leoraw");
  write_three(path);
  CHECK(RecordingWriter(path).path() == path + ".1");
  std::filesystem::resize_file(path, 1000);
  BlockReader reader(path);
  BlockReader::Block block;
  CHECK(reader.next(&block));
  CHECK_FALSE(reader.next(&block));
  CHECK_THROWS_WITH(RecordingWriter("/no/such/folder/a"), Catch::Contains("cannot be created"));
  CHECK_THROWS_WITH(BlockReader(place.beside("none")), Catch::Contains("cannot be opened"));
}

TEST_CASE("A damaged length is an error with its place, and allocates nothing", "[transport]") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("a.leoraw");
  write_three(path);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(19 + 12 + 3 + 8);
  file.write("\xFF\xFF\xFF\xFF", 4);
  file.close();
  BlockReader reader(path);
  BlockReader::Block block;
  REQUIRE(reader.next(&block));
  CHECK_THROWS_WITH(reader.next(&block), Catch::Contains("damaged before byte"));
  CHECK_THAT(play(path, 10.0).end, Catch::Contains("damaged"));
}

TEST_CASE("A recording is played by its arrivals, at any speed", "[transport]") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("a.leoraw");
  write_three(path);
  const Collector sink = play(path, 0.5);
  CHECK(sink.end == "end");
  CHECK(sink.count == 5003);
  REQUIRE(sink.arrivals_ns.size() == 2);  // the empty block brings nothing
  CHECK(sink.arrivals_ns[1] == 1'050'000'000);
  const std::chrono::duration<double> apart = sink.times[1] - sink.times[0];
  CHECK(apart.count() > 0.095);
}

TEST_CASE("A file without times is played without waiting", "[transport]") {
  const test::TemporaryFile file("a.ubx", std::string(10'000, 'x'));
  const Collector sink = play(file.path(), 1.0);
  CHECK(sink.count == 10'000);
  CHECK(sink.end == "end");
}

TEST_CASE("An instant far ahead holds a file up no longer than an hour's hole", "[transport]") {
  PlaybackClock clock(2.0);
  const auto now = ArrivalClock::Steady::now();
  constexpr std::int64_t kSecond = 1'000'000'000;
  CHECK(clock.due(1000 * kSecond, now) == now);
  CHECK(clock.due(1010 * kSecond, now) == now + std::chrono::seconds(5));
  CHECK(clock.due(990 * kSecond, now) == now);
  CHECK(clock.due(90'000 * kSecond, now) == now);
  CHECK(clock.due(90'002 * kSecond, now) == now + std::chrono::seconds(1));
}

}  // namespace leonav
