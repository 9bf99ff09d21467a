// RecordedStreet is the family of street errors that are pieces of the residuals of recorded runs.
#pragma once
#include <cstdint>

#include "tools/sim/street/street_errors.h"

namespace leonav::sim {

// A moving-block bootstrap (Kuensch, Annals of Statistics 17, 1989): a block begins at a row drawn
// from all recorded ones of the satellite's class of elevation, and goes on as the recording did,
// to the end of its piece or for block_s. Between the recorded epochs the last one holds. Blocks of
// different satellites are independent.
//
// What the recording contains replaces the receiver's noise. A second signal that it lacks has the
// error of the first, with the receiver's noise.
class RecordedStreet : public StreetErrors {
 public:
  RecordedStreet(const StreetErrorsConfig& config, std::uint64_t seed, std::size_t satellite);

  StreetEffect at(const SatelliteSight& sight) override;

 private:
  struct Block {
    double from_s = 0.0, to_s = 0.0, interval_s = 1.0;
    std::size_t first = 0;
  };
  void begin_block(double from_s, double elevation);
  void go_to(std::size_t row, StreetEffect* effect);
  void enter(std::size_t row, StreetEffect* effect);

  StreetErrorsConfig config_;
  std::uint64_t seed_;
  std::size_t satellite_;
  Block block_;
  unsigned blocks_ = 0, gaps_ = 0;  // so far; gaps: epochs without a carrier
  std::size_t row_ = 0;             // the last one that was entered
};

}  // namespace leonav::sim
