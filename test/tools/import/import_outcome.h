// What came of an import.
#pragma once
#include <exception>
#include <string>

#include "tools/import/import.h"

namespace leonav::test {

// Why a dataset cannot be imported; empty if it can.
inline std::string import_error(const std::string& yaml) {
  try {
    import_dataset(load_dataset(yaml), {}, yaml + ".lcmlog", nullptr);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

// How much was left out for reasons with these words.
inline long left_out(const ImportReport& report, const std::string& reason) {
  long count = 0;
  for (const auto& skip : report.skipped) {
    if (skip.reason.find(reason) != std::string::npos) count += skip.count;
  }
  return count;
}

}  // namespace leonav::test
