#include "core/filter/state/filter_state.h"

#include <algorithm>
#include <cmath>

#include "core/earth/rotation.h"

namespace leonav {

using namespace ekf_index;
using Eigen::Index;

void add(const EkfCorrection& error, bool has_attitude, CoreState* state) {
  NavState& nav = state->nav;
  nav.p_e += error.segment<3>(kPosition);
  nav.v_e += error.segment<3>(kVelocity);
  if (has_attitude)
    nav.q_eb =
        (quaternion_from_rotation_vector(error.segment<3>(kAttitude)) * nav.q_eb).normalized();
  nav.errors.gyro_bias_b += error.segment<3>(kGyroBias);
  nav.errors.accel_bias_b += error.segment<3>(kAccelBias);
  nav.errors.gyro_scale += error.segment<3>(kGyroScale);
  nav.errors.accel_scale += error.segment<3>(kAccelScale);
  state->clocks.offset_m += error.segment<4>(kClock);
  state->clocks.drift_m_s += error.segment<4>(kClockDrift);
  state->wet_delay_m += error(kWetDelay);
  state->carrier_clock_m += error(kCarrierClock);
  state->ionosphere_m += error(kIonosphere);
  for (std::size_t i = 0; i < state->vehicle.size(); ++i)
    state->vehicle[i] += error(kSize + static_cast<Index>(i));
}

void add(const EkfCorrection& error, bool has_attitude, FilterState* state) {
  add(error, has_attitude, static_cast<CoreState*>(state));
  const Index first = state->first_ambiguity();
  for (std::size_t i = 0; i < state->ambiguities.size(); ++i)
    state->ambiguities[i].value_m += error(first + static_cast<Index>(i));
}

EkfCorrection difference(const CoreState& state, const CoreState& reference) {
  const NavState& a = state.nav;
  const NavState& b = reference.nav;
  EkfCorrection error(state.size());
  error.segment<3>(kPosition) = a.p_e - b.p_e;
  error.segment<3>(kVelocity) = a.v_e - b.v_e;
  error.segment<3>(kAttitude) = rotation_vector_from_quaternion(a.q_eb * b.q_eb.conjugate());
  error.segment<3>(kGyroBias) = a.errors.gyro_bias_b - b.errors.gyro_bias_b;
  error.segment<3>(kAccelBias) = a.errors.accel_bias_b - b.errors.accel_bias_b;
  error.segment<3>(kGyroScale) = a.errors.gyro_scale - b.errors.gyro_scale;
  error.segment<3>(kAccelScale) = a.errors.accel_scale - b.errors.accel_scale;
  error.segment<4>(kClock) = state.clocks.offset_m - reference.clocks.offset_m;
  error.segment<4>(kClockDrift) = state.clocks.drift_m_s - reference.clocks.drift_m_s;
  error(kWetDelay) = state.wet_delay_m - reference.wet_delay_m;
  error(kCarrierClock) = state.carrier_clock_m - reference.carrier_clock_m;
  error(kIonosphere) = state.ionosphere_m - reference.ionosphere_m;
  for (std::size_t i = 0; i < state.vehicle.size(); ++i)
    error(kSize + static_cast<Index>(i)) = state.vehicle[i] - reference.vehicle[i];
  return error;
}

EkfCorrection difference(const FilterState& state, const FilterState& reference) {
  const Index first = state.first_ambiguity();
  EkfCorrection error(first + static_cast<Index>(state.ambiguities.size()));
  error.head(first) =
      difference(static_cast<const CoreState&>(state), static_cast<const CoreState&>(reference));
  for (std::size_t i = 0; i < state.ambiguities.size(); ++i)
    error(first + static_cast<Index>(i)) =
        state.ambiguities[i].value_m - reference.ambiguities[i].value_m;
  return error;
}

bool is_finite(const CoreState& state) {
  const NavState& nav = state.nav;
  return nav.p_e.allFinite() && nav.v_e.allFinite() && nav.q_eb.coeffs().allFinite() &&
         nav.errors.gyro_bias_b.allFinite() && nav.errors.accel_bias_b.allFinite() &&
         nav.errors.gyro_scale.allFinite() && nav.errors.accel_scale.allFinite() &&
         state.clocks.offset_m.allFinite() && state.clocks.drift_m_s.allFinite() &&
         std::isfinite(state.wet_delay_m) && std::isfinite(state.carrier_clock_m) &&
         std::isfinite(state.ionosphere_m) &&
         std::all_of(state.vehicle.begin(), state.vehicle.end(),
                     [](double x) { return std::isfinite(x); });
}

bool is_finite(const FilterState& state) {
  return is_finite(static_cast<const CoreState&>(state)) &&
         std::all_of(state.ambiguities.begin(), state.ambiguities.end(),
                     [](const Ambiguity& a) { return std::isfinite(a.value_m); });
}

}  // namespace leonav
