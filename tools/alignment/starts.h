// Many cold starts in one recorded run.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/lcm/decode.h"
#include "tools/alignment/start.h"

namespace leonav {

// Instants of the four ways of starting, `number` of each where the truth has so many, in order of
// time. Throws std::runtime_error where the truth is shorter than `seconds`.
std::vector<GpsTime> choose_starts(const Track& truth, int number, double seconds,
                                   std::uint64_t seed);

// The starts that are under way while the log is read once.
class Starts {
 public:
  // `told_off`: index-parallel to `instants`, or empty: nothing is told.
  Starts(const NavigatorConfig& config, const Track& truth, std::vector<GpsTime> instants,
         std::vector<double> told_off, double seconds)
      : config_(config),
        truth_(truth),
        instants_(std::move(instants)),
        told_off_(std::move(told_off)),
        seconds_(seconds) {}

  void take(Channel channel, const std::vector<std::uint8_t>& data);
  std::vector<StartResult> finish();
  // Of the instants: those that the log ends before.
  std::size_t not_begun() const { return instants_.size() - next_; }
  // Of the starts begun: those that the log ends before their `seconds` are over. After finish().
  std::size_t cut_short() const { return cut_short_; }

 private:
  void move_to(GpsTime now);
  void end_first();

  const NavigatorConfig& config_;
  const Track& truth_;
  std::vector<GpsTime> instants_;
  std::vector<double> told_off_;
  double seconds_;
  std::size_t next_ = 0, cut_short_ = 0;
  GpsTime now_;
  Decoder decoder_;
  std::vector<Product> products_;
  std::deque<std::unique_ptr<Start>> under_way_;
  std::vector<StartResult> results_;
};

}  // namespace leonav
