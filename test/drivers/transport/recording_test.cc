// Recordings: written, read, cut short, damaged; and files played at their pace.
#include "drivers/transport/recording.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
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
  REQUIRE(writer.close());
}

class PlayedFile : public ByteSink {
 public:
  using Steady = ArrivalClock::Steady;
  void on_open() override {
    opened = Steady::now();
    opened_after.push_back(count);
  }
  void on_bytes(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override {
    count += bytes.size();
    arrivals_ns.push_back(arrival_ns);
    times.push_back(Steady::now());
  }
  void on_failure(const std::string&, double) override {}
  void on_end(const std::string& why) override { end = why.empty() ? "end" : why; }

  Steady::time_point opened;
  std::size_t count = 0;
  std::vector<std::size_t> opened_after;  // so many bytes
  std::vector<std::int64_t> arrivals_ns;
  std::vector<Steady::time_point> times;
  std::string end;
};

PlayedFile play(const std::string& path, double speed) {
  boost::asio::io_context io;
  const ArrivalClock clock;
  PlaybackClocks clocks(speed, &clock);
  const auto source = make_file_source(&io, &clocks, path);
  PlayedFile sink;
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

TEST_CASE("The first arrival is known of a recording with a whole block alone", "[transport]") {
  const test::TemporaryFile text("text.ubx", "no recording"),
      empty("empty.leoraw", "leonav recording 1\n");
  write_three(text.beside("three.leoraw"));
  CHECK(first_arrival_ns(text.beside("three.leoraw")) == 1'000'000'000);
  CHECK(first_arrival_ns(text.path()) == std::nullopt);
  CHECK(first_arrival_ns(empty.path()) == std::nullopt);
  CHECK(first_arrival_ns(text.beside("none.leoraw")) == std::nullopt);
}

TEST_CASE("A pipe or a device is no file, and is refused at once with the remedy", "[transport]") {
  const test::TemporaryFile place("unused", "");
  const std::string fifo = place.beside("fifo");
  REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
  // Without a writer, and with one that sends nothing, reading would wait for ever.
  CHECK_THROWS_WITH(BlockReader(fifo), Catch::Contains("stdin"));
  const int silent = open(fifo.c_str(), O_RDWR);
  REQUIRE(silent >= 0);
  CHECK_THROWS_WITH(BlockReader(fifo), Catch::Contains("stdin"));
  // Nor is anything taken from it.
  REQUIRE(write(silent, "abc", 3) == 3);
  CHECK_THROWS_AS(BlockReader(fifo), FileError);
  CHECK(first_arrival_ns(fifo) == std::nullopt);
  char got[3];
  CHECK(read(silent, got, 3) == 3);
  close(silent);
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  REQUIRE((master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0));
  CHECK_THROWS_WITH(BlockReader(ptsname(master)), Catch::Contains("'source: serial'"));
  close(master);
  CHECK_THROWS_WITH(BlockReader(std::filesystem::temp_directory_path()),
                    Catch::Contains("is a directory"));
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

TEST_CASE("A disk that takes nothing holds nobody up, and costs whole blocks", "[transport]") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  constexpr std::size_t kBlock = 4096;
  const Bytes block(kBlock, 7);
  std::vector<std::uint8_t> written;
  std::uint64_t dropped = 0;
  std::thread reader;
  {
    RecordingWriter writer(fdopen(ends[1], "wb"), "pipe", {.queued_bytes = 1U << 20U});
    const auto start = ArrivalClock::Steady::now();
    for (int i = 0; i < 2000; ++i) REQUIRE(writer.write(1'000'000'000 + i, block));
    CHECK(writer.flush());
    CHECK(ArrivalClock::Steady::now() - start < std::chrono::seconds(2));
    dropped = writer.dropped_bytes();
    CHECK(dropped > 2000 * kBlock / 2);
    CHECK(dropped % kBlock == 0);
    reader = std::thread([&] {
      std::uint8_t buffer[65'536];
      for (;;) {
        const ssize_t count = read(ends[0], buffer, sizeof buffer);
        if (count <= 0) return;
        written.insert(written.end(), buffer, buffer + count);
      }
    });
    CHECK(writer.close());
  }
  reader.join();
  close(ends[0]);
  const std::size_t first_line = 19, header = 12;
  CHECK(written.size() == first_line + (2000 - dropped / kBlock) * (kBlock + header));
}

TEST_CASE("The beginning of a connection is kept until a block finds room", "[transport]") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("a.leoraw");
  {
    // Too little room for a block of 100 bytes, whatever is queued.
    RecordingWriter writer(path, {.queued_bytes = 80});
    writer.note_opening();
    REQUIRE(writer.write(1'000'000'000, Bytes(100, 1)));
    CHECK(writer.dropped_bytes() == 100);
    REQUIRE(writer.write(1'001'000'000, Bytes{2, 3}));
    REQUIRE(writer.close());
  }
  BlockReader reader(path);
  BlockReader::Block block;
  for (const Bytes& bytes : {Bytes{}, Bytes{2, 3}}) {
    REQUIRE(reader.next(&block));
    CHECK(block.arrival_ns == 1'001'000'000);
    CHECK(block.bytes == bytes);
  }
  CHECK_FALSE(reader.next(&block));
}

TEST_CASE("A disk that never takes anything again is given up at the end", "[transport]") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  RecordingWriter writer(fdopen(ends[1], "wb"), "pipe", {});
  REQUIRE(writer.write(1'000'000'000, Bytes(1U << 20U, 7)));
  CHECK_FALSE(writer.close());
  CHECK_THAT(writer.error(), Catch::Contains("pipe: cannot be completed"));
  std::signal(SIGPIPE, SIG_IGN);
  close(ends[0]);
}

TEST_CASE("A full disk and a recording's limit end the recording alone", "[transport]") {
  RecordingWriter full(std::fopen("/dev/full", "wb"), "full", {});
  REQUIRE(full.write(1'000'000'000, Bytes{1, 2, 3}));
  CHECK_FALSE(full.close());
  CHECK_THAT(full.error(), Catch::Contains("full: cannot be written: No space left"));

  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("a.leoraw");
  RecordingWriter limited(path, {.file_bytes = 19 + 2 * (12 + 100)});
  CHECK(limited.write(1'000'000'000, Bytes(100, 1)));
  CHECK(limited.write(1'000'000'001, Bytes(100, 2)));
  CHECK_FALSE(limited.write(1'000'000'002, Bytes(100, 3)));
  CHECK_THAT(limited.error(), Catch::Contains("record_limit_mb"));
  CHECK_FALSE(limited.close());
  CHECK(std::filesystem::file_size(path) == 19 + 2 * (12 + 100));
}

TEST_CASE("A recording that ends at its limit on a stalled disk holds nothing up", "[transport]") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const auto start = ArrivalClock::Steady::now();
  {
    RecordingWriter writer(fdopen(ends[1], "wb"), "pipe", {.file_bytes = 1U << 20U});
    int taken = 0;
    while (writer.write(1'000'000'000, Bytes(4096, 7))) ++taken;
    CHECK(taken == 255);
    CHECK_THAT(writer.error(), Catch::Contains("has reached its limit"));
    writer.end();
  }
  CHECK(ArrivalClock::Steady::now() - start < std::chrono::seconds(1));
  std::signal(SIGPIPE, SIG_IGN);
  close(ends[0]);
}

TEST_CASE("Stalled disks of several recordings are waited for together", "[transport]") {
  int first[2], second[2];
  REQUIRE(pipe(first) == 0);
  REQUIRE(pipe(second) == 0);
  RecordingWriter one(fdopen(first[1], "wb"), "one", {}), two(fdopen(second[1], "wb"), "two", {});
  REQUIRE(one.write(1'000'000'000, Bytes(1U << 20U, 7)));
  REQUIRE(two.write(1'000'000'000, Bytes(1U << 20U, 7)));
  const auto start = ArrivalClock::Steady::now();
  one.end();
  two.end();
  CHECK_FALSE(one.close());
  CHECK_FALSE(two.close());
  CHECK(ArrivalClock::Steady::now() - start < std::chrono::seconds(5));
  std::signal(SIGPIPE, SIG_IGN);
  close(first[0]);
  close(second[0]);
}

TEST_CASE("What is queued goes to the file although nobody waits for it", "[transport]") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("a.leoraw");
  { REQUIRE(RecordingWriter(path).write(1'000'000'000, Bytes(100, 1))); }
  const auto start = ArrivalClock::Steady::now();
  while (std::filesystem::file_size(path) < 19 + 12 + 100 &&
         ArrivalClock::Steady::now() - start < std::chrono::seconds(10)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  CHECK(std::filesystem::file_size(path) == 19 + 12 + 100);
}

TEST_CASE("A recording is near its limit from nine tenths on, and without a limit never",
          "[transport]") {
  const test::TemporaryFile place("unused", "");
  RecordingWriter limited(place.beside("a.leoraw"), {.file_bytes = 10'000});
  RecordingWriter unlimited(place.beside("b.leoraw"));
  for (RecordingWriter* writer : {&limited, &unlimited}) {
    CHECK(writer->write(1'000'000'000, Bytes(8900, 1)));
  }
  CHECK_FALSE(limited.is_near_limit());
  CHECK(limited.write(1'000'000'000, Bytes(100, 1)));
  CHECK(limited.is_near_limit());
  CHECK_FALSE(unlimited.is_near_limit());
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
  const PlayedFile sink = play(path, 0.5);
  CHECK(sink.end == "end");
  CHECK(sink.count == 5003);
  REQUIRE(sink.arrivals_ns.size() == 2);  // the empty block brings no bytes
  CHECK(sink.arrivals_ns[1] == 1'050'000'000);
  const std::chrono::duration<double> apart = sink.times[1] - sink.times[0];
  CHECK(apart.count() > 0.095);
}

TEST_CASE("A recording knows where a connection began, and so does who plays it", "[transport]") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("a.leoraw");
  {
    RecordingWriter writer(path);
    writer.note_opening();
    REQUIRE(writer.write(1'000'000'000, Bytes{1, 2, 3}));
    REQUIRE(writer.write(1'001'000'000, Bytes{4}));
    writer.note_opening();
    REQUIRE(writer.write(1'002'000'000, Bytes{5}));
    REQUIRE(writer.close());
  }
  CHECK(first_arrival_ns(path) == 1'000'000'000);
  const PlayedFile sink = play(path, 10.0);
  CHECK(sink.end == "end");
  CHECK(sink.opened_after == std::vector<std::size_t>{0, 4});
  CHECK(sink.arrivals_ns == std::vector<std::int64_t>{1'000'000'000, 1'001'000'000, 1'002'000'000});
  // A recording of before, without the first one.
  write_three(place.beside("b.leoraw"));
  CHECK(play(place.beside("b.leoraw"), 10.0).opened_after == std::vector<std::size_t>{0, 5003});
}

TEST_CASE("A file without times is played without waiting", "[transport]") {
  const test::TemporaryFile file("a.ubx", std::string(10'000, 'x'));
  const PlayedFile sink = play(file.path(), 1.0);
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
