#pragma once

#include <cstdint>
#include <string_view>

namespace raytruth {

/// How many bytes of memory one thing that a file announces may need, as the voxels of a volume, an image, a table, a
/// document. What needs more is refused before any is asked for. No limit unless a program sets one.
[[nodiscard]] std::uint64_t memory_limit();

/// Texts and documents that need no more are read whatever the limit is: a limit on volumes is none on cases.
inline constexpr std::uint64_t always_within_memory_limit = std::uint64_t{1} << 26U;

/// To be called before anything is read.
void set_memory_limit(std::uint64_t bytes);

/// Refuses `what` where it needs more bytes than the limit: "PLACE: found WHAT, which needs N bytes of memory; ...";
/// the place may be left to who catches it. Throws InputError.
void need_memory(std::uint64_t bytes, std::string_view what, std::string_view place = {});

}  // namespace raytruth
