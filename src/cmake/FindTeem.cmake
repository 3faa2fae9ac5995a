# Teem reads NRRD headers. Debian: libteem-dev, whose own CMake package names files that are not there.
# Defines the target Teem::teem.
find_path(Teem_INCLUDE_DIR NAMES teem/nrrd.h)
find_library(Teem_LIBRARY NAMES teem)
mark_as_advanced(Teem_INCLUDE_DIR Teem_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  Teem
  REQUIRED_VARS Teem_LIBRARY Teem_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "on Debian: apt-get install libteem-dev")

if(Teem_FOUND AND NOT TARGET Teem::teem)
  add_library(Teem::teem UNKNOWN IMPORTED)
  set_target_properties(Teem::teem PROPERTIES IMPORTED_LOCATION "${Teem_LIBRARY}"
                                              INTERFACE_INCLUDE_DIRECTORIES "${Teem_INCLUDE_DIR}")
endif()
