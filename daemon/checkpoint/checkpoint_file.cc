#include "daemon/checkpoint/checkpoint_file.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "core/navigator/sequencer/input_validation.h"
#include "daemon/checkpoint/internal/replace_file.h"
#include "daemon/config/config_file.h"
#include "daemon/config/load_config.h"

namespace leonav {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kDegreePerHour = kDegree / 3600.0;
constexpr std::uintmax_t kMostBytes = 4096;

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
  std::array<char, kMostBytes> bytes_;
  std::size_t size_ = 0;
};

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
      << "\ndoppler_sigma_factor: " << checkpoint.doppler_sigma_factor
      << "\ncomplete: true\n";  // last: what was cut lacks it
  return out;
}

Checkpoint parse(const std::string& text, const std::string& path) {
  ConfigSource source{path};
  Checkpoint checkpoint;
  int week = 0;
  double tow_s = 0.0;
  bool complete = false;
  read_yaml(text, {}, &source, [&](ConfigReader& root) {
    constexpr Bounds kEcef = {-1e7, 1e7}, kSigma = {0.0, 1e6};
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
  });
  for (const ConfigKey& key : source.keys) {
    if (!key.given && !key.path.ends_with("_sigma_factor"))
      throw ConfigError(path + ": is damaged: " + key.path + " is missing");
  }
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
  if (error || size == 0 || size > kMostBytes)
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
