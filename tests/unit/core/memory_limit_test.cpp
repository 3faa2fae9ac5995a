#include "raytruth/core/memory_limit.hpp"

#include "raytruth/core/error.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace raytruth {
namespace {

TEST(MemoryLimit, RefusesWhatNeedsMore) {
  EXPECT_NO_THROW(need_memory(std::numeric_limits<std::uint64_t>::max(), "everything"));  // none is set
  set_memory_limit(100);
  EXPECT_NO_THROW(need_memory(100, "an image"));
  try {
    need_memory(101, "an image", "a.png");
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "a.png: found an image, which needs 101 bytes of memory; the memory limit is 100 bytes; --memory-limit "
              "SIZE, or RAYTRUTH_MEMORY_LIMIT, sets another");
  }
  set_memory_limit(std::numeric_limits<std::uint64_t>::max());
}

}  // namespace
}  // namespace raytruth
