// This unit parses one antenna of an ANTEX file, line by line.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/propagation/antenna_model.h"

namespace leonav {

// The parser takes the lines between START OF ANTENNA and END OF ANTENNA. Each function returns the
// error, if there is one; the antenna must then not be used.
class AntexAntenna {
 public:
  using Problem = std::optional<std::string>;

  Problem line(std::string_view text);
  Problem finish();  // after the last line

  // Identity of the antenna, valid after its line TYPE / SERIAL NO.
  bool is_satellite() const { return is_satellite_; }
  // Unset for a system not used.
  const std::optional<SatelliteId>& satellite() const { return satellite_; }
  const std::string& type() const { return type_; }  // twenty characters
  // The serial number of an individually calibrated receiver antenna; else empty.
  const std::string& serial() const { return serial_; }
  GpsTime valid_from() const { return valid_from_; }
  GpsTime valid_until() const { return valid_until_; }

  // Results, valid after finish().
  const std::vector<AntennaPattern>& patterns() const { return patterns_; }
  int other_system_bands() const { return other_system_bands_; }
  int unknown_bands() const { return unknown_bands_; }
  int coarsened() const { return coarsened_; }

 private:
  Problem type_line(std::string_view text);
  Problem grid_line(std::string_view text);
  Problem time_line(std::string_view text, GpsTime* time);
  Problem start_frequency(std::string_view text);
  Problem end_frequency();
  Problem offset_line(std::string_view text);
  Problem values_line(std::string_view text);
  void fill_grid(AntennaGrid* grid);

  std::string type_, serial_;
  bool has_type_ = false, is_satellite_ = false;
  std::optional<SatelliteId> satellite_;
  GpsTime valid_from_, valid_until_;
  double azimuth_step_deg_ = 0.0, first_deg_ = 0.0, step_deg_ = 0.0;
  int angles_ = 0, rows_ = 0;  // rows_: by azimuth, 0 for none

  bool in_frequency_ = false, in_rms_ = false, use_frequency_ = false, has_offset_ = false;
  AntennaPattern pattern_;
  std::vector<float> mean_, by_azimuth_;  // of the current band, m

  std::vector<AntennaPattern> patterns_;
  int other_system_bands_ = 0, unknown_bands_ = 0, coarsened_ = 0;
};

}  // namespace leonav
