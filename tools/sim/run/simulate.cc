#include "tools/sim/run/simulate.h"

#include <cmath>
#include <filesystem>
#include <span>
#include <stdexcept>

#include "core/earth/rotation.h"
#include "drivers/csv/truth_csv.h"
#include "tools/common/format.h"
#include "tools/import/log_output.h"
#include "tools/sim/motion/ideal_imu.h"
#include "tools/sim/motion/inertial_sensor.h"
#include "tools/sim/route/drive.h"
#include "tools/sim/run/antennas.h"
#include "tools/sim/run/outbox.h"
#include "tools/sim/run/product_messages.h"
#include "tools/sim/run/pulse_counter.h"
#include "tools/sim/scenario/random_streams.h"
#include "tools/sim/signals/receiver.h"

namespace leonav::sim {
namespace {

// The last second of the motion is reserved for rates and latencies.
constexpr double kEndMargin_s = 1.0;

// Output is written under another name until the whole run has succeeded.
class TruthOutput {
 public:
  explicit TruthOutput(std::string path) : path_(std::move(path)), part_(path_ + ".part") {
    write({});
  }
  ~TruthOutput() {
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  void write(std::span<const TruthPoint> points) { write_truth_csv(part_, points); }
  void commit() { std::filesystem::rename(part_, path_); }

 private:
  std::string path_, part_;
};

class Run {
 public:
  Run(const Scenario& scenario, const std::optional<ExportOptions>& files, LogOutput* log)
      : scenario_(scenario),
        motion_(drive(scenario)),
        sky_(build_sky(scenario)),
        faults_(scenario.faults),
        receiver_(scenario, motion_, sky_, faults_),
        sensor_(scenario.imu.errors, scenario.imu.imperfections, scenario.imu.rate_hz,
                scenario.seed, random_stream(scenario.seed, "sensor")),
        wheel_(scenario.odometer, motion_),
        outbox_(&faults_, scenario.start, log),
        end_s_(motion_.duration_s() - kEndMargin_s),
        next_tag_s_(scenario.receiver.interval_s) {
    if (next_tag_s_ >= end_s_) {
      throw std::runtime_error("duration_s is too short: the drive ends before the first epoch, " +
                               std::to_string(next_tag_s_) + " s after its start");
    }
    const std::vector<AntennaPattern> antennas = ideal_antennas(scenario_, sky_);
    for (const AntennaPattern& pattern : antennas) log->write(scenario.start, pattern);
    BroadcastMessages messages = make_broadcast(scenario, sky_);
    Products products = provided_products(scenario, sky_, faults_);
    if (files) {
      export_.emplace(scenario, sky_, *files);
      export_->write(products, messages, antennas);
    }
    fits_ = messages.residuals;
    ephemerides_ = schedule_ephemerides(std::move(messages.ephemerides), scenario.start).items;
    products_ = in_order_of_arrival(std::move(products), scenario.start);
  }

  const std::array<FitStatistics, kSystemCount>& fits() const { return fits_; }

  std::vector<TruthPoint> go(ProgressBar* progress) {
    const auto interval_ns = static_cast<std::int64_t>(std::llround(1e9 / scenario_.imu.rate_hz));
    const GpsTime end = scenario_.start.plus_seconds(end_s_);
    for (GpsTime now = scenario_.start; now < end; now = now.plus_nanoseconds(interval_ns)) {
      const GpsTime next = now.plus_nanoseconds(interval_ns);
      post_products(next);
      post_epochs(next);
      post_odometer(next);
      if (scenario_.imu.enabled) post_imu(now, interval_ns);
      outbox_.deliver(next);
      progress->show(seconds_between(next, scenario_.start) / end_s_);
    }
    if (const double step = std::max(scenario_.truth_interval_s, 1.0 / scenario_.imu.rate_hz);
        scenario_.truth_interval_s > 0.0) {
      for (int i = 1; i * step < end_s_; ++i) add_truth(i * step);
    }
    outbox_.deliver_all();
    if (observations_ == 0) {
      throw std::runtime_error(
          "no signal of any satellite was received in the whole run; check satellites, "
          "receiver.elevation_mask_deg, receiver.latency_s, places and outages");
    }
    if (export_) export_->finish(truth_);
    return std::move(truth_);
  }

 private:
  void add_truth(double t) { truth_.push_back(motion_.point(scenario_.start.plus_seconds(t))); }

  void post_products(GpsTime until) {
    while (next_ephemeris_ < ephemerides_.size() &&
           ephemerides_[next_ephemeris_].arrival <= until) {
      const ScheduledEphemeris& next = ephemerides_[next_ephemeris_++];
      outbox_.post(next.arrival, next.ephemeris);
    }
    while (next_product_ < products_.size() && products_[next_product_].arrival <= until) {
      ScheduledOrbitEpoch& product = products_[next_product_++];
      outbox_.post(product.arrival, std::move(product.epoch.states));
    }
  }

  void post_epochs(GpsTime until) {
    const double latency_s = scenario_.receiver.gnss_latency_s;
    while (next_tag_s_ < end_s_ && scenario_.start.plus_seconds(next_tag_s_ + latency_s) <= until) {
      const bool is_off = faults_.is_receiver_off(next_tag_s_);
      if (was_off_ && !is_off) receiver_.reset();
      was_off_ = is_off;
      if (!is_off) {
        const RawEpoch epoch = receiver_.epoch(next_tag_s_);
        observations_ += epoch.observations.size();
        if (export_) export_->write(epoch);
        outbox_.post(scenario_.start.plus_seconds(next_tag_s_ + latency_s), epoch);
      }
      if (scenario_.truth_interval_s == 0.0) add_truth(next_tag_s_);
      ++epochs_;
      next_tag_s_ = scenario_.receiver.interval_s * static_cast<double>(epochs_ + 1);
    }
  }

  void post_odometer(GpsTime until) {
    const double latency_s = scenario_.odometer.latency_s;
    OdometerIncrement increment;
    while (wheel_.next(seconds_between(until, scenario_.start) - latency_s, &increment))
      outbox_.post(increment.time.plus_seconds(latency_s), increment);
  }

  void post_imu(GpsTime start, std::int64_t interval_ns) {
    const ImuSample ideal = in_imu_axes(ideal_sample(motion_, start, interval_ns));
    // The noise is drawn also in gaps, so that the noise after them does not change.
    const double speed = sensor_.needs_speed()
                             ? motion_.at(seconds_between(start, scenario_.start)).v_e.norm()
                             : 0.0;
    const ImuSample sample = scenario_.imu.ideal ? ideal : sensor_.measure(ideal, speed);
    const double t = seconds_between(sample.time, scenario_.start);
    if (faults_.is_imu_missing(t)) return;
    ImuSample measured = faults_.saturated(sample, t);
    measured.time = sample.time.plus_seconds(-scenario_.imu.time_offset_s);
    if (export_) export_->write(measured);
    outbox_.post(sample.time, measured);
  }

  ImuSample in_imu_axes(ImuSample sample) const {
    const Eigen::Vector3d& rpy = scenario_.imu.mounting_rpy;
    if (rpy.isZero(0.0)) return sample;
    const Eigen::Matrix3d C_imu_b = rotation_from_euler({rpy.x(), rpy.y(), rpy.z()}).transpose();
    sample.delta_theta_b = C_imu_b * sample.delta_theta_b;
    sample.delta_velocity_b = C_imu_b * sample.delta_velocity_b;
    return sample;
  }

  const Scenario& scenario_;
  SplineMotion motion_;
  TrueSky sky_;
  FaultScript faults_;
  std::vector<ScheduledEphemeris> ephemerides_;
  std::vector<ScheduledOrbitEpoch> products_;
  std::array<FitStatistics, kSystemCount> fits_;
  std::optional<Export> export_;
  Receiver receiver_;
  InertialSensor sensor_;
  PulseCounter wheel_;
  Outbox outbox_;
  double end_s_, next_tag_s_;
  std::size_t next_product_ = 0, next_ephemeris_ = 0, epochs_ = 0, observations_ = 0;
  bool was_off_ = false;
  std::vector<TruthPoint> truth_;
};

}  // namespace

std::string to_string(const RunReport& report) {
  std::string text = to_string(report.written);
  for (const System system : kSystems) {
    const FitStatistics& fits = report.fits[index_of(system)];
    if (fits.count == 0) continue;
    text +=
        format("%s: %ld broadcast issues, fitted to their orbits within %.3f m rms, worst %.3f m\n",
               std::string(to_string(system)).c_str(), static_cast<long>(fits.count), fits.rms_m(),
               fits.worst_m);
  }
  return text;
}

RunReport simulate(const Scenario& scenario, const RunOutputs& outputs, ProgressBar* progress) {
  RunReport report;
  // The outputs are opened first, so that a name that cannot be written costs no work.
  TruthOutput truth(outputs.truth);
  LogOutput log(outputs.log, &report.written);
  Run run(scenario, outputs.files, &log);
  const std::vector<TruthPoint> points = run.go(progress);
  truth.write(points);
  log.commit();
  truth.commit();
  report.fits = run.fits();
  return report;
}

}  // namespace leonav::sim
