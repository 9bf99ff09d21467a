// Each of these functions reads one group of the configuration file.
#pragma once
#include "daemon/config/config_reader.h"
#include "daemon/config/daemon_config.h"

namespace leonav {

void read_vehicle(ConfigReader& group, NavigatorConfig* navigator);
void read_imu(ConfigReader& group, ImuErrorModel* config);
// Reads the key of the group imu that does not concern its errors.
void read_imu_stamps(ConfigReader& group, double* time_offset_s);
// To be called after read_vehicle(), because some defaults depend on the vehicle's kind.
void read_alignment(ConfigReader& group, const VehicleConfig& vehicle, AlignmentConfig* config);
void read_gnss(ConfigReader& group, GnssConfig* config);
// Reads the group `key`, carriers of LEO satellites in MHz by band. Fails where two bands have the
// same carrier.
void read_leo_bands(ConfigReader& group, const char* key, BandPlan* bands);
// Reads the keys of gnss about the motion of the ground, and the file of ocean loading.
void read_ground(ConfigReader& group, GnssConfig* config);
void read_ekf(ConfigReader& group, NavigatorConfig* config);
void read_smoother(ConfigReader& group, SmootherConfig* config);
void read_robust(ConfigReader& group, RobustConfig* config);
void read_integrity(ConfigReader& group, IntegrityConfig* config);
// Deadlines and rates belong to the navigator, priorities and processors to the threads.
void read_realtime(ConfigReader& group, NavigatorConfig* navigator, ThreadsConfig* threads);
void read_drill(ConfigReader& group, DrillConfig* config);
void read_lcm(ConfigReader& group, LcmConfig* config);
void read_commands(ConfigReader& group, CommandsConfig* config);
void read_journal(ConfigReader& group, JournalConfig* config);
void read_log(ConfigReader& group, LogConfig* config);
// The navigator gets the greatest age of a checkpoint.
void read_checkpoint(ConfigReader& group, CheckpointConfig* config, NavigatorConfig* navigator);

}  // namespace leonav
