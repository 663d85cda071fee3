# SPDX-License-Identifier: GPL-2.0-or-later
# The Debian package: `cmake --build build --target package` (or `cpack -G DEB` in the build folder) makes build/yade-mca_VERSION_amd64.deb.
# Only for the stock package of YADE; nothing of YADE is replaced, plain `yade` never loads it. One package per release of Debian, made on it: 0.1.0~deb12u1, 0.1.0~deb13u1.
set(debian "${MCA_PLUGIN_DIR}/debian")
set(python lib/python3/dist-packages)

# maintainer: whoever builds the package may name himself as for any Debian package (DEBFULLNAME, DEBEMAIL); else those who sign the last commit
set(MCA_MAINTAINER "" CACHE STRING "maintainer field of the package, Name <address>; empty: DEBFULLNAME and DEBEMAIL, else the author of the last commit")
set(maintainer "${MCA_MAINTAINER}")
if(NOT maintainer AND DEFINED ENV{DEBFULLNAME} AND DEFINED ENV{DEBEMAIL})
	set(maintainer "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
if(NOT maintainer)
	execute_process(
		COMMAND git -C "${PROJECT_SOURCE_DIR}" log -1 "--format=%an <%ae>"
		OUTPUT_VARIABLE maintainer OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT maintainer) # sources without history: the domain .invalid says that this is no address
	set(maintainer "yade-mca authors <no-address@yade-mca.invalid>")
endif()

# release of Debian: deb13 by /etc/os-release, the code name where that has no number (testing)
set(suite unknown)
set(series unknown)
if(EXISTS /etc/os-release)
	file(STRINGS /etc/os-release release)
	if("${release}" MATCHES "VERSION_CODENAME=([a-z]+)")
		set(suite ${CMAKE_MATCH_1})
		set(series ${CMAKE_MATCH_1})
	endif()
	if("${release}" MATCHES "VERSION_ID=\"?([0-9.]+)")
		set(series deb${CMAKE_MATCH_1})
	endif()
endif()
set(packageVersion "${MCA_VERSION}~${series}u1")

install(DIRECTORY "${PROJECT_SOURCE_DIR}/pyscripts/yade_mca" DESTINATION ${python} PATTERN "__pycache__" EXCLUDE PATTERN "*.pyc" EXCLUDE)
install(PROGRAMS "${PROJECT_SOURCE_DIR}/pyscripts/yade-mca" "${PROJECT_SOURCE_DIR}/pyscripts/yade-mca-batch" DESTINATION bin)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/pyscripts/examples" DESTINATION share/yade-mca FILES_MATCHING PATTERN "*.py" PATTERN "*.table" PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY "${MCA_LIB_DIR}/" DESTINATION ${python}/yade_mca/lib FILES_MATCHING PATTERN "*.so")
install(FILES "${debian}/copyright" DESTINATION share/doc/yade-mca)
# strip, no search path outside the package, sizes and checksums of what is installed, compressed pages
install(
	CODE "file(RPATH_CHANGE FILE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${python}/yade_mca/lib/_yade_mca.so\" OLD_RPATH \"\\\$ORIGIN:${MCA_YADE_LIBDIR}\" NEW_RPATH \"\\\$ORIGIN\")
set(root \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\")
execute_process(COMMAND /usr/bin/python3 \"${debian}/finish.py\" \"\${root}\" \"${PROJECT_SOURCE_DIR}\" \"${MCA_VERSION}\" \"${MCA_YADE_LIBDIR}\" \"${maintainer}\" \"${packageVersion}\" ${suite} COMMAND_ERROR_IS_FATAL ANY)")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME yade-mca)
set(CPACK_PACKAGE_VERSION "${packageVersion}")
set(CPACK_PACKAGE_CONTACT "${maintainer}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "movable cellular automata with a Lagrangian grid for YADE")
set(CPACK_PACKAGE_DESCRIPTION
    "Adds classes to the discrete element code YADE without rebuilding it: metals
under shock and impact as movable cellular automata (equation of state,
plasticity, fracture, contact), tied to a Lagrangian finite-difference grid.
.
Scripts start with yade-mca in place of yade, or import yade_mca. Plain yade
is not touched.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES OFF) # finish.py does it before the checksums are taken
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# the YADE it was built with, to the build; dpkg-shlibdeps (dpkg-dev, file) adds the shared libraries with the versions they need here
string(REGEX REPLACE "^3\\." "" minor "${MCA_YADE_PYTHON}")
math(EXPR minor "${minor} + 1")
set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "yade (= ${MCA_YADE_PACKAGE}), libyade (= ${MCA_YADE_PACKAGE}), python3 (>= ${MCA_YADE_PYTHON}), python3 (<< 3.${minor}), python3-numpy, python3-scipy, python3-matplotlib, python3-pil, python3-vtk9")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${MCA_LIB_DIR}" "${MCA_YADE_LIBDIR}")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS python3-tqdm)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${debian}/postinst;${debian}/prerm")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
