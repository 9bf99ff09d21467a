#include "tools/sim/scenario/imu_config.h"

#include "daemon/config/config_groups.h"

namespace leonav::sim {

void read_sensor(ConfigReader& group, ImuConfig* imu) {
  group.boolean("enabled", &imu->enabled);
  group.boolean("ideal", &imu->ideal);
  group.number("rate_hz", {10.0, 1000.0}, &imu->rate_hz);
  read_imu(group, &imu->errors);
}

}  // namespace leonav::sim
