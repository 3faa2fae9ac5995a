# libnifti defines the NIfTI-1 header. Debian: libnifti-dev.
# Defines the target NIFTI::nifti (headers as <nifti1_io.h>).
find_path(NIFTI_INCLUDE_DIR NAMES nifti1_io.h PATH_SUFFIXES nifti)
find_library(NIFTI_LIBRARY NAMES niftiio)
find_library(NIFTI_znz_LIBRARY NAMES znz)
mark_as_advanced(NIFTI_INCLUDE_DIR NIFTI_LIBRARY NIFTI_znz_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  NIFTI
  REQUIRED_VARS NIFTI_LIBRARY NIFTI_znz_LIBRARY NIFTI_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "on Debian: apt-get install libnifti-dev")

if(NIFTI_FOUND AND NOT TARGET NIFTI::nifti)
  add_library(NIFTI::nifti UNKNOWN IMPORTED)
  set_target_properties(
    NIFTI::nifti PROPERTIES IMPORTED_LOCATION "${NIFTI_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${NIFTI_INCLUDE_DIR}"
                            INTERFACE_LINK_LIBRARIES "${NIFTI_znz_LIBRARY}")
endif()
