// A checkpoint comes back from the wire as it was; a hostile one does not.
#include <algorithm>
#include <cmath>
#include <functional>
#include <leonav/checkpoint_v1_t.hpp>
#include <limits>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/encode.h"
#include "support/catch.h"
#include "support/parked_checkpoint.h"

using namespace leonav;
using test::parked;

TEST_CASE("a checkpoint survives the wire") {
  Encoder encoder;
  Decoder decoder;
  const Checkpoint sent = parked();
  Checkpoint got;
  const DecodeResult result = decoder.decode(encoder.encode(sent, 3), &got);
  REQUIRE(result.fault == InputFault::kNone);
  CHECK(result.sequence == 3);
  CHECK(got.time == sent.time);
  CHECK(got.standing);
  CHECK(got.antenna_p_e == sent.antenna_p_e);
  CHECK(got.antenna_sigma == sent.antenna_sigma);
  CHECK(got.heading == sent.heading);
  CHECK(got.heading_sigma == sent.heading_sigma);
  CHECK(got.gyro_bias_b == sent.gyro_bias_b);
  CHECK(got.gyro_bias_sigma == sent.gyro_bias_sigma);
  CHECK(got.code_sigma_factor == sent.code_sigma_factor);
  CHECK(got.doppler_sigma_factor == sent.doppler_sigma_factor);
  CHECK(channel_from_name("LEONAV_CHECKPOINT") == Channel::kCheckpoint);
  CHECK(is_input(Channel::kCheckpoint));
  CHECK_FALSE(is_input(Channel::kSolution));
}

TEST_CASE("a hostile checkpoint is refused, whatever is wrong with it") {
  Encoder encoder;
  Decoder decoder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto fault_of = [&](const std::function<void(Checkpoint*)>& spoil) {
    Checkpoint checkpoint = parked(), got;
    spoil(&checkpoint);
    return decoder.decode(encoder.encode(checkpoint, 1), &got).fault;
  };
  using enum InputFault;
  for (const double bad : {nan, infinity, -infinity}) {
    CHECK(fault_of([&](Checkpoint* c) { c->antenna_p_e.y() = bad; }) == kNotFinite);
    CHECK(fault_of([&](Checkpoint* c) { c->antenna_sigma = bad; }) == kNotFinite);
    CHECK(fault_of([&](Checkpoint* c) { c->heading = bad; }) == kNotFinite);
    CHECK(fault_of([&](Checkpoint* c) { c->heading_sigma = bad; }) == kNotFinite);
    CHECK(fault_of([&](Checkpoint* c) { c->gyro_bias_b.z() = bad; }) == kNotFinite);
    CHECK(fault_of([&](Checkpoint* c) { c->gyro_bias_sigma = bad; }) == kNotFinite);
    CHECK(fault_of([&](Checkpoint* c) { c->code_sigma_factor = bad; }) == kNotFinite);
    CHECK(fault_of([&](Checkpoint* c) { c->doppler_sigma_factor = bad; }) == kNotFinite);
  }
  CHECK(fault_of([](Checkpoint* c) { c->time = GpsTime(); }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->time = GpsTime::from_nanoseconds(-1); }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->antenna_p_e *= 1.1; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->antenna_p_e.setZero(); }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->antenna_p_e.setConstant(1e200); }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->antenna_sigma = 0.0; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->heading = 7.0; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->heading_sigma = 0.0; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->heading_sigma = -0.1; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->heading_sigma = 0.2; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->gyro_bias_b.x() = 2.0; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->gyro_bias_sigma = -1.0; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->code_sigma_factor = 0.5; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->doppler_sigma_factor = -2.0; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->doppler_sigma_factor = 1e3; }) == kOutOfRange);
  CHECK(fault_of([](Checkpoint* c) { c->code_sigma_factor = 0.0; }) == kNone);
}

TEST_CASE("a checkpoint of an older journal is read, without sizes of errors") {
  const Checkpoint sent = parked();
  checkpoint_v1_t message{};
  message.time_ns = sent.time.nanoseconds();
  message.sequence = 1;
  message.schema = 1;
  message.standing = 1;
  std::copy(sent.antenna_p_e.begin(), sent.antenna_p_e.end(), message.antenna_p_e);
  message.antenna_sigma_m = sent.antenna_sigma;
  message.heading_rad = sent.heading;
  message.heading_sigma_rad = sent.heading_sigma;
  message.gyro_bias_sigma = sent.gyro_bias_sigma;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  Decoder decoder;
  Checkpoint got = sent;
  REQUIRE(decoder.decode(bytes, &got).fault == InputFault::kNone);
  CHECK(got.heading == sent.heading);
  CHECK(got.antenna_p_e == sent.antenna_p_e);
  CHECK(got.code_sigma_factor == 0.0);
  CHECK(got.doppler_sigma_factor == 0.0);
}

TEST_CASE("a checkpoint cut short, too long, or of another schema is refused") {
  Encoder encoder;
  Decoder decoder;
  const ByteSpan sent = encoder.encode(parked(), 1);
  std::vector<std::uint8_t> bytes(sent.begin(), sent.end());
  Checkpoint got;
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK(decoder.decode(ByteSpan(bytes).first(size), &got).fault == InputFault::kUndecodable);
  bytes.push_back(0);
  CHECK(decoder.decode(bytes, &got).fault == InputFault::kUndecodable);
  bytes.pop_back();
  bytes[27] = 3;  // schema
  CHECK(decoder.decode(bytes, &got).fault == InputFault::kUnknownSchema);
  bytes[27] = 1;  // of another type
  CHECK(decoder.decode(bytes, &got).fault == InputFault::kUndecodable);
  bytes[27] = 2;
  bytes[28] = 2;  // standing
  CHECK(decoder.decode(bytes, &got).fault == InputFault::kOutOfRange);
}
