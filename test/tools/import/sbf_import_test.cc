// Septentrio recordings in an import: observations with navigation data, and inertial samples.
#include <bit>
#include <filesystem>
#include <fstream>

#include "drivers/text/parse.h"
#include "import_outcome.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"
#include "tools/import/import.h"

namespace leonav {
namespace {

using test::import_error;
using test::left_out;

constexpr const char* kEpoch = "wire/sbf_x5_measurements.bin";
constexpr const char* kPositions = "wire/sbf_sbfdata.bin";

// A stream of ExtSensorMeas, 100 Hz; the sample at `gap` and the nine after it are missing.
std::string inertial(int count, int gap = -1) {
  std::string stream;
  for (int k = 0; k < count; ++k) {
    if (gap >= 0 && k >= gap && k < gap + 10) continue;
    std::string b;
    const auto add = [&b](std::uint64_t value, int size) {
      for (int i = 0; i < size; ++i) b.push_back(static_cast<char>(value >> (8 * i)));
    };
    const auto vector = [&add](unsigned type, double x) {
      add(0x20, 1), add(1, 1), add(type, 1), add(0, 1);
      for (int i = 0; i < 3; ++i) add(std::bit_cast<std::uint64_t>(x), 8);
    };
    add(4050, 2), add(72, 2), add(482'321'000u + 10u * static_cast<unsigned>(k), 4), add(2367, 2);
    add(2, 1), add(28, 1);
    vector(0, -5.0);
    vector(1, 2.0);
    while (b.size() < 68) add(0, 1);
    std::uint32_t crc = 0;
    for (const char byte : b) {
      for (int i = 7; i >= 0; --i) {
        const std::uint32_t carry = ((crc >> 15) ^ (static_cast<std::uint8_t>(byte) >> i)) & 1u;
        crc = ((crc << 1) & 0xFFFF) ^ (carry ? 0x1021u : 0u);
      }
    }
    stream += "$@";
    stream.push_back(static_cast<char>(crc));
    stream.push_back(static_cast<char>(crc >> 8));
    stream += b;
  }
  return stream;
}

using Catch::Contains;

}  // namespace

TEST_CASE("a Septentrio recording gives epochs", "[import]") {
  if (!test::have_shared_data(kEpoch)) return;
  const test::TemporaryFile yaml("set.yaml", "observations: a.SBF\n");
  std::filesystem::copy_file(test::shared_data(kEpoch), yaml.beside("a.SBF"));
  const ImportReport report =
      import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  CHECK(report.epochs == 1);
  CHECK(report.first == GpsTime::from_week_and_tow(2367, 482'321.0));
  CHECK(left_out(report, "measurement of a system not used") == 22);
  CHECK(left_out(report, "block that is not used: MeasExtra") == 1);
  CHECK(left_out(report, "block that is not used: EndOfMeas") == 1);
}

TEST_CASE("a Septentrio file under imu gives inertial samples", "[import]") {
  const test::TemporaryFile yaml("set.yaml", "imu: [a.sbf]\n");
  std::ofstream(yaml.beside("a.sbf"), std::ios::binary) << inertial(100, 60);
  const ImportReport report =
      import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  CHECK(report.imu_samples == 89);
  CHECK(left_out(report, "before its interval is known") == 1);
  CHECK(std::any_of(report.warnings.begin(), report.warnings.end(), [](const std::string& text) {
    return text.find("a.sbf has 1 gaps") != std::string::npos;
  }));
}

TEST_CASE("a Septentrio file without what it is listed for is refused", "[import]") {
  if (!test::have_shared_data(kPositions)) return;
  const test::TemporaryFile yaml("set.yaml", "imu: a.sbf\n");
  std::filesystem::copy_file(test::shared_data(kPositions), yaml.beside("a.sbf"));
  CHECK_THAT(import_error(yaml.path()), Contains("a.sbf") && Contains("no usable inertial sample"));
  std::ofstream(yaml.path()) << "observations: a.sbf\n";
  CHECK_THAT(import_error(yaml.path()), Contains("no usable epoch") && Contains("PVTCartesian"));
}

}  // namespace leonav
