#include "drivers/bias_sinex/signal_differences.h"

#include <algorithm>
#include <deque>
#include <set>

#include "core/gnss/measurement/weighting.h"

namespace leonav {
namespace {

struct Edge {
  SignalCode to;
  double difference_s = 0.0;  // bias of `to` minus bias of where the edge begins
};

using Graph = std::map<SignalCode, std::vector<Edge>>;
using Values = std::map<SignalCode, double>;

void connect(const BiasRecord& record, Graph* graph) {
  (*graph)[record.second].push_back({record.first, record.value_s});
  (*graph)[record.first].push_back({record.second, -record.value_s});
}

// Returns the biases relative to that of `start`, breadth first.
Values biases_from(SignalCode start, const Graph& graph) {
  Values values = {{start, 0.0}};
  std::deque<SignalCode> next = {start};
  for (; !next.empty(); next.pop_front()) {
    const double here = values.at(next.front());
    for (const Edge& edge : graph.at(next.front())) {
      if (values.emplace(edge.to, here + edge.difference_s).second) next.push_back(edge.to);
    }
  }
  return values;
}

double reference_value(System system, const ClockReference& reference, const Values& values) {
  if (!reference.second.is_set()) return values.at(reference.first);
  const double f1 = frequency_hz(system, reference.first.band);
  const double f2 = frequency_hz(system, reference.second.band);
  const IonosphereFree pair = ionosphere_free(f1, f2);
  return pair.gamma1 * values.at(reference.first) + pair.gamma2 * values.at(reference.second);
}

// Solves one interval.
Values solve(System system, const Graph& graph, std::span<const ClockReference> references) {
  Values solved;
  for (const ClockReference& reference : references) {
    if (graph.count(reference.first) == 0 || solved.count(reference.first) != 0) continue;
    const Values values = biases_from(reference.first, graph);
    if (reference.second.is_set() && values.count(reference.second) == 0) continue;
    const double shift = reference_value(system, reference, values);
    for (const auto& [code, value] : values) solved.emplace(code, value - shift);
  }
  return solved;
}

// Appends, or makes the bias before longer where it goes on with the same value.
void append(const BiasRecord& bias, std::vector<BiasRecord>* biases) {
  for (auto i = biases->rbegin(); i != biases->rend(); ++i) {
    if (i->first != bias.first) continue;
    if (i->until != bias.from || i->value_s != bias.value_s) break;
    i->until = bias.until;
    return;
  }
  biases->push_back(bias);
}

}  // namespace

std::vector<ClockReference> usual_references(System system) {
  switch (system) {
    case System::kGps:
      return {{{'1', 'W'}, {'2', 'W'}}, {{'1', 'P'}, {'2', 'P'}}};
    case System::kGalileo:
      return {{{'1', 'C'}, {'5', 'Q'}}, {{'1', 'C'}, {'5', 'I'}}, {{'1', 'X'}, {'5', 'X'}}};
    case System::kBeidou:
      return {{{'2', 'I'}, {'6', 'I'}}};
    case System::kLeo:
      return {};
  }
  return {};
}

DifferenceResult resolve_differences(std::span<const BiasRecord> differences,
                                     std::span<const ClockReference> references) {
  DifferenceResult result;
  std::set<GpsTime> boundaries;
  for (const BiasRecord& d : differences) boundaries.insert({d.from, d.until});
  std::set<SignalCode> unconnected;
  for (auto from = boundaries.begin(); from != boundaries.end(); ++from) {
    const auto until = std::next(from);
    if (until == boundaries.end()) break;
    Graph graph;
    for (const BiasRecord& d : differences) {
      if (d.from <= *from && d.until >= *until) connect(d, &graph);
    }
    if (graph.empty()) continue;
    const SatelliteId satellite = differences.front().satellite;
    const Values solved = solve(satellite.system, graph, references);
    for (const auto& [code, edges] : graph) {
      const auto value = solved.find(code);
      if (value == solved.end()) {
        unconnected.insert(code);
      } else {
        append({satellite, code, {}, *from, *until, value->second}, &result.biases);
      }
    }
  }
  result.unconnected.assign(unconnected.begin(), unconnected.end());
  return result;
}

}  // namespace leonav
