#include "tools/connect/formats/outputs/product_watch.h"

#include "tools/common/format.h"
#include "tools/import/import_report.h"

namespace leonav {
namespace {

std::string summary(const ProductOutput::Holding& holding, GpsTime now) {
  return format(
      "the files' products that hold at %s GPS time: %zu antenna models of the receiver and %zu of "
      "satellites (one for each band), biases of %zu signals, %zu sets of elements of LEO "
      "satellites",
      text_of(now).c_str(), holding.receiver_antennas.holding, holding.satellite_antennas.holding,
      holding.biases.holding, holding.leo_elements.holding);
}

}  // namespace

ProductWatch::State ProductWatch::state_of(const ProductOutput::Count& count) {
  if (count.given == 0 || count.holding > 0) return State::kHolds;
  return count.next.is_set() ? State::kLater : State::kNone;
}

void ProductWatch::look_at(const char* key, const ProductOutput::Count& count, GpsTime now,
                           Told* told, std::vector<Sentence>* sentences) {
  const State state = state_of(count);
  if (state == told->state) {
    told->different = 0;
    return;
  }
  if (++told->different < kPatience) return;
  *told = {state, 0};
  const std::string time = text_of(now) + " GPS time";
  switch (state) {
    case State::kHolds:
      sentences->push_back({false, format("%s: %zu of %zu hold at %s", key, count.holding,
                                          count.given, time.c_str())});
      break;
    case State::kLater:
      sentences->push_back({false, format("%s: none holds at %s; the first begins at %s", key,
                                          time.c_str(), text_of(count.next).c_str())});
      break;
    case State::kNone:
      sentences->push_back(
          {true, format("%s: none holds any more at %s; if this is the time, give newer files and "
                        "start leonav-connect again",
                        key, time.c_str())});
      break;
  }
}

std::vector<ProductWatch::Sentence> ProductWatch::look(const ProductOutput::Holding& holding,
                                                       GpsTime now) {
  std::vector<Sentence> sentences;
  if (!now.is_set()) return sentences;
  if (!has_begun_) sentences.push_back({false, summary(holding, now)});
  has_begun_ = true;
  look_at("corrections.antenna_models, of satellites", holding.satellite_antennas, now, &antennas_,
          &sentences);
  look_at("corrections.biases", holding.biases, now, &biases_, &sentences);
  look_at("leo_elements", holding.leo_elements, now, &elements_, &sentences);
  return sentences;
}

}  // namespace leonav
