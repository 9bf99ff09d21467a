// A vehicle that drives figures of eight for some minutes, observed at 1 Hz: carriers, codes and
// Dopplers of GPS, Galileo and LEO satellites with the errors that hide cycle slips. The ranges
// come from simulated_sky.h; what is predicted for the geometric check from the satellites'
// ephemerides.
#pragma once
#include <array>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "core/gnss/signals/band_plan.h"
#include "support/sky/simulated_sky.h"
#include "support/slips/slip_table.h"

namespace leonav::test {

struct SlipScene1HzOptions {
  double duration_s = 300.0;
  double interval_s = 1.0;
  bool leo = true;
  // 1 sigma of the predicted change of position, each axis; negative: nothing is predicted.
  double prediction_sigma_m = 0.01;
  double code_white_m = 0.25, code_multipath_m = 0.5;  // at 30 degrees and up
  double carrier_white_m = 0.0012, carrier_multipath_m = 0.003;
  double doppler_white_m_s = 0.04;
  double scintillation_m = 0.002;  // on L1, seconds long
  std::uint64_t seed = 1;
};

// A value that forgets itself with a time constant (first-order Gauss-Markov).
class GaussMarkov {
 public:
  double next(double sigma, double time_constant_s, double dt_s, double normal) {
    const double keep = started_ ? std::exp(-dt_s / time_constant_s) : 0.0;
    started_ = true;
    value_ = keep * value_ + sigma * std::sqrt(1.0 - keep * keep) * normal;
    return value_;
  }

 private:
  double value_ = 0.0;
  bool started_ = false;
};

// 200 m by 100 m in the tangent plane, up to 17 m/s and 2.5 m/s^2.
class FigureOfEight {
 public:
  Eigen::Vector3d p_e(double t) const {
    return start_ + C_en_ * Eigen::Vector3d(100.0 * std::sin(kRate * t),
                                            50.0 * std::sin(2.0 * kRate * t), 0.0);
  }
  Eigen::Vector3d v_e(double t) const {
    return C_en_ * Eigen::Vector3d(100.0 * kRate * std::cos(kRate * t),
                                   100.0 * kRate * std::cos(2.0 * kRate * t), 0.0);
  }

 private:
  static constexpr double kRate = 0.12;  // rad/s
  Geodetic origin_ = {0.69, 0.14, 300.0};
  Eigen::Vector3d start_ = to_ecef(origin_);
  Eigen::Matrix3d C_en_ = rotation_ecef_to_ned(origin_).transpose();
};

class SlipScene1Hz {
 public:
  explicit SlipScene1Hz(const SlipScene1HzOptions& options)
      : options_(options), generator_(options.seed) {
    sky_.add(gps_walker());
    sky_.add(galileo_walker());
    if (options.leo) sky_.add(leo_walker());
    const auto count = static_cast<int>(options.duration_s / options.interval_s);
    for (int k = 0; k < count; ++k) add_epoch(kStart_s + k * options.interval_s);
    predict_positions();
    scene_.predict = [this](std::size_t k, SatelliteId id, double pseudorange_m) {
      return predict_by_catalog(sky_.ephemeris_store, id, scene_.epochs[k].time, pseudorange_m,
                                positions_[k]);
    };
    scene_.prior.change_is_free = options.prediction_sigma_m < 0.0;
    scene_.prior.change_covariance =
        options.prediction_sigma_m * options.prediction_sigma_m * Eigen::Matrix3d::Identity();
    scene_.prior.position_covariance = 9.0 * Eigen::Matrix3d::Identity();
    scene_.carrier_sigma_m = 0.0025;
  }
  SlipScene1Hz(const SlipScene1Hz&) = delete;
  SlipScene1Hz& operator=(const SlipScene1Hz&) = delete;

  SlipScene& scene() { return scene_; }

 private:
  static constexpr double kStart_s = 5.0;
  static constexpr double kCodePosition_m = 2.0;

  struct Errors {
    std::array<GaussMarkov, 2> code, carrier;
    GaussMarkov scintillation;
    std::array<double, 2> ambiguity_cycles{};
    double wave_phase = 0.0;
  };

  // A prediction errs in each change by itself, and these errors add up; without one, every epoch's
  // position is that of its codes.
  void predict_positions() {
    Eigen::Vector3d error(1.0, -2.0, 1.5);
    const bool predicted = options_.prediction_sigma_m >= 0.0;
    for (std::size_t k = 0; k < scene_.epochs.size(); ++k) {
      if (!predicted) error.setZero();
      const double sigma = predicted ? options_.prediction_sigma_m : kCodePosition_m;
      for (double& axis : error) axis += sigma * normal_(generator_);
      const double t = kStart_s + static_cast<double>(k) * options_.interval_s;
      positions_.push_back(path_.p_e(t) + error);
    }
  }

  double draw() { return normal_(generator_); }

  // On L1: a zenith delay with a travelling wave, mapped by a shell at 350 km; a LEO satellite is
  // above most of it.
  double ionosphere_m(double elevation, double t, double wave_phase) const {
    const double sine = 6371.0 / 6721.0 * std::cos(elevation);
    const double mapping = 1.0 / std::sqrt(1.0 - sine * sine);
    return mapping * (2.5 + 0.05 * std::sin(2.0 * 3.14159265358979 * t / 600.0 + wave_phase));
  }

  void add_epoch(double t) {
    SimulatedReceiver receiver;
    receiver.v_e = path_.v_e(t);
    receiver.p_e = path_.p_e(t) - receiver.v_e * t;
    receiver.clock_s = 2e-5;
    receiver.clock_drift = 5e-8;
    receiver.signals = {{{'1', 'C'}, 45.0}, {{'2', 'W'}, 42.0}, {{'5', 'Q'}, 44.0}};
    receiver.atmosphere = false;
    RawEpoch raw = simulate_epoch(sky_, receiver, t);
    for (SignalObservation& o : raw.observations) spoil(receiver, t, &o);
    scene_.epochs.push_back(raw);
  }

  void spoil(const SimulatedReceiver& receiver, double t, SignalObservation* o) {
    const bool is_first = o->code.band == '1';
    const auto side = static_cast<std::size_t>(is_first ? 0 : 1);
    if (errors_.count(o->satellite) == 0) {
      Errors& fresh = errors_[o->satellite];
      for (double& cycles : fresh.ambiguity_cycles) cycles = std::round(1e6 * draw());
      fresh.wave_phase = 3.0 * draw();
    }
    Errors& e = errors_[o->satellite];
    const Ephemeris& ephemeris = *std::find_if(
        sky_.ephemerides.begin(), sky_.ephemerides.end(),
        [&](const Ephemeris& candidate) { return candidate.satellite == o->satellite; });
    const double elevation = simulated_elevation(receiver, ephemeris, t);
    const double weight = elevation_factor(elevation), dt = options_.interval_s;
    const double wavelength = BandPlan().wavelength_m(o->satellite.system, o->code.band);
    const double ratio = wavelength / BandPlan().wavelength_m(o->satellite.system, '1');
    if (is_first) scintillation_ = e.scintillation.next(options_.scintillation_m, 3.0, dt, draw());
    const double delay =
        ratio * ratio * (ionosphere_m(elevation, t, e.wave_phase) + scintillation_);
    const double range =
        o->pseudorange_m +
        saastamoinen_slant_delay_m(to_geodetic(receiver.p_e), elevation, kSkyEpoch.plus_seconds(t));
    o->pseudorange_m = range + delay +
                       weight * (options_.code_white_m * draw() +
                                 e.code[side].next(options_.code_multipath_m, 30.0, dt, draw()));
    o->carrier_cycles =
        (range - delay +
         weight * (options_.carrier_white_m * draw() +
                   e.carrier[side].next(options_.carrier_multipath_m, 40.0, dt, draw()))) /
            wavelength +
        e.ambiguity_cycles[side];
    o->doppler_hz += weight * options_.doppler_white_m_s * draw() / wavelength;
  }

  SlipScene1HzOptions options_;
  FigureOfEight path_;
  SimulatedSky sky_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
  std::map<SatelliteId, Errors> errors_;
  double scintillation_ = 0.0;  // of the satellite at hand
  std::vector<Eigen::Vector3d> positions_;
  SlipScene scene_;
};

}  // namespace leonav::test
