#include "daemon/journal/internal/piece_sequence.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

#include "daemon/journal/internal/journal_name.h"
#include "daemon/journal/internal/recorded_outputs.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/piece_name.h"

namespace leonav {
namespace {

constexpr int kMostNamesTried = 100;

}  // namespace

PieceSequence::PieceSequence(const JournalConfig& config, DiskCalls* disk,
                             JournalCounters* counters, KeptNames* kept)
    : limits_(limits_of(config)),
      name_(std::filesystem::path(config.path).filename()),
      disk_(disk),
      counters_(counters),
      folder_(config.path, disk),
      file_(disk),
      pieces_(name_, &folder_, disk, counters, kept) {
  info_.outputs = recorded_outputs(config.outputs);
}

bool PieceSequence::open() {
  if (is_stream_) return open_stream();
  // By its path each time: it may be another one, or gone.
  if (!folder_.open(first_begun_) || !prepare()) return false;
  if (is_stream_) return open_stream();
  if (left_behind_ && reopen()) return true;
  if (left_behind_) return false;
  return first_begun_ ? open_next() : claim();
}

// Once, before the first file is made: a disk that is full may have room then.
bool PieceSequence::prepare() {
  if (prepared_) return true;
  struct stat status {};
  const auto look = [&] { return fstatat(folder_.descriptor(), name_.c_str(), &status, 0); };
  const bool exists = !name_.empty() && (*disk_)(DiskCall::kLook, look) == 0;
  if (!name_.empty() && !exists && disk_->error() != ENOENT) return false;
  if (name_.empty() || (exists && S_ISDIR(status.st_mode))) {
    disk_->set_error(EISDIR);
    return false;
  }
  prepared_ = true;
  is_stream_ = exists && !S_ISREG(status.st_mode);
  if (is_stream_) return true;
  // A clock that has gone back must not put this run before an earlier one.
  info_.run = std::clamp<std::int64_t>(wall_clock_us(), pieces_.greatest_run() + 1, kGreatestRun);
  if (limits_.kept_mb > 0.0) pieces_.keep_crashed_run();
  apply_limits();
  return true;
}

bool PieceSequence::open_stream() {
  if (!file_.open(folder_.descriptor(), name_.c_str(), false)) return false;
  counters_->name.set(1);
  return true;
}

bool PieceSequence::claim() {
  const auto number = claim_journal(name_, &folder_, &file_, disk_);
  if (!number) return false;
  format_journal_name(name_, *number, journal_name_);
  piece_name_ = journal_name_;
  counters_->name.set(1 + *number);
  return true;
}

bool PieceSequence::open_next() {
  for (int i = 0; i < kMostNamesTried; ++i) {
    ++info_.number;
    if (!format_piece_name({journal_name_.data(), info_.number}, piece_name_))
      disk_->set_error(ENAMETOOLONG);
    else if (file_.open(folder_.descriptor(), piece_name_.data(), true))
      return true;
    if (disk_->error() == EEXIST) continue;  // not ours
    --info_.number;
    return false;
  }
  return false;
}

// The file of the piece that was discarded and could not be deleted, unless the name is another's
// by now.
bool PieceSequence::reopen() {
  if (file_.open(folder_.descriptor(), piece_name_.data(), false)) {
    if (file_.inode() == left_inode_) {
      file_.truncate(0);
      return true;
    }
    file_.drop();
  } else if (disk_->error() != ENOENT) {
    return false;
  }
  left_behind_ = false;
  if (first_begun_) --info_.number;
  return false;
}

void PieceSequence::note_begun() {
  if (is_stream_) return;
  left_behind_ = name_synced_ = false;
  first_begun_ = true;
  file_.release_earlier();
  pieces_.set_own(piece_name_, last_name_);
  apply_limits();
}

// All others leave room for the piece that is written.
void PieceSequence::apply_limits() {
  if (limits_.kept_mb > 0.0) pieces_.limit(true, bytes_of_megabytes(limits_.kept_mb));
  if (limits_.total_mb > 0.0)
    pieces_.limit(false,
                  bytes_of_megabytes(limits_.total_mb) - bytes_of_megabytes(limits_.piece_mb));
}

void PieceSequence::set_limits(const JournalLimits& limits) {
  limits_ = limits;
  if (first_begun_ && !is_stream_ && folder_.is_open()) apply_limits();
}

void PieceSequence::end(bool complete) {
  if (is_stream_) return file_.drop();
  file_.end();
  last_name_ = {};
  if (keeps_piece_)
    pieces_.keep(piece_name_.data());
  else
    last_name_ = piece_name_;
  keeps_piece_ = false;
  // For the one that is about to be written: a disk smaller than the limits.
  if (complete && folder_.free_bytes() < bytes_of_megabytes(limits_.piece_mb)) make_room();
}

void PieceSequence::discard() {
  if (is_stream_) return file_.drop();
  const bool is_there = file_.is_in_place(folder_.descriptor(), piece_name_.data());
  const bool is_gone = !is_there && (disk_->error() == 0 || disk_->error() == ENOENT);
  left_inode_ = file_.inode();
  file_.drop();
  const auto remove = [&] { return unlinkat(folder_.descriptor(), piece_name_.data(), 0); };
  left_behind_ = !is_gone && (!is_there || (*disk_)(DiskCall::kDelete, remove) != 0);
  if (!left_behind_ && first_begun_) --info_.number;
}

bool PieceSequence::sync() {
  if (!file_.sync()) return false;
  if (is_stream_ || name_synced_) return true;
  name_synced_ = folder_.sync();
  return name_synced_;
}

bool PieceSequence::is_in_place() {
  return is_stream_ ||
         (folder_.is_in_place() && file_.is_in_place(folder_.descriptor(), piece_name_.data()));
}

void PieceSequence::keep() {
  if (limits_.kept_mb <= 0.0 || is_stream_) return;
  keeps_piece_ = true;
  if (last_name_[0] != '\0') pieces_.keep(last_name_.data());
  last_name_ = {};
  pieces_.set_own(piece_name_, last_name_);
}

// With journal.kept_mb 0 the kept pieces that are there are not the journal's to delete.
bool PieceSequence::make_room() {
  return !is_stream_ && folder_.is_open() && pieces_.delete_oldest(limits_.kept_mb > 0.0);
}

}  // namespace leonav
