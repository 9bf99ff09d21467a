// Journal marks are the messages that a journal holds about itself: pieces, refused inputs, losses.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/navigator/interface/input_fault.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"

namespace leonav {

// Which outputs a journal holds. On the wire: append only.
enum class RecordedOutputs : std::uint8_t {
  kAll = 0,
  kThinned = 1,  // one SOLUTION a second, and all others
  kNone = 2,     // none that follows from the inputs but EVENT and SMOOTHER
};

// A piece of a journal. The events of a run are numbered over all of its pieces; each piece begins
// with the events 0 (CONFIG) and 1 (PIECE) again.
struct PieceInfo {
  // The same in all pieces of a run, greater in later runs of a journal: microseconds since 1970 at
  // the start, or where a clock went back, one more than in the run before.
  std::int64_t run = 0;
  std::int64_t number = 1;  // of the piece, from 1
  std::int64_t first = 0;   // number of the first event behind the mark
  RecordedOutputs outputs = RecordedOutputs::kAll;
};

// The greatest run that is believed: the year 2200. No clock of a vehicle is there, and runs that
// count up from it would never come to an end that can be written.
inline constexpr std::int64_t kGreatestRun = 7'258'118'400'000'000;

// Input messages of one channel that were refused as they came, for one reason.
struct RefusedInputs {
  Channel channel = Channel::kImu;
  InputFault fault = InputFault::kUndecodable;
  std::uint64_t count = 0;
};

// Messages that the disk did not take in time.
struct LostMessages {
  std::uint64_t solutions = 0;  // SOLUTION, which follow from the inputs
  std::uint64_t others = 0;     // without which a replay is another run

  bool any() const { return solutions > 0 || others > 0; }
};

// All three have a fixed size, so that encoding them allocates nothing.
inline constexpr std::size_t kPieceBytes = 8 + 8 + 8 + 4 + 8 + 8 + 1;
inline constexpr std::size_t kRefusedBytes = 8 + 8 + 8 + 4 + 1 + 1 + 8;
inline constexpr std::size_t kLostBytes = 8 + 8 + 8 + 4 + 8 + 8;

std::array<std::uint8_t, kPieceBytes> encode_piece(const PieceInfo& piece);
std::array<std::uint8_t, kRefusedBytes> encode_refused(const RefusedInputs& refused,
                                                       std::uint64_t sequence);
std::array<std::uint8_t, kLostBytes> encode_lost(const LostMessages& lost, std::uint64_t sequence);

// These return nullopt where the message is damaged or has another schema. None allocates.
std::optional<PieceInfo> decode_piece(ByteSpan bytes);
std::optional<RefusedInputs> decode_refused(ByteSpan bytes);
std::optional<LostMessages> decode_lost(ByteSpan bytes);

}  // namespace leonav
