// The line through arrivals, on delays that are made here: exponential queues over a least delay.
#include "tools/connect/stamps/envelope_line.h"

#include <cmath>
#include <random>

#include "support/catch.h"

namespace leonav {
namespace {

constexpr double kLeast_s = 0.004;

// A sensor whose clock runs `ppm` fast and began `start_s` before the host's, seen through a queue.
class Wire {
 public:
  Wire(double ppm, double queue_s) : ppm_(ppm), queue_s_(queue_s) {}

  // Sends from `from_s` to `to_s` of the host's time; `shift_s`: the sensor's clock has been set.
  void send(double from_s, double to_s, double rate_hz, EnvelopeLine* line, double shift_s = 0.0) {
    std::exponential_distribution<double> queue(1.0 / queue_s_);
    for (double t = from_s; t < to_s; t += 1.0 / rate_hz) {
      line->add(clock_ns(t, shift_s), std::llround((t + kLeast_s + queue(dice_)) * 1e9));
    }
  }
  std::int64_t clock_ns(double t, double shift_s = 0.0) const {
    return std::llround((7.0 + t * (1.0 + ppm_ * 1e-6) + shift_s) * 1e9);
  }
  // How far the line is from the truth at t, s.
  double error_s(const EnvelopeLine& line, double t, double shift_s = 0.0) const {
    return static_cast<double>(line.arrival_ns(clock_ns(t, shift_s))) * 1e-9 - (t + kLeast_s);
  }

 private:
  double ppm_, queue_s_;
  std::mt19937 dice_{1};
};

}  // namespace

TEST_CASE("A clock that drifts 100 ppm is followed within a tenth of the queue", "[connect]") {
  for (const double ppm : {-100.0, 0.0, 100.0}) {
    EnvelopeLine line;
    Wire wire(ppm, 0.002);
    wire.send(0.0, 4.0, 200.0, &line);
    CHECK_FALSE(line.is_ready());
    wire.send(4.0, 7.0, 200.0, &line);
    REQUIRE(line.is_ready());
    CHECK(std::abs(wire.error_s(line, 7.0)) < 1e-3);
    wire.send(7.0, 90.0, 200.0, &line);
    CHECK(std::abs(wire.error_s(line, 90.0)) < 0.1e-3);
    CHECK(line.drift() * 1e6 == Approx(-ppm).margin(3.0));
    CHECK(line.sigma_s() < 0.1e-3);
    CHECK(line.steps() == 0);
    const std::int64_t clock_ns = wire.clock_ns(85.0);
    CHECK(std::abs(line.clock_ns(line.arrival_ns(clock_ns)) - clock_ns) <= 2);
  }
}

TEST_CASE("Stalls of the host move the line by nothing", "[connect]") {
  EnvelopeLine line;
  Wire wire(20.0, 0.001);
  wire.send(0.0, 40.0, 100.0, &line);
  // Three seconds of messages come late by 1.5 s.
  for (double t = 40.0; t < 43.0; t += 0.01) {
    line.add(wire.clock_ns(t), std::llround((t + 1.5) * 1e9));
  }
  CHECK(std::abs(wire.error_s(line, 43.0)) < 0.2e-3);
  wire.send(43.0, 50.0, 100.0, &line);
  CHECK(std::abs(wire.error_s(line, 50.0)) < 0.2e-3);
}

TEST_CASE("A step of either clock is followed within five seconds and told", "[connect]") {
  for (const double shift_s : {-0.03, 0.02, 300.0, -50.0}) {
    EnvelopeLine line;
    Wire wire(20.0, 0.001);
    wire.send(0.0, 40.0, 100.0, &line);
    CHECK_FALSE(line.agrees(wire.clock_ns(40.0, 300.0), std::llround(40.01 * 1e9)));
    wire.send(40.0, 47.0, 100.0, &line, shift_s);
    CAPTURE(shift_s);
    CHECK(line.steps() == 1);
    // The drift of 20 ppm over the step is in it.
    CHECK(line.last_step_s() == Approx(-shift_s).margin(2e-3 + 25e-6 * std::abs(shift_s)));
    CHECK(std::abs(wire.error_s(line, 47.0, shift_s)) < 1e-3);
  }
}

TEST_CASE("A clock that learns the date begins a line of its own", "[connect]") {
  EnvelopeLine line;
  Wire wire(20.0, 0.001);
  wire.send(0.0, 20.0, 100.0, &line);
  constexpr double kDate_s = 1.6e9;
  wire.send(20.0, 28.0, 100.0, &line, kDate_s);
  CHECK(line.steps() == 1);
  REQUIRE(line.is_ready());
  CHECK(std::abs(wire.error_s(line, 28.0, kDate_s)) < 1e-3);
  CHECK_FALSE(line.agrees(-4'000'000'000'000'000'000, 0));
}

TEST_CASE("Two clocks on one wire make no line, and one that is left does", "[connect]") {
  // Many messages arrive at once.
  const auto send_both = [](EnvelopeLine* line, double from_s, double to_s) {
    for (double t = from_s; t < to_s; t += 0.02) {
      for (int i = 0; i < 20; ++i) {
        line->add(i % 2 == 0 ? 1'040'000'000 : 0, std::llround(t * 1e9));
        if (!line->is_ready()) continue;
        REQUIRE(std::isfinite(line->sigma_s()));
        REQUIRE(std::abs(line->arrival_ns(0)) < 100'000'000'000);
      }
    }
  };
  Wire wire(20.0, 0.001);
  EnvelopeLine line;
  send_both(&line, 0.0, 0.5);
  CHECK_FALSE(line.is_ready());
  CHECK(line.setbacks() > 1);
  wire.send(1.0, 20.0, 100.0, &line);  // one of them is left
  REQUIRE(line.is_ready());
  CHECK(std::abs(wire.error_s(line, 20.0)) < 1e-3);
  const std::uint64_t setbacks = line.setbacks();
  wire.send(20.0, 60.0, 100.0, &line);
  CHECK(line.setbacks() == setbacks);
}

TEST_CASE("One message a second suffices", "[connect]") {
  EnvelopeLine line;
  Wire wire(5.0, 0.005);
  wire.send(0.0, 60.0, 1.0, &line);
  REQUIRE(line.is_ready());
  CHECK(std::abs(wire.error_s(line, 60.0)) < 5e-3);
}

}  // namespace leonav
