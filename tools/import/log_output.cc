#include "tools/import/log_output.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace leonav {
namespace {

namespace fs = std::filesystem;
constexpr const char* kPartSuffix = ".part";

}  // namespace

void check_output(const std::string& path, const std::vector<std::string>& inputs) {
  for (const std::string& name : {path, path + kPartSuffix}) {
    std::error_code error;
    const fs::file_status status = fs::status(name, error);
    if (!fs::exists(status)) continue;
    if (!fs::is_regular_file(status)) {
      throw EventLogError(name + ": is there and no regular file; name another file to write to");
    }
    for (const std::string& input : inputs) {
      std::error_code absent;
      if (!fs::equivalent(name, input, absent)) continue;
      throw EventLogError(name + ": is an input (" + input + "); name another file to write to");
    }
  }
}

LogOutput::LogOutput(const std::string& path, ImportReport* report)
    : path_(path), part_path_(path + kPartSuffix), report_(report), writer_(part_path_) {
  for (std::size_t i = 0; i < kChannelCount; ++i) {
    names_[i] = channel_name(static_cast<Channel>(i));
  }
}

LogOutput::~LogOutput() {
  if (!writer_) return;
  writer_.reset();
  remove_part();
}

void LogOutput::remove_part() {
  std::error_code ignored;
  fs::remove(part_path_, ignored);
}

void LogOutput::put(GpsTime arrival, const InputMessage& message) {
  last_stamp_us_ = std::max(last_stamp_us_ + 1, arrival.nanoseconds() / 1000);
  if (!writer_->write(last_stamp_us_, names_[index_of(message.channel)], message.bytes)) {
    throw EventLogError(writer_->error());
  }
}

void LogOutput::extend_span(GpsTime time) {
  if (!report_->first.is_set() || time < report_->first) report_->first = time;
  report_->last = std::max(report_->last, time);
}

void LogOutput::write(GpsTime arrival, const ImuSample& sample) {
  put(arrival, messages_.encode(sample));
  extend_span(sample.time);
  ++report_->imu_samples;
}

void LogOutput::write(GpsTime arrival, const OdometerIncrement& increment) {
  put(arrival, messages_.encode(increment));
  extend_span(increment.time);
  ++report_->odometer_increments;
}

void LogOutput::write(GpsTime arrival, const RawEpoch& epoch) {
  put(arrival, messages_.encode(epoch));
  extend_span(epoch.time);
  ++report_->epochs;
  for (const SignalObservation& observation : epoch.observations) {
    if (satellites_.insert(observation.satellite).second) {
      ++report_->satellites[observation.satellite.system];
    }
  }
}

void LogOutput::write(GpsTime arrival, const Ephemeris& ephemeris) {
  put(arrival, messages_.encode(ephemeris));
  ++report_->ephemerides;
}

void LogOutput::write(GpsTime arrival, const KlobucharModel& model) {
  put(arrival, messages_.encode(model, arrival));
  ++report_->ionosphere_models;
}

void LogOutput::write(GpsTime arrival, std::span<const PreciseState> states) {
  put(arrival, messages_.encode(states));
  const bool clocks = !states.empty() && states.front().is_clock_only();
  ++(clocks ? report_->clock_epochs : report_->orbit_epochs);
}

void LogOutput::write(GpsTime arrival, std::span<const CorrectedState> states,
                      const CorrectionSource& source) {
  if (states.empty()) return;
  put(arrival, messages_.encode(states, source));
  report_->corrected_states += static_cast<long>(states.size());
}

void LogOutput::write(GpsTime arrival, std::span<const SignalBias> biases) {
  if (biases.empty()) return;
  put(arrival, messages_.encode(biases));
  report_->signal_biases += static_cast<long>(biases.size());
}

void LogOutput::write(GpsTime arrival, const AntennaPattern& pattern) {
  put(arrival, messages_.encode(pattern, arrival));
}

void LogOutput::commit() {
  if (!writer_->flush(true)) throw EventLogError(writer_->error());
  writer_.reset();
  std::error_code error;
  fs::rename(part_path_, path_, error);
  if (!error) return;
  remove_part();
  throw EventLogError(path_ + ": cannot be given its name: " + error.message());
}

}  // namespace leonav
