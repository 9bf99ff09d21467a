// The readers of files, each to the end of the file.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/gnss/orbits/satellite_state.h"
#include "drivers/antex/antex_reader.h"
#include "drivers/bias_sinex/bias_sinex_reader.h"
#include "drivers/blq/blq_reader.h"
#include "drivers/clk/clock_reader.h"
#include "drivers/csv/imu_csv.h"
#include "drivers/csv/leo_elements_csv.h"
#include "drivers/csv/solution_csv.h"
#include "drivers/csv/truth_csv.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/rinex/observation_reader.h"
#include "drivers/rtklib_pos/pos_reader.h"
#include "drivers/sp3/sp3_reader.h"
#include "drivers/text/parse.h"
#include "drivers/transport/recording.h"
#include "test/fuzz/memory_file.h"
#include "test/fuzz/target_groups.h"
#include "tools/import/dataset.h"

namespace leonav::test {
namespace {

// FileError is what every reader documents for a file that it cannot use.
template <typename Read>
void run_reader(FuzzBytes bytes, Read read) {
  try {
    read(path_of_file_with(bytes));
  } catch (const FileError&) {
  }
}

// "leonav recording 1" and the end of the line.
constexpr std::size_t kRecordingLine = 19;

// A reader that has a choice: the length of an input makes it.
template <typename Read>
void run_choice(FuzzBytes bytes, Read read) {
  run_reader(bytes, [&](const std::string& path) { read(path, bytes.size()); });
}

template <typename Rows, typename TimeOf>
void expect_order(const Rows& rows, TimeOf time_of) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    expect(time_of(rows[i - 1]) < time_of(rows[i]), "times do not increase");
  }
}

void read_observations(const std::string& path) {
  ObservationReader reader(path);
  RawEpoch epoch;
  while (reader.next(&epoch)) {
    expect(epoch.time.is_set(), "an epoch without a time");
    expect(!epoch.observations.empty(), "an epoch without an observation");
    for (std::size_t i = 1; i < epoch.observations.size(); ++i) {
      expect(comes_before(epoch.observations[i - 1], epoch.observations[i]),
             "observations are not sorted");
    }
  }
}

void read_clocks(const std::string& path) {
  ClockReader reader(path);
  ClockEpoch epoch;
  while (reader.next(&epoch)) expect(!epoch.states.empty(), "an epoch without a clock");
}

// Of a station without a name, of one by its name, or of one by its number.
void read_loading(const std::string& path, std::size_t which) {
  constexpr std::array<const char*, 3> kStations = {"", "ONSALA", "2"};
  static_cast<void>(ocean_loading(read_blq(path, kStations[which % kStations.size()]).rows));
}

// Of any time, or of one.
void read_antennas(const std::string& path, std::size_t which) {
  const GpsTime time = which % 2 == 0 ? GpsTime() : GpsTime::from_week_and_tow(2200, 0.0);
  const AntexFile file = read_antex(path, {time, antenna_name("TRM59800.00 NONE")});
  for (const AntennaPattern& one : file.satellites) {
    expect(is_storable(one), "a satellite's pattern that no store takes");
  }
  for (const AntennaPattern& one : file.receiver) {
    expect(is_storable(one), "a receiver's pattern that no store takes");
  }
}

void read_biases(const std::string& path) {
  for (SignalBias bias : read_bias_sinex(path).biases) {
    bias.time = GpsTime::from_week_and_tow(2200, 0.0);  // of the reception, which is the caller's
    expect(is_sane(bias), "a bias that is not sane");
  }
}

void read_orbits(const std::string& path) {
  expect_order(read_sp3(path).epochs, [](const Sp3Epoch& one) { return one.time; });
}

void read_samples(const std::string& path) {
  const ImuCsv file = read_imu_csv(path);
  expect(file.samples.size() >= 2, "fewer than two samples");
  expect_order(file.samples, [](const ImuSample& one) { return one.time; });
  for (const ImuSample& one : file.samples) {
    expect(one.interval_ns > 0, "an interval that is not positive");
    expect(one.delta_theta_b.allFinite() && one.delta_velocity_b.allFinite(), "not finite");
  }
}

void read_elements(const std::string& path) {
  const LeoElementsCsv file = read_leo_elements_csv(path);
  expect(!file.ephemerides.empty(), "no set of elements");
  for (const Ephemeris& one : file.ephemerides) {
    expect(is_sane(one) && one.satellite.system == System::kLeo, "elements that are not sane");
    expect(one.transmission_time.is_set(), "elements without a time of transmission");
  }
}

void read_trajectory(const std::string& path) {
  const TruthCsv file = read_truth_csv(path);
  expect(!file.points.empty(), "no point");
  expect_order(file.points, [](const TruthPoint& one) { return one.time; });
}

void read_solution(const std::string& path) {
  expect_order(read_solution_csv(path).rows, [](const SolutionRow& row) { return row.pva.time; });
}

void read_positions(const std::string& path) {
  static_cast<void>(looks_like_pos(path));
  expect(!read_pos(path).rows.empty(), "no solution");
}

// Compares what a reader gives with the bytes of its file, one after the other.
class FollowedBytes {
 public:
  explicit FollowedBytes(FuzzBytes file) : rest_(file) {}

  void expect_next(FuzzBytes bytes) {
    expect(bytes.size() <= rest_.size(), "more bytes than the file has");
    expect(std::equal(bytes.begin(), bytes.end(), rest_.begin()), "other bytes than the file's");
    rest_ = rest_.subspan(bytes.size());
  }
  void expect_number(std::uint64_t value, std::size_t bytes) {
    std::array<std::uint8_t, 8> text{};
    for (std::size_t i = 0; i < bytes; ++i) text[i] = static_cast<std::uint8_t>(value >> (8 * i));
    expect_next(FuzzBytes(text).first(bytes));
  }
  bool empty() const { return rest_.empty(); }

 private:
  FuzzBytes rest_;
};

// A recording is its first line and its blocks up to the damage or the end; of any other file the
// pieces are the file.
void read_recording(const std::string& path, FuzzBytes bytes) {
  const std::optional<std::int64_t> first = first_arrival_ns(path);
  BlockReader reader(path);
  FollowedBytes file(bytes);
  if (reader.is_recording()) file.expect_next(bytes.first(kRecordingLine));
  BlockReader::Block block;
  for (bool is_first = true; reader.next(&block); is_first = false) {
    if (!reader.is_recording()) {
      expect(block.arrival_ns == 0 && !block.bytes.empty(),
             "a piece with a time, or without bytes");
      file.expect_next(block.bytes);
      continue;
    }
    expect(block.arrival_ns > 0, "an arrival before 1970");
    expect(!is_first || first == block.arrival_ns, "another first arrival");
    file.expect_number(static_cast<std::uint64_t>(block.arrival_ns), 8);
    file.expect_number(block.bytes.size(), 4);
    file.expect_next(block.bytes);
  }
  expect(reader.is_recording() || (file.empty() && !first), "bytes of the file are left out");
}

}  // namespace

std::vector<FuzzTarget> file_targets() {
  return {
      {"rinex_observation", [](FuzzBytes b) { run_reader(b, read_observations); }},
      {"rinex_navigation",
       [](FuzzBytes b) { run_reader(b, [](const std::string& p) { read_navigation(p); }); }},
      {"sp3", [](FuzzBytes b) { run_reader(b, read_orbits); }},
      {"clk", [](FuzzBytes b) { run_reader(b, read_clocks); }},
      {"antex", [](FuzzBytes b) { run_choice(b, read_antennas); }},
      {"bias_sinex", [](FuzzBytes b) { run_reader(b, read_biases); }},
      {"blq", [](FuzzBytes b) { run_choice(b, read_loading); }},
      {"imu_csv", [](FuzzBytes b) { run_reader(b, read_samples); }},
      {"leo_elements", [](FuzzBytes b) { run_reader(b, read_elements); }},
      {"truth_csv", [](FuzzBytes b) { run_reader(b, read_trajectory); }},
      {"solution_csv", [](FuzzBytes b) { run_reader(b, read_solution); }},
      {"rtklib_pos", [](FuzzBytes b) { run_reader(b, read_positions); }},
      {"dataset",
       [](FuzzBytes b) { run_reader(b, [](const std::string& p) { load_dataset(p); }); }},
      {"recording",
       [](FuzzBytes b) { run_reader(b, [b](const std::string& p) { read_recording(p, b); }); }},
  };
}

}  // namespace leonav::test
