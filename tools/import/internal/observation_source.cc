#include "tools/import/internal/observation_source.h"

#include <cmath>
#include <deque>
#include <set>
#include <utility>

#include "drivers/text/parse.h"
#include "drivers/text/stamp_order.h"

namespace leonav {
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
  GpsTime date;
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
      file = open_observation_file(path, date);
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

ObservationSource::ObservationSource(std::vector<std::string> paths, GpsTime date,
                                     ImportReport* report)
    : state_(std::make_unique<State>()) {
  state_->paths = std::move(paths);
  state_->date = date;
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
