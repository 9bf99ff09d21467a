#include "drivers/lcm/event_log.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <utility>

#include "drivers/lcm/event_header.h"
#include "drivers/lcm/journal_pieces.h"

namespace leonav {
namespace {

// Further than any run counts; sums stay far from the end of the range.
constexpr std::int64_t kMostEvents = std::numeric_limits<std::int64_t>::max() / 4;
constexpr std::int64_t kUnknownSize = std::numeric_limits<std::int64_t>::max();

// A pipe has no known size.
std::int64_t size_of(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return error ? kUnknownSize : static_cast<std::int64_t>(size);
}

// Files with holes may claim any size.
std::int64_t sum_of_sizes(std::int64_t a, std::int64_t b) {
  return a > kUnknownSize - b ? kUnknownSize : a + b;
}

}  // namespace

EventFileReader::EventFileReader(const std::string& path) : path_(path) {
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (file_ == nullptr) {
    throw EventLogError(path + ": cannot be opened: " + std::strerror(errno));
  }
  size_ = size_of(path);
  if (size_ == 0) throw EventLogError(path + ": is empty; expected an LCM log");
}

bool EventFileReader::next(LogEvent* event) {
  EventHeaderBytes bytes;
  const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), file_.get());
  if (got == 0 && std::ferror(file_.get()) == 0) return false;
  if (std::ferror(file_.get()) != 0)
    damaged(std::string("cannot be read: ") + std::strerror(errno));
  if (got >= 4 && !begins_event(bytes.data(), got)) {
    damaged(position_ == 0 ? "is not an LCM log (no sync word at its start)"
                           : "no event starts here; the log is damaged");
  }
  if (got < bytes.size()) {
    truncated_ = true;
    return false;
  }
  const EventHeader header = *decode_event_header(bytes);
  const std::uint32_t channel_bytes = header.channel_bytes, data_bytes = header.data_bytes;
  if (channel_bytes == 0 || channel_bytes > kMaxEventChannelBytes) {
    damaged("event with a channel name of " + std::to_string(channel_bytes) + " bytes");
  }
  if (data_bytes > kMaxEventDataBytes) {
    damaged("event with " + std::to_string(data_bytes) + " bytes of data");
  }
  const auto end = position_ + static_cast<std::int64_t>(header.event_bytes());
  if (end > size_) {  // checked before the header's lengths allocate anything
    truncated_ = true;
    return false;
  }
  event->number = header.number;
  event->timestamp_us = header.timestamp_us;
  event->channel.resize(channel_bytes);
  event->data.resize(data_bytes);
  if (std::fread(event->channel.data(), 1, channel_bytes, file_.get()) != channel_bytes ||
      std::fread(event->data.data(), 1, data_bytes, file_.get()) != data_bytes) {
    truncated_ = true;
    return false;
  }
  before_ = position_;
  position_ = end;
  return true;
}

void EventFileReader::damaged_at(std::int64_t position, const std::string& what) const {
  throw EventLogError(path_ + ": byte " + std::to_string(position) + ": " + what);
}

EventLogReader::EventLogReader(const std::string& path) {
  LogFiles files = journal_pieces(path);
  paths_ = std::move(files.paths);
  first_piece_ = piece_ = files.first_piece;
  for (const std::string& one : paths_) size_ = sum_of_sizes(size_, size_of(one));
  open_next_file();
}

bool EventLogReader::open_next_file() {
  if (opened_ == paths_.size()) return false;
  if (file_ != nullptr) passed_ += file_->position_bytes();
  file_ = std::make_unique<EventFileReader>(paths_[opened_++]);
  numbers_ = {};
  return true;
}

// In a piece each event has the number behind that of the event before it; behind the mark PIECE
// stands the one that the mark names, or where a program has copied the log, the next one.
void EventLogReader::check_number(const LogEvent& event) {
  const auto is = [&](Channel channel) { return event.channel.ends_with(name_of(channel)); };
  if (numbers_.copied >= 0 && event.number == numbers_.copied) numbers_.next = event.number;
  numbers_.copied = -1;
  if (event.number != numbers_.next || event.number > kMostEvents) {
    file_->refuse_last("event with the number " + std::to_string(event.number) + " instead of " +
                       std::to_string(numbers_.next) + "; the log is damaged");
  }
  ++numbers_.next;
  if (numbers_.began || is(Channel::kConfig)) return;
  numbers_.began = true;
  const auto piece = decode_piece(event.data);
  if (!is(Channel::kPiece) || !piece) return;
  numbers_.copied = numbers_.next;
  numbers_.next = piece->first;
  piece_ = piece;
}

bool EventLogReader::next(LogEvent* event) {
  for (;;) {
    if (!file_->next(event)) {
      if (!open_next_file()) return false;
      continue;
    }
    if (!first_piece_) return true;
    check_number(*event);
    // What a piece repeats: its beginning, and what a failing disk had taken after all.
    if (event->number < next_number_) continue;
    missing_ += event->number - next_number_;
    next_number_ = event->number + 1;
    return true;
  }
}

EventLogWriter::EventLogWriter(const std::string& path) : path_(path) {
  file_.reset(std::fopen(path.c_str(), "wb"));
  if (file_ == nullptr) {
    throw EventLogError(path + ": cannot be created: " + std::strerror(errno));
  }
}

bool EventLogWriter::write(std::int64_t timestamp_us, std::string_view channel,
                           std::span<const std::uint8_t> data) {
  if (!error_.empty()) return false;
  const EventHeaderBytes header =
      encode_event_header({next_number_, timestamp_us, static_cast<std::uint32_t>(channel.size()),
                           static_cast<std::uint32_t>(data.size())});
  const auto write_all = [this](const void* bytes, std::size_t size) {
    return size == 0 || std::fwrite(bytes, 1, size, file_.get()) == size;
  };
  if (!write_all(header.data(), header.size()) || !write_all(channel.data(), channel.size()) ||
      !write_all(data.data(), data.size())) {
    return fail();
  }
  ++next_number_;
  return true;
}

bool EventLogWriter::flush(bool sync) {
  if (!error_.empty()) return false;
  if (std::fflush(file_.get()) != 0) return fail();
  // Pipes and special files cannot be synchronized; that is no error.
  if (sync && fsync(fileno(file_.get())) != 0 && errno != EINVAL && errno != EROFS) return fail();
  return true;
}

bool EventLogWriter::fail() {
  error_ = path_ + ": cannot be written: " + std::strerror(errno);
  return false;
}

}  // namespace leonav
