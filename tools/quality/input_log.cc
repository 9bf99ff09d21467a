#include "tools/quality/input_log.h"

#include <memory>
#include <ostream>

#include "drivers/lcm/decode.h"
#include "drivers/lcm/event_log.h"

namespace leonav {
namespace {

constexpr double kJump_s = 10.0;
constexpr std::int64_t kLongLog = 5'000'000;  // bytes

class Reading {
 public:
  explicit Reading(const InputHandlers& handlers) : handlers_(handlers) {}

  void take(Channel channel, const std::vector<std::uint8_t>& data) {
    ++counts.messages[index_of(channel)];
    if (channel == Channel::kGnssEpoch) return take_epoch(data);
    if (handlers_.ephemeris_store == nullptr) return;
    if (channel == Channel::kAntenna || channel == Channel::kBiases || !is_product(channel)) return;
    if (!take_product(channel, data)) ++counts.refused_products;
  }

  // Hands on the epoch that waits.
  void hand_on() {
    if (!waits_) return;
    waits_ = false;
    last_ = waiting_->time;
    ++counts.epochs;
    handlers_.epoch(*waiting_);
  }

  InputCounts counts;

 private:
  void take_epoch(const std::vector<std::uint8_t>& data) {
    const DecodeResult result = decoder_.decode(data, epoch_.get());
    if (result.fault != InputFault::kNone) {
      ++counts.refused_epochs;
      return;
    }
    if (result.element_faults != 0) ++counts.incomplete_epochs;
    put_in_order();
  }

  // An epoch waits for the next one, which may show that its time is wrong.
  void put_in_order() {
    if (waits_ && epoch_->time <= waiting_->time) {
      ++counts.disordered_epochs;
      const bool jumped = !last_.is_set() || seconds_between(waiting_->time, last_) > kJump_s;
      if (!jumped || epoch_->time <= last_) return;
    } else {
      hand_on();
    }
    std::swap(epoch_, waiting_);
    waits_ = true;
  }

  bool take_product(Channel channel, const std::vector<std::uint8_t>& data) {
    EphemerisStore& ephemeris_store = *handlers_.ephemeris_store;
    if (channel == Channel::kEphemeris) {
      Ephemeris ephemeris;
      return decoder_.decode(data, &ephemeris).fault == InputFault::kNone &&
             ephemeris_store.add(ephemeris);
    }
    if (channel == Channel::kIonosphere) {
      KlobucharModel model;
      if (decoder_.decode(data, &model).fault != InputFault::kNone) return false;
      ephemeris_store.set_klobuchar(model);
      return true;
    }
    if (channel == Channel::kCorrectedStates) {
      if (decoder_.decode(data, corrected_.get()).fault != InputFault::kNone) return false;
      return add_all(*corrected_);
    }
    if (decoder_.decode(data, states_.get()).fault != InputFault::kNone) return false;
    return add_all(*states_);
  }

  template <typename States>
  bool add_all(const States& states) {
    bool all = true;
    for (const auto& state : states) all = handlers_.ephemeris_store->add(state) && all;
    return all;
  }

  const InputHandlers& handlers_;
  Decoder decoder_;
  std::unique_ptr<RawEpoch> epoch_ = std::make_unique<RawEpoch>();
  std::unique_ptr<RawEpoch> waiting_ = std::make_unique<RawEpoch>();
  bool waits_ = false;
  GpsTime last_;  // the last one handed on
  std::unique_ptr<PreciseStates> states_ = std::make_unique<PreciseStates>();
  std::unique_ptr<CorrectedStates> corrected_ = std::make_unique<CorrectedStates>();
};

void report_progress(const EventLogReader& log, std::int64_t* next, const std::string& what,
                     std::ostream* progress) {
  if (progress == nullptr || log.size_bytes() < kLongLog || log.position_bytes() < *next) return;
  *progress << "leonav-eval: " << what << 100 * log.position_bytes() / log.size_bytes() << " %\n";
  *next += log.size_bytes() / 10;
}

}  // namespace

InputCounts read_inputs(const std::string& path, const std::string& prefix,
                        const InputHandlers& handlers, std::ostream* progress,
                        const std::string& what) {
  EventLogReader log(path);
  Reading reading(handlers);
  LogEvent event;
  std::int64_t next_progress = log.size_bytes() / 10;
  try {
    while (log.next(&event)) {
      const auto channel = channel_from_name(event.channel, prefix);
      if (channel) {
        reading.take(*channel, event.data);
      } else if (event.channel.ends_with(name_of(Channel::kGnssEpoch))) {
        reading.counts.other_prefix =
            event.channel.substr(0, event.channel.size() - name_of(Channel::kGnssEpoch).size());
      }
      report_progress(log, &next_progress, what, progress);
    }
  } catch (const EventLogError& error) {
    if (log.position_bytes() == 0) throw;
    reading.counts.damage = error.what();
  }
  reading.hand_on();
  reading.counts.truncated = log.truncated();
  return reading.counts;
}

}  // namespace leonav
