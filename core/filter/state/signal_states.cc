#include "core/filter/state/signal_states.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"

namespace leonav {

int find_ambiguity(const SignalStates& states, std::uint32_t arc) {
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i].kind == SignalState::Kind::kAmbiguity && states[i].arc == arc)
      return static_cast<int>(i);
  return kNoSignalState;
}

int find_signal_error(const SignalStates& states, SignalState::Kind kind, SatelliteId satellite,
                      SignalCode code, SignalCode second_code) {
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i].kind == kind && states[i].satellite == satellite && states[i].code == code &&
        states[i].second_code == second_code)
      return static_cast<int>(i);
  return kNoSignalState;
}

void add_signal_state(const SignalState& state, double sigma, SignalStates* states,
                      EkfCovariance* covariance) {
  const Eigen::Index n = covariance->rows();
  covariance->conservativeResize(n + 1, n + 1);
  covariance->row(n).setZero();
  covariance->col(n).setZero();
  (*covariance)(n, n) = sigma * sigma;
  states->push_back(state);
}

void remove_signal_state(int index, SignalStates* states, EkfCovariance* covariance) {
  const Eigen::Index last = covariance->rows() - 1;
  const Eigen::Index gone = covariance->rows() - static_cast<Eigen::Index>(states->size()) + index;
  for (Eigen::Index i = gone; i < last; ++i) covariance->col(i) = covariance->col(i + 1);
  for (Eigen::Index i = gone; i < last; ++i) covariance->row(i) = covariance->row(i + 1);
  covariance->conservativeResize(last, last);
  states->erase(states->begin() + index);
}

double decay(const SignalState& state, double dt) {
  return state.kind == SignalState::Kind::kAmbiguity ? 1.0
                                                     : std::exp(-dt / state.correlation_time_s);
}

void propagate_signal_states(const SignalStates& states, double dt, EkfCovariance* covariance) {
  const Eigen::Index first = covariance->rows() - static_cast<Eigen::Index>(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const SignalState& signal = states[i];
    const Eigen::Index state = first + static_cast<Eigen::Index>(i);
    if (signal.kind == SignalState::Kind::kAmbiguity) {
      (*covariance)(state, state) += signal.random_walk * signal.random_walk * dt;
      continue;
    }
    const double r = decay(signal, dt);
    covariance->row(state) *= r;
    covariance->col(state) *= r;
    (*covariance)(state, state) += square(signal.sigma) * (1.0 - r * r);
  }
}

}  // namespace leonav
