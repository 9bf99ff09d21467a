// The JournalCounters are numbers about the journal that any thread may read.
#pragma once
#include "daemon/threads/counters.h"

namespace leonav {

struct JournalCounters {
  Gauge journaled;         // messages handed to the operating system
  Gauge lost_solutions;    // SOLUTION left out where the memory was half full
  Gauge lost_others;       // messages that found no room
  Gauge pieces;            // begun
  Gauge piece_number;      // of the piece that is written
  Gauge deleted, kept;     // pieces, by this process
  Gauge failures;          // of the disk
  Gauge error;             // errno of the failure that lasts; 0: none does
  Gauge waiting_since_ns;  // steady clock: when the system call under way began; 0: there is none
  Gauge complete;          // 1: the end mark is on the disk
};

}  // namespace leonav
