// The pieces of a journal are read as one log, each event once, whatever stands beside them.
#include "drivers/lcm/journal_pieces.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "drivers/lcm/event_header.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/piece_file.h"
#include "drivers/lcm/piece_name.h"
#include "drivers/lcm/run_configuration.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace {

using namespace leonav;
namespace fs = std::filesystem;

void write_event(std::ofstream* file, std::int64_t number, const std::string& channel,
                 ByteSpan data) {
  const EventHeaderBytes header =
      encode_event_header({number, 1, static_cast<std::uint32_t>(channel.size()),
                           static_cast<std::uint32_t>(data.size())});
  file->write(reinterpret_cast<const char*>(header.data()), header.size());
  file->write(channel.data(), static_cast<std::streamsize>(channel.size()));
  file->write(reinterpret_cast<const char*>(data.data()),
              static_cast<std::streamsize>(data.size()));
}

constexpr std::uint8_t kByte[] = {7};

// A piece with the events `first` to `last`.
void write_piece(const std::string& path, PieceInfo info, std::int64_t first, std::int64_t last,
                 bool configuration = true) {
  std::ofstream file(path, std::ios::binary);
  std::int64_t number = 0;
  if (configuration) write_event(&file, number++, "X_CONFIG", std::vector<std::uint8_t>(500));
  info.first = first;
  write_event(&file, number, "X_PIECE", encode_piece(info));
  for (std::int64_t i = first; i <= last; ++i) write_event(&file, i, "X_IMU", kByte);
}

struct Numbers {
  std::vector<std::int64_t> list;
  std::int64_t missing = 0;
};

Numbers read_numbers(const std::string& path) {
  EventLogReader log(path);
  Numbers numbers;
  for (LogEvent event; log.next(&event);) numbers.list.push_back(event.number);
  numbers.missing = log.missing();
  return numbers;
}

std::vector<std::int64_t> from_to(std::int64_t first, std::int64_t last) {
  std::vector<std::int64_t> list;
  for (std::int64_t i = first; i <= last; ++i) list.push_back(i);
  return list;
}

}  // namespace

TEST_CASE("names of pieces are taken apart by the rule of the table, and put together") {
  std::ifstream table(LEONAV_SOURCE_DIR "/test/drivers/lcm/piece_names.txt");
  int names = 0;
  for (std::string line; std::getline(table, line);) {
    if (line.starts_with("#")) continue;
    INFO(line);
    std::istringstream words(line);
    std::string text, journal, kept;
    std::int64_t number = 0;
    REQUIRE(words >> text >> journal >> number >> kept);
    const PieceName name = parse_piece_name(text);
    CHECK(name.journal == journal);
    CHECK(name.number == number);
    CHECK(name.kept == (kept == "yes"));
    char again[64];
    REQUIRE(format_piece_name(name, again));
    if (text != "a.part00002") CHECK(std::string(again) == text);  // which is not written so
    ++names;
  }
  CHECK(names == 22);
  char small[8];
  CHECK_FALSE(format_piece_name({"journal", 2}, small));
}

TEST_CASE("marks of a journal come through bytes and back; damaged ones are refused") {
  const PieceInfo piece{123, 7, 456, RecordedOutputs::kThinned};
  const auto again = decode_piece(encode_piece(piece));
  REQUIRE(again);
  CHECK(again->run == 123);
  CHECK(again->number == 7);
  CHECK(again->first == 456);
  CHECK(again->outputs == RecordedOutputs::kThinned);
  const auto refused =
      decode_refused(encode_refused({Channel::kOdometer, InputFault::kTooMany, 256}, 3));
  REQUIRE(refused);
  CHECK(refused->channel == Channel::kOdometer);
  CHECK(refused->fault == InputFault::kTooMany);
  CHECK(refused->count == 256);
  const auto lost = decode_lost(encode_lost({5, 9}, 1));
  REQUIRE(lost);
  CHECK(lost->solutions == 5);
  CHECK(lost->others == 9);
  CHECK_FALSE(decode_piece(encode_piece({1, 0, 0, RecordedOutputs::kAll})));
  CHECK(decode_piece(encode_piece({kGreatestRun, 1, 0, RecordedOutputs::kAll})));
  for (const std::int64_t run : {std::int64_t{-1}, kGreatestRun + 1})
    CHECK_FALSE(decode_piece(encode_piece({run, 1, 0, RecordedOutputs::kAll})));
  CHECK_FALSE(decode_piece(encode_piece({1, 1, -1, RecordedOutputs::kAll})));
  CHECK_FALSE(decode_piece(encode_piece({1, 1, 1, static_cast<RecordedOutputs>(3)})));
  CHECK_FALSE(decode_refused(encode_refused({Channel::kSolution, InputFault::kTooMany, 1}, 1)));
  CHECK_FALSE(decode_refused(encode_refused({Channel::kImu, InputFault::kTooMany, ~0ULL}, 1)));
  CHECK_FALSE(decode_lost(encode_lost({~0ULL, 1}, 1)));
  const auto cut = [](auto bytes) { return ByteSpan(bytes).first(bytes.size() - 1); };
  const auto bytes = encode_piece(piece);
  CHECK_FALSE(decode_piece(cut(bytes)));
  CHECK_FALSE(decode_lost(bytes));
  CHECK_FALSE(decode_refused({}));
}

TEST_CASE("the pieces of a run are one log, from the first one or from the folder") {
  const test::TemporaryFile folder("note.txt", "not a log");
  for (const bool configuration : {true, false}) {
    const std::int64_t first = configuration ? 2 : 1;
    const std::string journal = folder.beside("run");
    write_piece(journal, {5, 1}, first, 9, configuration);
    write_piece(journal + ".part0002.kept", {5, 2}, 10, 19, configuration);
    write_piece(journal + ".part0003", {5, 3}, 20, 29, configuration);
    const auto whole = from_to(0, 29);
    for (const std::string& path : {journal, fs::path(journal).parent_path().string()}) {
      INFO(path);
      const Numbers numbers = read_numbers(path);
      CHECK(numbers.list == whole);
      CHECK(numbers.missing == 0);
      CHECK(EventLogReader(path).size_bytes() > static_cast<std::int64_t>(fs::file_size(journal)));
    }
  }
}

TEST_CASE("what was written twice is read once; what is gone is counted") {
  const test::TemporaryFile folder("unused", "");
  const std::string journal = folder.beside("run");
  write_piece(journal, {5, 1}, 2, 12);
  write_piece(journal + ".part0002", {5, 2}, 10, 19);
  write_piece(journal + ".part0004", {5, 4}, 30, 39);
  Numbers numbers = read_numbers(journal);
  auto expected = from_to(0, 19);
  for (const std::int64_t i : from_to(30, 39)) expected.push_back(i);
  CHECK(numbers.list == expected);
  CHECK(numbers.missing == 10);
  // An event that is cut short stands whole in the next piece.
  fs::resize_file(journal, fs::file_size(journal) - 3);
  CHECK(read_numbers(journal).list == expected);
  // The first pieces are gone: the beginning of the first that is left stands for theirs.
  numbers = read_numbers(journal + ".part0004");
  expected = from_to(0, 1);
  for (const std::int64_t i : from_to(30, 39)) expected.push_back(i);
  CHECK(numbers.list == expected);
  CHECK(numbers.missing == 28);
}

TEST_CASE("pieces of other runs, other names and damaged beginnings do not join a log") {
  const test::TemporaryFile folder("unused", "");
  const std::string journal = folder.beside("run");
  write_piece(journal, {5, 1}, 2, 9);
  write_piece(folder.beside("other.part0002"), {5, 2}, 10, 19);
  write_piece(journal + ".part0003", {6, 3}, 10, 19);
  write_piece(journal + ".part0002.txt", {5, 2}, 10, 19);
  std::ofstream(journal + ".part0004") << "";
  std::ofstream(journal + ".part0005") << std::string(5000, 'x');
  CHECK(read_numbers(journal).list == from_to(0, 9));
  // Hostile lengths behind a true beginning.
  std::ofstream file(journal + ".part0006", std::ios::binary);
  const auto header = encode_event_header({0, 1, 8, kMaxEventDataBytes + 1});
  file.write(reinterpret_cast<const char*>(header.data()), header.size());
  file.close();
  CHECK(read_numbers(journal).list == from_to(0, 9));
  CHECK_THROWS_WITH(EventLogReader(fs::path(journal).parent_path()),
                    Catch::Matchers::Contains("holds journals of several runs"));
}

TEST_CASE("a folder without pieces, or with the same piece twice, is refused with a remedy") {
  const test::TemporaryFile folder("unused", "");
  const std::string journal = folder.beside("run");
  CHECK_THROWS_WITH(EventLogReader(fs::path(journal).parent_path()),
                    Catch::Matchers::Contains("without a piece of a journal; name the log itself"));
  write_piece(journal, {5, 1}, 2, 9);
  write_piece(journal + ".part0002", {5, 2}, 10, 19);
  write_piece(journal + ".part0002.kept", {5, 2}, 10, 19);
  CHECK_THROWS_WITH(EventLogReader(journal),
                    Catch::Matchers::Contains("is the same piece of a journal as"));
}

TEST_CASE("a damaged event number inside a piece is damage, named with its byte") {
  const test::TemporaryFile folder("unused", "");
  const std::string journal = folder.beside("run");
  // Where a piece's beginning ends, and the length of an event behind it.
  write_piece(journal, {5, 1}, 2, 1);
  const auto beginning = static_cast<std::streamoff>(fs::file_size(journal));
  const std::streamoff length = kEventHeaderBytes + 5 + 1;
  const auto read_with = [&](std::streamoff event, std::int64_t number) {
    write_piece(journal, {5, 1}, 2, 9);
    write_piece(journal + ".part0002", {5, 2}, 8, 15);
    std::fstream file(journal + ".part0002", std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(beginning + event * length);
    const EventHeaderBytes header = encode_event_header({number, 1, 5, 1});
    file.write(reinterpret_cast<const char*>(header.data()), header.size());
    file.close();
    return read_numbers(journal).list;
  };
  CHECK(read_with(5, 13) == from_to(0, 15));
  for (const std::int64_t number :
       {std::int64_t{-1}, std::int64_t{3}, std::int64_t{12}, std::int64_t{14}, std::int64_t{1000},
        std::numeric_limits<std::int64_t>::max()}) {
    INFO(number);
    CHECK_THROWS_WITH(read_with(5, number),
                      journal + ".part0002: byte " + std::to_string(beginning + 5 * length) +
                          ": event with the number " + std::to_string(number) +
                          " instead of 13; the log is damaged");
  }
  // Behind the mark too; the number behind its own is that of a log that a program has copied.
  CHECK_THROWS_WITH(read_with(0, 9), Catch::Matchers::Contains(" 9 instead of 8; "));
  write_piece(journal, {5, 4}, 100, 99);
  std::ofstream copied(journal, std::ios::binary | std::ios::app);
  for (std::int64_t i = 2; i <= 5; ++i) write_event(&copied, i, "X_IMU", kByte);
  copied.close();
  fs::remove(journal + ".part0002");
  CHECK(read_numbers(journal).list == from_to(0, 5));
}

TEST_CASE("sizes of files with holes do not overflow their sum") {
  if (!fs::exists("/dev/shm")) return;
  std::string name = "/dev/shm/leonav-test-XXXXXX";
  REQUIRE(::mkdtemp(name.data()) != nullptr);
  const std::string journal = name + "/run";
  write_piece(journal, {5, 1}, 2, 9);
  bool made = true;
  for (int number = 2; number <= 4; ++number) {
    const std::string path = journal + ".part000" + std::to_string(number);
    write_piece(path, {5, number}, 10, 9);
    std::error_code error;
    fs::resize_file(path, std::uintmax_t{1} << 62, error);
    made = made && !error;
  }
  if (made) CHECK(EventLogReader(journal).size_bytes() == std::numeric_limits<std::int64_t>::max());
  fs::remove_all(name);
}

TEST_CASE("the end mark is seen at the end of a file alone") {
  const test::TemporaryFile folder("unused", "");
  const auto has_end = [&](const char* name) {
    const int directory = open(fs::path(folder.path()).parent_path().c_str(), O_RDONLY);
    const bool has = has_end_mark(directory, name);
    close(directory);
    return has;
  };
  const std::string journal = folder.beside("run");
  write_piece(journal, {5, 1}, 2, 9);
  CHECK_FALSE(has_end("run"));
  const auto append = [&](const std::string& channel, ByteSpan data) {
    std::ofstream file(journal, std::ios::binary | std::ios::app);
    write_event(&file, 10, channel, data);
  };
  append("A_LONG_PREFIX_END", encode_journal_end(10));
  CHECK(has_end("run"));
  append("A_LONG_PREFIX_IMU", kByte);
  CHECK_FALSE(has_end("run"));
  CHECK_FALSE(has_end("unused"));
  CHECK_FALSE(has_end("absent"));
}
