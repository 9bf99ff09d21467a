#include "tools/sim/run/outbox.h"

#include <utility>

namespace leonav::sim {
namespace {

// Delay of a duplicate, as from a network that repeats a message.
constexpr std::int64_t kCopyBehind_ns = 1'000'000;

}  // namespace

void Outbox::post(GpsTime arrival, const ImuSample& sample) {
  put(Stream::kImu, sample.time, arrival, sample);
}

void Outbox::post(GpsTime arrival, const OdometerIncrement& increment) {
  put(Stream::kOdometer, increment.time, arrival, increment);
}

void Outbox::post(GpsTime arrival, RawEpoch epoch) {
  const GpsTime time = epoch.time;
  put(Stream::kGnss, time, arrival, std::make_shared<const RawEpoch>(std::move(epoch)));
}

void Outbox::post(GpsTime arrival, std::vector<PreciseState> states) {
  put(Stream::kProducts, arrival, arrival, std::move(states));
}

void Outbox::post(GpsTime arrival, const Ephemeris& ephemeris) {
  put(Stream::kProducts, arrival, arrival, ephemeris);
}

void Outbox::put(Stream stream, GpsTime of, GpsTime arrival, Message message) {
  const double t = seconds_between(of, start_);
  const GpsTime then = arrival.plus_seconds(faults_.delay_s(stream, t));
  if (faults_.is_duplicate(stream, t)) {
    waiting_.emplace(then.plus_nanoseconds(kCopyBehind_ns), message);
  }
  waiting_.emplace(then, std::move(message));
}

void Outbox::write(GpsTime arrival, const Message& message) {
  if (const auto* sample = std::get_if<ImuSample>(&message)) {
    log_.write(arrival, *sample);
  } else if (const auto* increment = std::get_if<OdometerIncrement>(&message)) {
    log_.write(arrival, *increment);
  } else if (const auto* epoch = std::get_if<std::shared_ptr<const RawEpoch>>(&message)) {
    log_.write(arrival, **epoch);
  } else if (const auto* ephemeris = std::get_if<Ephemeris>(&message)) {
    log_.write(arrival, *ephemeris);
  } else {
    log_.write(arrival, std::span<const PreciseState>(std::get<2>(message)));
  }
}

void Outbox::deliver(GpsTime until) {
  while (!waiting_.empty() && waiting_.begin()->first <= until) {
    write(waiting_.begin()->first, waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
  }
}

void Outbox::deliver_all() {
  if (!waiting_.empty()) deliver(waiting_.rbegin()->first);
}

}  // namespace leonav::sim
