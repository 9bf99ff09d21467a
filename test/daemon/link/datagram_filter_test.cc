// The kernel's own judgement of datagrams: the filter sits on a socket.
#include "daemon/link/datagram_filter.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "support/catch.h"

using namespace leonav;

namespace {

constexpr std::uint32_t kMost = 30000, kMostOfCommand = 500;
const std::vector<std::string> kChannels = {"LEONAV_IMU", "LEONAV_GNSS_EPOCH", "LEONAV_EPHEMERIS"};

std::vector<ReceivedChannel> received(const std::vector<std::string>& names) {
  std::vector<ReceivedChannel> channels;
  for (const std::string& name : names) channels.push_back({name, kMost});
  channels.push_back({"LEONAV_COMMAND", kMostOfCommand});
  return channels;
}

std::string big_endian(std::uint32_t number, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(number >> (8 * i) & 0xFF);
  return text;
}

std::string zero_ended(const std::string& channel) { return channel + '\0'; }

std::string message(const std::string& channel, const std::string& data = "data") {
  return "LC02" + big_endian(7, 4) + zero_ended(channel) + data;
}

std::string fragment(std::uint32_t number, std::uint32_t size, const std::string& behind_header) {
  return "LC03" + big_endian(7, 4) + big_endian(size, 4) + big_endian(0, 4) +
         big_endian(number, 2) + big_endian(3, 2) + behind_header;
}

// A pair of local sockets: nothing leaves the process.
class FilteredSocket {
 public:
  explicit FilteredSocket(const std::vector<std::string>& channels = kChannels)
      : FilteredSocket(received(channels)) {}
  explicit FilteredSocket(const std::vector<ReceivedChannel>& channels)
      : program_(datagram_filter(channels)) {
    REQUIRE(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0, sockets_.data()) == 0);
    const sock_fprog filter{static_cast<unsigned short>(program_.size()), program_.data()};
    REQUIRE(setsockopt(sockets_[1], SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0);
  }
  ~FilteredSocket() {
    for (const int one : sockets_) close(one);
  }
  FilteredSocket(const FilteredSocket&) = delete;
  FilteredSocket& operator=(const FilteredSocket&) = delete;

  // Whether the datagram arrives, and whole, behind a UDP header.
  bool passes(const std::string& datagram) const {
    const std::string sent = std::string(8, 'h') + datagram;
    (void)send(sockets_[0], sent.data(), sent.size(), MSG_DONTWAIT);
    std::string got(sent.size() + 1, '\0');
    const ssize_t size = recv(sockets_[1], got.data(), got.size(), MSG_DONTWAIT);
    if (size < 0) return false;
    got.resize(static_cast<std::size_t>(size));
    CHECK(got == sent);
    return true;
  }

 private:
  std::vector<sock_filter> program_;
  std::array<int, 2> sockets_{};
};

}  // namespace

TEST_CASE("messages on channels of inputs pass, those on others do not") {
  const FilteredSocket socket;
  for (const std::string& channel : kChannels) {
    CAPTURE(channel);
    CHECK(socket.passes(message(channel)));
    CHECK(socket.passes(message(channel, "")));
    CHECK(socket.passes(message(channel, std::string(20000, 'x'))));
    CHECK_FALSE(socket.passes(message(channel + "_")));
    CHECK_FALSE(socket.passes(message("X" + channel)));
    CHECK_FALSE(socket.passes(message(channel.substr(0, channel.size() - 1))));
    for (std::size_t i = 0; i < channel.size(); ++i) {
      std::string other = channel;
      other[i] = '#';
      CHECK_FALSE(socket.passes(message(other)));
    }
  }
  CHECK_FALSE(socket.passes(message("LEONAV_SOLUTION")));
  CHECK_FALSE(socket.passes(message("")));
  CHECK_FALSE(socket.passes(message(std::string(63, 'n'))));
}

TEST_CASE("of messages in fragments the first one has to be of an input, and all short enough") {
  const FilteredSocket socket;
  for (const std::string& channel : kChannels) {
    CHECK(socket.passes(fragment(0, kMost, zero_ended(channel) + "data")));
    CHECK_FALSE(socket.passes(fragment(0, kMost + 1, zero_ended(channel) + "data")));
    CHECK_FALSE(socket.passes(fragment(0, kMost, zero_ended(channel + "2") + "data")));
  }
  for (const std::uint32_t number : {1, 2, 0x100, 0xFFFF}) {
    CHECK(socket.passes(fragment(number, kMost, "no channel")));
    CHECK(socket.passes(fragment(number, kMost, "")));
    CHECK_FALSE(socket.passes(fragment(number, kMost + 1, "no channel")));
    CHECK_FALSE(socket.passes(fragment(number, 0xFFFFFFFF, "no channel")));
  }
}

TEST_CASE("a channel of short messages has a limit of its own") {
  const FilteredSocket socket;
  const std::string channel = "LEONAV_COMMAND";
  const std::size_t most = kMostOfCommand - channel.size() - 1;
  CHECK(socket.passes(message(channel, std::string(most, 'x'))));
  CHECK_FALSE(socket.passes(message(channel, std::string(most + 1, 'x'))));
  CHECK(socket.passes(fragment(0, kMostOfCommand, zero_ended(channel) + "data")));
  CHECK_FALSE(socket.passes(fragment(0, kMostOfCommand + 1, zero_ended(channel) + "data")));
}

TEST_CASE("datagrams that are cut off or not of LCM do not pass") {
  const FilteredSocket socket;
  for (const std::string& whole :
       {message("LEONAV_IMU", ""), fragment(0, 9, zero_ended("LEONAV_IMU"))}) {
    REQUIRE(socket.passes(whole));
    for (std::size_t bytes = 0; bytes < whole.size(); ++bytes)
      CHECK_FALSE(socket.passes(whole.substr(0, bytes)));
  }
  std::string other = message("LEONAV_IMU");
  for (const char* magic : {"LC01", "LC04", "lc02", "MC02"}) {
    other.replace(0, 4, magic);
    CHECK_FALSE(socket.passes(other));
  }
}

TEST_CASE("one channel, the longest names, and one that another begins with") {
  const std::string longest(63, 'n');
  const FilteredSocket socket(std::vector<std::string>{longest, "short", "shorter"});
  CHECK(socket.passes(message(longest)));
  CHECK(socket.passes(message("short")));
  CHECK(socket.passes(message("shorter")));
  CHECK_FALSE(socket.passes(message("shorte")));
  CHECK_FALSE(socket.passes(message("shorter ")));
  CHECK_FALSE(socket.passes(message(longest.substr(1))));
  const FilteredSocket alone(std::vector<ReceivedChannel>{{"LEONAV_IMU", kMost}});
  CHECK(alone.passes(message("LEONAV_IMU")));
  CHECK_FALSE(alone.passes(message("LEONAV_IM")));
  CHECK_FALSE(alone.passes(message("LEONAV_IMU2")));
}
