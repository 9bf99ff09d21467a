// The ProductWatch says which products of files hold, and when there are none any more.
#pragma once
#include <string>
#include <vector>

#include "tools/connect/formats/outputs/product_output.h"

namespace leonav {

class ProductWatch {
 public:
  // What has changed must last for so many looks: a receiver's first times can be wrong.
  static constexpr int kPatience = 5;

  struct Sentence {
    bool is_warning = false;
    std::string text;
  };

  // To be called once a second. Returns what is new, for the log: first what holds, then each time
  // that of one kind nothing holds any more, or something does again.
  std::vector<Sentence> look(const ProductOutput::Holding& holding, GpsTime now);

 private:
  enum class State { kHolds, kLater, kNone };
  // What was told of one key.
  struct Told {
    State state = State::kHolds;
    int different = 0;  // looks since that is not so
  };

  static State state_of(const ProductOutput::Count& count);
  void look_at(const char* key, const ProductOutput::Count& count, GpsTime now, Told* told,
               std::vector<Sentence>* sentences);

  bool has_begun_ = false;
  Told antennas_, biases_, elements_;
};

}  // namespace leonav
