# OSMesa, Mesa's OpenGL into memory. Debian: libosmesa6-dev.
# Defines the target OSMesa::OSMesa (headers as <GL/osmesa.h>, <GL/glcorearb.h>).
find_path(OSMesa_INCLUDE_DIR NAMES GL/osmesa.h)
find_path(OSMesa_core_INCLUDE_DIR NAMES GL/glcorearb.h)
find_library(OSMesa_LIBRARY NAMES OSMesa)
mark_as_advanced(OSMesa_INCLUDE_DIR OSMesa_core_INCLUDE_DIR OSMesa_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  OSMesa
  REQUIRED_VARS OSMesa_LIBRARY OSMesa_INCLUDE_DIR OSMesa_core_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "on Debian: apt-get install libosmesa6-dev")

if(OSMesa_FOUND AND NOT TARGET OSMesa::OSMesa)
  add_library(OSMesa::OSMesa UNKNOWN IMPORTED)
  set_target_properties(
    OSMesa::OSMesa PROPERTIES IMPORTED_LOCATION "${OSMesa_LIBRARY}"
                              INTERFACE_INCLUDE_DIRECTORIES "${OSMesa_INCLUDE_DIR};${OSMesa_core_INCLUDE_DIR}")
endif()
