#include "tools/import/bias_files.h"

#include <set>
#include <utility>

#include "drivers/bias_sinex/bias_sinex_reader.h"

namespace leonav {
namespace {

std::string names_of(const std::set<std::pair<System, SignalCode>>& codes) {
  std::string text;
  for (const auto& [system, code] : codes) {
    text += (text.empty() ? "" : ", ") + std::string(to_string(system)) + " " + to_string(code);
  }
  return text;
}

void report_biases(const std::string& path, const BiasSinexFile& file, ImportReport* report) {
  const std::pair<std::string, std::uint64_t> reasons[] = {
      {"bias of a receiver", file.stations},
      {"bias of a carrier (not used)", file.phases},
      {"bias of a satellite not used", file.other_system},
      {"bias that is neither OSB nor DSB", file.other_kind},
      {"bias that changes within its validity (not read)", file.slopes},
      {"difference of a satellite that has biases of single codes too", file.beside_absolute},
      {"bias beyond the " + std::to_string(BiasSinexFile::kMaxRecords) +
           " that are read of a file, or beyond " + std::to_string(BiasSinexFile::kMaxDifferences) +
           " differences of one satellite",
       file.beyond_capacity},
      {"signal of a satellite that no differences connect to the clock's pair (" +
           names_of(file.unconnected) + ")",
       file.without_reference}};
  for (const auto& [reason, count] : reasons) {
    report->skip(path, reason, static_cast<long>(count));
  }
  if (!file.problems.empty()) {
    report->skip(path + ":" + std::to_string(file.problems.front().line),
                 "damaged line (" + file.problems.front().what + ")",
                 static_cast<long>(file.damaged_lines));
  }
  if (file.truncated) report->warnings.push_back(path + " ends early (no %=ENDBIA line)");
}

}  // namespace

std::vector<SignalBias> read_bias_file(const std::string& path, ImportReport* report) {
  BiasSinexFile file = read_bias_sinex(path);
  report_biases(path, file, report);
  return std::move(file.biases);
}

}  // namespace leonav
