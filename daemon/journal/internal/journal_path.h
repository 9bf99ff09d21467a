// A journal gets a path that does not overwrite an earlier journal.
#pragma once
#include <string>

namespace leonav {

inline constexpr int kMostNumberedJournals = 9999;

// Makes an empty file for a journal and returns its name: `path`, or if that file exists (the
// journal of a crash, say) or later pieces of it, the first of "path.1", "path.2", ... that is
// free. A pipe or a device is returned as it is, for it holds nothing that could be lost. A path
// where no file can be made is returned too: opening it gives the reason. Throws EventLogError if
// all numbers are taken.
std::string claim_journal_path(const std::string& path, int most_numbers = kMostNumberedJournals);

}  // namespace leonav
