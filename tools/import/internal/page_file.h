// This unit reads recorded pages of correction services for the import.
#pragma once
#include <string>
#include <vector>

#include "tools/import/import_report.h"
#include "tools/import/internal/corrections.h"

namespace leonav {

// Returns whether a file of corrections holds pages: lines of HAS (.has) or PPP-B2b (.b2b), or what
// a receiver has recorded of them (.ubx, .sbf).
bool has_page_name(const std::string& path);

// Reads the corrections of a file in its order; each arrives with the page that completes its
// message. What is left out is counted in `report`. Throws FileError for a file that cannot be read
// or has no corrections, with the reasons.
std::vector<ScheduledCorrection> read_pages(const std::string& path, ImportReport* report);

}  // namespace leonav
