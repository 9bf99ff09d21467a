// NovAtel recordings in an import: observations with navigation data, and inertial samples.
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

constexpr const char* kOemv = "wire/rtklib_oemv_200911218.gps";
constexpr const char* kIns = "wire/novatel_ins2.gps";

// A stream of RAWIMUX with a type of IMU, 100 Hz.
std::string rawimux(std::uint8_t type, int count) {
  std::string stream;
  for (int k = 0; k < count; ++k) {
    std::string m;
    const auto add = [&m](std::uint64_t value, int size) {
      for (int i = 0; i < size; ++i) m.push_back(static_cast<char>(value >> (8 * i)));
    };
    add(0x1244AA, 3), add(28, 1), add(1461, 2), add(0, 2), add(40, 2), add(0, 3), add(180, 1);
    add(2209, 2), add(512'487'000u + 10u * static_cast<unsigned>(k), 4), add(0, 8);
    add(0, 1), add(type, 1), add(2209, 2);
    add(std::bit_cast<std::uint64_t>(512'487.0 + 0.01 * k), 8);
    add(0, 4);
    for (int i = 0; i < 6; ++i) add(1000u + static_cast<unsigned>(i), 4);
    std::uint32_t crc = 0;
    for (const char byte : m) {
      crc ^= static_cast<std::uint8_t>(byte);
      for (int i = 0; i < 8; ++i) crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0xEDB88320u : crc >> 1;
    }
    add(crc, 4);
    stream += m;
  }
  return stream;
}

using Catch::Contains;

}  // namespace

TEST_CASE("a NovAtel recording gives epochs and ephemerides", "[import]") {
  if (!test::have_shared_data(kOemv)) return;
  const test::TemporaryFile yaml("set.yaml", "observations: a.GPS\n");
  std::filesystem::copy_file(test::shared_data(kOemv), yaml.beside("a.GPS"));
  const ImportReport report =
      import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  CHECK(report.epochs == 46);
  CHECK(report.ephemerides == 9);
  CHECK(report.first == GpsTime::from_week_and_tow(1562, 515'220.0));
  CHECK(left_out(report, "measurement of a system not used") == 552);
  CHECK(left_out(report, "log that is not used: BESTPOS") == 49);
  CHECK(left_out(report, "that the end of the file cuts off") == 1);
}

TEST_CASE("a NovAtel file under imu gives inertial samples, by its type or a scale", "[import]") {
  const test::TemporaryFile yaml("set.yaml", "imu: [a.oem7]\n");
  std::ofstream(yaml.beside("a.oem7"), std::ios::binary) << rawimux(58, 10);
  const ImportReport report =
      import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  CHECK(report.imu_samples == 9);
  CHECK(left_out(report, "before its interval is known") == 1);

  std::ofstream(yaml.beside("a.oem7"), std::ios::binary) << rawimux(49, 10);
  CHECK_THAT(import_error(yaml.path()),
             Contains("a.oem7") && Contains("type 49") && Contains("imu_scale: [rad, m/s]"));
  std::ofstream(yaml.path()) << "imu: [a.oem7]\nimu_scale: [1e-9, 2e-8]\n";
  CHECK(import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr)
            .imu_samples == 9);
  for (const char* scale : {"[1e-9]", "[1e-9, x]", "[1e-9, 0]", "[1, 2, 3]", "7"}) {
    std::ofstream(yaml.path()) << "imu: [a.oem7]\nimu_scale: " << scale << "\n";
    CHECK_THAT(import_error(yaml.path()), Contains("set.yaml:2") && Contains("[rad, m/s]"));
  }
}

TEST_CASE("a NovAtel file without what it is listed for is refused", "[import]") {
  if (!test::have_shared_data(kIns)) return;
  const test::TemporaryFile yaml("set.yaml", "imu: a.gps\n");
  std::filesystem::copy_file(test::shared_data(kIns), yaml.beside("a.gps"));
  CHECK_THAT(import_error(yaml.path()), Contains("a.gps") && Contains("no usable inertial sample"));
  std::ofstream(yaml.path()) << "observations: a.gps\n";
  CHECK_THAT(import_error(yaml.path()), Contains("no usable epoch") && Contains("IMURATECORRIMUS"));
}

}  // namespace leonav
