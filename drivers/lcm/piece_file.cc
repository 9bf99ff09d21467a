#include "drivers/lcm/piece_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "drivers/lcm/event_header.h"
#include "drivers/lcm/run_configuration.h"

namespace leonav {
namespace {

// Closes a file at the end of a block.
class Descriptor {
 public:
  Descriptor(int folder, const char* name)
      : number_(openat(folder, name, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW)) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

bool is_regular(int folder, const char* name) {
  struct stat status {};
  return fstatat(folder, name, &status, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(status.st_mode);
}

bool read_all(int descriptor, std::int64_t offset, void* to, std::size_t size) {
  return pread(descriptor, to, size, offset) == static_cast<ssize_t>(size);
}

// The beginning of the event at `offset`: its header and its channel.
struct EventStart {
  EventHeader header;
  std::array<char, kMaxEventChannelBytes> channel{};

  std::string_view name() const { return {channel.data(), header.channel_bytes}; }
  std::int64_t data_offset(std::int64_t offset) const {
    return offset + static_cast<std::int64_t>(kEventHeaderBytes + header.channel_bytes);
  }
};

std::optional<EventStart> read_start(int descriptor, std::int64_t offset) {
  EventHeaderBytes bytes;
  if (!read_all(descriptor, offset, bytes.data(), bytes.size())) return std::nullopt;
  const auto header = decode_event_header(bytes);
  if (!header || !header->is_sane()) return std::nullopt;
  EventStart start{*header, {}};
  const auto channel = offset + static_cast<std::int64_t>(kEventHeaderBytes);
  if (!read_all(descriptor, channel, start.channel.data(), header->channel_bytes))
    return std::nullopt;
  return start;
}

}  // namespace

std::optional<PieceInfo> read_piece_info(int descriptor) {
  std::int64_t offset = 0;
  auto start = read_start(descriptor, offset);
  // The prefix of the channels is part of the configuration, so that only the ending is compared.
  if (start && start->name().ends_with(name_of(Channel::kConfig))) {
    offset += static_cast<std::int64_t>(start->header.event_bytes());
    start = read_start(descriptor, offset);
  }
  if (!start || !start->name().ends_with(name_of(Channel::kPiece))) return std::nullopt;
  std::array<std::uint8_t, kPieceBytes> data;
  if (start->header.data_bytes != data.size()) return std::nullopt;
  if (!read_all(descriptor, start->data_offset(offset), data.data(), data.size()))
    return std::nullopt;
  return decode_piece(data);
}

std::optional<PieceInfo> read_piece_info(int folder, const char* name) {
  if (!is_regular(folder, name)) return std::nullopt;
  const Descriptor file(folder, name);
  return file.number() < 0 ? std::nullopt : read_piece_info(file.number());
}

bool has_end_mark(int folder, const char* name) {
  if (!is_regular(folder, name)) return false;
  const Descriptor file(folder, name);
  struct stat status {};
  if (file.number() < 0 || fstat(file.number(), &status) != 0) return false;
  // The length of the channel's prefix is not known here.
  for (std::uint32_t channel = 1; channel <= kMaxEventChannelBytes; ++channel) {
    const auto size = static_cast<std::int64_t>(kEventHeaderBytes + channel + kJournalEndBytes);
    if (size > status.st_size) return false;
    const auto start = read_start(file.number(), status.st_size - size);
    if (start && start->header.channel_bytes == channel &&
        start->header.data_bytes == kJournalEndBytes)
      return start->name().ends_with(name_of(Channel::kEnd));
  }
  return false;
}

}  // namespace leonav
