// This unit decodes what a stream says of its station: position (1005, 1006) and equipment (1007,
// 1008, 1033). Source: RTCM 10403.3, tables 3.5-6, 3.5-7, 3.5-8, 3.5-9, 3.5-26.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace leonav {

// Position of the antenna reference point.
struct StationPosition {
  std::uint16_t station = 0;               // DF003
  Eigen::Vector3d p_e{0, 0, 0};            // m, Earth-fixed, in the frame of the sender
  std::optional<double> antenna_height_m;  // of the reference point above the marker; 1006 only
};

// Names as the IGS writes them; empty: the message has no such field, or nothing in it.
struct StationEquipment {
  std::uint16_t station = 0;
  std::string antenna;  // type and radome, in 20 columns as in RINEX headers
  std::string antenna_serial;
  std::string receiver, firmware, receiver_serial;  // 1033 only
};

// Each function reads a message of one of its numbers; it returns nullopt if the message is shorter
// than its fields. Characters that are not printable become question marks.
std::optional<StationPosition> read_station_position(std::uint16_t message_number,
                                                     std::span<const std::uint8_t> message);
std::optional<StationEquipment> read_station_equipment(std::uint16_t message_number,
                                                       std::span<const std::uint8_t> message);

bool is_station_position(std::uint16_t message_number);
bool is_station_equipment(std::uint16_t message_number);

}  // namespace leonav
