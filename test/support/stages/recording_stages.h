// StageInputs that keeps what the Sequencer issues.
#pragma once
#include <variant>
#include <vector>

#include "core/navigator/sequencer/sequencer.h"

namespace leonav::test {

struct RecordingStages : StageInputs {
  struct Block {
    std::uint64_t index = 0;
    GpsTime time;
    bool empty = false;
    std::size_t observations = 0;
    std::vector<ImuSample> samples;
    std::vector<OdometerIncrement> odometer;
  };
  std::vector<std::uint64_t> opened;
  std::vector<ImuSample> samples;
  std::vector<EpochIssued> issued;
  std::vector<Block> blocks;
  std::vector<Command> commands;
  std::vector<Restart> restarts;
  std::vector<TimeWithoutImu> times_without_imu;
  std::vector<std::size_t> restarts_at_command;  // how many there were at each command
  std::vector<PreciseStates> precise;
  std::vector<Checkpoint> checkpoints;
  std::vector<Event> events;

  void open_epoch(std::uint64_t index) override { opened.push_back(index); }
  void push_inertial(const InertialWork& work) override {
    if (const auto* sample = std::get_if<ImuSample>(&work)) samples.push_back(*sample);
    if (const auto* epoch = std::get_if<EpochIssued>(&work)) issued.push_back(*epoch);
    if (const auto* restart = std::get_if<Restart>(&work)) restarts.push_back(*restart);
    if (const auto* data = std::get_if<TimeWithoutImu>(&work)) times_without_imu.push_back(*data);
  }
  void push_gnss(const GnssWork& work) override {
    if (const auto* command = std::get_if<Command>(&work)) {
      commands.push_back(*command);
      restarts_at_command.push_back(restarts.size());
    }
    if (const auto* states = std::get_if<PreciseStates>(&work)) precise.push_back(*states);
    if (const auto* one = std::get_if<Checkpoint>(&work)) checkpoints.push_back(*one);
    const auto* epoch = std::get_if<EpochWork>(&work);
    if (epoch == nullptr) return;
    blocks.push_back({epoch->index,
                      epoch->time,
                      epoch->empty,
                      epoch->raw.observations.size(),
                      {epoch->block.begin(), epoch->block.end()},
                      {epoch->odometer.begin(), epoch->odometer.end()}});
  }
  void event(const Event& event) override { events.push_back(event); }

  std::size_t count(EventKind kind) const {
    std::size_t n = 0;
    for (const Event& event : events) n += event.kind == kind ? 1 : 0;
    return n;
  }
};

}  // namespace leonav::test
