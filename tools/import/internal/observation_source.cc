#include "tools/import/internal/observation_source.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <deque>
#include <set>
#include <utility>

#include "drivers/rinex/observation_reader.h"
#include "drivers/text/parse.h"
#include "drivers/text/stamp_order.h"
#include "drivers/ubx/ubx_file_reader.h"

namespace leonav {
namespace {

// An observation file of any format.
class ObservationFile {
 public:
  virtual ~ObservationFile() = default;
  virtual bool next(ObservationItem* item) = 0;
  virtual std::string antenna() const { return {}; }
  virtual long line_number() const { return 0; }  // line of the last epoch read; 0: not a text file
  virtual long lost_epochs() const = 0;           // epochs that could not be read
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
  long line_number() const override { return reader_.line_number(); }
  long lost_epochs() const override {
    return reader_.counts().count_of("epoch line that is not readable") +
           reader_.counts().count_of("epoch without a measurement of a used system");
  }

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

bool has_ubx_name(const std::string& path) {
  std::string end = path.size() > 4 ? path.substr(path.size() - 4) : "";
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end == ".ubx";
}

}  // namespace

struct ObservationSource::State {
  using Signal = std::pair<SatelliteId, SignalCode>;
  struct File {
    std::string path;
    long epochs = 0, lost = 0;  // epochs read, and epochs that could not be read
    long disordered = 0, first_disordered_line = 0;
  };
  struct Waiting {
    ObservationItem item;
    std::size_t file = 0;
    long line = 0;
  };

  std::vector<std::string> paths;
  ImportReport* report = nullptr;
  std::vector<File> files;  // files opened; the last one may still be open
  std::unique_ptr<ObservationFile> file;
  std::deque<Waiting> waiting;
  StampWindow window;  // stamps of the epochs in `waiting`
  // Losses of lock that an omitted epoch reported.
  std::set<Signal> interrupted;
  std::string antenna;

  bool read_ahead();
  bool take_epoch(Waiting* front);
  void close();
  void report_order();
  void refuse_empty(const File& empty) const;
};

// Reads one more item; returns false at the end of the last file.
bool ObservationSource::State::read_ahead() {
  Waiting next;
  while (true) {
    if (!file) {
      if (files.size() == paths.size()) return false;
      const std::string& path = paths[files.size()];
      if (has_ubx_name(path)) {
        file = std::make_unique<UbxFile>(path);
      } else {
        file = std::make_unique<RinexFile>(path);
      }
      files.push_back({path});
      if (antenna.empty()) antenna = file->antenna();
    }
    if (file->next(&next.item)) break;
    close();
    if (files.back().epochs == 0) refuse_empty(files.back());
  }
  next.file = files.size() - 1;
  next.line = file->line_number();
  if (const RawEpoch* epoch = std::get_if<RawEpoch>(&next.item)) {
    ++files.back().epochs;
    window.push(epoch->time);
  }
  waiting.push_back(std::move(next));
  return true;
}

// Returns whether the epoch in front is in order; the losses of lock of one that is not are passed
// on.
bool ObservationSource::State::take_epoch(Waiting* front) {
  RawEpoch& epoch = std::get<RawEpoch>(front->item);
  if (window.take()) {
    for (SignalObservation& o : epoch.observations) {
      if (interrupted.empty()) break;
      if (std::isfinite(o.carrier_cycles) && interrupted.erase({o.satellite, o.code}) > 0) {
        o.loss_of_lock = true;
      }
    }
    return true;
  }
  for (const SignalObservation& o : epoch.observations) {
    if (o.loss_of_lock) interrupted.emplace(o.satellite, o.code);
  }
  File& of = files[front->file];
  if (of.disordered++ == 0) of.first_disordered_line = front->line;
  return false;
}

void ObservationSource::State::close() {
  if (!file) return;
  files.back().lost = file->lost_epochs();
  file->report(files.back().path, report);
  file.reset();
}

void ObservationSource::State::report_order() {
  for (const File& of : files) {
    const bool has_line = of.first_disordered_line > 0;
    report->skip(has_line ? of.path + ":" + std::to_string(of.first_disordered_line) : of.path,
                 "epoch whose time does not fit those around it", of.disordered);
    report->warn_if_most_lost(of.path, "epochs", of.disordered + of.lost, of.epochs + of.lost);
  }
  files.clear();
  paths.clear();
}

void ObservationSource::State::refuse_empty(const File& empty) const {
  std::string why = "holds no usable epoch";
  for (const ImportReport::Skip& skip : report->skipped) {
    if (skip.where.rfind(empty.path, 0) != 0) continue;
    why += "; " + std::to_string(skip.count) + " x " + skip.reason;
  }
  throw FileError(empty.path, 0, why);
}

ObservationSource::ObservationSource(std::vector<std::string> paths, ImportReport* report)
    : state_(std::make_unique<State>()) {
  state_->paths = std::move(paths);
  state_->report = report;
}
ObservationSource::~ObservationSource() = default;

bool ObservationSource::next(ObservationItem* item) {
  State& s = *state_;
  while (true) {
    while (!s.window.is_full() && s.read_ahead()) {
    }
    if (s.waiting.empty()) {
      s.report_order();
      return false;
    }
    State::Waiting& front = s.waiting.front();
    const bool is_kept = !std::holds_alternative<RawEpoch>(front.item) || s.take_epoch(&front);
    if (is_kept) *item = std::move(front.item);
    s.waiting.pop_front();
    if (is_kept) return true;
  }
}

const std::string& ObservationSource::antenna() const { return state_->antenna; }

void ObservationSource::finish() {
  state_->close();
  state_->report_order();
  state_->waiting.clear();
}

}  // namespace leonav
