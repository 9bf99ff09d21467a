// A journal gets a name that no earlier journal has.
#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "daemon/journal/internal/journal_file.h"
#include "daemon/journal/internal/journal_folder.h"

namespace leonav {

inline constexpr int kMostNumberedJournals = 9999;

// Returns 0 for NAME and n for NAME.n, n from 1 to 9999 as the daemon writes it; nullopt: another
// name, such as one with a date behind it, which is a user's.
std::optional<int> journal_number(std::string_view journal, std::string_view name);

// Writes NAME or NAME.n with a final zero; false: it does not fit.
bool format_journal_name(std::string_view name, int number, std::span<char> text);

// Makes an empty file for a journal and opens it: NAME, or if that (the journal of a crash, say)
// or one of its later pieces exists, the first of NAME.1, NAME.2, ... that is free. Returns its
// number; nullopt: error() of the calls is the reason, EEXIST where all numbers are taken. Does not
// allocate.
std::optional<int> claim_journal(std::string_view name, JournalFolder* folder, JournalFile* file,
                                 DiskCalls* disk, int most_numbers = kMostNumberedJournals);

}  // namespace leonav
