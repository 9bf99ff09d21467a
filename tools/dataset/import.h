// A recording in files -> an LCM event log, as a live system would have received it.
#pragma once
#include <iosfwd>
#include <string>

#include "core/time/gps_time.h"
#include "tools/dataset/dataset.h"
#include "tools/dataset/import_report.h"

namespace leonav {

struct ImportOptions {
  GpsTime from, to;              // data time, both included; unset: everything
  double gnss_latency_s = 0.05;  // an epoch arrives this long after its time
};

// Writes the log to `output`, under that name only once it is complete. Events are in the order of
// arrival and stamped with it, in microseconds of GPS time, strictly increasing: an IMU sample
// arrives at the end of its interval, an epoch `gnss_latency_s` after its time, products as
// product_schedule.h says. `progress`, if given, gets a line now and then. Throws FileError for a
// file that cannot be read, EventLogError for one that cannot be written, std::runtime_error if
// nothing came out.
ImportReport import_dataset(const Dataset& dataset, const ImportOptions& options,
                            const std::string& output, std::ostream* progress);

}  // namespace leonav
