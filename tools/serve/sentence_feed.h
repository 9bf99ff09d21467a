// The SentenceFeed makes the sentences of one instant from the newest solution and epoch.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "drivers/lcm/decode_output.h"
#include "drivers/nmea/sky_view.h"
#include "tools/serve/output_pace.h"
#include "tools/serve/output_queue.h"
#include "tools/serve/serve_config.h"

namespace leonav {

class SentenceFeed {
 public:
  // Satellites of an epoch that is further away are not told.
  static constexpr double kLongestSkyAge_s = 5.0;

  explicit SentenceFeed(const ServeConfig& config)
      : kinds_(config.sentences), fix_(config.fix), pace_(config.rate_hz) {}

  // Takes SOLUTION. Returns its sentences, or null where none are due or it cannot be read.
  std::shared_ptr<const Batch> on_solution(std::span<const std::uint8_t> bytes);
  // Takes EPOCH.
  void on_epoch(std::span<const std::uint8_t> bytes);

  std::uint64_t solutions() const { return solutions_; }
  std::uint64_t refused() const { return refused_; }  // messages that cannot be read
  const Solution& last() const { return last_; }

 private:
  std::shared_ptr<const Batch> sentences_of(const Solution& solution) const;

  std::vector<SentenceKind> kinds_;
  FixOptions fix_;
  OutputPace pace_;
  std::optional<SkyView> sky_;
  Solution last_;
  EpochInView epoch_;
  std::uint64_t solutions_ = 0, refused_ = 0;
};

}  // namespace leonav
