#include "drivers/lcm/journal_marks.h"

#include <leonav/lost_t.hpp>
#include <leonav/piece_t.hpp>
#include <leonav/refused_t.hpp>
#include <limits>

#include "drivers/lcm/internal/message_bytes.h"
#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

// More never comes together; sums stay far from the end of the range.
constexpr std::int64_t kMostCounted = std::numeric_limits<std::int64_t>::max() / 4;

bool is_count(std::int64_t count) { return count >= 0 && count <= kMostCounted; }

template <typename Message>
bool read(ByteSpan bytes, std::size_t size, Message* message) {
  if (bytes.size() != size) return false;
  const int length = static_cast<int>(size);
  return message->decode(bytes.data(), 0, length) == length && message->schema == wire::kSchema;
}

}  // namespace

std::array<std::uint8_t, kPieceBytes> encode_piece(const PieceInfo& piece) {
  piece_t message{};
  message.sequence = piece.number;
  message.schema = wire::kSchema;
  message.run = piece.run;
  message.first = piece.first;
  message.outputs = static_cast<std::int8_t>(piece.outputs);
  return bytes_of<kPieceBytes>(message);
}

std::array<std::uint8_t, kRefusedBytes> encode_refused(const RefusedInputs& refused,
                                                       std::uint64_t sequence) {
  refused_t message{};
  message.sequence = static_cast<std::int64_t>(sequence);
  message.schema = wire::kSchema;
  message.fault = static_cast<std::int8_t>(refused.fault);
  message.input = static_cast<std::int8_t>(index_of(refused.channel));
  message.count = static_cast<std::int64_t>(refused.count);
  return bytes_of<kRefusedBytes>(message);
}

std::array<std::uint8_t, kLostBytes> encode_lost(const LostMessages& lost, std::uint64_t sequence) {
  lost_t message{};
  message.sequence = static_cast<std::int64_t>(sequence);
  message.schema = wire::kSchema;
  message.solutions = static_cast<std::int64_t>(lost.solutions);
  message.others = static_cast<std::int64_t>(lost.others);
  return bytes_of<kLostBytes>(message);
}

std::optional<PieceInfo> decode_piece(ByteSpan bytes) {
  piece_t message{};
  if (!read(bytes, kPieceBytes, &message)) return std::nullopt;
  if (message.sequence < 1 || !is_count(message.sequence) || !is_count(message.first) ||
      message.run < 0 || message.run > kGreatestRun || message.outputs < 0 ||
      message.outputs > static_cast<int>(RecordedOutputs::kNone))
    return std::nullopt;
  return PieceInfo{message.run, message.sequence, message.first,
                   static_cast<RecordedOutputs>(message.outputs)};
}

std::optional<RefusedInputs> decode_refused(ByteSpan bytes) {
  refused_t message{};
  if (!read(bytes, kRefusedBytes, &message)) return std::nullopt;
  if (message.fault < 0 || message.input < 0 ||
      static_cast<std::size_t>(message.input) >= kInputChannels.size() || !is_count(message.count))
    return std::nullopt;
  return RefusedInputs{static_cast<Channel>(message.input), static_cast<InputFault>(message.fault),
                       static_cast<std::uint64_t>(message.count)};
}

std::optional<LostMessages> decode_lost(ByteSpan bytes) {
  lost_t message{};
  if (!read(bytes, kLostBytes, &message)) return std::nullopt;
  if (!is_count(message.solutions) || !is_count(message.others)) return std::nullopt;
  return LostMessages{static_cast<std::uint64_t>(message.solutions),
                      static_cast<std::uint64_t>(message.others)};
}

}  // namespace leonav
