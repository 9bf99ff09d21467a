// The EncodingSink turns outputs into LCM messages and passes them to a MessageTarget.
#pragma once
#include "core/navigator/interface/output_sink.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"

namespace leonav {

class MessageTarget {
 public:
  virtual ~MessageTarget() = default;
  // `bytes` are valid during the call.
  virtual void take(Channel channel, ByteSpan bytes) = 0;
};

// One per thread; allocates only at construction.
class EncodingSink : public OutputSink {
 public:
  // `schema`: the version of the messages; an older one to compare with an older journal.
  explicit EncodingSink(MessageTarget* target, OutputSchema schema = OutputSchema::kNewest)
      : target_(target), schema_(schema), encoder_(schema, Encoder::Room::kOutputs) {}
  void on_solution(const Solution& solution) override {
    target_->take(Channel::kSolution, encoder_.encode(solution));
  }
  void on_epoch(const EpochReport& report) override {
    target_->take(Channel::kEpoch, encoder_.encode(report));
    if (!report.constraint_reports.empty())
      target_->take(Channel::kConstraints, encoder_.encode_constraints(report));
  }
  void on_event(const Event& event) override {
    target_->take(Channel::kEvent, encoder_.encode(event));
  }
  void on_decision(const Decision& decision) override {
    target_->take(Channel::kDecision, encoder_.encode(decision));
  }
  void on_smoother(const SmootherReport& report) override {
    target_->take(Channel::kSmoother, encoder_.encode(report));
    // Journals of the first version have no such channel.
    if (report.lagged.source != Source::kNone && schema_ != OutputSchema::kFirst)
      target_->take(Channel::kSmoothed, encoder_.encode(report.lagged));
  }

 private:
  MessageTarget* target_;
  OutputSchema schema_;
  Encoder encoder_;
};

}  // namespace leonav
