// This unit decodes the messages with satellite ephemerides: 1019 (GPS), 1042 (BeiDou), 1045 and
// 1046 (Galileo F/NAV and I/NAV). Source: RTCM 10403.3, tables 3.5-21, 3.5-111, 3.5-115, 3.5-116.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "core/gnss/orbits/ephemeris.h"
#include "drivers/binary/ephemeris_status.h"

namespace leonav {

// Returns whether a message number is one of those that decode_ephemeris() reads.
bool is_broadcast_ephemeris(std::uint16_t message_number);

// Decodes one message. The times of week are completed to the instants nearest to `near`, with
// which the message's own week must agree. The messages do not say when the set was sent:
// transmission_time stays unset. `stated_toe` gets the time of ephemeris in the week that the
// message states, also where that week does not agree; it is a week early where the message was
// sent at the end of a week for the next. Precondition: is_broadcast_ephemeris(), `near` is set.
EphemerisStatus decode_ephemeris(std::uint16_t message_number,
                                 std::span<const std::uint8_t> message, GpsTime near,
                                 Ephemeris* ephemeris, GpsTime* stated_toe);

// Returns whether a message states another week than that of `near`; false within four hours of a
// week's end.
bool is_of_other_week(GpsTime stated_toe, GpsTime near);

}  // namespace leonav
