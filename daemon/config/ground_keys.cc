#include <numbers>

#include "daemon/config/config_groups.h"
#include "daemon/config/internal/yaml_text.h"
#include "daemon/config/load_config.h"
#include "drivers/blq/blq_reader.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr double kArcsecond = std::numbers::pi / 180.0 / 3600.0;
constexpr const char* kFile = "ocean_loading_file";
constexpr const char* kStation = "ocean_loading_station";
constexpr const char* kCoefficients = "ocean_loading_coefficients";

// As a list that is read back as the same bits.
std::string list_of(const BlqRows& rows) {
  std::string text;
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    for (Eigen::Index column = 0; column < rows.cols(); ++column) {
      text += (text.empty() ? "" : ", ") + number_text(rows(row, column));
    }
  }
  return "[" + text + "]";
}

BlqRows rows_of(const ConfigReader& group, const std::vector<double>& values) {
  BlqRows rows;
  if (values.size() != static_cast<std::size_t>(rows.size())) {
    group.fail(kCoefficients, "expected six rows of eleven numbers, 66; there are " +
                                  std::to_string(values.size()));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i) / rows.cols();
    if (const char* fault = blq_fault(static_cast<int>(row), values[i])) {
      group.fail(kCoefficients, "number " + std::to_string(i + 1) + " is " + fault);
    }
    rows(row, static_cast<Eigen::Index>(i) % rows.cols()) = values[i];
  }
  return rows;
}

// Throws ConfigError where the three keys do not give one set of coefficients.
void take_ocean_loading(ConfigReader& group, const std::string& file, const std::string& station,
                        const std::vector<double>& values, GnssConfig* config) {
  if (!values.empty()) {
    if (!file.empty()) {
      group.fail(kFile, std::string("is given beside ") + kCoefficients +
                            "; clear one of them (\"\" or [])");
    }
    config->ocean_loading = ocean_loading(rows_of(group, values));
  } else if (!file.empty()) {
    try {
      const BlqRows rows = read_blq(file, station).rows;
      config->ocean_loading = ocean_loading(rows);
      group.resolve(kCoefficients, list_of(rows), kFile);
      group.resolve(kFile, "\"\"", kFile);
      group.resolve(kStation, "\"\"", kFile);
    } catch (const FileError& error) {
      group.fail(kFile, error.what());
    }
  } else if (!station.empty()) {
    group.fail(kStation, std::string("is of no use without ") + kFile);
  }
}

void read_ocean_loading(ConfigReader& group, GnssConfig* config) {
  std::string file, station;
  std::vector<double> values;
  group.text(kFile, &file);
  group.text(kStation, &station);
  group.numbers(kCoefficients, {-360.0, 360.0}, &values);
  group.attempt([&] { take_ocean_loading(group, file, station, values, config); });
}

void read_polar_motion(ConfigReader& group, GnssConfig* config) {
  constexpr Bounds kFromCrust = {-1.0, 1.0};  // it has never been beyond 0.65
  std::optional<double> x, y;
  group.number("polar_motion_x_arcsec", kFromCrust, &x, kArcsecond);
  group.number("polar_motion_y_arcsec", kFromCrust, &y, kArcsecond);
  if (x.has_value() != y.has_value()) {
    group.report(x ? "polar_motion_x_arcsec" : "polar_motion_y_arcsec",
                 std::string("is given without ") + (x ? "y" : "x") + "; give both or neither");
  }
  if (x && y) config->polar_motion = PolarMotion{*x, *y};
}

}  // namespace

void read_ground(ConfigReader& group, GnssConfig* config) {
  read_ocean_loading(group, config);
  read_polar_motion(group, config);
}

}  // namespace leonav
