// These functions write right checksums into damaged messages.
//
// Mutated bytes hardly ever have a good checksum, and what lies behind it would never be tried.
#pragma once
#include <cstdint>
#include <vector>

namespace leonav::test {

// Each looks for messages by their start and length, and repairs those that are whole.
void repair_ubx(std::vector<std::uint8_t>* bytes);
void repair_rtcm3(std::vector<std::uint8_t>* bytes);
void repair_sbf(std::vector<std::uint8_t>* bytes);
void repair_oem7(std::vector<std::uint8_t>* bytes);
void repair_vectornav(std::vector<std::uint8_t>* bytes);
void repair_xsens(std::vector<std::uint8_t>* bytes);
void repair_nmea_lines(std::vector<std::uint8_t>* bytes);  // "$...*HH"
void repair_page_lines(std::vector<std::uint8_t>* bytes);  // the CRC-24Q within a page
void repair_products(std::vector<std::uint8_t>* bytes);    // the last event of a products file

}  // namespace leonav::test
