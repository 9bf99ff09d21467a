// This header keeps the dated nodes of one satellite in a table of fixed capacity.
#pragma once
#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <cstdint>

#include "core/base/gps_time.h"

namespace leonav {

// The table holds nodes (any type with a member `time`) in order of time, at most one per instant.
// When it is full, the node that arrived first is dropped, so that wrong times in the input cannot
// block a slot permanently.
template <typename Node, std::size_t kCapacity>
class InterpolationTable {
 public:
  // Inserts a node; it replaces one of the same instant. `arrival` must grow from call to call.
  void insert(const Node& node, std::uint64_t arrival) {
    auto slot = lower_bound(node.time);
    if (slot != nodes_.end() && slot->time == node.time) {
      *slot = node;
      arrivals_[static_cast<std::size_t>(slot - nodes_.begin())] = arrival;
      return;
    }
    if (nodes_.size() == nodes_.capacity()) {
      const auto first = std::min_element(arrivals_.begin(), arrivals_.end());
      nodes_.erase(nodes_.begin() + (first - arrivals_.begin()));
      arrivals_.erase(first);
      slot = lower_bound(node.time);
    }
    arrivals_.insert(arrivals_.begin() + (slot - nodes_.begin()), arrival);
    nodes_.insert(slot, node);
  }

  const Node* data() const { return nodes_.data(); }
  std::size_t size() const { return nodes_.size(); }
  bool empty() const { return nodes_.empty(); }

 private:
  auto lower_bound(GpsTime time) {
    return std::lower_bound(nodes_.begin(), nodes_.end(), time,
                            [](const Node& node, GpsTime t) { return node.time < t; });
  }

  boost::container::static_vector<Node, kCapacity> nodes_;
  // Arrivals are kept apart from the nodes, which must be contiguous for interpolation.
  boost::container::static_vector<std::uint64_t, kCapacity> arrivals_;
};

}  // namespace leonav
