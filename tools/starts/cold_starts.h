// ColdStarts runs many cold starts within one recorded run.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/lcm/decode.h"
#include "tools/starts/cold_start.h"

namespace leonav {

// Chooses instants for the four kinds of motion, `number` of each where the truth has so many, in
// order of time. Throws std::runtime_error if the truth is shorter than `seconds`.
std::vector<GpsTime> choose_starts(const Track& truth, int number, double seconds,
                                   std::uint64_t seed);

// ColdStarts holds the starts that are under way while the log is read once.
class ColdStarts {
 public:
  // `given_heading_error` is index-parallel to `instants`, or empty if no heading is given.
  ColdStarts(const NavigatorConfig& config, const Track& truth, std::vector<GpsTime> instants,
             std::vector<double> given_heading_error, double seconds)
      : config_(config),
        truth_(truth),
        instants_(std::move(instants)),
        given_heading_errors_(std::move(given_heading_error)),
        seconds_(seconds) {}

  void take(Channel channel, const std::vector<std::uint8_t>& data);
  std::vector<StartResult> finish();
  // Returns how many instants the log ends before.
  std::size_t not_begun() const { return instants_.size() - next_; }
  // Returns how many of the starts begun were ended by the log before `seconds`. Precondition:
  // finish().
  std::size_t cut_short() const { return cut_short_; }

 private:
  void move_to(GpsTime now);
  void end_first();

  const NavigatorConfig& config_;
  const Track& truth_;
  std::vector<GpsTime> instants_;
  std::vector<double> given_heading_errors_;
  double seconds_;
  std::size_t next_ = 0, cut_short_ = 0;
  GpsTime now_;
  Decoder decoder_;
  std::vector<Product> products_;
  std::deque<std::unique_ptr<ColdStart>> under_way_;
  std::vector<StartResult> results_;
};

}  // namespace leonav
