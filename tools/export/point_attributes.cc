#include "tools/export/point_attributes.h"

#include <array>
#include <charconv>
#include <cmath>

namespace leonav {
namespace {

using Names = std::array<std::string_view, 3>;

void add(const Names& names, const std::optional<Eigen::Vector3d>& vector, double scale,
         int decimals, std::vector<PointAttribute>* attributes) {
  for (int i = 0; i < 3; ++i) {
    attributes->push_back({names[static_cast<std::size_t>(i)],
                           vector ? std::optional((*vector)[i] * scale) : std::nullopt, decimals});
  }
}

std::optional<double> degrees(const std::optional<double>& angle) {
  return angle ? std::optional(*angle * kDegreesPerRadian) : std::nullopt;
}

}  // namespace

std::vector<PointAttribute> attributes_of(const SolutionRow& row) {
  std::vector<PointAttribute> all;
  all.push_back({"height_m", row.pva.position.height, 4});
  add({"v_north_m_s", "v_east_m_s", "v_down_m_s"}, row.pva.v_n, 1.0, 4, &all);
  all.push_back({"roll_deg", degrees(row.pva.roll), 4});
  all.push_back({"pitch_deg", degrees(row.pva.pitch), 4});
  all.push_back({"yaw_deg", degrees(row.pva.yaw), 4});
  add({"std_north_m", "std_east_m", "std_down_m"}, row.sigma_p_n, 1.0, 4, &all);
  add({"std_v_north_m_s", "std_v_east_m_s", "std_v_down_m_s"}, row.sigma_v_n, 1.0, 4, &all);
  add({"std_roll_deg", "std_pitch_deg", "std_yaw_deg"}, row.sigma_rpy, kDegreesPerRadian, 4, &all);
  all.push_back({"satellites", row.satellites, 0});
  all.push_back({"pdop", row.pdop, 2});
  all.push_back({"protection_horizontal_m", row.horizontal_protection_m, 4});
  all.push_back({"protection_vertical_m", row.vertical_protection_m, 4});
  all.push_back({"protection_heading_deg", degrees(row.heading_protection), 4});
  for (PointAttribute& one : all) {
    if (one.value && !std::isfinite(*one.value)) one.value.reset();
  }
  return all;
}

std::string decimal(double value, int decimals) {
  std::array<char, 400> buffer;  // the largest double has 309 digits
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  return {buffer.data(), end};
}

}  // namespace leonav
