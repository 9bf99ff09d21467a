// What an NTRIP caster's answer is taken for, without a socket.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/transport/internal/ntrip_reply.h"

namespace leonav::test {

struct ReadAnswer {
  NtripAnswer answer = NtripAnswer::kPending;
  int status = 0;
  std::vector<std::uint8_t> stream;
};

// The answer comes in pieces of `piece` bytes.
inline ReadAnswer read_answer(std::span<const std::uint8_t> bytes, std::size_t piece) {
  NtripReply reply;
  ReadAnswer read;
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(piece, bytes.size()))) {
    reply.feed(bytes.first(std::min(piece, bytes.size())), &read.stream);
  }
  read.answer = reply.answer();
  read.status = reply.status();
  return read;
}

}  // namespace leonav::test
