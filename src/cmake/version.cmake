# cmake -D SOURCE= -D OUTPUT= -D VERSION= -D COMPILER= -D FLAGS= -P version.cmake
# Writes what src/experiments/version.hpp declares; leaves the file alone where nothing changed.

# A source tree without git history of its own, perhaps unpacked inside somebody else's repository, has no commit.
# No optional locks: a build must never be in the way of a git command.
set(git git --no-optional-locks -C ${SOURCE})
execute_process(COMMAND ${git} rev-parse --show-prefix RESULT_VARIABLE failed OUTPUT_VARIABLE prefix ERROR_QUIET
                OUTPUT_STRIP_TRAILING_WHITESPACE)
set(COMMIT "")
if(NOT failed AND prefix STREQUAL "")
  execute_process(COMMAND ${git} describe --always --dirty --exclude=* --abbrev=40 OUTPUT_VARIABLE COMMIT ERROR_QUIET
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
set(COMMIT_DATE "")
if(COMMIT STREQUAL "")
  set(COMMIT unknown)
else()
  execute_process(COMMAND ${git} log -1 --format=%cs OUTPUT_VARIABLE COMMIT_DATE ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()

string(REGEX REPLACE " +" " " FLAGS "${FLAGS}")
string(STRIP "${FLAGS}" FLAGS)
file(
  CONFIGURE
  OUTPUT ${OUTPUT}
  CONTENT
    [=[#include "experiments/version.hpp"

namespace raytruth {

const char* const version = R"(@VERSION@)";
const char* const commit = R"(@COMMIT@)";
const char* const commit_date = R"(@COMMIT_DATE@)";
const char* const compiler = R"(@COMPILER@)";
const char* const flags = R"(@FLAGS@)";

}  // namespace raytruth
]=]
  @ONLY)
