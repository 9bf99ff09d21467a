// The PieceSequence gives a run its files, one after the other, and keeps their folder within its
// limits.
#pragma once
#include <string>

#include "daemon/config/daemon_config.h"
#include "daemon/journal/internal/journal_file.h"
#include "daemon/journal/internal/journal_folder.h"
#include "daemon/journal/internal/piece_folder.h"
#include "daemon/journal/journal_limits.h"

namespace leonav {

// Nothing is looked for before open(), and from there on nothing is allocated. What fails leaves
// its reason in error() of the calls, and may be tried again. A pipe or a device has no pieces: it
// is opened under its name, and that is all.
class PieceSequence {
 public:
  PieceSequence(const JournalConfig& config, DiskCalls* disk, JournalCounters* counters,
                KeptNames* kept);

  // Opens the file of the next piece, empty. At first it finds the folder, tidies it, and claims
  // the journal's name.
  bool open();
  // The beginning of the piece is written.
  void note_begun();
  // The piece ends, with messages. `complete`: no failure has ended it.
  void end(bool complete);
  // The piece has no message: it would only be in the way.
  void discard();

  // Waits until the piece and its name are on the disk.
  bool sync();
  // Whether the piece can still be found under its path.
  bool is_in_place();
  // Keeps the present piece, when it ends, and the one before it, at once.
  void keep();
  // Deletes the oldest piece; false: there is none.
  bool make_room();

  // These hold from now on.
  void set_limits(const JournalLimits& limits);
  // Between two pieces: the next one says that it holds these.
  void set_outputs(RecordedOutputs outputs) { info_.outputs = outputs; }

  JournalFile& file() { return file_; }
  // Of the piece that is open, without its first event.
  const PieceInfo& info() const { return info_; }
  bool has_pieces() const { return !is_stream_; }

 private:
  bool prepare();
  bool open_stream();
  bool claim();
  bool open_next();
  bool reopen();
  void apply_limits();

  JournalLimits limits_;
  std::string name_;  // of journal.path, without folder
  DiskCalls* disk_;
  JournalCounters* counters_;
  JournalFolder folder_;
  JournalFile file_;
  PieceFolder pieces_;
  PieceInfo info_;
  PieceFolder::Name journal_name_{}, piece_name_{}, last_name_{};  // last: of the piece before
  bool prepared_ = false, is_stream_ = false;
  bool first_begun_ = false;
  bool left_behind_ = false;  // the piece that was discarded is still there
  ino_t left_inode_ = 0;
  bool keeps_piece_ = false;
  bool name_synced_ = false;
};

}  // namespace leonav
