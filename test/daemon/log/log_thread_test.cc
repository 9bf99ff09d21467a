// Lines of the log, whether somebody reads them or not.
#include "daemon/log/log_thread.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/threads/counters.h"
#include "support/catch.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"
#include "tools/common/allocations/allocation_counter.h"

namespace {

using namespace leonav;

double seconds_since(const Stopwatch& watch) {
  return static_cast<double>(watch.nanoseconds()) * 1e-9;
}

// A pipe with little room. One of one page is full for poll() once anything is in it.
class Pipe {
 public:
  explicit Pipe(int pages = 4) {
    REQUIRE(pipe2(ends_, O_CLOEXEC) == 0);
    REQUIRE(fcntl(ends_[1], F_SETPIPE_SZ, 4096 * pages) >= 4096 * pages);
  }
  ~Pipe() {
    close_reader();
    close(ends_[1]);
  }
  int in() const { return ends_[1]; }
  void close_reader() {
    if (ends_[0] >= 0) close(ends_[0]);
    ends_[0] = -1;
  }
  // Waits for a part of what comes; its bytes.
  std::size_t read_some(char* to, std::size_t room) const {
    const ssize_t size = read(ends_[0], to, room);
    return size > 0 ? static_cast<std::size_t>(size) : 0;
  }
  // What comes, until a line holds `last`, for 10 s at most.
  std::vector<std::string> lines_until(const std::string& last) {
    std::string text;
    const Stopwatch watch;
    while (text.find(last) == text.npos || text.back() != '\n') {
      pollfd place{ends_[0], POLLIN, 0};
      if (seconds_since(watch) > 10.0) break;
      if (poll(&place, 1, 100) <= 0) continue;
      char part[512];
      const std::size_t size = read_some(part, sizeof part);
      if (size == 0) break;
      text.append(part, size);
    }
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
  }

  // Reads until `last` has come, for 10 s at most, and returns whether it has. Allocates nothing.
  bool has_until(std::string_view last) const {
    const Stopwatch watch;
    char part[4096];
    std::size_t kept = 0;  // of the end of what was read before, in which `last` may begin
    while (seconds_since(watch) < 10.0) {
      pollfd place{ends_[0], POLLIN, 0};
      if (poll(&place, 1, 100) <= 0) continue;
      const std::string_view text(part, kept + read_some(part + kept, sizeof part - kept));
      if (text.find(last) != text.npos) return true;
      kept = std::min(text.size(), last.size() - 1);
      std::copy(text.end() - static_cast<std::ptrdiff_t>(kept), text.end(), part);
    }
    return false;
  }

 private:
  int ends_[2] = {-1, -1};
};

std::string line_of(int number) { return "line " + std::to_string(number) + "\n"; }

// More than pipe and queue have room for.
int write_too_much(LogThread* writer) {
  constexpr int kLines = 20'000;
  for (int i = 0; i < kLines; ++i) writer->write(line_of(i));
  return kLines;
}

// A file that takes `bytes` only, as on a disk that is full then, as long as this lives.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    REQUIRE(getrlimit(RLIMIT_FSIZE, &before_) == 0);
    const rlimit limit{bytes, before_.rlim_max};
    REQUIRE(setrlimit(RLIMIT_FSIZE, &limit) == 0);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }

 private:
  rlimit before_{};
};

std::vector<std::string> lines_of(const std::string& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

// How many lines are said to be lost.
std::uint64_t told_of(const std::vector<std::string>& lines) {
  constexpr std::string_view kBegin = " warning: log: ";
  std::uint64_t told = 0;
  for (const std::string& line : lines)
    if (const std::size_t at = line.find(kBegin); at != line.npos)
      told += std::stoull(line.substr(at + kBegin.size()));
  return told;
}

template <typename Is>
bool comes(Is is) {
  const Stopwatch watch;
  while (!is() && seconds_since(watch) < 10.0) test::wait_a_moment();
  return is();
}

}  // namespace

TEST_CASE("the lines of the log come out in order, before and after the writer has its thread") {
  Pipe pipe;
  LogThread writer(pipe.in(), "program");
  writer.write("first\n");
  writer.start();
  writer.write("second\n");
  writer.finish();
  writer.write("third\n");
  CHECK(pipe.lines_until("third") == std::vector<std::string>{"first", "second", "third"});
  CHECK(writer.lost() == 0);
}

TEST_CASE("a log that nobody reads lets nobody wait, and says what was lost once it is read") {
  Pipe pipe;
  LogThread writer(pipe.in(), "program");
  writer.start();
  const Stopwatch watch;
  const int written = write_too_much(&writer);
  CHECK(seconds_since(watch) < 2.0);
  const std::uint64_t lost = writer.lost();
  REQUIRE(lost > 0);

  const std::vector<std::string> lines = pipe.lines_until("lost");
  REQUIRE(lines.size() == static_cast<std::size_t>(written) - lost + 1);
  for (std::size_t i = 0; i + 1 < lines.size(); ++i)
    CHECK(lines[i] + "\n" == line_of(static_cast<int>(i)));
  CHECK(lines.back().starts_with("program "));
  CHECK(lines.back().ends_with(" warning: log: " + std::to_string(lost) + " lines lost"));

  writer.write("it goes on\n");
  CHECK(pipe.lines_until("on") == std::vector<std::string>{"it goes on"});
  CHECK(writer.lost() == lost);
}

TEST_CASE("the end of a log that nobody reads comes in time") {
  Pipe pipe;
  auto writer = std::make_unique<LogThread>(pipe.in(), "program");
  writer->start();
  write_too_much(writer.get());
  const Stopwatch watch;
  writer->finish();
  writer->write("too late\n");
  CHECK(writer->lost() > 0);
  writer.reset();
  CHECK(seconds_since(watch) < LogThread::kLongestEnd_s + 1.0);
  pipe.lines_until("lost");  // lets the thread go
}

TEST_CASE("the end of a log that is read waits until all is written") {
  Pipe pipe;
  LogThread writer(pipe.in(), "program");
  writer.start();
  for (int i = 0; i < 300; ++i) writer.write(line_of(i));
  writer.finish();
  CHECK(pipe.lines_until("line 299").size() == 300);
}

TEST_CASE("without a thread a log that nobody reads costs a moment, and tells what was lost") {
  Pipe pipe;
  LogThread writer(pipe.in(), "program");
  const Stopwatch watch;
  const int written = write_too_much(&writer);
  CHECK(seconds_since(watch) < 2.0);
  const std::uint64_t lost = writer.lost();
  REQUIRE(lost > 0);
  pipe.lines_until(line_of(written - 1 - static_cast<int>(lost)));
  writer.write("it goes on\n");
  const std::vector<std::string> lines = pipe.lines_until("goes on");
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].ends_with(" warning: log: " + std::to_string(lost) + " lines lost"));
  CHECK(lines[1] == "it goes on");
}

TEST_CASE("lines that a full disk refuses are counted, and told once there is room again") {
  const bool has_thread = GENERATE(true, false);
  CAPTURE(has_thread);
  const test::TemporaryFile file("log", "");
  const int descriptor = open(file.path().c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  REQUIRE(descriptor >= 0);
  constexpr int kLines = 1000;  // several parts of the queue
  constexpr std::size_t kWhole = 300;
  std::size_t room = 3;  // of the line that is torn
  for (std::size_t i = 0; i < kWhole; ++i) room += line_of(static_cast<int>(i)).size();
  LogThread writer(descriptor, "program");
  {
    const FullDisk full(room);
    if (has_thread) writer.start();
    for (int i = 0; i < kLines; ++i) writer.write(line_of(i));
    CHECK(comes([&] { return writer.lost() == kLines - kWhole; }));
  }
  writer.write("there is room again\n");  // dropped, if the others are not yet told
  CHECK(comes([&] { return told_of(lines_of(file.path())) == writer.lost(); }));
  writer.write("it goes on\n");
  writer.finish();
  close(descriptor);
  const std::vector<std::string> lines = lines_of(file.path());
  REQUIRE(lines.size() > kWhole + 2);
  for (std::size_t i = 0; i < kWhole; ++i) CHECK(lines[i] + "\n" == line_of(static_cast<int>(i)));
  CHECK(lines[kWhole] == "lin");
  CHECK(lines[kWhole + 1].starts_with("program "));
  CHECK(lines.back() == "it goes on");
  CHECK(told_of(lines) == writer.lost());
}

TEST_CASE("a disk that stays full does not keep a log from its end") {
  const int descriptor = open("/dev/full", O_WRONLY | O_CLOEXEC);
  REQUIRE(descriptor >= 0);
  LogThread writer(descriptor, "program");
  writer.start();
  for (int i = 0; i < 10; ++i) writer.write(line_of(i));
  const Stopwatch watch;
  writer.finish();
  CHECK(seconds_since(watch) < 1.0);
  CHECK(writer.lost() == 10);
  close(descriptor);
}

TEST_CASE("a reader that has gone ends no program that logs") {
  Pipe pipe;
  pipe.close_reader();
  LogThread writer(pipe.in(), "program");
  writer.start();  // the test has not set SIGPIPE aside: the thread blocks it
  for (int i = 0; i < 10; ++i) writer.write(line_of(i));
  writer.finish();
  SUCCEED("the program is still there");
}

TEST_CASE("a log allocates nothing once it has begun") {
  Pipe pipe;
  LogThread writer(pipe.in(), "program");
  writer.start();
  start_counting_allocations();
  for (int i = 0; i < 20'000; ++i) writer.write("a line that is always the same\n");
  CHECK(stop_counting_allocations() == 0);
  REQUIRE(writer.lost() > 0);
  start_counting_allocations();
  CHECK(pipe.has_until("lost"));
  CHECK(stop_counting_allocations() == 0);
}
