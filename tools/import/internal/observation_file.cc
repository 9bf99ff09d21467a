#include "tools/import/internal/observation_file.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "drivers/rinex/observation_reader.h"
#include "drivers/ubx/ubx_file_reader.h"
#include "tools/import/internal/oem7_file.h"
#include "tools/import/internal/rtcm3_file.h"

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

class UbxFile final : public ObservationFile {
 public:
  explicit UbxFile(const std::string& path) : reader_(path) {}

  bool next(ObservationItem* item) override { return reader_.next(item); }
  long lost_epochs() const override {
    const RxmRawxCounters rawx = reader_.counters().rawx;
    return static_cast<long>(rawx.bad_length + rawx.bad_version + rawx.bad_time);
  }

  void report(const std::string& path, ImportReport* report) const override {
    const UbxCounters counters = reader_.counters();
    const auto& [framer, rawx, sfrbx, other] = counters;
    const std::pair<const char*, std::uint64_t> reasons[] = {
        {"message with a wrong checksum", framer.bad_checksums},
        {"message with an impossible length", framer.oversize},
        {"message that the end of the file cuts off", framer.incomplete},
        {"NMEA sentence (another protocol, not read; the UBX messages around it are whole)",
         framer.foreign.nmea_sentences},
        {"RTCM 3 frame (another protocol, not read; the UBX messages around it are whole)",
         framer.foreign.rtcm3_frames},
        {"byte of no message (damage, or a protocol that is not known here)",
         framer.bytes_skipped - framer.foreign.bytes()},
        {"RAWX message with a wrong length or version", rawx.bad_length + rawx.bad_version},
        {"RAWX message with an impossible time", rawx.bad_time},
        {"measurement of a system not used", rawx.other_system},
        {"measurement of a signal without a RINEX code", rawx.unknown_signal},
        {"measurement of a satellite that does not exist", rawx.bad_satellite},
        {"measured value out of range", rawx.bad_value},
        {"measurement that is twice in an epoch", rawx.duplicates},
        {"measurement without a value", rawx.empty},
        {"subframe of a system not used", sfrbx.other_system},
        {"subframe of a message not used", sfrbx.other_message},
        {"subframe with a wrong length or version", sfrbx.bad_length + sfrbx.bad_version},
        {"subframe with a parity error", sfrbx.bad_parity},
        {"subframe of a satellite that does not exist", sfrbx.bad_satellite},
        {"subframe that contradicts its message", sfrbx.bad_week + sfrbx.wrong_satellite},
        {"subframe before the first epoch told the week", sfrbx.without_time},
        {"ephemeris that no satellite can have sent", sfrbx.not_sane}};
    for (const auto& [reason, count] : reasons) {
      report->skip(path, reason, static_cast<long>(count));
    }
  }

 private:
  UbxFileReader reader_;
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
  if (has_ending(path, ".ubx")) return std::make_unique<UbxFile>(path);
  if (has_oem7_name(path)) return std::make_unique<Oem7File>(path);
  if (has_rtcm3_name(path)) return std::make_unique<Rtcm3File>(path, date);
  return std::make_unique<RinexFile>(path);
}

}  // namespace leonav
