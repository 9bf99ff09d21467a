#include "tools/export/mcap_track.h"

#include <stdexcept>

#include "tools/export/mcap_writer.h"
#include "tools/export/ros_messages.h"
#include "tools/export/utc_text.h"

namespace leonav {
namespace {

constexpr std::size_t index_of(RosTopicIndex topic) { return static_cast<std::size_t>(topic); }

}  // namespace

McapCounts write_mcap(std::span<const SolutionRow> rows, OutputFile* file) {
  std::vector<McapChannel> channels;
  for (const RosTopic& topic : ros_topics()) {
    channels.push_back({topic.name, "cdr", topic.type, "ros2msg", topic.definition});
  }
  McapWriter writer(file, "ros2", std::move(channels));
  const Geodetic origin = rows.front().pva.position;
  McapCounts counts;
  for (const SolutionRow& row : rows) {
    if (!is_ros_time(row.pva.time)) {
      throw std::runtime_error(utc_text(row.pva.time) +
                               ": ROS has no times after 2038; choose another format");
    }
    const std::int64_t time = unix_nanoseconds(row.pva.time);
    writer.add(index_of(RosTopicIndex::kFix), time, nav_sat_fix(row));
    ++counts.fixes;
    writer.add(index_of(RosTopicIndex::kSource), time, source_text(row));
    if (const auto pose = odometry(row, origin)) {
      writer.add(index_of(RosTopicIndex::kOdometry), time, *pose);
      ++counts.odometries;
    }
  }
  writer.finish();
  return counts;
}

}  // namespace leonav
