// This unit reads pages of correction services from lines of text.
#pragma once
#include <optional>
#include <string_view>

#include "drivers/binary/correction_page.h"

namespace leonav {

// Reads a line of six columns between blanks or tabs:
//   WEEK SECOND SATELLITE TYPE LENGTH HEX
// the GPS week, the second of the week in which the page was received (0 up to 604800, decimals
// allowed; of PPP-B2b in BeiDou's time, 14 s behind GPS time), the number of the satellite that
// sent it, a number that is not used, the number of octets (61 or more), and these as two
// hexadecimal digits each, from the first bit behind the synchronization pattern. The page is the
// first 486 bits; up to 128 octets may be there. Returns nullopt for any other text.
std::optional<CorrectionPage> page_from_line(std::string_view line, PageService service);

// Returns whether a line is blank or a remark, which begins with '#'.
bool is_remark(std::string_view line);

}  // namespace leonav
