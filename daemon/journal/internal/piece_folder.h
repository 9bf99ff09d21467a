// The PieceFolder is the folder of a journal: it deletes and keeps pieces of the journal's naming.
#pragma once
#include <dirent.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/journal/journal_counters.h"
#include "drivers/lcm/journal_marks.h"

namespace leonav {

// A file is a piece of its own only if its name is NAME or NAME.<number> with an ending of a piece
// (piece_name.h), and if it begins as a piece does. All others are left alone: journals of older
// versions, logs, whatever a user has put there. Allocates at construction only.
class PieceFolder {
 public:
  // `path`: journal.path. Throws EventLogError if the folder cannot be read.
  PieceFolder(const std::string& path, JournalCounters* counters);

  // The piece that is written, a name in the folder: neither deleted nor renamed.
  void set_current(const char* name);

  // Deletes the oldest pieces until the others have at most `bytes`: those that are kept, or those
  // that are not.
  void limit(bool kept, std::int64_t bytes);
  // Deletes the oldest one that is not kept, or without such a one the oldest that is; false: there
  // is none.
  bool delete_oldest();
  // Renames a piece to NAME.kept, so that limit(false, ...) passes it over.
  void keep(const char* name);
  // Keeps the last two pieces of a run that ended without an end mark. At the start, before there
  // is a current piece.
  void keep_crashed_run();

  // Bytes that may be written to the file system; the largest number where it is not known.
  std::int64_t free_bytes() const;

  int descriptor() const { return dirfd(folder_.get()); }

 private:
  using Name = std::array<char, 256>;
  struct Found {
    Name name{};
    PieceInfo info;
    std::int64_t bytes = 0;
    bool kept = false, in_use = false;  // in_use: another daemon writes it
  };
  struct CloseFolder {
    void operator()(DIR* folder) const { closedir(folder); }
  };
  bool is_own(const char* name) const;
  // Calls use(found) for each piece but the current one.
  template <typename Use>
  void for_each(Use&& use);
  std::optional<Found> oldest(bool kept, std::int64_t* total_bytes);
  void remove(const Found& piece);

  std::string name_;  // of journal.path, without folder
  std::unique_ptr<DIR, CloseFolder> folder_;
  JournalCounters* counters_;
  Name current_{};
};

}  // namespace leonav
