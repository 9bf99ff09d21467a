#include "tools/import/internal/ubx_file.h"

#include <cmath>
#include <utility>

#include "drivers/text/parse.h"
#include "tools/import/ubx_samples.h"

namespace leonav {
namespace {

void report_framer(const std::string& path, const UbxFramerCounters& framer, ImportReport* report) {
  skip_all(path,
           {{"message with a wrong checksum", framer.bad_checksums},
            {"message with an impossible length", framer.oversize},
            {"message that the end of the file cuts off", framer.incomplete},
            {"NMEA sentence (another protocol, not read; the UBX messages around it are whole)",
             framer.foreign.nmea_sentences},
            {"RTCM 3 frame (another protocol, not read; the UBX messages around it are whole)",
             framer.foreign.rtcm3_frames},
            {"byte of no message (damage, or a protocol that is not known here)",
             framer.bytes_skipped - framer.foreign.bytes()}},
           report);
}

void report_epochs(const std::string& path, const UbxCounters& counters, ImportReport* report) {
  const RxmRawxCounters& rawx = counters.rawx;
  const auto& sfrbx = counters.sfrbx;
  skip_all(path,
           {{"RAWX message with a wrong length or version", rawx.bad_length + rawx.bad_version},
            {"RAWX message with an impossible time", rawx.bad_time},
            {"measurement of a system not used", rawx.other_system},
            {"measurement of a signal without a RINEX code", rawx.unknown_signal},
            {"measurement of a satellite that does not exist", rawx.bad_satellite},
            {"measured value out of range", rawx.bad_value},
            {"measurement that is twice in an epoch", rawx.duplicates},
            {"measurement without a value", rawx.empty},
            {"subframe of a system not used", sfrbx.other_system},
            {"subframe of a message not used", sfrbx.other_message},
            {"page of Galileo HAS (used where the file is listed under corrections)", sfrbx.pages},
            {"subframe with a wrong length or version", sfrbx.bad_length + sfrbx.bad_version},
            {"subframe with a parity error", sfrbx.bad_parity},
            {"subframe of a satellite that does not exist", sfrbx.bad_satellite},
            {"subframe that contradicts its message", sfrbx.bad_week + sfrbx.wrong_satellite},
            {"subframe before the first epoch told the week", sfrbx.without_time},
            {"ephemeris that no satellite can have sent", sfrbx.not_sane},
            {"inertial sample (used where the file is listed under imu)", counters.esf.readings}},
           report);
}

void report_samples(const std::string& path, const EsfCounters& esf, const UbxSamples& samples,
                    ImportReport* report) {
  const ImuSamplerCounters& sampler = samples.counters();
  skip_all(path,
           {{"inertial message that does not hold what it claims", esf.bad_length},
            {"inertial value of a kind that is not used", esf.other_values},
            {"inertial sample of which an axis is missing", esf.incomplete},
            {"UBX-ESF-MEAS beside UBX-ESF-RAW", esf.superseded},
            {"IMU sample before its clock was tied to GPS time", samples.before_tie()},
            {"IMU sample whose clock contradicts its place in the file", samples.contradictions()},
            {"IMU sample that is not later than the one before", sampler.out_of_order},
            {"IMU sample before its interval is known", sampler.without_interval},
            {"IMU sample beyond any sensor", sampler.impossible}},
           report);
}

}  // namespace

bool has_ubx_name(const std::string& path) { return has_ending(path, ".ubx"); }

bool UbxFile::next(ObservationItem* item) {
  for (UbxOutput output; reader_.next(&output);) {
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

long UbxFile::lost_epochs() const {
  const RxmRawxCounters rawx = reader_.counters().rawx;
  return static_cast<long>(rawx.bad_length + rawx.bad_version + rawx.bad_time);
}

void UbxFile::report(const std::string& path, ImportReport* report) const {
  const UbxCounters counters = reader_.counters();
  report_framer(path, counters.framer, report);
  report_epochs(path, counters, report);
}

std::vector<ImuSample> read_ubx_imu(const std::string& path, double gnss_latency_s,
                                    ImportReport* report) {
  UbxFileReader reader(path);
  UbxSamples samples(gnss_latency_s);
  std::vector<ImuSample> all;
  for (UbxOutput output; reader.next(&output);) {
    if (const auto* epoch = std::get_if<RawEpoch>(&output)) samples.on_epoch(epoch->time);
    const auto* reading = std::get_if<EsfReading>(&output);
    if (reading == nullptr) continue;
    if (const auto sample = samples.take(*reading)) all.push_back(*sample);
  }
  const UbxCounters counters = reader.counters();
  report_framer(path, counters.framer, report);
  report_samples(path, counters.esf, samples, report);
  if (all.empty()) {
    throw FileError(path, 0,
                    counters.esf.readings == 0
                        ? "holds no inertial sample: switch UBX-ESF-RAW on in the receiver"
                        : "holds no usable inertial sample: its clock needs ten seconds of "
                          "UBX-RXM-RAWX in the same file to be tied to GPS time");
  }
  report->warnings.push_back(
      path +
      " gives its inertial samples no GPS time: they are tied to it by the order of messages, " +
      "within " + std::to_string(std::lround(samples.uncertainty_s() * 1e3)) +
      " ms or so; leonav-calibrate finds the rest");
  if (samples.counters().gaps > 0) {
    report->warnings.push_back(path + " has " + std::to_string(samples.counters().gaps) +
                               " gaps: the solution is interrupted or worse after them");
  }
  return all;
}

}  // namespace leonav
