// A checkpoint comes back from the wire as it was; a hostile one does not.
#include <algorithm>
#include <cmath>
#include <functional>
#include <leonav/checkpoint_v1_t.hpp>
#include <leonav/checkpoint_v2_t.hpp>
#include <limits>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/encode.h"
#include "support/catch.h"
#include "support/programs/parked_checkpoint.h"

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
  REQUIRE(got.calibration);
  CHECK(got.calibration->mounting_rpy == sent.calibration->mounting_rpy);
  CHECK(got.calibration->accel_bias_b == sent.calibration->accel_bias_b);
  CHECK(got.calibration->accel_bias_sigma == sent.calibration->accel_bias_sigma);
  CHECK(got.calibration->gyro_scale == sent.calibration->gyro_scale);
  CHECK(got.calibration->gyro_scale_sigma == sent.calibration->gyro_scale_sigma);
  CHECK(got.calibration->accel_scale == sent.calibration->accel_scale);
  CHECK(got.calibration->accel_scale_sigma == sent.calibration->accel_scale_sigma);
  CHECK(got.calibration->constants == sent.calibration->constants);
  CHECK(got.calibration->constant_sigmas == sent.calibration->constant_sigmas);
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

TEST_CASE("a hostile calibration is refused, each number of it by itself") {
  Encoder encoder;
  Decoder decoder;
  const auto fault_of = [&](const std::function<void(Calibration*)>& spoil) {
    Checkpoint checkpoint = parked(), got;
    spoil(&*checkpoint.calibration);
    return decoder.decode(encoder.encode(checkpoint, 1), &got).fault;
  };
  using enum InputFault;
  using Vector = Eigen::Vector3d Calibration::*;
  for (const Vector of :
       {&Calibration::mounting_rpy, &Calibration::accel_bias_b, &Calibration::accel_bias_sigma,
        &Calibration::gyro_scale, &Calibration::gyro_scale_sigma, &Calibration::accel_scale,
        &Calibration::accel_scale_sigma}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double bad :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        CHECK(fault_of([&](Calibration* c) { (c->*of)[axis] = bad; }) == kNotFinite);
      CHECK(fault_of([&](Calibration* c) { (c->*of)[axis] = 1e3; }) == kOutOfRange);
    }
  }
  for (const Vector sigma : {&Calibration::accel_bias_sigma, &Calibration::gyro_scale_sigma,
                             &Calibration::accel_scale_sigma})
    CHECK(fault_of([&](Calibration* c) { (c->*sigma)[1] = -1e-3; }) == kOutOfRange);
  for (std::size_t i = 0; i < ekf_index::kMaxVehicle; ++i) {
    CAPTURE(i);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(fault_of([&](Calibration* c) { c->constants[i] = nan; }) == kNotFinite);
    CHECK(fault_of([&](Calibration* c) { c->constant_sigmas[i] = nan; }) == kNotFinite);
    CHECK(fault_of([&](Calibration* c) { c->constants[i] = -2e3; }) == kOutOfRange);
    CHECK(fault_of([&](Calibration* c) { c->constant_sigmas[i] = -1e-3; }) == kOutOfRange);
    CHECK(fault_of([&](Calibration* c) { c->constant_sigmas[i] = 0.0; }) == kNone);
  }
  Checkpoint without = parked(), got = parked();
  without.calibration.reset();
  CHECK(decoder.decode(encoder.encode(without, 1), &got).fault == kNone);
  CHECK_FALSE(got.calibration);
}

namespace {

template <typename T>
std::vector<std::uint8_t> older_message(std::int32_t schema, T message) {
  const Checkpoint sent = parked();
  message.time_ns = sent.time.nanoseconds();
  message.sequence = 1;
  message.schema = schema;
  message.standing = 1;
  std::copy(sent.antenna_p_e.begin(), sent.antenna_p_e.end(), message.antenna_p_e);
  message.antenna_sigma_m = sent.antenna_sigma;
  message.heading_rad = sent.heading;
  message.heading_sigma_rad = sent.heading_sigma;
  message.gyro_bias_sigma = sent.gyro_bias_sigma;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace

TEST_CASE("a checkpoint of an older journal is read, without what it had not") {
  const Checkpoint sent = parked();
  const std::vector<std::uint8_t> bytes = older_message(1, checkpoint_v1_t{});
  Decoder decoder;
  Checkpoint got = sent;
  REQUIRE(decoder.decode(bytes, &got).fault == InputFault::kNone);
  CHECK(got.heading == sent.heading);
  CHECK(got.antenna_p_e == sent.antenna_p_e);
  CHECK(got.code_sigma_factor == 0.0);
  CHECK(got.doppler_sigma_factor == 0.0);
  CHECK_FALSE(got.calibration);

  checkpoint_v2_t second{};
  second.code_sigma_factor = 2.5;
  second.doppler_sigma_factor = 1.5;
  got = sent;
  REQUIRE(decoder.decode(older_message(2, second), &got).fault == InputFault::kNone);
  CHECK(got.heading == sent.heading);
  CHECK(got.code_sigma_factor == 2.5);
  CHECK(got.doppler_sigma_factor == 1.5);
  CHECK_FALSE(got.calibration);
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
  bytes[27] = 4;  // schema
  CHECK(decoder.decode(bytes, &got).fault == InputFault::kUnknownSchema);
  for (const std::uint8_t older : {1, 2}) {
    bytes[27] = older;  // of another type
    CHECK(decoder.decode(bytes, &got).fault == InputFault::kUndecodable);
  }
  bytes[27] = 3;
  bytes[28] = 2;  // standing
  CHECK(decoder.decode(bytes, &got).fault == InputFault::kOutOfRange);
}
