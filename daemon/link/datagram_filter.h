// This function makes the filter by which the kernel drops datagrams that are no input.
#pragma once
#include <linux/filter.h>

#include <cstdint>
#include <string>
#include <vector>

namespace leonav {

// A program for a UDP socket (SO_ATTACH_FILTER). It passes datagrams of LCM messages on `channels`
// whose data have at most `most_bytes`. The channel stands in the first datagram of a message, so
// that later ones pass by the size alone. There must be a channel; a name has 63 characters at
// most.
std::vector<sock_filter> datagram_filter(std::uint32_t most_bytes,
                                         const std::vector<std::string>& channels);

}  // namespace leonav
