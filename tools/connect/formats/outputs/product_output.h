// The ProductOutput publishes what comes from files and not from streams: antenna models, biases of
// signals, elements of LEO satellites.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/gnss/propagation/antenna_model.h"
#include "tools/connect/formats/outputs/file_biases.h"
#include "tools/connect/formats/outputs/message_output.h"
#include "tools/connect/formats/outputs/product_pace.h"
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

  // `repeat_s`: from one time that something is sent to the next; 0: never again. `output` must
  // outlive this object.
  ProductOutput(std::shared_ptr<const FileProducts> products, double repeat_s,
                MessageOutput* output);

  // To be called whenever something shows that it is `now`: sends what is due, at most once in
  // ProductPace::kStep_s. Returns the number of messages.
  int send_due(GpsTime now);

  // Takes biases that a correction service is about to send, and sends ends of those of the files
  // that its own replace (file_biases.h).
  void yield_to(std::span<const SignalBias> biases);

  // Of one kind: how many the files give, how many of them hold at time(), and when the first of
  // the others begins to (unset: none will).
  struct Count {
    std::size_t given = 0, holding = 0;
    GpsTime next;
  };
  // Biases are counted by signals, models by bands. Elements of LEO satellites hold as long as
  // leonavd uses them by default.
  struct Holding {
    Count receiver_antennas, satellite_antennas, biases, leo_elements;
  };
  Holding holding() const;
  // Unset before the first time is known.
  GpsTime time() const { return pace_.time(); }

 private:
  enum class Kind : std::uint8_t { kAntenna, kBiases, kElements };
  // A message: one of `antennas` or `leo_elements`, or one of biases_.messages().
  struct Item {
    Kind kind;
    std::size_t index;
    GpsTime from, until;   // unset: always, for good
    bool is_sent = false;  // whole, and not ended since
  };

  void add_elements();
  bool is_due(const Item& item) const;
  bool send(Item* item, bool missing_only);
  int repeat(double elapsed_s, int most);
  Count* count_of(const Item& item, Holding* holding) const;

  std::shared_ptr<const FileProducts> products_;
  double repeat_s_;
  MessageOutput* output_;
  FileBiases biases_;
  std::vector<Item> items_;
  ProductPace pace_;
  std::size_t next_ = 0;  // of those that are repeated
  double credit_ = 0.0;   // of messages that may be repeated
};

}  // namespace leonav
