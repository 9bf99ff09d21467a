#include "drivers/rtcm3/msm_message.h"

#include "drivers/binary/bit_field.h"
#include "drivers/rtcm3/msm_lock_time.h"

namespace leonav {
namespace {

constexpr std::size_t kHeaderBits = 73;  // up to the satellite mask
constexpr int kSatelliteMaskBits = 64;
constexpr int kSignalMaskBits = 32;
constexpr std::uint32_t kNoMilliseconds = 255;

// Takes a signed field whose most negative value means "not measured", and shifts it to the finer
// unit of the longer formats.
std::optional<std::int32_t> take_measured(BitReader* bits, int count, int shift = 0) {
  const std::int32_t value = bits->take_signed(count);
  if (value == -(std::int32_t{1} << (count - 1))) return std::nullopt;
  return value * (std::int32_t{1} << shift);
}

void take_satellites(BitReader* bits, const MsmType& type, MsmMessage* message) {
  std::array<std::uint32_t, kMsmCells> milliseconds{};
  const std::size_t count = message->satellites.size();
  for (std::size_t i = 0; i < count; ++i) milliseconds[i] = bits->take(8);  // DF397
  if (type.has_rate()) bits->skip(4 * count);                               // extended information
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t fraction = bits->take(10);  // DF398
    if (milliseconds[i] == kNoMilliseconds) continue;
    message->satellites[i].rough_range =
        static_cast<std::int32_t>(milliseconds[i] * 1024u + fraction);
  }
  if (!type.has_rate()) return;
  for (MsmSatellite& satellite : message->satellites) {
    satellite.rough_rate = take_measured(bits, 14);  // DF399
  }
}

// The fields come one after the other, each of all cells.
void take_cells(BitReader* bits, const MsmType& type, MsmMessage* message) {
  auto& cells = message->cells;
  const bool fine = type.is_fine();
  for (MsmCell& c : cells) {
    c.fine_range = fine ? take_measured(bits, 20) : take_measured(bits, 15, 5);
  }
  for (MsmCell& c : cells) {
    c.fine_phase = fine ? take_measured(bits, 24) : take_measured(bits, 22, 2);
  }
  for (MsmCell& c : cells) {
    c.least_lock_ms = fine ? least_lock_extended_ms(bits->take(10)) : least_lock_ms(bits->take(4));
  }
  for (MsmCell& c : cells) c.half_cycle_ambiguous = bits->take(1) != 0;
  for (MsmCell& c : cells) c.cn0 = fine ? bits->take(10) : bits->take(6) << 4;
  if (!type.has_rate()) return;
  for (MsmCell& c : cells) c.fine_rate = take_measured(bits, 15);
}

}  // namespace

std::optional<MsmHeader> read_msm_header(const MsmType& type,
                                         std::span<const std::uint8_t> message) {
  BitReader bits(message);
  MsmHeader header;
  header.type = type;
  bits.skip(12);  // number
  header.station = static_cast<std::uint16_t>(bits.take(12));
  header.epoch_ms = bits.take(30);
  header.more_follow = bits.take(1) != 0;
  if (bits.overrun()) return std::nullopt;
  return header;
}

MsmStatus read_msm(const MsmType& type, std::span<const std::uint8_t> message, MsmMessage* result) {
  result->satellites.clear();
  result->cells.clear();
  const std::optional<MsmHeader> header = read_msm_header(type, message);
  if (!header) return MsmStatus::kBadLength;
  result->header = *header;

  BitReader bits(message);
  bits.skip(kHeaderBits);
  for (int i = 1; i <= kSatelliteMaskBits; ++i) {
    if (bits.take(1) == 0) continue;
    result->satellites.emplace_back().number = static_cast<std::uint8_t>(i);
  }
  boost::container::static_vector<std::uint8_t, kSignalMaskBits> signals;
  for (int i = 1; i <= kSignalMaskBits; ++i) {
    if (bits.take(1) != 0) signals.push_back(static_cast<std::uint8_t>(i));
  }
  if (result->satellites.size() * signals.size() > kMsmCells) return MsmStatus::kBadMask;
  for (std::size_t i = 0; i < result->satellites.size(); ++i) {
    for (const std::uint8_t signal : signals) {
      if (bits.take(1) == 0) continue;  // DF396
      MsmCell& cell = result->cells.emplace_back();
      cell.satellite = static_cast<std::uint8_t>(i);
      cell.signal = signal;
    }
  }
  take_satellites(&bits, type, result);
  take_cells(&bits, type, result);
  return bits.overrun() ? MsmStatus::kBadLength : MsmStatus::kOk;
}

}  // namespace leonav
