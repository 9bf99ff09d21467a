// This function makes the filter by which the kernel drops datagrams that are no input.
#pragma once
#include <linux/filter.h>

#include <cstdint>
#include <string>
#include <vector>

namespace leonav {

struct ReceivedChannel {
  std::string name;          // 63 characters at most
  std::uint32_t most_bytes;  // of a message's data, and of its name where both are in one datagram
};

// A program for a UDP socket (SO_ATTACH_FILTER). It passes datagrams of LCM messages on `channels`
// that are short enough. The channel stands in the first datagram of a message, so that later ones
// pass if they are short enough for any channel. There must be a channel.
std::vector<sock_filter> datagram_filter(const std::vector<ReceivedChannel>& channels);

}  // namespace leonav
