#include "tools/connect/formats/outputs/product_output.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/gnss/orbits/ephemeris_store.h"
#include "tools/import/product_schedule.h"

namespace leonav {
namespace {

bool holds(GpsTime from, GpsTime until, GpsTime now) {
  return !(from.is_set() && now < from) && !(until.is_set() && now >= until);
}

}  // namespace

ProductOutput::ProductOutput(std::shared_ptr<const FileProducts> products, double repeat_s,
                             MessageOutput* output)
    : products_(std::move(products)),
      repeat_s_(repeat_s),
      output_(output),
      biases_(products_->biases) {
  for (std::size_t i = 0; i < products_->antennas.size(); ++i) {
    const AntennaPattern& pattern = products_->antennas[i];
    items_.push_back({Kind::kAntenna, i, pattern.valid_from, pattern.valid_until});
  }
  const std::span<const FileBiases::Message> messages = biases_.messages();
  for (std::size_t i = 0; i < messages.size(); ++i) {
    items_.push_back({Kind::kBiases, i, messages[i].from, messages[i].until});
  }
  add_elements();
}

// Elements are sent from their transmission on, until the second next ones have come. Of rows that
// repeat a set the first counts.
void ProductOutput::add_elements() {
  std::map<SatelliteId, std::vector<std::size_t>> issues;
  std::set<std::tuple<SatelliteId, GpsTime, std::uint16_t>> known;
  const std::vector<Ephemeris>& all = products_->leo_elements;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (known.emplace(all[i].satellite, all[i].toe, all[i].issue).second) {
      issues[all[i].satellite].push_back(i);
    }
  }
  for (auto& [satellite, own] : issues) {
    std::stable_sort(own.begin(), own.end(), [&](std::size_t a, std::size_t b) {
      return transmission_time(all[a]) < transmission_time(all[b]);
    });
    for (std::size_t k = 0; k < own.size(); ++k) {
      GpsTime until = all[own[k]].toe.plus_seconds(kLongestLeoAge_s);
      if (k + kIssuesInUse < own.size()) {
        until = std::min(until, transmission_time(all[own[k + kIssuesInUse]]));
      }
      items_.push_back({Kind::kElements, own[k], transmission_time(all[own[k]]), until});
    }
  }
}

void ProductOutput::yield_to(std::span<const SignalBias> biases) {
  const std::vector<SignalBias> ends = biases_.yield_to(biases, time());
  for (std::size_t i = 0; i < ends.size(); i += FileBiases::kOfMessage) {
    output_->send(std::span<const SignalBias>(ends).subspan(
        i, std::min(FileBiases::kOfMessage, ends.size() - i)));
  }
  if (ends.empty()) return;
  for (Item& item : items_) {
    if (item.kind == Kind::kBiases) item.is_sent = biases_.is_whole(item.index);
  }
}

bool ProductOutput::is_due(const Item& item) const { return holds(item.from, item.until, time()); }

// Returns whether there was anything to send.
bool ProductOutput::send(Item* item, bool missing_only) {
  switch (item->kind) {
    case Kind::kAntenna:
      output_->send(products_->antennas[item->index], time());
      break;
    case Kind::kElements: {
      Ephemeris sent = products_->leo_elements[item->index];
      sent.transmission_time = transmission_time(sent);
      output_->send(sent);
      break;
    }
    case Kind::kBiases: {
      const std::vector<SignalBias> sent = biases_.take(item->index, time(), missing_only);
      item->is_sent = biases_.is_whole(item->index);
      if (!sent.empty()) output_->send(std::span<const SignalBias>(sent));
      return !sent.empty();
    }
  }
  item->is_sent = true;
  return true;
}

int ProductOutput::send_due(GpsTime now) {
  if (items_.empty()) return 0;
  const std::optional<double> elapsed_s = pace_.advance(now);
  if (!elapsed_s) return 0;
  int count = 0;
  for (Item& item : items_) {
    if (count == kMostAtOnce) return count;
    if (!item.is_sent && is_due(item)) count += send(&item, true);
  }
  return count + repeat(*elapsed_s, kMostAtOnce - count);
}

// One after the other, so that a round takes the interval.
int ProductOutput::repeat(double elapsed_s, int most) {
  if (repeat_s_ <= 0.0) return 0;
  const auto due =
      std::count_if(items_.begin(), items_.end(), [&](const Item& item) { return is_due(item); });
  credit_ = std::min(credit_ + elapsed_s * static_cast<double>(due) / repeat_s_,
                     static_cast<double>(most));
  int count = 0;
  for (std::size_t tried = 0; credit_ >= 1.0 && tried < items_.size(); ++tried) {
    Item& item = items_[next_];
    next_ = (next_ + 1) % items_.size();
    if (!is_due(item)) continue;
    count += send(&item, false);
    credit_ -= 1.0;
  }
  return count;
}

ProductOutput::Count* ProductOutput::count_of(const Item& item, Holding* holding) const {
  if (item.kind == Kind::kBiases) return &holding->biases;
  if (item.kind == Kind::kElements) return &holding->leo_elements;
  return products_->antennas[item.index].is_receiver ? &holding->receiver_antennas
                                                     : &holding->satellite_antennas;
}

ProductOutput::Holding ProductOutput::holding() const {
  const double max_age_leo_s = EphemerisConfig().max_age_leo_s;
  Holding holding;
  for (const Item& item : items_) {
    Count* count = count_of(item, &holding);
    const bool is_old =
        item.kind == Kind::kElements &&
        seconds_between(time(), products_->leo_elements[item.index].toe) > max_age_leo_s;
    const std::size_t many = item.kind == Kind::kBiases ? biases_.messages()[item.index].count : 1;
    count->given += many;
    if (is_due(item) && !is_old) count->holding += many;
    if (time() < item.from && (!count->next.is_set() || item.from < count->next)) {
      count->next = item.from;
    }
  }
  return holding;
}

}  // namespace leonav
