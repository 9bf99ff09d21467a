// Where a journal goes without destroying an earlier one.
#pragma once
#include <string>

namespace leonav {

inline constexpr int kMostNumberedJournals = 9999;

// Makes an empty file for a journal and returns its name: `path`, or where that is a file already
// (the evidence of a crash, say) the first of "path.1", "path.2", ... that is free. What is no
// ordinary file (a pipe, a device) holds nothing that could be lost and is returned as it is, and
// so is a path where no file can be made: whoever opens it learns why. Throws EventLogError if all
// numbers are taken.
std::string claim_journal_path(const std::string& path, int most_numbers = kMostNumberedJournals);

}  // namespace leonav
