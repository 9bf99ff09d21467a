#include "daemon/journal/internal/piece_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

#include "daemon/journal/internal/journal_name.h"
#include "drivers/lcm/piece_file.h"
#include "drivers/lcm/piece_name.h"

namespace leonav {
namespace {

// A file with holes may claim any size; what it takes of the disk is the least of both.
std::int64_t bytes_on_disk(const struct stat& status) {
  constexpr std::int64_t kBlock = 512;  // stat(2)
  return std::clamp<std::int64_t>(status.st_size, 0, kBlock * std::int64_t{status.st_blocks});
}

std::int64_t sum(std::int64_t a, std::int64_t b) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  return a > kMost - b ? kMost : a + b;
}

}  // namespace

PieceFolder::PieceFolder(std::string name, JournalFolder* folder, DiskCalls* disk,
                         JournalCounters* counters, KeptNames* kept)
    : name_(std::move(name)), folder_(folder), disk_(disk), counters_(counters), kept_(kept) {}

void PieceFolder::set_own(const Name& current, const Name& before) {
  current_ = current;
  before_ = before;
}

// A daemon that writes a file holds a lock on it (journal_file.h).
bool PieceFolder::is_in_use(const char* name) {
  const long file = (*disk_)(DiskCall::kLook, [&] {
    return openat(folder_->descriptor(), name, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW);
  });
  if (file < 0) return false;
  const bool locked = flock(static_cast<int>(file), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(static_cast<int>(file));
  return locked;
}

std::optional<PieceFolder::Found> PieceFolder::look_at(const char* name) {
  if (!journal_number(parse_piece_name(name).journal, name_)) return std::nullopt;
  if (std::strcmp(name, current_.data()) == 0) return std::nullopt;
  struct stat status {};
  std::optional<PieceInfo> info;
  (*disk_)(DiskCall::kLook, [&] {
    if (fstatat(folder_->descriptor(), name, &status, AT_SYMLINK_NOFOLLOW) != 0) return -1;
    info = read_piece_info(folder_->descriptor(), name);
    return 0;
  });
  if (!info) return std::nullopt;
  Found found{{}, *info, bytes_on_disk(status), parse_piece_name(name).kept, is_in_use(name)};
  std::snprintf(found.name.data(), found.name.size(), "%s", name);
  return found;
}

template <typename Use>
void PieceFolder::for_each(Use&& use) {
  folder_->for_each_name([&](const char* name) {
    if (const auto found = look_at(name)) use(*found);
  });
}

std::optional<PieceFolder::Found> PieceFolder::oldest(bool kept, const std::optional<Found>& behind,
                                                      std::int64_t* total_bytes) {
  const auto age = [](const Found& piece) {
    return std::tuple(piece.info.run, piece.info.number, std::string_view(piece.name.data()));
  };
  std::optional<Found> first;
  *total_bytes = 0;
  for_each([&](const Found& piece) {
    if (piece.kept != kept || piece.in_use) return;
    *total_bytes = sum(*total_bytes, piece.bytes);
    if (behind && age(piece) <= age(*behind)) return;
    if (!first || age(piece) < age(*first)) first = piece;
  });
  return first;
}

void PieceFolder::limit(bool kept, std::int64_t bytes) {
  std::int64_t total = 0;
  std::optional<Found> passed;
  for (;;) {
    const auto first = oldest(kept, passed, &total);
    if (!first || total <= bytes) return;
    const bool is_before = std::strcmp(first->name.data(), before_.data()) == 0;
    if (is_before || !remove(*first)) passed = first;
  }
}

bool PieceFolder::delete_oldest(bool with_kept) {
  for (const bool kept : {false, true}) {
    if (kept && !with_kept) return false;
    std::int64_t total = 0;
    for (auto first = oldest(kept, std::nullopt, &total); first;
         first = oldest(kept, first, &total))
      if (remove(*first)) return true;
  }
  return false;
}

bool PieceFolder::remove(const Found& piece) {
  const long failed = (*disk_)(
      DiskCall::kDelete, [&] { return unlinkat(folder_->descriptor(), piece.name.data(), 0); });
  (failed == 0 ? counters_->deleted : counters_->undeletable).add(1);
  return failed == 0;
}

void PieceFolder::keep(const char* name) {
  PieceName piece = parse_piece_name(name);
  if (piece.kept) return;
  piece.kept = true;
  Name to{};
  if (!format_piece_name(piece, to)) return;
  const int folder = folder_->descriptor();
  // Never over a file that is there.
  const auto is_free = [&] {
    return faccessat(folder, to.data(), F_OK, AT_SYMLINK_NOFOLLOW) == 0 ? -1 : 0;
  };
  if ((*disk_)(DiskCall::kLook, is_free) != 0) return;
  const auto rename = [&] { return renameat(folder, name, folder, to.data()); };
  if ((*disk_)(DiskCall::kRename, rename) != 0) return;
  counters_->kept.add(1);
  kept_->put(to.data());
}

void PieceFolder::keep_crashed_run() {
  std::optional<Found> last, before;
  const auto place = [](const Found& piece) {
    return std::pair(piece.info.run, piece.info.number);
  };
  for_each([&](const Found& piece) {
    if (!last || place(piece) >= place(*last)) last = piece;
  });
  if (!last || last->in_use) return;
  bool ended = true;
  (*disk_)(DiskCall::kLook, [&] {
    ended = has_end_mark(folder_->descriptor(), last->name.data());
    return 0;
  });
  if (ended) return;
  for_each([&](const Found& piece) {
    if (piece.info.run == last->info.run && piece.info.number == last->info.number - 1)
      before = piece;
  });
  if (before) keep(before->name.data());
  keep(last->name.data());
}

std::int64_t PieceFolder::greatest_run() {
  std::int64_t greatest = 0;
  for_each([&](const Found& piece) {
    if (piece.info.run < kGreatestRun) greatest = std::max(greatest, piece.info.run);
  });
  return greatest;
}

}  // namespace leonav
