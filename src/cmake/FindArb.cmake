# Arb, ball arithmetic, and the number theory library FLINT below it. Debian: libflint-arb-dev, where Arb's own name of
# the library is flint-arb; elsewhere it is arb.
# Defines the target Arb::arb (headers as <arb.h>, <acb_calc.h>).
find_path(Arb_INCLUDE_DIR NAMES acb_calc.h)
find_path(Arb_flint_INCLUDE_DIR NAMES flint/flint.h)
find_library(Arb_LIBRARY NAMES flint-arb arb)
find_library(Arb_flint_LIBRARY NAMES flint)
mark_as_advanced(Arb_INCLUDE_DIR Arb_flint_INCLUDE_DIR Arb_LIBRARY Arb_flint_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  Arb
  REQUIRED_VARS Arb_LIBRARY Arb_flint_LIBRARY Arb_INCLUDE_DIR Arb_flint_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "on Debian: apt-get install libflint-arb-dev")

if(Arb_FOUND AND NOT TARGET Arb::arb)
  add_library(Arb::arb UNKNOWN IMPORTED)
  set_target_properties(
    Arb::arb PROPERTIES IMPORTED_LOCATION "${Arb_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${Arb_INCLUDE_DIR};${Arb_flint_INCLUDE_DIR}"
                        INTERFACE_LINK_LIBRARIES "${Arb_flint_LIBRARY}")
endif()
