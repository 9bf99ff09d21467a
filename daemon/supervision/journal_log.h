// The JournalLog logs, each once, where the journal is, what has begun and ceased to be wrong with
// it, and which pieces are kept.
#pragma once
#include <string>
#include <utility>

#include "daemon/health/journal_health.h"
#include "daemon/journal/journal.h"
#include "daemon/supervision/changed.h"

namespace leonav {

class JournalLog {
 public:
  // `path`: that of the configuration.
  JournalLog(std::string path, Journal* journal) : path_(std::move(path)), journal_(journal) {}

  // Once a second.
  void look(const JournalHealth& health);
  static void tell_kept(Journal* journal);

 private:
  void tell_name();
  void tell_failure(const JournalHealth& health);
  void tell_loss(const JournalHealth& health);

  std::string path_;
  Journal* journal_;
  bool named_ = false;
  Changed<bool> fails_, loses_, unsynced_, undeletable_;
};

}  // namespace leonav
