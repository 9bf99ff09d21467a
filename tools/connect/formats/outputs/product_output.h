// The ProductOutput publishes what comes from files and not from streams: antenna models, biases of
// signals, elements of LEO satellites.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "core/gnss/propagation/antenna_model.h"
#include "tools/connect/formats/outputs/message_output.h"
#include "tools/import/import_report.h"

namespace leonav {

// The contents of the files, of any time.
struct FileProducts {
  std::vector<AntennaPattern> antennas;  // the receiver's first
  std::vector<SignalBias> biases;        // `time` unset
  std::vector<Ephemeris> leo_elements;
  ImportReport report;  // what the files leave out, and what is missing
};

// Each model, bias and set of elements is sent once it holds, and then again and again while it
// does, for a service that starts later or has lost one.
class ProductOutput {
 public:
  // More could find no room in the receiving socket.
  static constexpr int kMostAtOnce = 20;
  static constexpr double kStep_s = 0.1;  // from one time that so many are sent to the next
  // Few enough for a datagram that the network does not split.
  static constexpr std::size_t kBiasesOfMessage = 40;
  // Elements serve no longer, whatever `max_age_leo_s` of leonavd allows.
  static constexpr double kLongestElements_s = 7200.0;

  // `repeat_s`: from one time that something is sent to the next; 0: never again. `output` must
  // outlive this object.
  ProductOutput(std::shared_ptr<const FileProducts> products, double repeat_s,
                MessageOutput* output);

  // To be called whenever something shows that it is `now`: sends what is due. Returns the number
  // of messages.
  int send_due(GpsTime now);

  // Takes biases that a correction service has sent. Those of the files are not sent for its
  // satellites while its own hold: they belong to the clocks of another provider.
  void yield_to(std::span<const SignalBias> biases);

  // How many hold at the last time; of biases signals.
  struct Holding {
    std::size_t antennas = 0, biases = 0, leo_elements = 0;
  };
  Holding holding() const;
  // Whether the time is known.
  bool has_begun() const { return last_.is_set(); }

 private:
  enum class Kind : std::uint8_t { kAntenna, kBiases, kElements };
  // A message: one of `antennas` or `leo_elements`, or `count` of `biases_`.
  struct Item {
    Kind kind;
    std::size_t index, count;
    GpsTime from, until;  // unset: always, for good
    bool is_sent = false;
  };

  void add_biases();
  void add_elements();
  bool is_due(const Item& item) const;
  bool send(Item* item);
  int repeat(double elapsed_s, int most);

  std::shared_ptr<const FileProducts> products_;
  double repeat_s_;
  MessageOutput* output_;
  std::vector<SignalBias> biases_;  // by validity
  std::vector<Item> items_;
  std::map<SatelliteId, GpsTime> of_service_;  // until when its biases are a service's
  GpsTime last_;
  std::size_t next_ = 0;  // of those that are repeated
  double credit_ = 0.0;   // of messages that may be repeated
};

}  // namespace leonav
