// What all framers have from MessageFramer, at the example of UBX.
#include "drivers/binary/message_framer.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "drivers/ubx/ubx_framer.h"
#include "support/bytes/ubx_message.h"
#include "support/catch.h"
#include "tools/common/allocations/allocation_counter.h"

namespace leonav {
namespace {

using test::Bytes;

void append(Bytes* to, const Bytes& bytes) { to->insert(to->end(), bytes.begin(), bytes.end()); }

// A start that claims 5000 bytes, and is none.
const Bytes kFalseStart = {0xB5, 0x62, 0x02, 0x15, 0x88, 0x13};

// Messages of many lengths, whole and damaged, and false starts before and between them.
Bytes damaged_stream() {
  Bytes stream;
  for (std::size_t i = 0; i < 300; ++i) {
    Bytes message = test::message(0x01, static_cast<std::uint8_t>(i), Bytes(13 * i % 700, 0x37));
    if (i % 5 == 0) message[i % message.size()] ^= 0x10U;
    append(&stream, message);
    for (std::size_t k = 0; k < i % 7; ++k) append(&stream, kFalseStart);
  }
  return stream;
}

std::size_t messages_in(std::span<const std::uint8_t> bytes, UbxFramer* framer) {
  std::size_t messages = 0;
  UbxMessage message;
  while (!bytes.empty()) {
    bytes = bytes.subspan(framer->append(bytes.first(std::min<std::size_t>(bytes.size(), 100))));
    while (framer->next(&message)) ++messages;
  }
  return messages;
}

}  // namespace

TEST_CASE("A framer allocates nothing once it has run for a while") {
  const Bytes stream = damaged_stream();
  const auto framer = std::make_unique<UbxFramer>();
  for (int pass = 0; pass < 3; ++pass) messages_in(stream, framer.get());
  start_counting_allocations();
  const std::size_t messages = messages_in(stream, framer.get());
  CHECK(stop_counting_allocations() == 0);
  CHECK(messages == 240);
}

TEST_CASE("A start within a message that counts is none, and is not counted") {
  Bytes payload(40, 0x37);
  std::copy(kFalseStart.begin(), kFalseStart.end(), payload.begin() + 10);
  Bytes stream = kFalseStart;
  append(&stream, test::message(0x01, 0x07, payload));
  const auto framer = std::make_unique<UbxFramer>();
  CHECK(messages_in(stream, framer.get()) == 1);
  CHECK(framer->counters().bad_checksums == 1);
  CHECK(framer->counters().bytes_skipped == kFalseStart.size());
}

}  // namespace leonav
