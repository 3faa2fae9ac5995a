# EGL, OpenGL without a window on the machine's own driver. Debian: libegl-dev.
# Defines the target EGL::EGL (headers as <EGL/egl.h>, <GL/glcorearb.h>). CMake's FindOpenGL wants libOpenGL for it.
find_path(EGL_INCLUDE_DIR NAMES EGL/egl.h)
find_path(EGL_core_INCLUDE_DIR NAMES GL/glcorearb.h)
find_library(EGL_LIBRARY NAMES EGL)
mark_as_advanced(EGL_INCLUDE_DIR EGL_core_INCLUDE_DIR EGL_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  EGL
  REQUIRED_VARS EGL_LIBRARY EGL_INCLUDE_DIR EGL_core_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "on Debian: apt-get install libegl-dev")

if(EGL_FOUND AND NOT TARGET EGL::EGL)
  add_library(EGL::EGL UNKNOWN IMPORTED)
  set_target_properties(
    EGL::EGL PROPERTIES IMPORTED_LOCATION "${EGL_LIBRARY}" INTERFACE_COMPILE_DEFINITIONS EGL_NO_X11
                        INTERFACE_INCLUDE_DIRECTORIES "${EGL_INCLUDE_DIR};${EGL_core_INCLUDE_DIR}")
endif()
