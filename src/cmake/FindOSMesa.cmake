# OSMesa, Mesa's OpenGL into memory: its headers. The library is loaded when it is needed. Debian: libosmesa6-dev.
# Defines the target OSMesa::OSMesa (headers as <GL/osmesa.h>, <GL/glcorearb.h>).
find_path(OSMesa_INCLUDE_DIR NAMES GL/osmesa.h)
find_path(OSMesa_core_INCLUDE_DIR NAMES GL/glcorearb.h)
mark_as_advanced(OSMesa_INCLUDE_DIR OSMesa_core_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  OSMesa
  REQUIRED_VARS OSMesa_INCLUDE_DIR OSMesa_core_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "on Debian: apt-get install libosmesa6-dev")

if(OSMesa_FOUND AND NOT TARGET OSMesa::OSMesa)
  add_library(OSMesa::OSMesa INTERFACE IMPORTED)
  set_target_properties(
    OSMesa::OSMesa PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${OSMesa_INCLUDE_DIR};${OSMesa_core_INCLUDE_DIR}")
endif()
