#include "core/filter/signal_errors.h"

#include <algorithm>

#include "core/filter/state/signal_states.h"

namespace leonav {
namespace {

constexpr double kForgotten = 3.0;  // correlation times

bool is_error(const SignalState& state) { return state.kind != SignalState::Kind::kAmbiguity; }

}  // namespace

int find_or_add_signal_error(const Measurement& measurement, SatelliteId satellite,
                             const GaussMarkov& model, GpsTime time, StateEstimate* estimate) {
  const SignalStates& states = estimate->state().signal_states;
  const SignalState::Kind kind = measurement.observable == Observable::kCode
                                     ? SignalState::Kind::kCodeError
                                     : SignalState::Kind::kDopplerError;
  const int first = estimate->state().first_signal_state();
  int index = find_signal_error(states, kind, satellite, measurement.code, measurement.second_code);
  if (index == kNoSignalState) {
    const auto errors = std::count_if(states.begin(), states.end(), is_error);
    if (static_cast<std::size_t>(errors) >= kMaxSignalErrors) return kNoSignalState;
    SignalState state;
    state.kind = kind;
    state.satellite = satellite;
    state.code = measurement.code;
    state.second_code = measurement.second_code;
    state.started = time;
    estimate->add_signal_state(state, model.sigma);
    index = static_cast<int>(states.size()) - 1;
  }
  estimate->set_error_model(first + index, model.sigma, model.correlation_time_s);
  return first + index;
}

void remove_idle_signal_errors(GpsTime time, StateEstimate* estimate) {
  const SignalStates& states = estimate->state().signal_states;
  for (int i = static_cast<int>(states.size()) - 1; i >= 0; --i) {
    const SignalState& state = states[static_cast<std::size_t>(i)];
    if (is_error(state) && (state.started == time || state.rejected > 0 || seconds_between(time, state.last_used) >
                                                         kForgotten * state.correlation_time_s))
      estimate->remove_signal_state(i);
  }
}

}  // namespace leonav
