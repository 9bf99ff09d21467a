#include "tools/connect/connect_config.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "daemon/config/config_file.h"
#include "daemon/config/config_groups.h"
#include "daemon/config/load_config.h"
#include "tools/connect/product_keys.h"
#include "tools/connect/stream_keys.h"

namespace leonav {
namespace {

constexpr std::size_t kMaxStreams = 64;  // of streams_t

bool is_receiver(const StreamConfig& stream) {
  return !stream.is_service && stream.format != FormatKind::kVectornav &&
         stream.format != FormatKind::kXsens && stream.format != FormatKind::kImuLine;
}
bool gives_imu(const StreamConfig& stream) {
  return (!stream.is_service && !is_receiver(stream)) || stream.is_inertial;
}

void refuse_names(const ConfigReader& root, const std::vector<StreamConfig>& streams) {
  if (streams.size() > kMaxStreams) root.report("streams", "more than 64");
  std::set<std::string> names;
  for (const StreamConfig& stream : streams) {
    if (!stream.name.empty() && !names.insert(stream.name).second) {
      root.report("streams", "two are named '" + stream.name + "'; give each its own name");
    }
  }
}

// Two senders on one channel would be one stream with twice the messages.
void refuse_conflicts(const ConfigReader& root, const std::vector<StreamConfig>& streams) {
  if (streams.empty()) root.report("streams", "must list at least one stream");
  int receivers = 0, inertial = 0, inputs = 0;
  for (const StreamConfig& stream : streams) {
    receivers += is_receiver(stream);
    inertial += gives_imu(stream);
    inputs += std::holds_alternative<InputOptions>(stream.source);
  }
  if (receivers > 1 || inertial > 1) {
    root.report("streams", receivers > 1
                               ? "two receivers would publish on one channel, GNSS_EPOCH; run "
                                 "leonav-connect once for each, with another lcm.prefix"
                               : "two inertial sensors would publish on one channel, IMU; run "
                                 "leonav-connect once for each, with another lcm.prefix, or leave "
                                 "out 'inertial: true' of a receiver's stream");
  }
  if (inputs > 1) root.report("streams", "only one can be read from standard input");
}

void read_pulse(ConfigReader& group, PulseConfig* pulse) {
  group.text("stream", &pulse->stream);
  group.integer("input", 0, 1, &pulse->input.input);
  group.choice<bool>("edge", {{"rising", false}, {"falling", true}}, &pulse->input.is_falling);
  group.number("delay_ms", {-1000.0, 1000.0}, &pulse->input.delay_s, kKeyMillisecond_s);
}

// A pulse needs who sends it and who sees it.
void refuse_lonely_pulse(const ConfigReader& root, const ConnectConfig& config) {
  if (config.pulse.stream.empty()) return;
  const bool has_sensor =
      std::any_of(config.streams.begin(), config.streams.end(), [&](const StreamConfig& stream) {
        return stream.name == config.pulse.stream && !stream.is_service && !is_receiver(stream);
      });
  if (!has_sensor) {
    root.report("time", "pulse.stream is '" + config.pulse.stream +
                            "', but no stream of an inertial sensor has this name");
  }
  const bool has_receiver =
      std::any_of(config.streams.begin(), config.streams.end(),
                  [](const StreamConfig& stream) { return stream.format == FormatKind::kUbx; });
  if (!has_receiver) {
    root.report("time", "pulse needs a stream of the format ubx, whose receiver sees the pulses");
  }
}

void read_corrections(ConfigReader& group, CorrectionOptions* options,
                      ServiceChoiceOptions* services) {
  constexpr Bounds kAge = {1.0, 3600.0};
  group.choice<bool>("point", {{"antenna", true}, {"mass_centre", false}}, &options->at_antenna);
  group.choice<NavigationMessage>(
      "galileo_message",
      {{"inav", NavigationMessage::kGalileoInav}, {"fnav", NavigationMessage::kGalileoFnav}},
      &options->galileo_message);
  group.number("max_orbit_age_s", kAge, &options->max_orbit_age_s);
  group.number("max_clock_age_s", kAge, &options->max_clock_age_s);
  group.number("max_high_rate_age_s", kAge, &options->max_high_rate_age_s);
  group.number("sigma_m", {0.001, 100.0}, &options->default_sigma_m);
  group.number("fallback_s", {5.0, 600.0}, &services->fallback_s);
  group.number("return_s", {0.0, 3600.0}, &services->return_s);
}

// Whether orbits of mass centres come without what leads to the antennas. Pages of HAS and of
// PPP-B2b say themselves that theirs are of antennas.
bool lacks_antenna_models(const ConnectConfig& config, const FileProducts& products) {
  const auto brings_ssr = [](const StreamConfig& stream) {
    return stream.format == FormatKind::kRtcm3;
  };
  const auto is_of_satellite = [](const AntennaPattern& pattern) { return !pattern.is_receiver; };
  return !config.corrections.at_antenna &&
         std::any_of(config.streams.begin(), config.streams.end(), brings_ssr) &&
         std::none_of(products.antennas.begin(), products.antennas.end(), is_of_satellite);
}

// Where another program sends the orbits of a system, or nobody uses it, none is missing.
void read_expected_orbits(ConfigReader& root, ExpectedOrbits* expected) {
  std::vector<std::string> names;
  for (const System system : kSystems) {
    if ((*expected)[index_of(system)]) names.emplace_back(to_string(system));
  }
  if (!root.list("warn_without_ephemerides", &names, "list of gps, galileo, beidou")) return;
  expected->fill(false);
  for (const std::string& name : names) {
    const auto system = system_from_string(name);
    if (!system || *system == System::kLeo) {
      root.report("warn_without_ephemerides", "'" + name + "' is not one of gps, galileo, beidou");
      continue;
    }
    (*expected)[index_of(*system)] = true;
  }
}

}  // namespace

bool has_only_files(const ConnectConfig& config) {
  return std::all_of(config.streams.begin(), config.streams.end(), [](const StreamConfig& stream) {
    return std::holds_alternative<FileOptions>(stream.source);
  });
}

double product_repeat_s(const ConnectConfig& config) {
  const auto receiver = std::find_if(config.streams.begin(), config.streams.end(), is_receiver);
  return receiver == config.streams.end() ? StreamConfig().repeat_s : receiver->repeat_s;
}

const char* name_of(FormatKind format) {
  switch (format) {
    case FormatKind::kUbx:
      return "ubx";
    case FormatKind::kRtcm3:
      return "rtcm3";
    case FormatKind::kOem7:
      return "oem7";
    case FormatKind::kSbf:
      return "sbf";
    case FormatKind::kVectornav:
      return "vectornav";
    case FormatKind::kXsens:
      return "xsens";
    case FormatKind::kHas:
      return "has";
    case FormatKind::kB2b:
      return "b2b";
    case FormatKind::kImuLine:
      break;
  }
  return "imu_line";
}

ConnectConfig load_connect_config(const std::string& path,
                                  const std::vector<std::string>& overrides) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  ConnectConfig config;
  ConfigSource source{path};
  const auto products = std::make_shared<FileProducts>();
  read_yaml(read_config_file(path), overrides, &source, [&](ConfigReader& root) {
    root.group("lcm", [&](ConfigReader& group) { read_lcm(group, &config.lcm); });
    root.group("time", [&](ConfigReader& group) {
      group.choice<TimeReference>("reference",
                                  {{"gnss", TimeReference::kGnss}, {"host", TimeReference::kHost}},
                                  &config.reference);
      group.number("gnss_latency_ms", {0.0, 10'000.0}, &config.gnss_latency_s, kKeyMillisecond_s);
      group.group("pulse", [&](ConfigReader& pulse) { read_pulse(pulse, &config.pulse); });
    });
    root.group("corrections", [&](ConfigReader& group) {
      read_corrections(group, &config.corrections, &config.services);
      read_correction_files(group, {folder, &source.errors}, products.get());
    });
    read_leo_files(root, {folder, &source.errors}, products.get());
    read_expected_orbits(root, &config.expected_orbits);
    root.number("playback_speed", {0.01, 1000.0}, &config.playback_speed);
    root.number("status_interval_s", {0.0, 3600.0}, &config.status_interval_s);
    const std::size_t errors_before = source.errors.size();
    root.groups("streams", [&](ConfigReader& group) {
      read_stream(group, folder, &config.streams.emplace_back());
    });
    refuse_names(root, config.streams);
    // What a stream with an error is meant to be may not be known.
    if (source.errors.size() > errors_before) return;
    refuse_conflicts(root, config.streams);
    refuse_lonely_pulse(root, config);
  });
  if (lacks_antenna_models(config, *products)) {
    products->report.warnings.push_back(
        "corrections.point is mass_centre, and no model of corrections.antenna_models says where a "
        "satellite's antennas are: unless another program sends ANTENNA, ranges are off by up to "
        "metres, most of it common to all");
  }
  config.products = products;
  return config;
}

}  // namespace leonav
