#include "drivers/oem7/imu_scale.h"
#include "core/base/angle.h"

#include <array>

namespace leonav {
namespace {

constexpr double kArcsecond = kDegree / 3600.0;
constexpr double kFoot_m = 0.3048;
constexpr double kMilligravity_m_s2 = 9.80665e-3;

constexpr ImuScale kHoneywell = {0x1p-33, 0x1p-27 * kFoot_m};
constexpr ImuScale kHoneywellWide = {0x1p-33, 0x1p-26 * kFoot_m};
constexpr ImuScale kHg4930 = {0x1p-33, 0x1p-29};
constexpr ImuScale kLn200 = {0x1p-19, 0x1p-14};
constexpr ImuScale kFsas = {0.1 * 0x1p-8 * kArcsecond, 0.05 * 0x1p-15};
constexpr ImuScale kKvh = {0.1 / (3600.0 * 256.0), 0.05 * 0x1p-15};
constexpr ImuScale kLitef = {1e-9, 2e-8};
constexpr ImuScale kAdis16488 = {720.0 * 0x1p-31 * kDegree, 200.0 * 0x1p-31};
constexpr ImuScale kStim300 = {0x1p-21 * kDegree, 0x1p-22};

// These sensors give rates, so that the scale of an increment depends on the output rate.
constexpr ImuScale epson(double degrees_s, double milligravities, double rate_hz) {
  return {degrees_s * 0x1p-16 * kDegree / rate_hz,
          milligravities * 0x1p-16 * kMilligravity_m_s2 / rate_hz};
}

struct TypeScale {
  std::uint32_t type;
  ImuScale scale;
};
constexpr std::array<TypeScale, 24> kScales = {{
    {1, kHoneywell},                     // HG1700-AG11
    {4, kHoneywellWide},                 // HG1700-AG17
    {5, kHoneywell},                     // HG1900-CA29
    {8, kLn200},                         // LN200
    {11, kHoneywell},                    // HG1700-AG58
    {12, kHoneywellWide},                // HG1700-AG62
    {13, kFsas},                         // iMAR FSAS
    {16, kKvh},                          // KVH CPT
    {20, kHoneywell},                    // HG1930-AA99
    {26, kLitef},                        // ISA-100C
    {27, kHoneywell},                    // HG1900-CA50
    {28, kHoneywell},                    // HG1930-CA50
    {31, kAdis16488},                    // ADIS16488, IGM-A1
    {32, kStim300},                      // STIM300, IGM-S1
    {33, kKvh},                          // KVH 1750
    {41, epson(0.008, 0.2, 125.0)},      // Epson G320, 125 Hz
    {52, kLitef},                        // µIMU
    {56, kStim300},                      // STIM300D
    {58, kHg4930},                       // HG4930-AN01
    {61, epson(0.0151515, 0.4, 200.0)},  // Epson G370, 200 Hz
    {62, epson(0.008, 0.2, 200.0)},      // Epson G320, 200 Hz
    {68, kHg4930},                       // HG4930-AN04
    {69, kHg4930},                       // HG4930-AN04, 400 Hz
    {70, kLitef},                        // µIMU, 400 Hz
}};

}  // namespace

std::optional<ImuScale> documented_imu_scale(std::uint32_t imu_type) {
  for (const TypeScale& each : kScales) {
    if (each.type == imu_type) return each.scale;
  }
  return std::nullopt;
}

}  // namespace leonav
