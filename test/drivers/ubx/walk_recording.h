// The recorded u-blox stream of the walk, decoded once for all tests.
#pragma once
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "drivers/ubx/ubx_decoder.h"
#include "support/recorded/shared_data.h"

namespace leonav::test {

inline constexpr const char* kWalkUbx = "walk/gnss.ubx";

struct UbxCollector : UbxHandler {
  void on_epoch(const RawEpoch& epoch) override { epochs.push_back(epoch); }
  void on_ephemeris(const Ephemeris& ephemeris) override { ephemerides.push_back(ephemeris); }
  void on_klobuchar(const KlobucharModel& model) override { klobuchars.push_back(model); }
  void on_page(const CorrectionPage& page) override { pages.push_back(page); }
  void on_biases(const std::vector<SignalBias>& of_satellite) override {
    biases.insert(biases.end(), of_satellite.begin(), of_satellite.end());
  }

  std::vector<RawEpoch> epochs;
  std::vector<Ephemeris> ephemerides;
  std::vector<KlobucharModel> klobuchars;
  std::vector<CorrectionPage> pages;
  std::vector<SignalBias> biases;
  UbxCounters counters;
};

inline std::vector<std::uint8_t> read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline UbxCollector decode_ubx(std::span<const std::uint8_t> bytes, std::size_t chunk = 4096,
                               const RxmRawxOptions& options = {}) {
  UbxCollector collector;
  UbxDecoder decoder(options);
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(chunk, bytes.size()))) {
    decoder.feed(bytes.first(std::min(chunk, bytes.size())), &collector);
  }
  decoder.finish(&collector);
  collector.counters = decoder.counters();
  return collector;
}

inline UbxCollector decode_walk(const RxmRawxOptions& options = {}) {
  return decode_ubx(read_bytes(shared_data(kWalkUbx)), 4096, options);
}

}  // namespace leonav::test
