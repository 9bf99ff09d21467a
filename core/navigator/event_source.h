// One stage's events, numbered.
#pragma once
#include <cstdint>

#include "core/navigator/outputs.h"

namespace leonav {

class EventSource {
 public:
  EventSource(Stage stage, OutputSink* sink) : stage_(stage), sink_(sink) {}

  void emit(EventKind kind, std::uint8_t code, double value, GpsTime time) {
    Event event;
    event.sequence = next_++;
    event.stage = stage_;
    event.time = time;
    event.kind = kind;
    event.code = code;
    event.value = value;
    sink_->on_event(event);
  }

 private:
  Stage stage_;
  OutputSink* sink_;
  std::uint64_t next_ = 1;
};

}  // namespace leonav
