// This unit reads the header of a HAS page.
#pragma once
#include <cstdint>

#include "drivers/binary/correction_page.h"
#include "drivers/has/reed_solomon.h"

namespace leonav {

// HAS page header. Source: Galileo HAS SIS ICD 1.0, tables 5 to 8.
struct HasPage {
  std::uint8_t status = 0;        // HASS: 0 test, 1 operational, 2 reserved, 3 do not use
  std::uint8_t message_type = 0;  // MT: 1 is the only one defined
  std::uint8_t message_id = 0;    // MID, 0 to 31
  std::uint8_t message_size = 0;  // MS, 1 to 32 pages
  EncodedPage encoded;
};

inline constexpr std::uint8_t kHasOperational = 1, kHasDoNotUse = 3;

// Returns whether a page carries nothing: its header is the pattern of dummy pages.
bool is_dummy(const CorrectionPage& page);
// Reads a page that is intact and no dummy.
HasPage read_has_page(const CorrectionPage& page);

}  // namespace leonav
