#pragma once

#include <array>
#include <string_view>

namespace raytruth {

/// The types in which a file may store its voxels.
enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

struct VoxelTypeFacts {
  std::string_view name;
  int bytes;
  bool is_integer;
  bool is_signed;
};

[[nodiscard]] constexpr VoxelTypeFacts facts(VoxelType type) {
  constexpr std::array<VoxelTypeFacts, 10> table{{{"int8", 1, true, true},
                                                  {"uint8", 1, true, false},
                                                  {"int16", 2, true, true},
                                                  {"uint16", 2, true, false},
                                                  {"int32", 4, true, true},
                                                  {"uint32", 4, true, false},
                                                  {"int64", 8, true, true},
                                                  {"uint64", 8, true, false},
                                                  {"float32", 4, false, true},
                                                  {"float64", 8, false, true}}};
  return table[static_cast<std::size_t>(type)];
}

}  // namespace raytruth
