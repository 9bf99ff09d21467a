// This unit holds the lengths of the fields that VectorNav's binary groups consist of.
//
// Source: VN-200 and VN-300 user manuals (UM004, UM005), chapter "User Configurable Binary Output
// Messages".
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace leonav {

// The groups in the order in which their fields follow each other in a message.
enum class VectornavGroup : std::uint8_t { kCommon, kTime, kImu, kGnss1, kAttitude, kIns, kGnss2 };
inline constexpr std::size_t kVectornavGroups = 7;
inline constexpr std::size_t kVectornavFields = 16;  // bits of a group's mask

// Returns the length of a field in bytes; 0 for one that is reserved or has no fixed length.
std::size_t vectornav_field_bytes(VectornavGroup group, std::size_t field);

// The extent of one message, as its header gives it.
struct VectornavExtent {
  std::size_t header_bytes = 0;   // sync byte, groups and masks
  std::size_t payload_bytes = 0;  // fields
  // Sync byte to checksum.
  std::size_t total_bytes() const { return header_bytes + payload_bytes + 2; }
};

// The result of reading a header.
enum class VectornavHeader : std::uint8_t {
  kComplete,
  kIncomplete,   // more bytes are needed
  kUnknownField  // a group or field whose length is not known: the end cannot be found
};

// Reads the header at the start of `bytes`, which begins with the sync byte.
VectornavHeader read_vectornav_header(std::span<const std::uint8_t> bytes, VectornavExtent* extent);

// Longest header: sync byte, groups, and a mask of each group.
inline constexpr std::size_t kMaxVectornavHeader = 2 + 2 * kVectornavGroups;

// Longest message: every field with a known length, in every group.
inline constexpr std::size_t kMaxVectornavMessage = 1200;

}  // namespace leonav
