// This unit reads a file of pages of a correction service, one after the other.
#pragma once
#include <string>

#include "drivers/page_lines/page_line.h"
#include "drivers/text/line_reader.h"

namespace leonav {

// Counts of lines that are no page.
struct PageFileCounters {
  long bad_lines = 0;
  long first_bad_line = 0;  // its number; 0: none
};

// Blank lines and remarks are left out. The constructor and next() throw FileError as LineReader
// does.
class PageFileReader {
 public:
  PageFileReader(const std::string& path, PageService service) : lines_(path), service_(service) {}

  // Returns the next page in the order of the file; false at its end.
  bool next(CorrectionPage* page);
  const PageFileCounters& counters() const { return counters_; }

 private:
  LineReader lines_;
  PageService service_;
  PageFileCounters counters_;
};

}  // namespace leonav
