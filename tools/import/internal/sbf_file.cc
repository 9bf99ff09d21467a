#include "tools/import/internal/sbf_file.h"

#include <utility>

#include "drivers/text/parse.h"
#include "tools/import/sbf_samples.h"

namespace leonav {
namespace {

void report_framer(const std::string& path, const SbfFramerCounters& framer, ImportReport* report) {
  skip_all(path,
           {{"block with a wrong checksum", framer.bad_checksums},
            {"block with an impossible length", framer.bad_lengths},
            {"block that the end of the file cuts off", framer.incomplete},
            {"byte of no block (text, damage, or another protocol)", framer.bytes_skipped}},
           report);
}

void report_epochs(const std::string& path, const SbfCounters& counters, ImportReport* report) {
  const auto& [framer, measurements, epochs, navigation, raw, decoded, imu, unused, losses] =
      counters;
  skip_all(
      path,
      {{"MeasEpoch that does not hold what it claims", measurements.bad_length},
       {"MeasEpoch before the receiver knew the time", measurements.without_time},
       {"MeasEpoch that the receiver has scrambled (a permission is missing)",
        measurements.scrambled},
       {"measurement of another antenna than the main one", measurements.other_antennas},
       {"MeasEpoch of the time of the one before", epochs.repeated},
       {"measurement of a system not used", epochs.other_system},
       {"measurement of a signal without a RINEX code", epochs.unknown_signal},
       {"measurement of a satellite that does not exist", epochs.bad_satellite},
       {"measured value out of range", epochs.bad_value},
       {"measurement that is twice in an epoch", epochs.duplicates},
       {"measurement without a value", epochs.empty},
       {"subframe of a message not used", navigation.other_message},
       {"subframe with a parity error", navigation.bad_parity + raw.crc_failed + raw.bad_pages},
       {"subframe that contradicts its message",
        navigation.bad_week + navigation.wrong_satellite + raw.wrong_satellite},
       {"page of Galileo HAS or PPP-B2b (used where the file is listed under corrections)",
        raw.pages},
       {"subframe that is shorter than its fields", raw.bad_length},
       {"subframe of a satellite that does not exist", raw.bad_satellite},
       {"subframe before the receiver knew the time", raw.without_time},
       {"ephemeris that no satellite can have sent", navigation.not_sane},
       {"ephemeris whose raw bits are there", decoded.beside_raw},
       {"ephemeris that is shorter than its fields", decoded.bad_length},
       {"ephemeris of a satellite that does not exist", decoded.bad_satellite},
       {"ephemeris with an impossible time", decoded.bad_time},
       {"ephemeris of another week", decoded.bad_week},
       {"ephemeris whose subframes do not belong together", decoded.bad_subframes},
       {"ephemeris without a group delay, or of an unknown message", decoded.not_sane},
       {"ephemeris before the receiver knew the time", decoded.without_time},
       {"GPSIon that is damaged", decoded.bad_ionosphere},
       {"inertial block (used where the file is listed under imu)", imu.samples}},
      report);
  report->skip(path, losses);
  for (const auto& [number, count] : unused) {
    report->skip(path, "block that is not used: " + unused_block_text(number),
                 static_cast<long>(count));
  }
}

void report_samples(const std::string& path, const ExtSensorCounters& imu,
                    const ImuSamplerCounters& sampler, ImportReport* report) {
  skip_all(path,
           {{"ExtSensorMeas that does not hold what it claims", imu.bad_length},
            {"ExtSensorMeas before the receiver knew the time", imu.without_time},
            {"ExtSensorMeas without both angular rate and acceleration", imu.without_motion},
            {"ExtSensorMeas whose values are not available", imu.bad_value},
            {"IMU sample that is not later than the one before", sampler.out_of_order},
            {"IMU sample before its interval is known", sampler.without_interval},
            {"IMU sample beyond any sensor", sampler.impossible}},
           report);
}

[[noreturn]] void refuse(const std::string& path, const ImportReport& report) {
  std::string why = "holds no usable inertial sample (ExtSensorMeas)";
  for (const ImportReport::Skip& skip : report.skipped) {
    if (skip.where == path) why += "; " + std::to_string(skip.count) + " x " + skip.reason;
  }
  throw FileError(path, 0, why);
}

}  // namespace

bool has_sbf_name(const std::string& path) { return has_ending(path, ".sbf"); }

bool SbfFile::next(ObservationItem* item) {
  for (SbfOutput output; reader_.next(&output);) {
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
    if (auto* biases = std::get_if<std::vector<SignalBias>>(&output)) {
      *item = std::move(*biases);
      return true;
    }
  }
  return false;
}

long SbfFile::lost_epochs() const {
  const MeasEpochCounters c = reader_.counters().measurements;
  return static_cast<long>(c.bad_length + c.without_time + c.scrambled);
}

void SbfFile::report(const std::string& path, ImportReport* report) const {
  const SbfCounters counters = reader_.counters();
  report_framer(path, counters.framer, report);
  report_epochs(path, counters, report);
}

std::vector<ImuSample> read_sbf_imu(const std::string& path, ImportReport* report) {
  SbfFileReader reader(path);
  SbfSamples samples;
  std::vector<ImuSample> all;
  for (SbfOutput output; reader.next(&output);) {
    const auto* rates = std::get_if<ExtSensorRates>(&output);
    if (rates == nullptr) continue;
    if (const auto sample = samples.take(*rates)) all.push_back(*sample);
  }
  const SbfCounters counters = reader.counters();
  report_framer(path, counters.framer, report);
  report_samples(path, counters.imu, samples.counters(), report);
  if (all.empty()) refuse(path, *report);
  if (samples.counters().gaps > 0) {
    report->warnings.push_back(path + " has " + std::to_string(samples.counters().gaps) +
                               " gaps: the solution is interrupted or worse after them");
  }
  return all;
}

}  // namespace leonav
