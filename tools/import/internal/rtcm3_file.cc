#include "tools/import/internal/rtcm3_file.h"

#include <algorithm>
#include <utility>

#include "drivers/text/parse.h"

namespace leonav {
namespace {

// Returns the decoder's settings, for which the date must be known.
Rtcm3Options options_for(const std::string& path, GpsTime date) {
  if (!date.is_set()) {
    throw FileError(path, 0,
                    "RTCM 3 messages give the time of week without the week; add the day of the "
                    "recording to the dataset, for example 'date: 2024-03-20' (up to three days "
                    "from it will do)");
  }
  return {date};
}

void report_corrections(const std::string& path, const Rtcm3Counters& counters,
                        ImportReport* report) {
  report->skip(path, "SSR message (used where the file is listed under corrections)",
               static_cast<long>(counters.ssr.messages));
}

// Whether the ephemerides of a file are all of systems that are not used. Where one of another
// system was refused, or a frame is damaged, that is not known.
bool has_only_unused_ephemerides(const Rtcm3Counters& counters) {
  const EphemerisRefusals& refused = counters.ephemerides;
  const std::uint64_t lost = counters.framer.bad_checksums + refused.bad_length +
                             refused.bad_satellite + refused.bad_time + refused.bad_week +
                             refused.bad_subframes + refused.not_sane;
  return lost == 0 && std::any_of(counters.unused.begin(), counters.unused.end(),
                                  [](const auto& number_and_count) {
                                    return is_ephemeris_of_unused_system(number_and_count.first);
                                  });
}

}  // namespace

Rtcm3FileReader open_rtcm3(const std::string& path, GpsTime date) {
  return Rtcm3FileReader(path, options_for(path, date));
}

void report_rtcm3(const std::string& path, const Rtcm3Counters& counters, ImportReport* report) {
  const auto& [framer, epochs, measurements, ephemerides, ssr, station, damaged_station, unused,
               losses] = counters;
  const std::pair<const char*, std::uint64_t> reasons[] = {
      {"frame with a wrong checksum", framer.bad_checksums},
      {"frame that the end of the file cuts off", framer.incomplete},
      {"frame without a message", framer.too_short},
      {"byte of no frame (damage, or another protocol)", framer.bytes_skipped},
      {"observation message that is shorter than its masks require", epochs.bad_length},
      {"observation message with more cells than there may be", epochs.bad_mask},
      {"observation message with an impossible time", epochs.bad_time},
      {"observation message of an epoch that had ended", epochs.late},
      {"observation message of another station than the one in use", epochs.other_station},
      {"MSM1 to MSM3 (ranges without their milliseconds; turn on MSM4 to MSM7)",
       epochs.without_full_range},
      {"epoch without a measurement of a used system", epochs.empty_epochs},
      {"measurement of a signal without a RINEX code", measurements.unknown_signal},
      {"measurement of a satellite that does not exist", measurements.bad_satellite},
      {"measured value out of range", measurements.bad_value},
      {"measurement that is twice in an epoch", measurements.duplicates},
      {"measurement without a value", measurements.empty},
      {"ephemeris that repeats the one before", ephemerides.repeated},
      {"ephemeris that is shorter than its fields", ephemerides.bad_length},
      {"ephemeris of a satellite that does not exist", ephemerides.bad_satellite},
      {"ephemeris with an impossible time", ephemerides.bad_time},
      {"ephemeris of another week (old, or the dataset's date is wrong)", ephemerides.bad_week},
      {"ephemeris that no satellite can have sent", ephemerides.not_sane},
      {"SSR message that is damaged", ssr.bad_length + ssr.bad_time},
      {"station message that is shorter than its fields", damaged_station}};
  for (const auto& [reason, count] : reasons) {
    report->skip(path, reason, static_cast<long>(count));
  }
  report->skip(path, losses);
  for (const auto& [number, count] : unused) {
    report->skip(
        path, "message " + std::to_string(number) + ": " + std::string(unused_message_text(number)),
        static_cast<long>(count));
  }
  if (epochs.bit_is_wrong) {
    report->warnings.push_back(path +
                               " ends epochs that go on (multiple message bit): the first ones are "
                               "incomplete");
  }
  if (epochs.not_ended > 1) {
    report->warnings.push_back(path + " has " + std::to_string(epochs.not_ended) +
                               " epochs whose last message is missing");
  }
}

bool has_rtcm3_name(const std::string& path) {
  return has_ending(path, ".rtcm3") || has_ending(path, ".rtcm");
}

Rtcm3File::Rtcm3File(const std::string& path, GpsTime date)
    : reader_(open_rtcm3(path, date)), antenna_(first_antenna(path)) {}

bool Rtcm3File::next(ObservationItem* item) {
  for (Rtcm3Output output; reader_.next(&output);) {
    if (auto* epoch = std::get_if<RawEpoch>(&output)) {
      *item = std::move(*epoch);
      return true;
    }
    if (auto* ephemeris = std::get_if<Ephemeris>(&output)) {
      *item = *ephemeris;
      return true;
    }
  }
  return false;
}

long Rtcm3File::lost_epochs() const {
  return static_cast<long>(reader_.counters().epochs.empty_epochs);
}

void Rtcm3File::report(const std::string& path, ImportReport* report) const {
  report_rtcm3(path, reader_.counters(), report);
  report_corrections(path, reader_.counters(), report);
}

std::vector<Ephemeris> read_rtcm3_ephemerides(const std::string& path, GpsTime date,
                                              ImportReport* report) {
  Rtcm3FileReader reader = open_rtcm3(path, date);
  std::vector<Ephemeris> ephemerides;
  long epochs = 0;
  for (Rtcm3Output output; reader.next(&output);) {
    if (const auto* ephemeris = std::get_if<Ephemeris>(&output)) ephemerides.push_back(*ephemeris);
    epochs += std::holds_alternative<RawEpoch>(output);
  }
  report_rtcm3(path, reader.counters(), report);
  report_corrections(path, reader.counters(), report);
  report->skip(path, "epoch in a file of ephemerides (list it under observations)", epochs);
  if (ephemerides.empty()) {
    std::string why = "holds no usable ephemeris";
    for (const ImportReport::Skip& skip : report->skipped) {
      if (skip.where == path) why += "; " + std::to_string(skip.count) + " x " + skip.reason;
    }
    if (!has_only_unused_ephemerides(reader.counters())) throw FileError(path, 0, why);
    report->warnings.push_back(path + " " + why);
  }
  return ephemerides;
}

}  // namespace leonav
