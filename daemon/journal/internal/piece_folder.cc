#include "daemon/journal/internal/piece_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>

#include "drivers/lcm/event_log.h"
#include "drivers/lcm/piece_file.h"
#include "drivers/lcm/piece_name.h"

namespace leonav {
namespace {

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

// Returns whether a daemon writes the file at present: it holds a lock on it (journal_file.h).
bool is_in_use(int folder, const char* name) {
  const int file = openat(folder, name, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return false;
  const bool locked = flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(file);
  return locked;
}

bool is_earlier(const PieceInfo& a, const PieceInfo& b) {
  return std::pair(a.run, a.number) < std::pair(b.run, b.number);
}

}  // namespace

PieceFolder::PieceFolder(const std::string& path, JournalCounters* counters)
    : name_(std::filesystem::path(path).filename()),
      folder_(opendir(folder_of(path).c_str())),
      counters_(counters) {
  if (folder_ == nullptr) {
    throw EventLogError(folder_of(path) +
                        ": the journal's folder cannot be read: " + std::strerror(errno));
  }
}

void PieceFolder::set_current(const char* name) {
  std::snprintf(current_.data(), current_.size(), "%s", name);
}

bool PieceFolder::is_own(const char* name) const {
  std::string_view journal = parse_piece_name(name).journal;
  if (!journal.starts_with(name_)) return false;
  journal.remove_prefix(name_.size());
  if (journal.empty()) return true;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  // ".1" to ".9999", as the daemon writes them; a date behind the name is a user's.
  return journal.size() > 1 && journal.size() <= 5 && journal[0] == '.' && journal[1] != '0' &&
         std::all_of(journal.begin() + 1, journal.end(), is_digit);
}

template <typename Use>
void PieceFolder::for_each(Use&& use) {
  rewinddir(folder_.get());
  while (const dirent* entry = readdir(folder_.get())) {
    const char* name = entry->d_name;
    if (!is_own(name) || std::strcmp(name, current_.data()) == 0) continue;
    struct stat status {};
    if (fstatat(descriptor(), name, &status, AT_SYMLINK_NOFOLLOW) != 0) continue;
    const auto info = read_piece_info(descriptor(), name);
    if (!info) continue;
    Found found{
        {}, *info, status.st_size, parse_piece_name(name).kept, is_in_use(descriptor(), name)};
    std::snprintf(found.name.data(), found.name.size(), "%s", name);
    use(found);
  }
}

std::optional<PieceFolder::Found> PieceFolder::oldest(bool kept, std::int64_t* total_bytes) {
  std::optional<Found> first;
  *total_bytes = 0;
  for_each([&](const Found& piece) {
    if (piece.kept != kept || piece.in_use) return;
    *total_bytes += piece.bytes;
    if (!first || is_earlier(piece.info, first->info)) first = piece;
  });
  return first;
}

void PieceFolder::limit(bool kept, std::int64_t bytes) {
  std::int64_t total = 0;
  for (std::optional<Found> first = oldest(kept, &total); first && total > bytes;
       first = oldest(kept, &total)) {
    const std::int64_t before = counters_->deleted.get();
    remove(*first);
    if (counters_->deleted.get() == before) return;  // it cannot be deleted
  }
}

bool PieceFolder::delete_oldest() {
  std::int64_t total = 0;
  auto first = oldest(false, &total);
  if (!first) first = oldest(true, &total);
  if (!first) return false;
  const std::int64_t before = counters_->deleted.get();
  remove(*first);
  return counters_->deleted.get() != before;
}

std::int64_t PieceFolder::free_bytes() const {
  struct statvfs status {};
  if (fstatvfs(descriptor(), &status) != 0) return std::numeric_limits<std::int64_t>::max();
  const double bytes = static_cast<double>(status.f_bavail) * static_cast<double>(status.f_frsize);
  return static_cast<std::int64_t>(std::min(bytes, 1e18));
}

void PieceFolder::remove(const Found& piece) {
  if (unlinkat(descriptor(), piece.name.data(), 0) == 0) counters_->deleted.add(1);
}

void PieceFolder::keep(const char* name) {
  PieceName piece = parse_piece_name(name);
  if (piece.kept) return;
  piece.kept = true;
  Name to{};
  // Never over a file that is there.
  if (!format_piece_name(piece, to) ||
      faccessat(descriptor(), to.data(), F_OK, AT_SYMLINK_NOFOLLOW) == 0)
    return;
  if (renameat(descriptor(), name, descriptor(), to.data()) == 0) counters_->kept.add(1);
}

void PieceFolder::keep_crashed_run() {
  std::optional<Found> last, before;
  for_each([&](const Found& piece) {
    if (last && is_earlier(piece.info, last->info)) return;
    last = piece;
  });
  if (!last || last->in_use || has_end_mark(descriptor(), last->name.data())) return;
  for_each([&](const Found& piece) {
    if (piece.info.run == last->info.run && piece.info.number == last->info.number - 1)
      before = piece;
  });
  if (before) keep(before->name.data());
  keep(last->name.data());
}

}  // namespace leonav
