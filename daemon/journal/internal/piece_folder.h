// The PieceFolder deletes and keeps the pieces of a journal's naming in its folder.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "daemon/journal/internal/journal_folder.h"
#include "daemon/journal/internal/kept_names.h"
#include "daemon/journal/journal_counters.h"
#include "drivers/lcm/journal_marks.h"

namespace leonav {

// A file is a piece of its own only if its name is NAME or NAME.<number> with an ending of a piece
// (piece_name.h), and if it begins as a piece does. All others are left alone: journals of older
// versions, logs, whatever a user has put there. Allocates at construction only.
class PieceFolder {
 public:
  using Name = std::array<char, 256>;

  // `name`: of journal.path, without folder. Names of kept pieces go to `kept`.
  PieceFolder(std::string name, JournalFolder* folder, DiskCalls* disk, JournalCounters* counters,
              KeptNames* kept);

  // The piece that is written is neither counted nor touched; the one before it (empty: there is
  // none) is counted.
  void set_own(const Name& current, const Name& before);

  // Deletes the oldest pieces until the others have at most `bytes`: those that are kept, or those
  // that are not. One that cannot be deleted is counted, and the next one is tried.
  void limit(bool kept, std::int64_t bytes);
  // Deletes the oldest one that is not kept; without such a one and `with_kept`, the oldest that
  // is. False: there is none that can be deleted.
  bool delete_oldest(bool with_kept);
  // Renames a piece to NAME.kept, so that limit(false, ...) passes it over.
  void keep(const char* name);
  // Keeps the last two pieces of a run that ended without an end mark. At the start, before there
  // is a current piece.
  void keep_crashed_run();
  // Returns the greatest run of all pieces that leaves room for a greater one; 0: there is none.
  std::int64_t greatest_run();

 private:
  struct Found {
    Name name{};
    PieceInfo info;
    std::int64_t bytes = 0;             // on the disk
    bool kept = false, in_use = false;  // in_use: another daemon writes it
  };
  // Calls use(found) for each piece but the current one.
  template <typename Use>
  void for_each(Use&& use);
  std::optional<Found> look_at(const char* name);
  bool is_in_use(const char* name);
  // The oldest one behind `behind` in age; total_bytes: of all.
  std::optional<Found> oldest(bool kept, const std::optional<Found>& behind,
                              std::int64_t* total_bytes);
  bool remove(const Found& piece);

  std::string name_;
  JournalFolder* folder_;
  DiskCalls* disk_;
  JournalCounters* counters_;
  KeptNames* kept_;
  Name current_{}, before_{};
};

}  // namespace leonav
