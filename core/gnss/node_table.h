// Dated nodes of one satellite in a table of fixed capacity.
#pragma once
#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <cstdint>

#include "core/time/gps_time.h"

namespace leonav {

// Keeps nodes (anything with a `time`) in order of time, at most one per instant. When full, what
// arrived first goes, so that wrong times in the input cannot block a place for good.
template <typename Node, std::size_t kCapacity>
class NodeTable {
 public:
  // A node of an instant that is there replaces it. `arrival` grows from call to call.
  void insert(const Node& node, std::uint64_t arrival) {
    auto place = lower_bound(node.time);
    if (place != nodes_.end() && place->time == node.time) {
      *place = node;
      arrivals_[static_cast<std::size_t>(place - nodes_.begin())] = arrival;
      return;
    }
    if (nodes_.size() == nodes_.capacity()) {
      const auto first = std::min_element(arrivals_.begin(), arrivals_.end());
      nodes_.erase(nodes_.begin() + (first - arrivals_.begin()));
      arrivals_.erase(first);
      place = lower_bound(node.time);
    }
    arrivals_.insert(arrivals_.begin() + (place - nodes_.begin()), arrival);
    nodes_.insert(place, node);
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
  // Apart from the nodes, which lie together for interpolation.
  boost::container::static_vector<std::uint64_t, kCapacity> arrivals_;
};

}  // namespace leonav
