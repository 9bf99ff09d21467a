// This unit decodes a Septentrio byte stream (SBF) to observations, ephemerides, ionosphere
// coefficients, group delays, pages of corrections and inertial measurements. Source: mosaic-X5 and
// AsteRx SBi3 Pro+ Reference Guides.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "core/gnss/signals/observation.h"
#include "drivers/binary/correction_page.h"
#include "drivers/binary/ephemeris_status.h"
#include "drivers/binary/range_epoch.h"
#include "drivers/sbf/ext_sensor_meas.h"
#include "drivers/sbf/raw_navigation.h"
#include "drivers/sbf/sbf_framer.h"

namespace leonav {

// The handler gets the decoder's results in the order of the stream.
class SbfHandler {
 public:
  virtual ~SbfHandler() = default;
  virtual void on_epoch(const RawEpoch& epoch) = 0;
  virtual void on_ephemeris(const Ephemeris& ephemeris) = 0;
  virtual void on_klobuchar(const KlobucharModel& model) = 0;
  // Group delays of one satellite; a page of Galileo HAS or PPP-B2b, received at the time of its
  // block; measurements of an inertial sensor. Who does not need one leaves it as it is.
  virtual void on_biases(const std::vector<SignalBias>& /*biases*/) {}
  virtual void on_page(const CorrectionPage& /*page*/) {}
  virtual void on_imu(const ExtSensorRates& /*rates*/) {}
};

// Counts of blocks with measurements that gave no epoch, and of measurements left out.
struct MeasEpochCounters {
  std::uint64_t bad_length = 0;      // the block does not hold what it claims
  std::uint64_t without_time = 0;    // the receiver did not know the time
  std::uint64_t scrambled = 0;       // for want of a permission of the receiver
  std::uint64_t other_antennas = 0;  // measurements of antennas other than the main one
};

// Counts of blocks with navigation data that the receiver has decoded.
struct DecodedNavigationCounters : EphemerisRefusals {
  std::uint64_t beside_raw = 0;      // not needed: the bits come too
  std::uint64_t without_time = 0;    // the receiver did not know the time
  std::uint64_t bad_ionosphere = 0;  // GPSIon that is too short or not finite
};

// Counts of all parts of the decoder.
struct SbfCounters {
  SbfFramerCounters framer;
  MeasEpochCounters measurements;
  RangeEpochCounters epochs;
  NavigationCounters navigation;
  RawNavigationCounters raw;
  DecodedNavigationCounters decoded;
  ExtSensorCounters imu;
  std::map<std::uint16_t, std::uint64_t> unused;  // other blocks, by number
  CapacityLosses losses;                          // signals that did not fit into their epoch
};

// Returns the name of a block and, where it helps, what to turn on instead; its number if it is
// unknown.
std::string unused_block_text(std::uint16_t number);

// The decoder streams: chunks of any size, no recursion, bounded memory. A MeasEpoch is a whole
// epoch and given out with its last byte. An ephemeris and a set of coefficients are given out once
// per contents.
class SbfDecoder {
 public:
  SbfDecoder();
  ~SbfDecoder();

  void feed(std::span<const std::uint8_t> bytes, SbfHandler* handler);
  // Ends the stream and decodes the bytes that a false sync near the end still holds back.
  void finish(SbfHandler* handler);
  SbfCounters counters() const;

 private:
  void drain(SbfHandler* handler);
  void dispatch(const SbfBlock& block, SbfHandler* handler);
  void take_measurements(const SbfBlock& block, SbfHandler* handler);
  void take_raw_navigation(const SbfBlock& block, SbfHandler* handler);
  bool take_decoded_navigation(const SbfBlock& block, SbfHandler* handler);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
