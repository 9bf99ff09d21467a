#include "tools/connect/formats/outputs/product_output.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "tools/import/bias_files.h"
#include "tools/import/product_schedule.h"

namespace leonav {
namespace {

// Issues of a satellite that serve at once: as an import sends them (product_schedule.h).
constexpr std::size_t kIssues = 2;

bool holds(GpsTime from, GpsTime until, GpsTime now) {
  return !(from.is_set() && now < from) && !(until.is_set() && now >= until);
}

}  // namespace

ProductOutput::ProductOutput(std::shared_ptr<const FileProducts> products, double repeat_s,
                             MessageOutput* output)
    : products_(std::move(products)), repeat_s_(repeat_s), output_(output) {
  for (std::size_t i = 0; i < products_->antennas.size(); ++i) {
    const AntennaPattern& pattern = products_->antennas[i];
    items_.push_back({Kind::kAntenna, i, 1, pattern.valid_from, pattern.valid_until});
  }
  add_biases();
  add_elements();
}

// A message holds biases of one validity.
void ProductOutput::add_biases() {
  biases_ = products_->biases;
  const auto validity = [](const SignalBias& one) {
    return std::tuple(one.valid_from, one.valid_until);
  };
  std::stable_sort(biases_.begin(), biases_.end(), [&](const SignalBias& a, const SignalBias& b) {
    return validity(a) < validity(b);
  });
  for (std::size_t i = 0; i < biases_.size(); ++i) {
    const bool continues = i > 0 && validity(biases_[i]) == validity(biases_[i - 1]) &&
                           items_.back().count < kBiasesOfMessage;
    if (continues) {
      ++items_.back().count;
      continue;
    }
    const GpsTime from = biases_[i].valid_from;
    items_.push_back({Kind::kBiases, i, 1, from.is_set() ? from.plus_seconds(-kBiasLead_s) : from,
                      biases_[i].valid_until});
  }
}

// Elements are sent from their transmission on, until the second next ones have come.
void ProductOutput::add_elements() {
  std::map<SatelliteId, std::vector<std::size_t>> issues;
  const std::vector<Ephemeris>& all = products_->leo_elements;
  for (std::size_t i = 0; i < all.size(); ++i) issues[all[i].satellite].push_back(i);
  for (auto& [satellite, own] : issues) {
    std::stable_sort(own.begin(), own.end(), [&](std::size_t a, std::size_t b) {
      return transmission_time(all[a]) < transmission_time(all[b]);
    });
    for (std::size_t k = 0; k < own.size(); ++k) {
      GpsTime until = all[own[k]].toe.plus_seconds(kLongestElements_s);
      if (k + kIssues < own.size()) {
        until = std::min(until, transmission_time(all[own[k + kIssues]]));
      }
      items_.push_back({Kind::kElements, own[k], 1, transmission_time(all[own[k]]), until});
    }
  }
}

void ProductOutput::yield_to(std::span<const SignalBias> biases) {
  for (const SignalBias& bias : biases) {
    if (bias.kind != BiasKind::kCode) continue;
    of_service_[bias.satellite] =
        bias.valid_until.is_set() ? bias.valid_until : bias.time.plus_seconds(kLongestBiasAge_s);
  }
}

bool ProductOutput::is_due(const Item& item) const { return holds(item.from, item.until, last_); }

// Returns whether there was anything to send.
bool ProductOutput::send(Item* item) {
  item->is_sent = true;
  switch (item->kind) {
    case Kind::kAntenna:
      output_->send(products_->antennas[item->index], last_);
      return true;
    case Kind::kElements: {
      Ephemeris sent = products_->leo_elements[item->index];
      sent.transmission_time = transmission_time(sent);
      output_->send(sent);
      return true;
    }
    case Kind::kBiases:
      break;
  }
  std::vector<SignalBias> sent;
  for (std::size_t i = item->index; i < item->index + item->count; ++i) {
    const auto service = of_service_.find(biases_[i].satellite);
    if (service != of_service_.end() && last_ < service->second) continue;
    sent.push_back(biases_[i]);
    sent.back().time = last_;
  }
  if (sent.empty()) return false;
  output_->send(std::span<const SignalBias>(sent));
  return true;
}

int ProductOutput::send_due(GpsTime now) {
  if (items_.empty()) return 0;
  // A receiver whose time was set back must not silence what is due.
  const double elapsed_s = last_.is_set() ? std::abs(seconds_between(now, last_)) : kStep_s;
  if (elapsed_s < kStep_s) return 0;
  last_ = now;
  int count = 0;
  for (Item& item : items_) {
    if (count == kMostAtOnce) return count;
    if (!item.is_sent && is_due(item)) count += send(&item);
  }
  return count + repeat(elapsed_s, kMostAtOnce - count);
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
    count += send(&item);
    credit_ -= 1.0;
  }
  return count;
}

ProductOutput::Holding ProductOutput::holding() const {
  Holding holding;
  for (const Item& item : items_) {
    if (!is_due(item)) continue;
    if (item.kind == Kind::kAntenna) ++holding.antennas;
    if (item.kind == Kind::kBiases) holding.biases += item.count;
    if (item.kind == Kind::kElements) ++holding.leo_elements;
  }
  return holding;
}

}  // namespace leonav
