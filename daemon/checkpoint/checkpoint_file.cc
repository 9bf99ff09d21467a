#include "daemon/checkpoint/checkpoint_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <type_traits>

#include "core/base/angle.h"
#include "core/navigator/sequencer/input_validation.h"
#include "daemon/checkpoint/internal/replace_file.h"
#include "daemon/config/config_file.h"
#include "daemon/config/load_config.h"

namespace leonav {
namespace {

constexpr double kDegreePerHour = kDegree / 3600.0;
constexpr std::uintmax_t kMostCheckpointBytes = 4096;

// The text of a file, which allocates nothing: the daemon writes it while it runs.
class FileText {
 public:
  FileText& operator<<(std::string_view text) {
    size_ += text.copy(bytes_.data() + size_, bytes_.size() - size_);
    return *this;
  }
  FileText& operator<<(double value) {
    constexpr int kDigits = 13;  // micrometres on the Earth
    char* const begin = bytes_.data() + size_;
    const auto done = std::to_chars(begin, bytes_.data() + bytes_.size(), value,
                                    std::chars_format::general, kDigits);
    size_ += static_cast<std::size_t>(done.ptr - begin);
    return *this;
  }
  FileText& operator<<(const Eigen::Vector3d& v) {
    return *this << "[" << v.x() << ", " << v.y() << ", " << v.z() << "]";
  }
  std::string_view text() const { return {bytes_.data(), size_}; }

 private:
  std::array<char, kMostCheckpointBytes> bytes_;
  std::size_t size_ = 0;
};

// The numbers of a calibration, one key a line, in the order of the file. `visit` takes key, a
// number or vector, and the file's unit in SI.
template <typename Of, typename Visit>
void for_each_number(Of& calibration, const Visit& visit) {
  visit("mounting_rpy_deg", calibration.mounting_rpy, kDegree);
  visit("accel_bias_b_m_s2", calibration.accel_bias_b, 1.0);
  visit("accel_bias_sigma_m_s2", calibration.accel_bias_sigma, 1.0);
  visit("gyro_scale", calibration.gyro_scale, 1.0);
  visit("gyro_scale_sigma", calibration.gyro_scale_sigma, 1.0);
  visit("accel_scale", calibration.accel_scale, 1.0);
  visit("accel_scale_sigma", calibration.accel_scale_sigma, 1.0);
  constexpr std::array<const char*, ekf_index::kMaxVehicle> kConstants = {
      "travel_yaw_rad", "travel_pitch_rad", "odometer_scale",   "lever_arm_x_m",
      "lever_arm_y_m",  "lever_arm_z_m",    "imu_time_offset_s"};
  constexpr std::array<const char*, ekf_index::kMaxVehicle> kSigmas = {
      "travel_yaw_sigma_rad",   "travel_pitch_sigma_rad", "odometer_scale_sigma",
      "lever_arm_x_sigma_m",    "lever_arm_y_sigma_m",    "lever_arm_z_sigma_m",
      "imu_time_offset_sigma_s"};
  for (std::size_t i = 0; i < kConstants.size(); ++i) {
    visit(kConstants[i], calibration.constants[i], 1.0);
    visit(kSigmas[i], calibration.constant_sigmas[i], 1.0);
  }
}

FileText text_of(const Checkpoint& checkpoint) {
  FileText out;
  out << "# Where leonavd was last sure of its heading, for its next start. It may be deleted.\n"
      << "gps_week: " << static_cast<double>(checkpoint.time.week())
      << "\ngps_tow_s: " << checkpoint.time.tow_s()
      << "\nstanding: " << (checkpoint.standing ? "true" : "false")
      << "\nantenna_p_e_m: " << checkpoint.antenna_p_e
      << "\nantenna_sigma_m: " << checkpoint.antenna_sigma
      << "\nheading_deg: " << checkpoint.heading / kDegree
      << "\nheading_sigma_deg: " << checkpoint.heading_sigma / kDegree
      << "\ngyro_bias_b_deg_per_h: " << Eigen::Vector3d(checkpoint.gyro_bias_b / kDegreePerHour)
      << "\ngyro_bias_sigma_deg_per_h: " << checkpoint.gyro_bias_sigma / kDegreePerHour
      << "\ncode_sigma_factor: " << checkpoint.code_sigma_factor
      << "\ndoppler_sigma_factor: " << checkpoint.doppler_sigma_factor;
  if (checkpoint.calibration)
    for_each_number(*checkpoint.calibration, [&](const char* key, const auto& value, double unit) {
      out << "\n" << key << ": ";
      out << std::remove_cvref_t<decltype(value)>(value / unit);
    });
  out << "\ncomplete: true\n";  // last: what was cut lacks it
  return out;
}

Checkpoint parse(const std::string& text, const std::string& path) {
  ConfigSource source{path};
  Checkpoint checkpoint;
  int week = 0;
  double tow_s = 0.0;
  bool complete = false;
  Calibration calibration;
  std::size_t first_of_calibration = 0;
  read_yaml(text, {}, &source, [&](ConfigReader& root) {
    constexpr Bounds kEcef = {-1e7, 1e7}, kSigma = {0.0, 1e6}, kCalibration = {-1e4, 1e4};
    root.integer("gps_week", 1, 10000, &week);
    root.number("gps_tow_s", {0.0, 604800.0}, &tow_s);
    root.boolean("standing", &checkpoint.standing);
    root.vector("antenna_p_e_m", kEcef, &checkpoint.antenna_p_e);
    root.number("antenna_sigma_m", kSigma, &checkpoint.antenna_sigma);
    root.number("heading_deg", {-360.0, 360.0}, &checkpoint.heading, kDegree);
    root.number("heading_sigma_deg", kSigma, &checkpoint.heading_sigma, kDegree);
    root.vector("gyro_bias_b_deg_per_h", {-1e6, 1e6}, &checkpoint.gyro_bias_b, kDegreePerHour);
    root.number("gyro_bias_sigma_deg_per_h", kSigma, &checkpoint.gyro_bias_sigma, kDegreePerHour);
    // Zero, and in files of older versions nothing, where errors are not learned.
    root.number("code_sigma_factor", {0.0, 100.0}, &checkpoint.code_sigma_factor);
    root.number("doppler_sigma_factor", {0.0, 100.0}, &checkpoint.doppler_sigma_factor);
    root.boolean("complete", &complete);
    first_of_calibration = source.keys.size();
    for_each_number(calibration, [&](const char* key, auto& value, double unit) {
      if constexpr (std::is_same_v<decltype(value), double&>)
        root.number(key, kCalibration, &value, unit);
      else
        root.vector(key, kCalibration, &value, unit);
    });
  });
  const auto is_given = [](const ConfigKey& key) { return key.given; };
  // Files of older versions have no calibration; one has all of it.
  const auto of_calibration =
      source.keys.begin() + static_cast<std::ptrdiff_t>(first_of_calibration);
  if (std::any_of(of_calibration, source.keys.end(), is_given))
    checkpoint.calibration = calibration;
  else
    source.keys.erase(of_calibration, source.keys.end());
  for (const ConfigKey& key : source.keys) {
    if (!key.given && !key.path.ends_with("_sigma_factor"))
      throw ConfigError(path + ": is damaged: " + key.path + " is missing");
  }
  if (checkpoint.calibration && check(*checkpoint.calibration) != InputFault::kNone)
    throw ConfigError(path + ": holds a calibration that no IMU and no vehicle can have");
  checkpoint.time = GpsTime::from_week_and_tow(week, tow_s);
  if (!complete || check(checkpoint) != InputFault::kNone)
    throw ConfigError(path + ": holds no place on the Earth with a heading (sigma at most 10 deg)");
  return checkpoint;
}

}  // namespace

std::optional<Checkpoint> load_checkpoint(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return std::nullopt;
  if (error) throw ConfigError(path + ": " + error.message());
  if (!std::filesystem::is_regular_file(status)) throw ConfigError(path + ": is no ordinary file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size == 0 || size > kMostCheckpointBytes)
    throw ConfigError(path + ": is damaged: " + (size == 0 ? "empty" : "too long"));
  std::ifstream file(path, std::ios::binary);
  std::string text(size, '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(size)))
    throw ConfigError(path + ": cannot be read: " + std::strerror(errno));
  return parse(text, path);
}

std::string save_checkpoint(const std::string& path, const Checkpoint& checkpoint) {
  return replace_file(path, text_of(checkpoint).text());
}

std::string remove_checkpoint(const std::string& path) { return remove_file(path); }

}  // namespace leonav
