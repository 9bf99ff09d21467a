// Who is called back, and how often, while a query of the name server hangs.
#include "drivers/transport/internal/name_lookup.h"

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <chrono>
#include <future>

#include "support/catch.h"

namespace leonav {
namespace {

using Error = NameLookup::Error;
using Results = NameLookup::Results;

// A name server that answers when it is told to.
struct SlowServer {
  NameLookup::Query query() {
    return [this, answer = answer.get_future().share()](const std::string&, const std::string&,
                                                        Error*) {
      ++queries;
      answer.wait();
      return Results();
    };
  }
  std::promise<void> answer;
  std::atomic<int> queries = 0;
};

void run(boost::asio::io_context* io, const int& calls, int wanted) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (calls < wanted && std::chrono::steady_clock::now() < end) {
    io->run_for(std::chrono::milliseconds(10));
  }
  io->run_for(std::chrono::milliseconds(50));  // for calls too many
}

}  // namespace

TEST_CASE("A reconnection while a lookup hangs gets its answer, and the attempt before none",
          "[transport]") {
  boost::asio::io_context io;
  const auto guard = boost::asio::make_work_guard(io);  // it waits for work
  SlowServer server;
  NameLookup lookup(&io, "caster.example", 2101, server.query());
  int first = 0, second = 0;
  lookup.start([&first](const Error&, const Results&) { ++first; });
  io.run_for(std::chrono::milliseconds(20));
  CHECK(lookup.is_asking());
  lookup.cancel();
  lookup.start([&second](const Error&, const Results&) { ++second; });
  CHECK(second == 0);
  server.answer.set_value();
  run(&io, second, 1);
  CHECK(first == 0);
  CHECK(second == 1);
  CHECK(server.queries == 1);
  CHECK_FALSE(lookup.is_asking());
}

TEST_CASE("An answer that nobody waits for any more calls nobody back", "[transport]") {
  boost::asio::io_context io;
  const auto guard = boost::asio::make_work_guard(io);  // it waits for work
  SlowServer server;
  int calls = 0;
  {
    NameLookup lookup(&io, "caster.example", 2101, server.query());
    lookup.start([&calls](const Error&, const Results&) { ++calls; });
    while (server.queries == 0) io.run_for(std::chrono::milliseconds(1));
  }
  server.answer.set_value();
  run(&io, calls, 0);
  CHECK(calls == 0);
}

TEST_CASE("An address that is looked up twice is answered once, to who asked last", "[transport]") {
  boost::asio::io_context io;
  const auto guard = boost::asio::make_work_guard(io);  // it waits for work
  NameLookup lookup(&io, "192.0.2.1", 2101);
  int first = 0, second = 0;
  lookup.start([&first](const Error&, const Results&) { ++first; });
  lookup.cancel();
  lookup.start([&second](const Error& error, const Results& found) {
    CHECK_FALSE(error);
    CHECK(found.size() == 1);
    ++second;
  });
  CHECK(second == 0);
  run(&io, second, 1);
  CHECK(first == 0);
  CHECK(second == 1);
}

}  // namespace leonav
