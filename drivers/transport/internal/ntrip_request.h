// This unit writes the request for a stream of an NTRIP caster.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "drivers/transport/credentials.h"
#include "drivers/transport/ntrip_source.h"

namespace leonav {

// Returns `text` in base64 (RFC 4648, chapter 4).
std::string base64(std::string_view text);

// `version` is k1 or k2. `position_line` is without line end; version 2 sends it as Ntrip-GGA,
// version 1 has no such field. Source: RTCM 10410.0 chapter 5, RTCM 10410.1 chapter 2.
std::string ntrip_request(const NtripOptions& options, NtripVersion version,
                          const std::optional<Credentials>& credentials,
                          std::string_view position_line);

}  // namespace leonav
