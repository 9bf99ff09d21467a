#include "drivers/csv/imu_csv.h"

#include <algorithm>
#include <array>

#include "drivers/csv/csv_writer.h"

namespace leonav {
namespace {

// At this point the increments of all usable rows hold rates; the intervals are not known yet.
std::int64_t median_interval(const std::vector<ImuSample>& samples) {
  std::vector<std::int64_t> intervals;
  intervals.reserve(samples.size());
  for (std::size_t i = 1; i < samples.size(); ++i) {
    intervals.push_back(samples[i].time.nanoseconds() - samples[i - 1].time.nanoseconds());
  }
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>((intervals.size() - 1) / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

void rates_to_increments(ImuCsv* imu) {
  imu->median_interval_ns = median_interval(imu->samples);
  const double longest = kGapIntervals * static_cast<double>(imu->median_interval_ns);
  GpsTime previous = imu->samples.front().time.plus_nanoseconds(-imu->median_interval_ns);
  for (ImuSample& sample : imu->samples) {
    sample.interval_ns = sample.time.nanoseconds() - previous.nanoseconds();
    if (static_cast<double>(sample.interval_ns) > longest) {
      sample.interval_ns = imu->median_interval_ns;
      ++imu->gaps;
    }
    sample.delta_theta_b *= sample.interval_s();
    sample.delta_velocity_b *= sample.interval_s();
    previous = sample.time;
  }
}

}  // namespace

ImuCsv read_imu_csv(const std::string& path) {
  CsvRows rows(path, kImuCsvHeader, kImuCsvHeader);
  constexpr std::array<std::string_view, 6> kNames = {"gyro_x_rad_s", "gyro_y_rad_s",
                                                      "gyro_z_rad_s", "accel_x_m_s2",
                                                      "accel_y_m_s2", "accel_z_m_s2"};
  std::array<int, 6> columns_of{};
  std::transform(kNames.begin(), kNames.end(), columns_of.begin(),
                 [&](std::string_view name) { return rows.column(name); });
  const int week = rows.column("gps_week"), tow = rows.column("gps_tow_s");

  ImuCsv imu;
  while (rows.next()) {
    ImuSample sample;
    sample.time = rows.time(week, tow);
    Eigen::Matrix<double, 6, 1> values;
    for (int i = 0; i < 6; ++i) {
      const int column = columns_of[static_cast<std::size_t>(i)];
      values[i] = rows.number(column).value_or(0.0);
      if (rows.blank(column)) rows.mark_bad("a value is missing");
    }
    if (rows.bad()) {
      rows.skip();
      continue;
    }
    sample.delta_theta_b = values.head<3>();
    sample.delta_velocity_b = values.tail<3>();
    imu.samples.push_back(sample);
  }
  rows.drop_disordered(&imu.samples, [](const ImuSample& sample) { return sample.time; });
  imu.report = rows.finish();
  if (imu.samples.size() < 2) {
    throw FileError(path, 0, "has one usable row; at least two are needed to know the interval");
  }
  rates_to_increments(&imu);
  return imu;
}

void write_imu_csv(const std::string& path, std::span<const ImuSample> samples) {
  CsvWriter writer(path, kImuCsvHeader);
  for (const ImuSample& sample : samples) {
    writer.time(sample.time);
    for (const double angle : sample.delta_theta_b) writer.number(angle / sample.interval_s(), 12);
    for (const double v : sample.delta_velocity_b) writer.number(v / sample.interval_s(), 10);
    writer.end_row();
  }
  writer.close();
}

}  // namespace leonav
