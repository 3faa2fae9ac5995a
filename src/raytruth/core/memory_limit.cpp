#include "raytruth/core/memory_limit.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <atomic>
#include <limits>

namespace raytruth {

namespace {

// What belongs to the process has one place: no thread may have more of the machine's memory than another.
std::atomic<std::uint64_t> limit = std::numeric_limits<std::uint64_t>::max();

}  // namespace

std::uint64_t memory_limit() { return limit; }

void set_memory_limit(std::uint64_t bytes) { limit = bytes; }

void need_memory(std::uint64_t bytes, std::string_view what, std::string_view place) {
  if (bytes <= memory_limit()) return;
  throw InputError(
      fmt::format("{}{}found {}, which needs {} bytes of memory; the memory limit is {} bytes; --memory-limit SIZE, or "
                  "RAYTRUTH_MEMORY_LIMIT, sets another",
                  place, place.empty() ? "" : ": ", what, bytes, memory_limit()));
}

}  // namespace raytruth
