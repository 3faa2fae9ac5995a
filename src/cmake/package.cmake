# The manual and the completions, which the program writes itself, and the Debian package, which `cpack -G DEB` makes in a
# build folder. Whatever has an install rule is in the package: a module of another language needs no word here.

if(NOT CMAKE_CROSSCOMPILING)
  set(written ${PROJECT_BINARY_DIR}/written)
  find_program(GZIP gzip)
  if(GZIP)
    set(compress COMMAND ${GZIP} -9nr ${written}/man1) # without names and times, so that bytes are those of the texts
  endif()
  add_custom_command(
    OUTPUT ${written}/stamp
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${written}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${written}
    COMMAND raytruth_program manual -o ${written}/man1
    COMMAND raytruth_program completion bash -o ${written}/raytruth
    COMMAND raytruth_program completion fish -o ${written}/raytruth.fish
    COMMAND raytruth_program completion zsh -o ${written}/_raytruth
    ${compress}
    COMMAND ${CMAKE_COMMAND} -E touch ${written}/stamp
    DEPENDS raytruth_program
    COMMENT "Writing the manual and the completions"
    VERBATIM)
  add_custom_target(raytruth_manual ALL DEPENDS ${written}/stamp)
  install(DIRECTORY ${written}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
  install(FILES ${written}/raytruth DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${written}/raytruth.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
  install(FILES ${written}/_raytruth DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
endif()

# What Debian wants beside the files: whose they are, and a changelog in its form.
set(CPACK_PACKAGE_CONTACT "The Raytruth authors <raytruth@packages.debian.org>")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC) # of SOURCE_DATE_EPOCH where it is set
file(WRITE ${PROJECT_BINARY_DIR}/changelog
     "raytruth (${PROJECT_VERSION}) unstable; urgency=medium\n\n  * CHANGELOG.md of the sources tells what is new.\n\n"
     " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
find_program(GZIP gzip)
if(GZIP)
  execute_process(COMMAND ${GZIP} -9nkf ${PROJECT_BINARY_DIR}/changelog)
  install(FILES ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME raytruth)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "how wrong approximations of the volume rendering integral are")
set(CPACK_PACKAGE_DESCRIPTION
    "Raytruth takes rays through volumes, by every published scheme of volume\nrendering, against values with a proven bound. It has the program, the\nexperiments with their schemas, and the C++ library with its headers.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
if(TARGET raytruth_python) # its file's name says for which Python it is
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(python_versions ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR} ${Python_VERSION_MAJOR}.${next})
  list(JOIN python_versions "), python3 (<< " python_versions)
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= ${python_versions})")
endif()
# Plots; a volume that is always at hand; what programs that use the library include.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-matplotlib, python3-numpy, mricron-data")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "cmake, g++, libboost-dev, libegl-dev, libeigen3-dev, libflint-arb-dev, libfmt-dev, libnifti-dev, libpng-dev, libpugixml-dev, libtbb-dev, libteem-dev, nlohmann-json3-dev, zlib1g-dev")
include(CPack)
