#include "drivers/rtcm3/station_messages.h"

#include "drivers/binary/bit_field.h"

namespace leonav {
namespace {

constexpr double kUnit = 1e-4;  // m

// Takes 38 bits in two's complement.
double take_coordinate(BitReader* bits) {
  const std::int64_t high = bits->take_signed(6);
  const std::int64_t low = bits->take(32);
  return static_cast<double>(high * (std::int64_t{1} << 32) + low) * kUnit;
}

// Takes a text behind its length, without blanks at its end.
std::string take_text(BitReader* bits) {
  std::string text;
  const std::uint32_t size = bits->take(8);
  for (std::uint32_t i = 0; i < size; ++i) {
    const auto c = static_cast<char>(bits->take(8));
    text.push_back(c >= ' ' && c <= '~' ? c : '?');
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

bool is_station_position(std::uint16_t message_number) {
  return message_number == 1005 || message_number == 1006;
}

bool is_station_equipment(std::uint16_t message_number) {
  return message_number == 1007 || message_number == 1008 || message_number == 1033;
}

std::optional<StationPosition> read_station_position(std::uint16_t message_number,
                                                     std::span<const std::uint8_t> message) {
  BitReader bits(message);
  StationPosition position;
  position.station = static_cast<std::uint16_t>(bits.skip(12).take(12));
  bits.skip(6 + 4);  // year of the frame, which systems are served, whether the station is real
  position.p_e.x() = take_coordinate(&bits);
  bits.skip(2);
  position.p_e.y() = take_coordinate(&bits);
  bits.skip(2);
  position.p_e.z() = take_coordinate(&bits);
  if (message_number == 1006) position.antenna_height_m = bits.take(16) * kUnit;
  if (bits.overrun()) return std::nullopt;
  return position;
}

std::optional<StationEquipment> read_station_equipment(std::uint16_t message_number,
                                                       std::span<const std::uint8_t> message) {
  BitReader bits(message);
  StationEquipment equipment;
  equipment.station = static_cast<std::uint16_t>(bits.skip(12).take(12));
  equipment.antenna = take_text(&bits);
  bits.skip(8);  // setup
  if (message_number != 1007) equipment.antenna_serial = take_text(&bits);
  if (message_number == 1033) {
    equipment.receiver = take_text(&bits);
    equipment.firmware = take_text(&bits);
    equipment.receiver_serial = take_text(&bits);
  }
  if (bits.overrun()) return std::nullopt;
  return equipment;
}

}  // namespace leonav
