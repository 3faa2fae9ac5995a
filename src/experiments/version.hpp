#pragma once

namespace raytruth {

/// What this program was built from and how; written into every result's provenance. src/cmake/version.cmake fills them
/// in at each build.
extern const char* const version;      ///< of the project, as "0.1.0"
extern const char* const commit;       ///< git's hash, with "-dirty" for a changed tree; "unknown" outside git
extern const char* const commit_date;  ///< as "2026-11-30"; empty outside git
extern const char* const compiler;     ///< as "GNU 12.2.0"
extern const char* const flags;        ///< those of the build type and those that decide about bits

}  // namespace raytruth
