// Outbox holds messages on their way to the log: in order of arrival, some late, some twice.
#pragma once
#include <map>
#include <memory>
#include <variant>
#include <vector>

#include "tools/import/log_output.h"
#include "tools/sim/faults/fault_script.h"

namespace leonav::sim {

// Outbox applies delays and duplicates of the fault script.
class Outbox {
 public:
  // Both must outlive this object.
  Outbox(const FaultScript* faults, GpsTime start, LogOutput* log)
      : faults_(*faults), start_(start), log_(*log) {}

  // The fault script applies to samples, increments and epochs by their own time, to products by
  // their arrival.
  void post(GpsTime arrival, const ImuSample& sample);
  void post(GpsTime arrival, const OdometerIncrement& increment);
  void post(GpsTime arrival, RawEpoch epoch);
  void post(GpsTime arrival, std::vector<PreciseState> states);
  void post(GpsTime arrival, const Ephemeris& ephemeris);  // counts as a product

  // Writes what has arrived by then, in order of arrival, at equal times in the order of posting.
  // Throws as LogOutput does.
  void deliver(GpsTime until);
  void deliver_all();

 private:
  using Message = std::variant<ImuSample, std::shared_ptr<const RawEpoch>,
                               std::vector<PreciseState>, Ephemeris, OdometerIncrement>;
  void put(Stream stream, GpsTime of, GpsTime arrival, Message message);
  void write(GpsTime arrival, const Message& message);

  const FaultScript& faults_;
  GpsTime start_;
  LogOutput& log_;
  std::multimap<GpsTime, Message> waiting_;
};

}  // namespace leonav::sim
