#include "tools/dataset/observation_source.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "drivers/rinex/observation_reader.h"
#include "drivers/text/parse.h"
#include "drivers/ubx/ubx_file_reader.h"

namespace leonav {
namespace {

// One observation file, whatever its format.
class ObservationFile {
 public:
  virtual ~ObservationFile() = default;
  virtual bool next(ObservationItem* item) = 0;
  virtual std::string antenna() const { return {}; }
  virtual void report(const std::string& path, ImportReport* report) const = 0;
};

class RinexFile final : public ObservationFile {
 public:
  explicit RinexFile(const std::string& path) : reader_(path) {}

  bool next(ObservationItem* item) override {
    if (!std::holds_alternative<RawEpoch>(*item)) item->emplace<RawEpoch>();
    return reader_.next(&std::get<RawEpoch>(*item));
  }

  std::string antenna() const override { return reader_.header().antenna; }

  void report(const std::string& path, ImportReport* report) const override {
    for (const ReadCounts::Skip& skip : reader_.counts().skipped) {
      report->skip(path + ":" + std::to_string(skip.first_line), skip.reason, skip.count);
    }
  }

 private:
  ObservationReader reader_;
};

class UbxFile final : public ObservationFile {
 public:
  explicit UbxFile(const std::string& path) : reader_(path) {}

  bool next(ObservationItem* item) override { return reader_.next(item); }

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

bool has_ubx_name(const std::string& path) {
  std::string end = path.size() > 4 ? path.substr(path.size() - 4) : "";
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end == ".ubx";
}

}  // namespace

struct ObservationSource::State {
  std::vector<std::string> paths;
  ImportReport* report = nullptr;
  std::size_t opened = 0;  // paths[opened - 1] is open or was
  std::unique_ptr<ObservationFile> file;
  long epochs_of_file = 0, late_of_file = 0;
  GpsTime last_time;
  std::string antenna;

  const std::string& path() const { return paths[opened - 1]; }

  void open_next() {
    const std::string& path = paths[opened++];
    epochs_of_file = late_of_file = 0;
    if (has_ubx_name(path)) {
      file = std::make_unique<UbxFile>(path);
    } else {
      file = std::make_unique<RinexFile>(path);
    }
    if (antenna.empty()) antenna = file->antenna();
  }

  void close() {
    if (!file) return;
    file->report(path(), report);
    report->skip(path(), "epoch that is not later than the one before", late_of_file);
    file.reset();
  }

  void refuse_empty() const {
    if (epochs_of_file > 0) return;
    std::string why = "holds no usable epoch";
    for (const ImportReport::Skip& skip : report->skipped) {
      if (skip.where.rfind(path(), 0) != 0) continue;
      why += "; " + std::to_string(skip.count) + " x " + skip.reason;
    }
    throw FileError(path(), 0, why);
  }
};

ObservationSource::ObservationSource(std::vector<std::string> paths, ImportReport* report)
    : state_(std::make_unique<State>()) {
  state_->paths = std::move(paths);
  state_->report = report;
}
ObservationSource::~ObservationSource() = default;

bool ObservationSource::next(ObservationItem* item) {
  while (true) {
    if (!state_->file) {
      if (state_->opened == state_->paths.size()) return false;
      state_->open_next();
    }
    if (!state_->file->next(item)) {
      state_->close();
      state_->refuse_empty();
      continue;
    }
    const RawEpoch* epoch = std::get_if<RawEpoch>(item);
    if (epoch == nullptr) return true;
    ++state_->epochs_of_file;
    if (epoch->time > state_->last_time) {
      state_->last_time = epoch->time;
      return true;
    }
    ++state_->late_of_file;
  }
}

const std::string& ObservationSource::antenna() const { return state_->antenna; }

void ObservationSource::finish() { state_->close(); }

}  // namespace leonav
