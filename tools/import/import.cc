#include "tools/import/import.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "drivers/clk/clock_reader.h"
#include "drivers/csv/imu_csv.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/sp3/sp3_reader.h"
#include "drivers/text/parse.h"
#include "drivers/text/stamp_order.h"
#include "tools/import/internal/antenna_source.h"
#include "tools/import/internal/bias_source.h"
#include "tools/import/internal/corrections.h"
#include "tools/import/internal/delay_source.h"
#include "tools/import/internal/observation_source.h"
#include "tools/import/internal/oem7_file.h"
#include "tools/import/internal/page_file.h"
#include "tools/import/internal/rtcm3_file.h"
#include "tools/import/internal/sbf_file.h"
#include "tools/import/internal/ubx_file.h"
#include "tools/import/leo_element_files.h"
#include "tools/import/log_output.h"
#include "tools/import/product_schedule.h"

namespace leonav {
namespace {

const GpsTime kNever = GpsTime::from_nanoseconds(std::numeric_limits<std::int64_t>::max());

class Import {
 public:
  Import(const Dataset& dataset, const ImportOptions& options, std::ostream* progress)
      : dataset_(dataset),
        options_(options),
        progress_(progress),
        corrections_({.at_antenna = dataset.corrections_at_antenna}),
        observations_(dataset.observations, dataset.date, &report_) {}

  ImportReport run(const std::string& output) {
    check_output(output, dataset_.files());
    warn_of_missing();
    load_navigation();
    load_leo_elements();
    load_orbits();
    load_corrections();
    load_imu();
    fetch_observation();
    const GpsTime start = std::min(imu_arrival(), observation_arrival());
    if (start == kNever) {
      throw std::runtime_error(dataset_.path +
                               ": no IMU sample and no GNSS epoch within the time asked for; "
                               "nothing to write");
    }
    antennas_ = load_antennas(dataset_, observations_.antenna(), start, &report_);
    LogOutput log(output, &report_);
    load_clocks(start);
    schedule_biases(start);
    schedule(start);
    send_first(start, &log);
    while (send_next(&log)) show_progress();
    observations_.finish();
    corrections_.report(dataset_.path, &report_);
    report_.skip(dataset_.path, "ephemeris sent after the end",
                 static_cast<long>(ephemerides_.size() - next_ephemeris_));
    long late_biases = 0;
    for (std::size_t i = next_bias_; i < biases_.size(); ++i)
      late_biases += static_cast<long>(biases_[i].biases.size());
    report_.skip(dataset_.path, "bias that comes after the end", late_biases);
    warn_of_missing_ephemerides();
    log.commit();
    return report_;
  }

 private:
  bool is_after(GpsTime time) const { return options_.to.is_set() && time > options_.to; }
  bool is_before(GpsTime time) const { return options_.from.is_set() && time < options_.from; }

  void warn_of_missing();
  void warn_of_missing_ephemerides();
  void load_navigation();
  void load_leo_elements();
  void load_orbits();
  void load_clocks(GpsTime start);
  std::vector<ImuSample> read_imu(const std::string& path);
  void load_corrections();
  void load_imu();
  void schedule_biases(GpsTime start);
  void schedule(GpsTime start);
  void send_first(GpsTime start, LogOutput* log);
  bool send_next(LogOutput* log);
  void send_observation(LogOutput* log);
  void fetch_observation();
  void show_progress();

  GpsTime imu_arrival() const { return next_imu_ < imu_.size() ? imu_[next_imu_].time : kNever; }
  GpsTime observation_arrival() const { return observation_ ? observation_arrival_ : kNever; }
  GpsTime ephemeris_arrival() const {
    return next_ephemeris_ < ephemerides_.size() ? ephemerides_[next_ephemeris_].arrival : kNever;
  }
  GpsTime orbit_arrival() const {
    return next_orbit_ < orbits_.size() ? orbits_[next_orbit_].arrival : kNever;
  }

  GpsTime bias_arrival() const {
    return next_bias_ < biases_.size() ? biases_[next_bias_].arrival : kNever;
  }
  GpsTime correction_arrival() const {
    return next_correction_ < arriving_corrections_.size()
               ? arriving_corrections_[next_correction_].arrival
               : kNever;
  }

  const Dataset& dataset_;
  const ImportOptions& options_;
  std::ostream* progress_;
  ImportReport report_;
  Corrections corrections_;
  std::vector<ScheduledCorrection> arriving_corrections_;
  std::vector<ScheduledBiases> biases_;
  ObservationSource observations_;
  std::optional<ObservationItem> observation_;  // the next one; empty at the end
  GpsTime observation_arrival_;
  std::vector<ObservationItem> before_start_;  // navigation data ahead of the first epoch
  bool has_epoch_ = false;
  std::vector<ImuSample> imu_;
  std::vector<Ephemeris> navigation_;
  std::vector<SignalBias> navigation_delays_;
  std::vector<OrbitEpoch> orbit_epochs_, clock_epochs_;
  std::vector<ScheduledEphemeris> ephemerides_;
  std::vector<ScheduledOrbitEpoch> orbits_;
  KlobucharModel klobuchar_;
  std::vector<AntennaPattern> antennas_;
  std::size_t next_imu_ = 0, next_ephemeris_ = 0, next_orbit_ = 0, next_correction_ = 0,
              next_bias_ = 0;
  std::chrono::steady_clock::time_point shown_ = std::chrono::steady_clock::now();
};

// Observations of some formats bring ephemerides, so that this is known at the end.
void Import::warn_of_missing_ephemerides() {
  if (report_.ephemerides > 0) return;
  report_.warnings.push_back(
      dataset_.orbits.empty()
          ? "no orbits, and no ephemerides in the navigation or the observations: no satellite has "
            "a position and there will be no solution"
          : "no ephemerides in the navigation or the observations: no group delays and no "
            "ionosphere model, so single-frequency positions "
            "are off by metres, and satellites the orbits lack are not used");
}

void Import::warn_of_missing() {
  const auto warn = [this](const std::string& text) { report_.warnings.push_back(text); };
  if (dataset_.observations.empty()) {
    warn("no observations: there is nothing to position by, only the IMU can be replayed");
  }
  if (dataset_.orbits.empty() && dataset_.corrections.empty()) {
    warn(
        "no orbits: broadcast orbits and clocks are used, which are off by 0.5 to 2 m; there is "
        "no centimetre solution");
  }
  if (dataset_.imu.empty()) {
    warn(
        "no imu: no attitude, no solution between the epochs and through outages (configure the "
        "constant-velocity motion model)");
  }
  for (const std::string& path : dataset_.truth) {
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) continue;
    warn("truth " + path + " is not there: nothing to judge the results by");
  }
  if (!dataset_.biases.empty() && dataset_.orbits.empty() && dataset_.corrections.empty()) {
    warn(
        "biases without orbits: they belong to the clocks of the product they came with, and "
        "broadcast clocks are used without them");
  }
  if (!dataset_.clocks.empty() && dataset_.orbits.empty()) {
    warn("clocks without orbits are of no use: broadcast orbits go with broadcast clocks");
  } else if (dataset_.clocks.empty() && !dataset_.orbits.empty()) {
    warn(
        "no clocks: satellite clocks are interpolated between the sparser nodes of the orbits, so "
        "that GPS ranges are off by 3 cm (5 minutes) to 4 cm (15 minutes), rms");
  }
}

void Import::load_navigation() {
  for (const std::string& path : dataset_.navigation) {
    if (has_rtcm3_name(path)) {
      const std::vector<Ephemeris> read = read_rtcm3_ephemerides(path, dataset_.date, &report_);
      navigation_.insert(navigation_.end(), read.begin(), read.end());
      continue;
    }
    NavigationFile file = read_navigation(path);
    for (const ReadCounts::Skip& skip : file.counts.skipped) {
      report_.skip(path + ":" + std::to_string(skip.first_line), skip.reason, skip.count);
    }
    if (file.ephemerides.empty()) {
      const std::string what = "holds no usable ephemeris (" +
                               std::to_string(file.counts.skipped_total()) + " records left out)";
      if (!file.counts.all_skipped_by_design()) throw FileError(path, 0, what);
      report_.warnings.push_back(path + " " + what);
    }
    navigation_.insert(navigation_.end(), file.ephemerides.begin(), file.ephemerides.end());
    navigation_delays_.insert(navigation_delays_.end(), file.delays.begin(), file.delays.end());
    if (file.klobuchar.valid && !klobuchar_.valid) klobuchar_ = file.klobuchar;
  }
}

void Import::load_leo_elements() {
  for (const std::string& path : dataset_.leo_elements) {
    const std::vector<Ephemeris> read = read_leo_element_file(path, &report_);
    navigation_.insert(navigation_.end(), read.begin(), read.end());
  }
}

void Import::load_orbits() {
  for (const std::string& path : dataset_.orbits) {
    Sp3File file = read_sp3(path);
    report_.skip(path, "position of a system not used", static_cast<long>(file.other_system));
    report_.skip(path, "position marked bad or absent", static_cast<long>(file.bad_positions));
    report_.skip(path, "clock marked bad or absent", static_cast<long>(file.bad_clocks));
    const std::string first =
        file.problems.empty() ? path : path + ":" + std::to_string(file.problems.front().line);
    report_.skip(first, "damaged line", static_cast<long>(file.damaged_lines));
    report_.skip(path, "interval in which a clock was changed",
                 static_cast<long>(file.clock_events));
    report_.skip(path, "interval in which an orbit was changed", static_cast<long>(file.maneuvers));
    if (file.truncated) report_.warnings.push_back(path + " ends early (no EOF line)");
    for (Sp3Epoch& epoch : file.epochs) {
      orbit_epochs_.push_back({epoch.time, std::move(epoch.states)});
    }
  }
}

// Loads only clocks that the recording can need: a day of 5 s clocks is a hundred times the rest.
void Import::load_clocks(GpsTime start) {
  constexpr double kMargin = 3600.0;  // s; more than the nodes ahead take
  for (const std::string& path : dataset_.clocks) {
    ClockReader reader(path);
    for (ClockEpoch epoch; reader.next(&epoch);) {
      const bool late = options_.to.is_set() && epoch.time > options_.to.plus_seconds(kMargin);
      if (late || epoch.time < start.plus_seconds(-kMargin)) continue;
      clock_epochs_.push_back({epoch.time, std::move(epoch.states)});
    }
    const ClockCounts& counts = reader.counts();
    report_.skip(path, "clock of a system not used", static_cast<long>(counts.other_system));
    report_.skip(path, "clock marked bad", static_cast<long>(counts.bad_clocks));
    report_.skip(path, "record of a receiver's clock", static_cast<long>(counts.other_records));
    const bool located = !counts.problems.empty();
    report_.skip(located ? path + ":" + std::to_string(counts.problems.front().line) : path,
                 "damaged line", static_cast<long>(counts.damaged_lines));
  }
}

// Returns the samples of an imu.csv, or of a file of a receiver that has an inertial sensor.
std::vector<ImuSample> Import::read_imu(const std::string& path) {
  if (has_oem7_name(path)) return read_oem7_imu(path, dataset_.imu_scale, &report_);
  if (has_sbf_name(path)) return read_sbf_imu(path, &report_);
  if (has_ubx_name(path)) return read_ubx_imu(path, options_.gnss_latency_s, &report_);
  ImuCsv csv = read_imu_csv(path);
  const bool located = !csv.report.problems.empty();
  report_.skip(located ? csv.report.problems.front() : path, "unusable row", csv.report.skipped);
  report_.warn_if_most_lost(path, "rows", csv.report.skipped, csv.report.skipped + csv.report.rows);
  if (csv.gaps > 0) {
    report_.warnings.push_back(path + " has " + std::to_string(csv.gaps) +
                               " gaps: the solution is interrupted or worse after them");
  }
  return std::move(csv.samples);
}

void Import::load_corrections() {
  for (const std::string& path : dataset_.corrections) {
    auto of_file = has_page_name(path) ? read_pages(path, &report_)
                                       : read_corrections(path, dataset_.date,
                                                          dataset_.corrections_latency_s, &report_);
    corrections_.add_file(path, &of_file);
    std::move(of_file.begin(), of_file.end(), std::back_inserter(arriving_corrections_));
  }
  std::stable_sort(arriving_corrections_.begin(), arriving_corrections_.end(),
                   [](const auto& a, const auto& b) { return a.arrival < b.arrival; });
}

void Import::load_imu() {
  std::vector<ImuSample> all;
  std::vector<GpsTime> stamps;
  for (const std::string& path : dataset_.imu) {
    long outside = 0;
    for (const ImuSample& sample : read_imu(path)) {
      if (is_before(sample.time) || is_after(sample.time)) {
        ++outside;
      } else {
        all.push_back(sample);
        stamps.push_back(sample.time);
      }
    }
    report_.skip(path, "IMU sample outside the time asked for", outside);
  }
  // Each file is tested for order separately: a wrong stamp at the end of one must not affect the
  // next.
  const std::vector<bool> in_order = stamps_in_order(stamps);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (in_order[i]) imu_.push_back(all[i]);
  }
  const auto late = static_cast<long>(all.size() - imu_.size());
  report_.skip(dataset_.path, "IMU sample whose time does not fit the files around it", late);
  report_.warn_if_most_lost(dataset_.path, "IMU samples", late, static_cast<long>(all.size()));
}

void Import::schedule_biases(GpsTime start) {
  biases_ = load_biases(dataset_.biases, start, options_.to, &report_);
  auto delays = schedule_delays(std::move(navigation_delays_), start, options_.to);
  std::move(delays.begin(), delays.end(), std::back_inserter(biases_));
  std::stable_sort(biases_.begin(), biases_.end(),
                   [](const auto& a, const auto& b) { return a.arrival < b.arrival; });
}

void Import::schedule(GpsTime start) {
  EphemerisSchedule schedule = schedule_ephemerides(std::move(navigation_), start);
  ephemerides_ = std::move(schedule.items);
  report_.skip(dataset_.path, "ephemeris that repeats another", schedule.repeated);
  report_.skip(dataset_.path, "ephemeris no longer valid at the start", schedule.expired);
  report_.skip(dataset_.path, "ephemeris with two newer ones at the start", schedule.superseded);
  const std::size_t nodes = orbit_epochs_.size();
  orbits_ = schedule_orbits(std::move(orbit_epochs_), start, kOrbitNodesAhead);
  if (nodes > 0 && orbits_.empty()) {
    report_.warnings.push_back("the orbits end before the recording begins: they are of no use");
  }
  auto clocks = schedule_orbits(std::move(clock_epochs_), start, kClockNodesAhead);
  if (!dataset_.clocks.empty() && clocks.empty()) {
    report_.warnings.push_back("the clocks end before the recording begins: they are of no use");
  }
  const auto orbits_end = static_cast<std::ptrdiff_t>(orbits_.size());
  std::move(clocks.begin(), clocks.end(), std::back_inserter(orbits_));
  std::inplace_merge(orbits_.begin(), orbits_.begin() + orbits_end, orbits_.end(),
                     [](const auto& a, const auto& b) { return a.arrival < b.arrival; });
}

// Sends everything that is known when the recording begins.
void Import::send_first(GpsTime start, LogOutput* log) {
  for (const AntennaPattern& pattern : antennas_) log->write(start, pattern);
  if (klobuchar_.valid) log->write(start, klobuchar_);
  // Of what arrived before, the newest is known.
  for (; correction_arrival() < start; ++next_correction_) {
    corrections_.take(arriving_corrections_[next_correction_], nullptr);
  }
  for (ObservationItem& item : before_start_) {
    if (auto* ephemeris = std::get_if<Ephemeris>(&item)) {
      if (!is_for_corrections_alone(*ephemeris)) log->write(start, *ephemeris);
      corrections_.add(*ephemeris);
    }
    if (auto* model = std::get_if<KlobucharModel>(&item)) log->write(start, *model);
    if (auto* biases = std::get_if<std::vector<SignalBias>>(&item)) log->write(start, *biases);
  }
}

// Reads ahead to the next item that will be sent.
void Import::fetch_observation() {
  if (!observation_) observation_.emplace();
  while (observations_.next(&*observation_)) {
    if (const RawEpoch* epoch = std::get_if<RawEpoch>(&*observation_)) {
      if (is_before(epoch->time)) continue;
      if (is_after(epoch->time)) break;
      has_epoch_ = true;
      observation_arrival_ = epoch->time.plus_seconds(options_.gnss_latency_s);
      return;
    }
    if (auto* ephemeris = std::get_if<Ephemeris>(&*observation_)) {
      ephemeris->transmission_time = transmission_time(*ephemeris);
    }
    // Navigation data arrive with the epoch that they follow in the file.
    if (has_epoch_) return;
    before_start_.push_back(*observation_);
  }
  observation_.reset();
}

void Import::send_observation(LogOutput* log) {
  const auto* ephemeris = std::get_if<Ephemeris>(&*observation_);
  if (ephemeris == nullptr || !is_for_corrections_alone(*ephemeris)) {
    std::visit([&](const auto& item) { log->write(observation_arrival_, item); }, *observation_);
  }
  if (ephemeris != nullptr) corrections_.add(*ephemeris);
  fetch_observation();
}

// Sends the earliest of the waiting items, products first if several arrive at once. Returns false
// when neither IMU samples nor observations are left.
bool Import::send_next(LogOutput* log) {
  const GpsTime data = std::min(imu_arrival(), observation_arrival());
  if (data == kNever) return false;
  if (bias_arrival() <= data) {
    const ScheduledBiases& item = biases_[next_bias_++];
    log->write(item.arrival, std::span<const SignalBias>(item.biases));
  } else if (ephemeris_arrival() <= std::min(data, correction_arrival())) {
    const ScheduledEphemeris& item = ephemerides_[next_ephemeris_++];
    if (!is_for_corrections_alone(item.ephemeris)) log->write(item.arrival, item.ephemeris);
    corrections_.add(item.ephemeris);
  } else if (correction_arrival() <= data) {
    corrections_.take(arriving_corrections_[next_correction_++], log);
  } else if (orbit_arrival() <= data) {
    const ScheduledOrbitEpoch& item = orbits_[next_orbit_++];
    log->write(item.arrival, std::span<const PreciseState>(item.epoch.states));
  } else if (imu_arrival() <= data) {
    log->write(data, imu_[next_imu_++]);
  } else {
    send_observation(log);
  }
  return true;
}

void Import::show_progress() {
  const auto now = std::chrono::steady_clock::now();
  if (progress_ == nullptr || now - shown_ < std::chrono::seconds(2)) return;
  shown_ = now;
  *progress_ << "leonav-import: " << report_.epochs << " epochs, " << report_.imu_samples
             << " IMU samples, " << seconds_between(report_.last, report_.first) << " s of data\n"
             << std::flush;
}

}  // namespace

ImportReport import_dataset(const Dataset& dataset, const ImportOptions& options,
                            const std::string& output, std::ostream* progress) {
  return Import(dataset, options, progress).run(output);
}

}  // namespace leonav
