#include "tools/import/leo_element_files.h"

#include <utility>

#include "drivers/csv/leo_elements_csv.h"

namespace leonav {

std::vector<Ephemeris> read_leo_element_file(const std::string& path, ImportReport* report) {
  LeoElementsCsv file = read_leo_elements_csv(path);
  report->skip(file.report.problems.empty() ? path : file.report.problems.front(), "unusable row",
               file.report.skipped);
  return std::move(file.ephemerides);
}

}  // namespace leonav
