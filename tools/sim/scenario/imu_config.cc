#include "tools/sim/scenario/imu_config.h"

#include "core/base/angle.h"
#include "daemon/config/config_groups.h"

namespace leonav::sim {
namespace {

constexpr double kMilligal = 1e-5;  // m/s^2
constexpr double kHour = 3600.0;

void read_vibration(ConfigReader& group, double rate_hz, VibrationModel* model) {
  group.number("accel_idle_m_s2", {0.0, 100.0}, &model->accel_idle);
  group.number("accel_m_s2_per_m_s", {0.0, 10.0}, &model->accel_per_speed);
  group.number("gyro_idle_deg_s", {0.0, 100.0}, &model->gyro_idle, kDegree);
  group.number("gyro_deg_s_per_m_s", {0.0, 10.0}, &model->gyro_per_speed, kDegree);
  group.number("low_hz", {0.1, 500.0}, &model->low_hz);
  group.number("high_hz", {0.1, 500.0}, &model->high_hz);
  if (model->high_hz <= model->low_hz) group.report("high_hz", "must be greater than low_hz");
  if (model->active() && model->high_hz >= 0.5 * rate_hz) {
    group.report("high_hz", "must be below half of imu.rate_hz: a sensor cannot show more");
  }
}

void read_temperature(ConfigReader& group, ImuImperfections* imu) {
  group.number("rise_k", {-200.0, 200.0}, &imu->temperature_rise_k);
  group.number("time_s", {1.0, 1e6}, &imu->temperature_time_s);
  group.number("gyro_deg_per_h_per_k", {0.0, 1e4}, &imu->gyro_bias_per_k, kDegree / kHour);
  group.number("accel_mgal_per_k", {0.0, 1e5}, &imu->accel_bias_per_k, kMilligal);
}

}  // namespace

ImuErrorModel errors_of(ImuGrade grade) {
  ImuErrorModel imu;
  switch (grade) {
    case ImuGrade::kTactical:
      imu.angle_random_walk = 0.05 * kDegree / 60.0;
      imu.velocity_random_walk = 0.1 / 60.0;
      imu.gyro_bias = {0.5 * kDegree / kHour, 3600.0};
      imu.accel_bias = {25.0 * kMilligal, 3600.0};
      break;
    case ImuGrade::kMems:
      imu.angle_random_walk = 0.3 * kDegree / 60.0;
      imu.velocity_random_walk = 0.1 / 60.0;
      imu.gyro_bias = {1000.0 * kDegree / kHour, 1000.0};
      imu.accel_bias = {20000.0 * kMilligal, 1000.0};
      imu.gyro_scale = {5000e-6, 10000.0};
      imu.accel_scale = {5000e-6, 10000.0};
      break;
    case ImuGrade::kIdeal:
      break;
  }
  return imu;
}

void read_sensor(ConfigReader& group, ImuConfig* imu) {
  group.boolean("enabled", &imu->enabled);
  group.boolean("ideal", &imu->ideal);
  group.number("rate_hz", {10.0, 1000.0}, &imu->rate_hz);
  group.vector("mounting_rpy_deg", {-360.0, 360.0}, &imu->mounting_rpy, kDegree);
  group.number("time_offset_ms", {-500.0, 500.0}, &imu->time_offset_s, 1e-3);
  ImuGrade grade = ImuGrade::kTactical;
  group.choice<ImuGrade>(
      "grade",
      {{"tactical", ImuGrade::kTactical}, {"mems", ImuGrade::kMems}, {"ideal", ImuGrade::kIdeal}},
      &grade);
  imu->errors = errors_of(grade);
  read_imu(group, &imu->errors);
  ImuImperfections& more = imu->imperfections;
  group.number("gyro_misalignment_deg", {0.0, 5.0}, &more.gyro_misalignment, kDegree);
  group.number("accel_misalignment_deg", {0.0, 5.0}, &more.accel_misalignment, kDegree);
  group.number("gyro_quantum_deg", {0.0, 1.0}, &more.gyro_quantum, kDegree);
  group.number("accel_quantum_m_s", {0.0, 1.0}, &more.accel_quantum);
  group.group("vibration",
              [&](ConfigReader& r) { read_vibration(r, imu->rate_hz, &more.vibration); });
  group.group("temperature", [&](ConfigReader& r) { read_temperature(r, &more); });
}

}  // namespace leonav::sim
