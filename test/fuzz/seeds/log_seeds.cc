#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/checkpoint/products_file.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_header.h"
#include "drivers/lcm/journal_marks.h"
#include "support/programs/parked_checkpoint.h"
#include "support/sky/simulated_sky.h"
#include "support/temporary_file.h"
#include "test/fuzz/seeds/seed_writer.h"

namespace leonav::test {
namespace {

void add_event(Seed* log, std::int64_t number, Channel channel,
               std::span<const std::uint8_t> data) {
  const std::string name = channel_name(channel);
  const EventHeaderBytes header =
      encode_event_header({number, 1'000'000 * number, static_cast<std::uint32_t>(name.size()),
                           static_cast<std::uint32_t>(data.size())});
  log->add(header).text(name).add(data);
}

// The events `first` to `last` of a run, behind the marks with which a piece begins.
Seed piece(std::int64_t run, std::int64_t number, std::int64_t first, std::int64_t last) {
  Seed log;
  const SeedBytes configuration(40, 'c'), sample(20, 's');
  add_event(&log, 0, Channel::kConfig, configuration);
  add_event(&log, 1, Channel::kPiece, encode_piece({run, number, first, RecordedOutputs::kAll}));
  for (std::int64_t i = first; i <= last; ++i) add_event(&log, i, Channel::kImu, sample);
  return log;
}

}  // namespace

void write_log_seeds(SeedWriter* writer) {
  Seed log;
  std::int64_t number = 0;
  for (const SeedMessage& one : seed_messages()) {
    if (one.bytes.size() > 400) continue;
    add_event(&log, number++, static_cast<Channel>(one.channel), one.bytes);
  }
  writer->write("event_log", "inputs", log);
  writer->write("event_log", "piece", piece(7, 1, 2, 5));

  const auto folder = [](std::initializer_list<std::pair<std::size_t, Seed>> files) {
    Seed all;
    for (const auto& [name, content] : files) {
      all.byte(name).half(content.bytes().size()).add(content.bytes());
    }
    return all;
  };
  writer->write("journal", "three",
                folder({{0, piece(7, 1, 2, 5)}, {1, piece(7, 2, 6, 8)}, {2, piece(7, 3, 9, 9)}}));
  writer->write("journal", "gap", folder({{0, piece(7, 1, 2, 5)}, {2, piece(7, 3, 9, 9)}}));
  writer->write("journal", "kept", folder({{4, piece(7, 1, 2, 5)}, {3, piece(7, 2, 4, 8)}}));
  writer->write("journal", "two_runs", folder({{0, piece(7, 1, 2, 5)}, {1, piece(8, 2, 6, 8)}}));

  int count = 0;
  for (const char* name : {"drive.lcmlog", "drive.lcmlog.part0002", "drive.part9999.kept",
                           "part0002", ".kept", "a.part00002"}) {
    writer->write("piece_name", std::to_string(++count), Seed().text(name));
  }
}

void write_state_seeds(SeedWriter* writer) {
  const TemporaryFile file("checkpoint.yaml", "");
  const auto write_checkpoint = [&](const char* name, const Checkpoint& checkpoint) {
    save_checkpoint(file.path(), checkpoint);
    std::ifstream stream(file.path(), std::ios::binary);
    writer->write("checkpoint", name,
                  Seed().text(std::string(std::istreambuf_iterator<char>(stream), {})));
  };
  Checkpoint checkpoint = parked();
  write_checkpoint("parked", checkpoint);
  checkpoint.calibration.reset();  // as older versions
  write_checkpoint("without_calibration", checkpoint);

  BroadcastProducts products;
  products.ephemerides = {walker_ephemerides(gps_walker()).front(),
                          walker_ephemerides(galileo_walker()).front()};
  writer->write("products", "ephemerides", Seed().byte(0).text(ProductsText().of(products)));
  products.ionosphere = KlobucharModel{{1e-8, 0, 0, 0}, {1e5, 0, 0, 0}, true};
  writer->write("products", "ionosphere", Seed().byte(0).text(ProductsText().of(products)));
  SignalBias bias;
  bias.satellite = {System::kGps, 5};
  bias.code = {'1', 'C'};
  bias.time = kSkyEpoch;
  bias.bias_m = 1.5;
  products.biases = {bias};
  writer->write("products", "biases", Seed().byte(0).text(ProductsText().of(products)));
}

}  // namespace leonav::test
