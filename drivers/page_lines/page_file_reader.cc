#include "drivers/page_lines/page_file_reader.h"

namespace leonav {

bool PageFileReader::next(CorrectionPage* page) {
  for (std::string_view line; lines_.next(line);) {
    if (is_remark(line)) continue;
    if (const auto read = page_from_line(line, service_)) {
      *page = *read;
      return true;
    }
    if (counters_.bad_lines++ == 0) counters_.first_bad_line = lines_.line_number();
  }
  return false;
}

}  // namespace leonav
