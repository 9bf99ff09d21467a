#include "tools/import/internal/bias_source.h"

#include <algorithm>
#include <string>

#include "core/base/capacity.h"
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

void report_file(const std::string& path, const BiasSinexFile& file, ImportReport* report) {
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

std::vector<ScheduledBiases> in_messages(
    const std::map<GpsTime, std::vector<SignalBias>>& by_arrival) {
  std::vector<ScheduledBiases> scheduled;
  for (const auto& [arrival, biases] : by_arrival) {
    for (std::size_t i = 0; i < biases.size(); i += kMaxBiases) {
      const auto begin = biases.begin() + static_cast<std::ptrdiff_t>(i);
      const auto count = static_cast<std::ptrdiff_t>(std::min(kMaxBiases, biases.size() - i));
      scheduled.push_back({arrival, {begin, begin + count}});
    }
  }
  return scheduled;
}

std::vector<ScheduledBiases> load_biases(const std::vector<std::string>& paths, GpsTime start,
                                         GpsTime end, ImportReport* report) {
  std::map<GpsTime, std::vector<SignalBias>> by_arrival;
  for (const std::string& path : paths) {
    const BiasSinexFile file = read_bias_sinex(path);
    report_file(path, file, report);
    long outside = 0, not_sane = 0;
    for (SignalBias bias : file.biases) {
      if (bias.valid_until <= start || (end.is_set() && bias.valid_from > end)) {
        ++outside;
        continue;
      }
      const bool holds = bias.valid_from <= start;
      bias.time = holds ? start : std::max(start, bias.valid_from.plus_seconds(-kBiasLead_s));
      if (is_sane(bias)) {
        by_arrival[bias.time].push_back(bias);
      } else {
        ++not_sane;
      }
    }
    report->skip(path, "bias that does not hold during the recording", outside);
    report->skip(path, "bias that no satellite can have", not_sane);
  }
  return in_messages(by_arrival);
}

}  // namespace leonav
