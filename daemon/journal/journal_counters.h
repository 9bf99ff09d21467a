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
  Gauge name;              // 1 + the number behind journal.path, 1: none; 0: there is no file yet
  Gauge deleted, kept;     // pieces, by this process
  Gauge undeletable;       // times that a piece could not be deleted
  Gauge failures;          // of the disk
  Gauge unsynced;          // times that the disk has not confirmed what was written
  Gauge error;             // errno of the failure that lasts; 0: none does
  Gauge last_error;        // of the last one
  Gauge waiting_since_ns;  // steady clock: when the system call under way began; 0: there is none
  Gauge complete;          // 1: the end mark is on the disk
};

}  // namespace leonav
