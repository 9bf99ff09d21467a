// These functions add, find, remove and propagate the signal states of a state and covariance:
// ambiguities of carriers, and time-correlated errors of codes and Dopplers.
#pragma once
#include <cstdint>

#include "core/filter/state/ekf_state.h"

namespace leonav {

inline constexpr int kNoSignalState = -1;

// Returns the index of an arc's ambiguity in `states`, or kNoSignalState.
int find_ambiguity(const SignalStates& states, std::uint32_t arc);
// Returns the index of the error state of a satellite's code or Doppler, or kNoSignalState.
int find_signal_error(const SignalStates& states, SignalState::Kind kind, SatelliteId satellite,
                      SignalCode code, SignalCode second_code);

// Appends a state with `sigma`, uncorrelated with all others. The table must have room.
void add_signal_state(const SignalState& state, double sigma, SignalStates* states,
                      EkfCovariance* covariance);

// Removes a state; those behind it move up.
void remove_signal_state(int index, SignalStates* states, EkfCovariance* covariance);

// Returns exp(-dt/T) of an error, 1 of an ambiguity.
double decay(const SignalState& state, double dt);

// Propagates the covariance of all signal states by `dt` seconds. An ambiguity takes its random
// walk; an error e of variance sigma^2 and correlation time T is a shaping filter driven by white
// noise w (Gelb, Applied Optimal Estimation, 1974, 3.8):
//   e(t + dt) = exp(-dt/T) e(t) + w,   var w = sigma^2 (1 - exp(-2 dt/T))
void propagate_signal_states(const SignalStates& states, double dt, EkfCovariance* covariance);

}  // namespace leonav
