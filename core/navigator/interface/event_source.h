// EventSource numbers the events of one stage and passes them to the sink.
#pragma once
#include <cstdint>

#include "core/navigator/interface/event.h"
#include "core/navigator/interface/output_sink.h"

namespace leonav {

// EventNumbering makes the events of one stage, numbered from 1.
class EventNumbering {
 public:
  explicit EventNumbering(Stage stage) : stage_(stage) {}

  Event next(EventKind kind, std::uint8_t code, double value, GpsTime time) {
    Event event;
    event.sequence = next_++;
    event.stage = stage_;
    event.time = time;
    event.kind = kind;
    event.code = code;
    event.value = value;
    return event;
  }

 private:
  Stage stage_;
  std::uint64_t next_ = 1;
};

// EventSource serves a stage that publishes its events itself. `sink` must outlive it.
class EventSource {
 public:
  EventSource(Stage stage, OutputSink* sink) : numbering_(stage), sink_(sink) {}

  void emit(EventKind kind, std::uint8_t code, double value, GpsTime time) {
    sink_->on_event(numbering_.next(kind, code, value, time));
  }

 private:
  EventNumbering numbering_;
  OutputSink* sink_;
};

}  // namespace leonav
