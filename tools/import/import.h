// This unit converts a recording in files to an LCM event log, as a live system would have received
// it.
#pragma once
#include <iosfwd>
#include <string>

#include "core/base/gps_time.h"
#include "tools/import/dataset.h"
#include "tools/import/import_report.h"

namespace leonav {

// Settings of an import.
struct ImportOptions {
  GpsTime from, to;              // data time, both inclusive; unset: everything
  double gnss_latency_s = 0.05;  // an epoch arrives this long after its time
};

// Writes the log to `output`, under that name only once it is complete.
//
// Events are in the order of arrival and stamped with it, in microseconds of GPS time, strictly
// increasing. An IMU sample arrives at the end of its interval, an epoch `gnss_latency_s` after its
// time, products as product_schedule.h defines. `progress`, if given, gets a line now and then.
// Throws FileError for a file that cannot be read, EventLogError for one that cannot be written,
// std::runtime_error if the log would be empty.
ImportReport import_dataset(const Dataset& dataset, const ImportOptions& options,
                            const std::string& output, std::ostream* progress);

}  // namespace leonav
