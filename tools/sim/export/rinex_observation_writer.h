// RinexObservationWriter writes RINEX 3.04 observation files.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "core/gnss/signals/observation.h"
#include "tools/sim/export/text_file.h"

namespace leonav::sim {

// Contents of the header.
struct ObservationFileHeader {
  std::string marker;
  std::string antenna;                                   // type and radome, 20 characters
  Eigen::Vector3d position_e = Eigen::Vector3d::Zero();  // approximate, m
  double interval_s = 1.0;
  std::map<System, std::vector<SignalCode>> signals;  // in the order of the file's columns
};

// Source: RINEX 3.04, tables A2 and A3.
//
// LEO satellites have the letters L, M, N, ..., and each letter in use has a line of observation
// types. Code and Doppler are rounded to 1 mm and 1 mHz, carriers to 1/1000 cycle, time tags to 100
// ns. The receiver's lock time becomes loss of lock where it is shorter than the time since the
// signal was last measured.
class RinexObservationWriter {
 public:
  // Throws FileError if the file cannot be created.
  RinexObservationWriter(const std::string& path, ObservationFileHeader header);

  // Writes epochs in order of time. A signal that the header does not list is left out and counted.
  void write(const RawEpoch& epoch);
  void close();  // throws FileError; a file without an epoch has no header either
  long left_out() const { return left_out_; }

 private:
  struct Signal {
    SatelliteId satellite;
    SignalCode code;
    friend auto operator<=>(const Signal&, const Signal&) = default;
  };
  void write_header(GpsTime first);
  std::string fields(const SignalObservation& observation, GpsTime time);
  bool lost_lock(const SignalObservation& observation, GpsTime time);

  TextFile file_;
  ObservationFileHeader header_;
  bool has_header_ = false;
  std::map<Signal, GpsTime> last_carrier_;
  long left_out_ = 0;
};

}  // namespace leonav::sim
