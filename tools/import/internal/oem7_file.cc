#include "tools/import/internal/oem7_file.h"

#include <utility>

#include "drivers/text/parse.h"
#include "tools/import/oem7_samples.h"

namespace leonav {
namespace {

void report_framer(const std::string& path, const Oem7FramerCounters& framer,
                   ImportReport* report) {
  skip_all(path,
           {{"message with a wrong checksum", framer.bad_checksums},
            {"message with an impossible length", framer.bad_headers},
            {"message that the end of the file cuts off", framer.incomplete},
            {"byte of no message (text, damage, or another protocol)", framer.bytes_skipped}},
           report);
}

void report_epochs(const std::string& path, const Oem7Counters& counters, ImportReport* report) {
  const auto& [framer, ranges, epochs, ephemerides, imu, second_antenna, responses, unused,
               losses] = counters;
  skip_all(path,
           {{"range log that does not hold what it claims", ranges.bad_length},
            {"range log before the receiver knew the time", ranges.without_time},
            {"signal of RANGECMP4 whose reference is missing", ranges.without_reference},
            {"range log of the time of the one before", epochs.repeated},
            {"measurement of a system not used", epochs.other_system},
            {"measurement of a signal without a RINEX code", epochs.unknown_signal},
            {"measurement of a satellite that does not exist", epochs.bad_satellite},
            {"measured value out of range", epochs.bad_value},
            {"measurement that is twice in an epoch", epochs.duplicates},
            {"measurement without a value", epochs.empty},
            {"ephemeris that repeats the one before", ephemerides.repeated},
            {"ephemeris that is shorter than its fields", ephemerides.bad_length},
            {"ephemeris of a satellite that does not exist", ephemerides.bad_satellite},
            {"ephemeris with an impossible time", ephemerides.bad_time},
            {"ephemeris of another week", ephemerides.bad_week},
            {"ephemeris whose subframes do not belong together", ephemerides.bad_subframes},
            {"ephemeris that no satellite can have sent", ephemerides.not_sane},
            {"ephemeris before the receiver knew the time", ephemerides.without_time},
            {"IONUTC that is damaged", ephemerides.bad_ionosphere},
            {"inertial message (used where the file is listed under imu)",
             imu.samples + imu.unknown_scale},
            {"log of the second antenna", second_antenna},
            {"answer to a command", responses}},
           report);
  report->skip(path, losses);
  for (const auto& [number, count] : unused) {
    report->skip(path, "log that is not used: " + unused_log_text(number),
                 static_cast<long>(count));
  }
}

void report_samples(const std::string& path, const RawImuCounters& imu,
                    const ImuSamplerCounters& sampler, ImportReport* report) {
  skip_all(path,
           {{"inertial message that is shorter than its fields", imu.bad_length},
            {"inertial message without a time", imu.bad_time},
            {"inertial message that its sensor marks as wrong", imu.sensor_errors},
            {"inertial message that the receiver has encrypted", imu.encrypted},
            {"inertial message of an IMU without a known scale", imu.unknown_scale},
            {"IMU sample that is not later than the one before", sampler.out_of_order},
            {"IMU sample before its interval is known", sampler.without_interval},
            {"IMU sample beyond any sensor", sampler.impossible}},
           report);
}

[[noreturn]] void refuse(const std::string& path, const Oem7Counters& counters,
                         const ImportReport& report) {
  std::string why = "holds no usable inertial sample";
  if (const std::string problem = problem_of_scale(counters.imu); !problem.empty()) {
    throw FileError(path, 0, why + ": " + problem);
  }
  for (const ImportReport::Skip& skip : report.skipped) {
    if (skip.where == path) why += "; " + std::to_string(skip.count) + " x " + skip.reason;
  }
  throw FileError(path, 0, why);
}

}  // namespace

bool has_oem7_name(const std::string& path) {
  return has_ending(path, ".oem7") || has_ending(path, ".gps");
}

bool Oem7File::next(ObservationItem* item) {
  for (Oem7Output output; reader_.next(&output);) {
    if (auto* epoch = std::get_if<RawEpoch>(&output)) {
      *item = std::move(*epoch);
      return true;
    }
    if (const auto* ephemeris = std::get_if<Ephemeris>(&output)) {
      *item = *ephemeris;
      return true;
    }
    if (const auto* model = std::get_if<KlobucharModel>(&output)) {
      *item = *model;
      return true;
    }
  }
  return false;
}

long Oem7File::lost_epochs() const {
  const Oem7RangeCounters ranges = reader_.counters().ranges;
  return static_cast<long>(ranges.bad_length + ranges.without_time);
}

void Oem7File::report(const std::string& path, ImportReport* report) const {
  const Oem7Counters counters = reader_.counters();
  report_framer(path, counters.framer, report);
  report_epochs(path, counters, report);
}

std::vector<ImuSample> read_oem7_imu(const std::string& path, std::optional<ImuScale> scale,
                                     ImportReport* report) {
  Oem7FileReader reader(path, {scale});
  Oem7Samples samples;
  std::vector<ImuSample> all;
  for (Oem7Output output; reader.next(&output);) {
    const auto* increments = std::get_if<RawImuIncrements>(&output);
    if (increments == nullptr) continue;
    if (const auto sample = samples.take(*increments)) all.push_back(*sample);
  }
  const Oem7Counters counters = reader.counters();
  report_framer(path, counters.framer, report);
  report_samples(path, counters.imu, samples.counters(), report);
  if (all.empty()) refuse(path, counters, *report);
  if (samples.counters().gaps > 0) {
    report->warnings.push_back(path + " has " + std::to_string(samples.counters().gaps) +
                               " gaps: the solution is interrupted or worse after them");
  }
  return all;
}

}  // namespace leonav
