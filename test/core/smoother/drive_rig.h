// A synthetic drive through an inertial filter that keeps its process, and the keyframes that the
// smoother is given of it.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "core/filter/carrier_receiver.h"
#include "core/filter/nees.h"
#include "core/filter/synthetic.h"
#include "core/filter/update/measurement_model.h"
#include "core/smoother/keyframe_from_filter.h"
#include "support/drive/white_errors.h"

namespace leonav::synthetic {

struct DriveOptions {
  std::uint64_t seed = 1;
  // Share of what the sigmas say that is drawn: a small one leaves the problem linear.
  double noise = 1.0;
  bool inertial = true;  // otherwise constant velocity
  bool carriers = true;
  bool robust = false;
  std::size_t gps_satellites = 5;  // of eight, the others of Galileo
  bool leo = false;                // those are near and fast instead, of LEO
  double code_sigma = 3.0, doppler_sigma = 0.2, carrier_sigma = 0.005;
  bool constrained = false;                     // it neither slides nor flies
  bool odometer = false;                        // and has one, where it is constrained
  bool calibrating = false;                     // lever arm and time offset are estimated
  double random_walk = 0.0;                     // of the carriers, m/sqrt(s)
  int arc_epochs = 1'000'000;                   // an arc's length; they end one after the other
  bool whole_cycles = false;                    // is what a satellite's arcs differ by
  bool joined = false;                          // the smoother is told joins of its first two arcs
  Eigen::Vector3d sigma_rpy{0.02, 0.02, 0.08};  // rad, of the attitude that the filter is given
  Eigen::Vector3d misaligned_rpy{0.0, 0.0, 0.0};  // rad, that is beyond
  int straight_epochs = 0;                        // at the start, without acceleration or turn
  int aligned_at = 0;  // epoch at whose end it is given that; 0: the start
  // Epoch at which the filter starts over from a point solution, and at whose end it has an
  // attitude again; 0: never.
  int restarted_at = 0, aligned_again_at = 0;
  Eigen::Vector3d lever_b{0.5, 0.3, -1.2};
  // Changes what the receiver measures at an epoch (1 is the first), its truth included.
  std::function<void(int, MeasurementEpoch*)> edit;
  std::function<void(int, Truth*)> edit_truth;
};

// One epoch a second.
class Drive {
 public:
  explicit Drive(const DriveOptions& options)
      : options_(options),
        config_(make_config(options)),
        noise_(options.seed),
        errors_(draw_errors(drawn(mems(), options.noise), &noise_)),
        filter_(config_, mems(), options.inertial ? options.lever_b : Eigen::Vector3d::Zero()),
        input_(std::make_unique<KeyframeInput>()) {
    const Eigen::Matrix3d C_en = C_en_at(start_position());
    NavState start;
    start.time = kStart;
    start.p_e = start_position();
    start.v_e = C_en * Eigen::Vector3d{8.0, 0.0, 0.0};
    start.q_eb = Eigen::Quaterniond(C_en);
    mechanization_.reset(start);
    truth_.clocks.offset_m.setConstant(100.0);
    place_antenna(Eigen::Vector3d::Zero());
    ambiguities_m_ = Eigen::VectorXd::LinSpaced(8, -40.0, 60.0);
    PointSolution point = point_near(truth_, 3.0 * options.noise, 0.2 * options.noise, &noise_);
    point.covariance_p_e = 9.0 * Eigen::Matrix3d::Identity();
    point.covariance_v_e = 0.04 * Eigen::Matrix3d::Identity();
    filter_.initialize(start.time, point);
    if (options.inertial && options.aligned_at == 0) align();
  }

  // The next epoch, as the smoother is given it.
  const KeyframeInput& step() {
    ++epoch_;
    move();
    if (options_.edit_truth) options_.edit_truth(epoch_, &truth_);
    measured_ = measure_epoch();
    if (options_.edit) options_.edit(epoch_, &measured_);
    predict();
    if (epoch_ == options_.restarted_at) restart();
    result_ = filter_.update(measured_);
    const bool aligns = epoch_ == options_.aligned_at || epoch_ == options_.aligned_again_at;
    if (aligns) align();
    keyframe_from_filter(measured_.index, measured_.time, &measured_, &from_, &filter_,
                         input_.get());
    if (options_.joined) join();
    input_->block_complete = input_->follows_previous || aligns || epoch_ == options_.restarted_at;
    return *input_;
  }

  static MotionConstraintConfig motion() {
    MotionConstraintConfig config;
    config.non_holonomic = true;
    config.slip_per_acceleration = 0.0;
    return config;
  }
  int epoch() const { return epoch_; }
  const Ekf& filter() const { return filter_; }
  const EkfConfig& config() const { return config_; }
  const EkfUpdateResult& result() const { return result_; }
  const NavState& truth() const { return mechanization_.state(); }
  // Of the state in question: the antenna without attitude.
  const Truth& antenna() const { return truth_; }
  Eigen::Vector3d lever_b() const {
    return options_.inertial ? options_.lever_b : Eigen::Vector3d::Zero();
  }

 private:
  static EkfConfig make_config(const DriveOptions& options) {
    EkfConfig config = white_error_config();
    config.keep_process = true;
    config.use_carrier = options.carriers;
    config.robust.enabled = options.robust;
    if (options.constrained) {
      config.vehicle = {2, {0.02, 0.02, 0.03}, {1e-5, 1e-5, 1e-6}};
      if (options.odometer) config.vehicle.count = 3;
    }
    if (options.calibrating)
      config.vehicle = {ekf_index::kMaxVehicle,
                        {0.0, 0.0, 0.0, 0.5, 0.5, 0.5, 0.01},
                        {0.0, 0.0, 0.0, 2e-4, 2e-4, 2e-4, 2e-6}};
    return config;
  }

  // Every third epoch: the first two ambiguities differ by what they do and 4 mm, within 1 cm.
  void join() {
    const Ambiguities& ambiguities = input_->from.ambiguities;
    if (!input_->follows_previous || epoch_ % 3 != 0 || ambiguities.size() < 2) return;
    const Eigen::Index first = input_->from.first_ambiguity();
    input_->process.joins.push_back({first, first + 1, 0.004, 1e-4});
  }

  void restart() {
    PointSolution point = point_near(truth_, 3.0 * options_.noise, 0.2 * options_.noise, &noise_);
    point.covariance_p_e = 9.0 * Eigen::Matrix3d::Identity();
    point.covariance_v_e = 0.04 * Eigen::Matrix3d::Identity();
    filter_.reset();
    filter_.initialize(measured_.time, point);
  }

  // Gives the filter the true attitude with an error of its sigmas.
  void align() {
    const Eigen::Vector3d& sigma_rpy = options_.sigma_rpy;
    const Eigen::Vector3d rotation =
        options_.noise * sigma_rpy.cwiseProduct(noise_.normal3()) + options_.misaligned_rpy;
    filter_.set_attitude(
        quaternion_from_rotation_vector(C_en_at(truth().p_e) * -rotation) * truth().q_eb, sigma_rpy,
        Eigen::Vector3d::Zero(), mems().gyro_bias.sigma);
  }

  void predict() {
    const std::span<const ImuSample> block{input_->block.data(), input_->block.size()};
    input_->instants.clear();
    for (std::size_t i = 19; i < block.size() && options_.constrained; i += 20) {
      filter_.predict(block, block[i].time);
      ConstraintInstant instant;
      instant.time = block[i].time;
      if (options_.odometer) instant.odometer = odometer_at(i);
      MotionMeasurements measurements;
      motion_measurements(motion(), instant, filter_.filter_state(), filter_.body().measured_rate_b,
                          &measurements);
      instant.used = filter_.constrain(&measurements, motion().gate);
      input_->instants.push_back(instant);
    }
    filter_.predict(block, measured_.time);
  }

  // Of the last 0.15 s but 0.03 s; it shows 1 % too much.
  OdometerSpeed odometer_at(std::size_t i) {
    double mean = 0.0;
    for (std::size_t k = i - 17; k <= i - 3; ++k) mean += speeds_[k] / 15.0;
    const double noise = options_.noise * motion().odometer_sigma * noise_.normal();
    return {true, (1.0 + 0.01 * options_.noise) * mean + noise, speeds_[i] - mean, 0.0};
  }

  static ImuErrorModel drawn(ImuErrorModel model, double share) {
    model.angle_random_walk *= share;
    model.velocity_random_walk *= share;
    for (GaussMarkov* process :
         {&model.gyro_bias, &model.accel_bias, &model.gyro_scale, &model.accel_scale})
      process->sigma *= share;
    return model;
  }

  void place_antenna(const Eigen::Vector3d& rate_b) {
    const AntennaMotion antenna = antenna_motion(truth(), rate_b, lever_b(), true);
    truth_.p_antenna_e = antenna.p_e;
    truth_.v_antenna_e = antenna.v_e;
  }

  // A turn in steps slides sideways by millimetres per second; takes that out of the sample.
  void keep_on_rails(ImuSample* ideal) const {
    for (int again = 0; again < 2; ++again) {
      Mechanization ahead = mechanization_;
      ahead.advance(*ideal);
      const Eigen::Vector3d v_b = ahead.state().q_eb.conjugate() * ahead.state().v_e;
      ideal->delta_velocity_b.tail<2>() -= v_b.tail<2>();
    }
  }

  // A start, then turns left and right; without an IMU, white acceleration.
  void move() {
    constexpr double kStep = 0.01;
    constexpr int kPerEpoch = 100;
    const ImuErrorModel model = drawn(mems(), options_.noise);
    ClockModel clock = config_.clock;
    for (double* noise : {&clock.offset_noise, &clock.drift_noise, &clock.inter_system_noise,
                          &clock.inter_system_drift_noise})
      *noise *= options_.noise;
    advance_clocks(clock, kPerEpoch * kStep, &truth_.clocks, &noise_);
    for (double& ambiguity : ambiguities_m_)
      ambiguity += options_.noise * options_.random_walk * noise_.normal();
    input_->sample_before_block = input_->block.empty() ? ImuSample{} : input_->block.back();
    input_->block.clear();
    speeds_.clear();
    if (!options_.inertial) {
      EkfConfig config = config_;
      config.acceleration_noise_horizontal *= options_.noise;
      config.acceleration_noise_vertical *= options_.noise;
      move_a_second(config, C_en_at(start_position()), &truth_, &noise_);
      return;
    }
    Eigen::Vector3d rate_b = Eigen::Vector3d::Zero();
    for (int k = 0; k < kPerEpoch; ++k) {
      const double t = epoch_ - 1 + k * kStep;
      const double share = epoch_ > options_.straight_epochs ? 1.0 : 0.0;
      const Maneuver maneuver{.yaw_rate = share * 0.4 * std::sin(0.5 * t),
                              .acceleration = share * std::cos(0.7 * t)};
      ImuSample ideal = ideal_sample(truth(), maneuver, kStep);
      if (options_.constrained) keep_on_rails(&ideal);
      advance_errors(model, kStep, &errors_, &noise_);
      input_->block.push_back(with_errors(ideal, model, errors_, &noise_));
      rate_b = ideal.delta_theta_b / kStep;
      mechanization_.advance(ideal);
      speeds_.push_back((truth().q_eb.conjugate() * truth().v_e).x());
    }
    place_antenna(rate_b);
  }

  // On straight lines: 1,200 km away at 16 s, at 7.5 km/s.
  static void bring_near(double t, std::vector<SatelliteInView>* sky) {
    for (SatelliteInView& view : *sky) {
      if (view.satellite.system != System::kGalileo) continue;
      view.satellite.system = System::kLeo;
      const Eigen::Vector3d start_e = start_position();
      view.v_e *= 7500.0 / view.v_e.norm();
      view.p_e = start_e + 1.2e6 * (view.p_e - start_e).normalized() + (t - 16.0) * view.v_e;
    }
  }

  MeasurementEpoch measure_epoch() {
    const double share = options_.noise;
    std::vector<SatelliteInView> sky = sky_at(epoch_, options_.gps_satellites);
    if (options_.leo) bring_near(epoch_, &sky);
    MeasurementEpoch epoch =
        measure(kStart.plus_seconds(epoch_), sky, truth_, share * options_.code_sigma,
                share * options_.doppler_sigma, &noise_);
    epoch.index = static_cast<std::uint64_t>(epoch_);
    const auto codes = epoch.measurements;
    for (const Measurement& code : codes) {
      if (!options_.carriers || code.observable != Observable::kCode) continue;
      const SatelliteInView& view = epoch.satellites[code.satellite_index];
      Measurement carrier = code;
      carrier.observable = Observable::kCarrier;
      const auto i = static_cast<int>(code.satellite_index);
      const auto turn = static_cast<std::uint32_t>((epoch_ + 7 * i) / options_.arc_epochs);
      carrier.arc = 1u + code.satellite_index + 100u * turn;
      carrier.random_walk = options_.random_walk;
      carrier.value =
          predict_range(view, truth_.p_antenna_e).range_m +
          truth_.clocks.offset_m(static_cast<Eigen::Index>(index_of(view.satellite.system))) +
          ambiguities_m_(i) + 10.0 * turn + share * options_.carrier_sigma * noise_.normal();
      if (options_.whole_cycles) {
        constexpr double kWavelength_m = 0.2;  // 50 of them are the 10 m
        epoch.satellites[code.satellite_index].cn0_dbhz = 45.0;
        carrier.cycles.wavelength_m = {kWavelength_m, 0.0};
        carrier.cycles.gamma = {1.0, 0.0};
      }
      epoch.measurements.push_back(carrier);
    }
    for (Measurement& m : epoch.measurements)
      m.sigma = m.observable == Observable::kCode      ? options_.code_sigma
                : m.observable == Observable::kDoppler ? options_.doppler_sigma
                                                       : options_.carrier_sigma;
    return epoch;
  }

  DriveOptions options_;
  EkfConfig config_;
  Generator noise_;
  ImuErrors errors_;
  Truth truth_;
  Eigen::VectorXd ambiguities_m_;
  Mechanization mechanization_;
  std::vector<double> speeds_;  // true ones, forward, of the last epoch's samples
  Ekf filter_;
  FilterState from_;
  MeasurementEpoch measured_;
  EkfUpdateResult result_;
  std::unique_ptr<KeyframeInput> input_;
  int epoch_ = 0;
};

inline void remove_satellites(const std::function<bool(SatelliteId)>& which,
                              MeasurementEpoch* epoch) {
  for (Measurement& m : epoch->measurements)
    if (which(epoch->satellites[m.satellite_index].satellite)) m.reason = Reason::kNotSolved;
}

// The largest |a - b| over the sigma that `covariance` has for it.
inline double apart_in_sigmas(const FilterState& a, const FilterState& b,
                              const EkfCovariance& covariance) {
  const EkfCorrection error = difference(a, b);
  double most = 0.0;
  for (Eigen::Index i = 0; i < error.size(); ++i)
    if (covariance(i, i) > 0.0)
      most = std::max(most, std::abs(error(i)) / std::sqrt(covariance(i, i)));
  return most;
}

// The largest element of a - b, in products of the sigmas of b.
inline double apart_in_correlations(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                    const Eigen::Ref<const Eigen::MatrixXd>& b) {
  const Eigen::VectorXd scale = b.diagonal().cwiseSqrt().cwiseInverse();
  return (scale.asDiagonal() * (a - b) * scale.asDiagonal()).cwiseAbs().maxCoeff();
}

}  // namespace leonav::synthetic
