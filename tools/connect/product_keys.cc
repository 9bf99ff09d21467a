#include "tools/connect/product_keys.h"

#include <utility>

#include "drivers/antex/antex_reader.h"
#include "drivers/text/line_reader.h"
#include "tools/connect/in_folder.h"
#include "tools/import/antenna_models.h"
#include "tools/import/bias_files.h"
#include "tools/import/leo_element_files.h"

namespace leonav {
namespace {

constexpr const char *kAntennaModels = "antenna_models", *kReceiverAntenna = "receiver_antenna",
                     *kBiases = "biases", *kLeoElements = "leo_elements";

// A path or a list of them.
std::vector<std::string> read_paths(ConfigReader& group, const char* key,
                                    const std::string& folder) {
  std::vector<std::string> paths;
  const std::string allowed = "path or list of paths";
  if (group.is_scalar(key)) {
    group.text(key, &paths.emplace_back(), allowed);
  } else {
    group.list(key, &paths, allowed);
  }
  std::erase_if(paths, [](const std::string& path) { return path.empty(); });
  for (std::string& path : paths) path = in_folder(folder, path);
  return paths;
}

template <typename Read>
void attempt(const ConfigReader& group, const char* key, const ProductKeys& keys, Read read) {
  try {
    read();
  } catch (const FileError& error) {
    keys.errors->push_back(group.where(key) + ": " + error.what());
  }
}

void read_antennas(ConfigReader& group, const ProductKeys& keys, FileProducts* products) {
  std::vector<std::string> paths = read_paths(group, kAntennaModels, keys.folder);
  std::string receiver;
  group.text(kReceiverAntenna, &receiver, "type and radome");
  if (paths.empty()) {
    if (!receiver.empty()) {
      group.report(kReceiverAntenna, "is of no use without antenna_models, which have its model");
    }
    return;
  }
  if (receiver.empty()) {
    products->report.warnings.push_back(std::string("no corrections.receiver_antenna") +
                                        kWithoutReceiverAntenna);
  }
  // Of several files each one that is not there is told.
  std::vector<std::string> readable;
  for (const std::string& path : paths) {
    attempt(group, kAntennaModels, keys, [&] {
      static_cast<void>(LineReader(path));
      readable.push_back(path);
    });
  }
  attempt(group, kAntennaModels, keys, [&] {
    AntennaModels models =
        read_antenna_models(readable, antenna_name(receiver), GpsTime(), &products->report);
    products->antennas = std::move(models.receiver);
    products->antennas.insert(products->antennas.end(), models.satellites.begin(),
                              models.satellites.end());
  });
}

void add_biases(const std::string& path, FileProducts* products) {
  long not_sane = 0;
  for (const SignalBias& bias : read_bias_file(path, &products->report)) {
    SignalBias sent = bias;
    sent.time = GpsTime::from_nanoseconds(1);  // that of sending is not known yet
    if (is_sane(sent)) {
      products->biases.push_back(bias);
    } else {
      ++not_sane;
    }
  }
  products->report.skip(path, "bias that no satellite can have", not_sane);
}

}  // namespace

void read_correction_files(ConfigReader& group, const ProductKeys& keys, FileProducts* products) {
  for (const std::string& path : read_paths(group, kBiases, keys.folder)) {
    attempt(group, kBiases, keys, [&] { add_biases(path, products); });
  }
  read_antennas(group, keys, products);
}

void read_leo_files(ConfigReader& root, const ProductKeys& keys, FileProducts* products) {
  for (const std::string& path : read_paths(root, kLeoElements, keys.folder)) {
    attempt(root, kLeoElements, keys, [&] {
      const std::vector<Ephemeris> read = read_leo_element_file(path, &products->report);
      products->leo_elements.insert(products->leo_elements.end(), read.begin(), read.end());
    });
  }
}

}  // namespace leonav
