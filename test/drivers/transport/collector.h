// What a source tells its sink, kept for tests, and a source's event loop run until something has
// happened.
#pragma once
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/transport/byte_source.h"

namespace leonav::test {

class Collector : public ByteSink {
 public:
  void on_open() override { ++opened; }
  void on_bytes(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override {
    text.append(bytes.begin(), bytes.end());
    sizes.push_back(bytes.size());
    last_arrival_ns = arrival_ns;
  }
  void on_waiting(const std::string& what) override { waiting.push_back(what); }
  void on_failure(const std::string& why, double retry_s) override {
    failures.push_back(why);
    waits_s.push_back(retry_s);
  }
  void on_end(const std::string& why) override { ends.push_back(why); }

  int opened = 0;
  std::string text;
  std::vector<std::size_t> sizes;  // of the pieces of `text`
  std::int64_t last_arrival_ns = 0;
  std::vector<std::string> waiting, failures, ends;
  std::vector<double> waits_s;  // until the next attempt, of each failure
};

// Runs until `done`, fifteen seconds at most.
template <typename Done>
bool run_until(boost::asio::io_context* io, Done done) {
  for (int i = 0; i < 1500 && !done(); ++i) {
    io->restart();
    io->run_for(std::chrono::milliseconds(10));
  }
  return done();
}

}  // namespace leonav::test
