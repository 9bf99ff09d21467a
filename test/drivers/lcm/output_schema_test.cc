#include "drivers/lcm/output_schema.h"

#include <cmath>
#include <leonav/epoch_t.hpp>
#include <leonav/epoch_v1_t.hpp>
#include <leonav/smoother_v1_t.hpp>
#include <leonav/solution_t.hpp>
#include <leonav/solution_v1_t.hpp>
#include <memory>

#include "drivers/lcm/decode.h"
#include "drivers/lcm/encode.h"
#include "support/catch.h"

using namespace leonav;

namespace {

Solution solution() {
  Solution solution;
  solution.sequence = 5;
  solution.time = GpsTime::from_week_and_tow(2300, 1000.0);
  solution.source = Source::kEkf;
  solution.p_e = {1.0, 2.0, 3.0};
  solution.jump_m = 0.25;
  solution.horizontal_protection_m = 4.5;
  solution.vertical_protection_m = 6.5;
  return solution;
}

template <typename T>
T decoded(ByteSpan bytes) {
  T message;
  const int size = static_cast<int>(bytes.size());
  REQUIRE(message.decode(bytes.data(), 0, size) == size);
  return message;
}

std::uint64_t fingerprint(ByteSpan bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) value = value << 8 | bytes[i];
  return value;
}

}  // namespace

TEST_CASE("a solution carries its levels, NaN where there is none, under schema 2") {
  Encoder encoder;
  const ByteSpan bytes = encoder.encode(solution());
  CHECK(output_schema_of(Channel::kSolution, bytes) == OutputSchema::kNewest);
  const auto message = decoded<solution_t>(bytes);
  CHECK(message.schema == 2);
  CHECK(message.jump_m == 0.25);
  CHECK(message.horizontal_protection_m == 4.5);
  CHECK(message.vertical_protection_m == 6.5);
  CHECK(std::isnan(message.heading_protection_rad));
}

TEST_CASE("outputs of the first schema are those of the programs that wrote it") {
  // Fingerprints of solution_t, epoch_t and smoother_t before they had protection levels.
  constexpr std::uint64_t kSolution = 0xe7ace7f8804f75d7, kEpoch = 0x1f4f6d83cb476860,
                          kSmoother = 0x492fab20c3d9e68d;
  Encoder encoder(OutputSchema::kFirst);
  ByteSpan bytes = encoder.encode(solution());
  CHECK(fingerprint(bytes) == kSolution);
  CHECK(output_schema_of(Channel::kSolution, bytes) == OutputSchema::kFirst);
  const auto message = decoded<solution_v1_t>(bytes);
  CHECK(message.schema == 1);
  CHECK(message.sequence == 5);
  CHECK(message.p_e[2] == 3.0);
  CHECK(message.jump_m == 0.25);

  const auto report = std::make_unique<EpochReport>();
  report->time = solution().time;
  report->index = 9;
  report->solution = solution();
  report->satellites.resize(3);
  report->aiding.resize(2);
  bytes = encoder.encode(*report);
  CHECK(fingerprint(bytes) == kEpoch);
  CHECK(output_schema_of(Channel::kEpoch, bytes) == OutputSchema::kFirst);
  const auto epoch = decoded<epoch_v1_t>(bytes);
  CHECK(epoch.schema == 1);
  CHECK(epoch.index == 9);
  CHECK(epoch.solution.schema == 1);
  CHECK(epoch.satellites.size() == 3);

  SmootherReport smoother;
  smoother.solution = solution();
  smoother.index = 4;
  smoother.iterations = 3;
  bytes = encoder.encode(smoother);
  CHECK(fingerprint(bytes) == kSmoother);
  CHECK(decoded<smoother_v1_t>(bytes).schema == 1);
}

TEST_CASE("an epoch tells its levels and how many faults they allow for") {
  const auto report = std::make_unique<EpochReport>();
  report->time = solution().time;
  report->solution = solution();
  report->fault_hypotheses.resize(2);
  Encoder encoder;
  const auto message = decoded<epoch_t>(encoder.encode(*report));
  CHECK(message.schema == 2);
  CHECK(message.solution.schema == 2);
  CHECK(message.solution.horizontal_protection_m == 4.5);
  CHECK(message.fault_hypotheses == 2);
}

TEST_CASE("the smoother's iterations are read from either schema") {
  SmootherReport report;
  report.solution = solution();
  report.sequence = 2;
  report.index = 4;
  report.iterations = 3;
  Decoder decoder;
  for (const OutputSchema schema : {OutputSchema::kFirst, OutputSchema::kNewest}) {
    Encoder encoder(schema);
    SmootherReport back;
    const ByteSpan bytes = encoder.encode(report);
    REQUIRE(decoder.decode(bytes, &back).fault == InputFault::kNone);
    CHECK(back.index == 4);
    CHECK(back.iterations == 3);
    // Cut short, it is no message of either.
    CHECK(decoder.decode(bytes.first(bytes.size() - 1), &back).fault == InputFault::kUndecodable);
  }
}

TEST_CASE("messages without versions, of unknown ones, or cut short have no schema") {
  Encoder encoder;
  const ByteSpan bytes = encoder.encode(solution());
  CHECK_FALSE(output_schema_of(Channel::kEvent, bytes));
  CHECK_FALSE(output_schema_of(Channel::kImu, bytes));
  CHECK_FALSE(output_schema_of(Channel::kSolution, bytes.first(27)));
  CHECK_FALSE(output_schema_of(Channel::kSolution, {}));
  std::vector<std::uint8_t> other(bytes.begin(), bytes.end());
  other[27] = 3;
  CHECK_FALSE(output_schema_of(Channel::kSolution, other));
}
