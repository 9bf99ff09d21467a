#include "drivers/transport/recording.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include "drivers/binary/little_endian.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr std::string_view kFirstLine = "leonav recording 1\n";
constexpr std::size_t kHeaderBytes = 12;
// A block is what one read gave; longer ones are damage.
constexpr std::uint32_t kMaxBlock = 1U << 20;
// The thread writes when so much waits, and at each flush.
constexpr std::size_t kBatch = 1U << 16;
// Small pieces, so that a file keeps a receiver's pace.
constexpr std::size_t kPiece = 256;

using Header = std::array<std::uint8_t, kHeaderBytes>;

Header header_of(std::int64_t arrival_ns, std::size_t length) {
  Header header;
  for (std::size_t i = 0; i < 8; ++i) {
    header[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(arrival_ns) >> (8 * i));
  }
  for (std::size_t i = 0; i < 4; ++i) header[8 + i] = static_cast<std::uint8_t>(length >> (8 * i));
  return header;
}

// Returns the open file; nullptr: it cannot be opened, and errno says why. Reading waits in the one
// thread of all streams, so that only a regular file may be read, whose bytes are there. O_NONBLOCK
// keeps a named pipe from waiting for its writer before it can be refused.
std::FILE* open_regular(const std::string& path) {
  const int number = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (number < 0) return nullptr;
  struct stat status = {};
  if (fstat(number, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(number);
    throw FileError(path, 0,
                    S_ISDIR(status.st_mode)
                        ? "is a directory; name a file of a stream's bytes"
                        : "is a device or a pipe and no file; read a device with 'source: serial', "
                          "a pipe with 'source: stdin'");
  }
  return fdopen(number, "rb");
}

}  // namespace

struct RecordingWriter::State {
  std::mutex mutex;
  std::condition_variable wake, closed;
  std::FILE* file = nullptr;  // the thread's
  std::vector<std::uint8_t> queue;
  bool is_flush_due = false, is_end = false, is_closed = false;
  std::chrono::steady_clock::time_point ended;  // when is_end was set
  std::string problem;
  bool has_failed = false;  // the file takes nothing more

  void run();
  void fail(int error) {
    has_failed = true;
    if (problem.empty()) problem = std::string("cannot be written: ") + std::strerror(error);
  }
};

// Takes over all that is queued at once, so that nobody waits for the disk.
void RecordingWriter::State::run() {
  std::vector<std::uint8_t> batch;
  std::unique_lock lock(mutex);
  while (!is_end || !queue.empty()) {
    wake.wait(lock, [this] { return is_flush_due || is_end || queue.size() >= kBatch; });
    batch.clear();
    std::swap(batch, queue);
    is_flush_due = false;
    if (has_failed) continue;
    lock.unlock();
    const bool written =
        std::fwrite(batch.data(), 1, batch.size(), file) == batch.size() && std::fflush(file) == 0;
    const int error = errno;
    lock.lock();
    if (!written) fail(error);
  }
  lock.unlock();
  const bool is_closed_well = std::fclose(file) == 0;
  const int error = errno;
  lock.lock();
  if (!is_closed_well) fail(error);
  is_closed = true;
  closed.notify_all();
}

RecordingWriter::RecordingWriter(const std::string& path, const RecordingLimits& limits)
    : path_(path), limits_(limits) {
  for (int number = 1; std::filesystem::exists(path_) && number < 10'000; ++number) {
    path_ = path + "." + std::to_string(number);
  }
  std::FILE* file = std::fopen(path_.c_str(), "wbx");
  if (file == nullptr) {
    throw FileError(path_, 0,
                    std::string("cannot be created (") + std::strerror(errno) +
                        "); check the folder of 'record' and its permissions");
  }
  start(file);
}

RecordingWriter::RecordingWriter(std::FILE* file, const std::string& path,
                                 const RecordingLimits& limits)
    : path_(path), limits_(limits) {
  start(file);
}

void RecordingWriter::start(std::FILE* file) {
  state_ = std::make_shared<State>();
  state_->file = file;
  state_->queue.assign(kFirstLine.begin(), kFirstLine.end());
  accepted_bytes_ = kFirstLine.size();
  std::thread([state = state_] { state->run(); }).detach();
}

bool RecordingWriter::write(std::int64_t arrival_ns, std::span<const std::uint8_t> bytes) {
  const std::size_t size = (opening_is_due_ ? 2 : 1) * kHeaderBytes + bytes.size();
  const std::lock_guard lock(state_->mutex);
  if (limits_.file_bytes > 0 && accepted_bytes_ + size > limits_.file_bytes) {
    if (state_->problem.empty()) state_->problem = "has reached its limit, 'record_limit_mb'";
  }
  if (!state_->problem.empty()) return false;
  if (state_->queue.size() + size > limits_.queued_bytes) {
    dropped_bytes_ += bytes.size();
    return true;
  }
  accepted_bytes_ += size;
  const auto queue_header = [&](std::size_t length) {
    const Header header = header_of(arrival_ns, length);
    state_->queue.insert(state_->queue.end(), header.begin(), header.end());
  };
  if (std::exchange(opening_is_due_, false)) queue_header(0);
  queue_header(bytes.size());
  state_->queue.insert(state_->queue.end(), bytes.begin(), bytes.end());
  if (state_->queue.size() >= kBatch) state_->wake.notify_one();
  return true;
}

bool RecordingWriter::flush() {
  const std::lock_guard lock(state_->mutex);
  state_->is_flush_due = true;
  state_->wake.notify_one();
  return state_->problem.empty();
}

void RecordingWriter::end() {
  const std::lock_guard lock(state_->mutex);
  if (std::exchange(state_->is_end, true)) return;
  state_->ended = std::chrono::steady_clock::now();
  state_->wake.notify_one();
}

bool RecordingWriter::close() {
  end();
  std::unique_lock lock(state_->mutex);
  state_->closed.wait_until(lock, state_->ended + kCloseTimeout,
                            [this] { return state_->is_closed; });
  if (!state_->is_closed && state_->problem.empty()) {
    state_->problem = "cannot be completed: the disk takes nothing any more";
  }
  return state_->problem.empty();
}

std::string RecordingWriter::error() const {
  const std::lock_guard lock(state_->mutex);
  return state_->problem.empty() ? "" : path_ + ": " + state_->problem;
}

BlockReader::BlockReader(const std::string& path) : path_(path) {
  file_.reset(open_regular(path));
  if (file_ == nullptr) {
    throw FileError(path, 0,
                    std::string("cannot be opened (") + std::strerror(errno) +
                        "); check the path and the permissions");
  }
  std::array<char, kFirstLine.size()> first;
  const std::size_t got = std::fread(first.data(), 1, first.size(), file_.get());
  is_recording_ = std::string_view(first.data(), got) == kFirstLine;
  if (!is_recording_) std::rewind(file_.get());
}

bool BlockReader::next(Block* block) {
  if (is_recording_) return next_recorded(block);
  block->arrival_ns = 0;
  block->bytes.resize(kPiece);
  block->bytes.resize(std::fread(block->bytes.data(), 1, kPiece, file_.get()));
  if (std::ferror(file_.get()) != 0) {
    throw FileError(path_, 0, "cannot be read to its end; check the disk");
  }
  return !block->bytes.empty();
}

bool BlockReader::next_recorded(Block* block) {
  std::array<std::uint8_t, kHeaderBytes> header;
  if (std::fread(header.data(), 1, header.size(), file_.get()) != header.size()) {
    if (std::ferror(file_.get()) == 0) return false;
    throw FileError(path_, 0, "cannot be read to its end; check the disk");
  }
  const std::uint32_t length = read_u4(header.data() + 8);
  block->arrival_ns = static_cast<std::int64_t>(read_u8(header.data()));
  if (length > kMaxBlock || block->arrival_ns <= 0) {
    throw FileError(path_, 0,
                    "is damaged before byte " + std::to_string(std::ftell(file_.get())) +
                        ": no block begins there; what came before it has been used");
  }
  block->bytes.resize(length);
  return length == 0 || std::fread(block->bytes.data(), 1, length, file_.get()) == length;
}

std::optional<std::int64_t> first_arrival_ns(const std::string& path) {
  try {
    BlockReader reader(path);
    BlockReader::Block block;
    if (reader.is_recording() && reader.next(&block)) return block.arrival_ns;
  } catch (const FileError&) {
    // Told by whoever plays the file.
  }
  return std::nullopt;
}

}  // namespace leonav
