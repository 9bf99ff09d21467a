#include "tools/import/internal/observation_file.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "drivers/rinex/observation_reader.h"
#include "tools/import/internal/oem7_file.h"
#include "tools/import/internal/rtcm3_file.h"
#include "tools/import/internal/sbf_file.h"
#include "tools/import/internal/ubx_file.h"

namespace leonav {
namespace {

class RinexFile final : public ObservationFile {
 public:
  explicit RinexFile(const std::string& path) : reader_(path) {}

  bool next(ObservationItem* item) override {
    if (!std::holds_alternative<RawEpoch>(*item)) item->emplace<RawEpoch>();
    return reader_.next(&std::get<RawEpoch>(*item));
  }

  std::string antenna() const override { return reader_.header().antenna; }
  long line_number() const override { return reader_.line_number(); }
  long lost_epochs() const override {
    return reader_.counts().count_of("epoch line that is not readable") +
           reader_.counts().count_of("epoch without a measurement of a used system");
  }

  void report(const std::string& path, ImportReport* report) const override {
    for (const ReadCounts::Skip& skip : reader_.counts().skipped) {
      report->skip(path + ":" + std::to_string(skip.first_line), skip.reason, skip.count);
    }
    report->skip(path, reader_.losses());
  }

 private:
  ObservationReader reader_;
};

}  // namespace

bool has_ending(const std::string& path, std::string_view lower_case_ending) {
  if (path.size() < lower_case_ending.size()) return false;
  std::string end = path.substr(path.size() - lower_case_ending.size());
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end == lower_case_ending;
}

std::unique_ptr<ObservationFile> open_observation_file(const std::string& path, GpsTime date) {
  if (has_ubx_name(path)) return std::make_unique<UbxFile>(path);
  if (has_oem7_name(path)) return std::make_unique<Oem7File>(path);
  if (has_sbf_name(path)) return std::make_unique<SbfFile>(path);
  if (has_rtcm3_name(path)) return std::make_unique<Rtcm3File>(path, date);
  return std::make_unique<RinexFile>(path);
}

}  // namespace leonav
