#include "drivers/lcm/event_log.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>

namespace leonav {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
constexpr std::size_t kHeaderBytes = 28;
constexpr std::uint32_t kMaxChannelBytes = 999;  // liblcm has the same limit
// Messages of liblcm have at most some megabytes.
constexpr std::uint32_t kMaxDataBytes = 64U << 20;

std::uint64_t get(const std::uint8_t* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

void put(std::uint64_t value, int count, std::uint8_t* bytes) {
  for (int i = count - 1; i >= 0; --i, value >>= 8) bytes[i] = static_cast<std::uint8_t>(value);
}

}  // namespace

EventLogReader::EventLogReader(const std::string& path) : path_(path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw EventLogError(path + ": is a directory, not an LCM log");
  }
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (file_ == nullptr) {
    throw EventLogError(path + ": cannot be opened: " + std::strerror(errno));
  }
  size_ = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
  if (error) size_ = std::numeric_limits<std::int64_t>::max();  // a pipe has no known size
  if (size_ == 0) throw EventLogError(path + ": is empty; expected an LCM log");
}

bool EventLogReader::next(LogEvent* event) {
  std::array<std::uint8_t, kHeaderBytes> header;
  const std::size_t got = std::fread(header.data(), 1, header.size(), file_.get());
  if (got == 0 && std::ferror(file_.get()) == 0) return false;
  if (std::ferror(file_.get()) != 0)
    damaged(std::string("cannot be read: ") + std::strerror(errno));
  if (got >= 4 && get(header.data(), 4) != kSyncWord) {
    damaged(position_ == 0 ? "is not an LCM log (no sync word at its start)"
                           : "no event starts here; the log is damaged");
  }
  if (got < header.size()) {
    truncated_ = true;
    return false;
  }
  const auto channel_bytes = static_cast<std::uint32_t>(get(&header[20], 4));
  const auto data_bytes = static_cast<std::uint32_t>(get(&header[24], 4));
  if (channel_bytes == 0 || channel_bytes > kMaxChannelBytes) {
    damaged("event with a channel name of " + std::to_string(channel_bytes) + " bytes");
  }
  if (data_bytes > kMaxDataBytes) {
    damaged("event with " + std::to_string(data_bytes) + " bytes of data");
  }
  const auto end = position_ + static_cast<std::int64_t>(kHeaderBytes + channel_bytes + data_bytes);
  if (end > size_) {  // checked before the header's lengths allocate anything
    truncated_ = true;
    return false;
  }
  event->number = static_cast<std::int64_t>(get(&header[4], 8));
  event->timestamp_us = static_cast<std::int64_t>(get(&header[12], 8));
  event->channel.resize(channel_bytes);
  event->data.resize(data_bytes);
  if (std::fread(event->channel.data(), 1, channel_bytes, file_.get()) != channel_bytes ||
      std::fread(event->data.data(), 1, data_bytes, file_.get()) != data_bytes) {
    truncated_ = true;
    return false;
  }
  position_ = end;
  return true;
}

void EventLogReader::damaged(const std::string& what) const {
  throw EventLogError(path_ + ": byte " + std::to_string(position_) + ": " + what);
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
  std::array<std::uint8_t, kHeaderBytes> header;
  put(kSyncWord, 4, &header[0]);
  put(static_cast<std::uint64_t>(next_number_), 8, &header[4]);
  put(static_cast<std::uint64_t>(timestamp_us), 8, &header[12]);
  put(channel.size(), 4, &header[20]);
  put(data.size(), 4, &header[24]);
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
