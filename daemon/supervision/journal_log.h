// The JournalLog logs, each once, where the journal is, what has begun and ceased to be wrong with
// it, and which pieces are kept.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include "daemon/health/journal_health.h"
#include "daemon/journal/journal.h"

namespace leonav {

class JournalLog {
 public:
  // `path`: that of the configuration.
  JournalLog(std::string path, Journal* journal) : path_(std::move(path)), journal_(journal) {}

  // Once a second.
  void look(const JournalHealth& health);
  static void tell_kept(Journal* journal);

 private:
  class Switch {
   public:
    // The new position, where it has changed.
    std::optional<bool> change(bool on) {
      if (std::exchange(on_, on) == on) return std::nullopt;
      return on;
    }

   private:
    bool on_ = false;
  };

  void tell_name();
  void tell_failure(const JournalHealth& health);
  void tell_loss(const JournalHealth& health);

  std::string path_;
  Journal* journal_;
  bool named_ = false;
  Switch fails_, loses_, unsynced_, undeletable_;
};

}  // namespace leonav
