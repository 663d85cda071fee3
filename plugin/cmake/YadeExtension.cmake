# SPDX-License-Identifier: GPL-2.0-or-later
# The Python extension with the YADE classes, built against the stock package (declarations of plugin/sdk, libraries of libyade).
# Baseline instructions only: -mavx and the like change the alignment of Eigen's types and with it the layout of YADE's classes.
find_package(Python3 3.11 EXACT QUIET COMPONENTS Interpreter Development.Module)
find_package(Boost 1.74 REQUIRED COMPONENTS python311 serialization)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)

find_path(MCA_YADE_LIBDIR libyade.so PATHS /usr/lib/x86_64-linux-gnu/yade-double NO_DEFAULT_PATH DOC "folder of libyade.so (double precision build)")
if(NOT MCA_YADE_LIBDIR)
	message(FATAL_ERROR "libyade.so not found: apt-get install yade, or set -DMCA_YADE_LIBDIR=, or -DMCA_YADE=OFF for the solvers alone")
endif()

# flags of whatever sees YADE's types
add_library(mca_yade_abi INTERFACE)
target_include_directories(mca_yade_abi INTERFACE "${MCA_PLUGIN_DIR}/sdk/include" "${MCA_PLUGIN_DIR}/sdk/helpers"
			   "${MCA_PLUGIN_DIR}")
target_include_directories(mca_yade_abi SYSTEM INTERFACE /usr/include/python3.11)
target_compile_definitions(
	mca_yade_abi INTERFACE EIGEN_DONT_ALIGN EIGEN_DONT_VECTORIZE EIGEN_DONT_PARALLELIZE EIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT BOOST_BIND_GLOBAL_PLACEHOLDERS
			       BOOST_ALLOW_DEPRECATED_HEADERS MCA_VERSION="${MCA_VERSION}")
target_compile_options(mca_yade_abi INTERFACE -Wall -Wextra -ffp-contract=off)
target_link_directories(mca_yade_abi INTERFACE "${MCA_YADE_LIBDIR}")
# -z defs: a symbol this libyade lacks is an error here; libyade and libpkg_* themselves leave symbols to be found in the process
target_link_options(mca_yade_abi INTERFACE -Wl,--no-as-needed -Wl,--allow-shlib-undefined -Wl,-z,defs)
target_link_libraries(
	mca_yade_abi INTERFACE Eigen3::Eigen OpenMP::OpenMP_CXX pkg_dem pkg_common yade Boost::python311 Boost::serialization python3.11)

# registration and guard, once for all extensions
get_property(sdk GLOBAL PROPERTY MCA_SDK_SOURCES)
add_library(mca_sdk OBJECT ${sdk} ${helpers})
target_link_libraries(mca_sdk PRIVATE mca_yade_abi)
# Boost and Eigen are most of the compiler's work; only their headers, so that no source leans on an include of another
target_precompile_headers(
	mca_sdk PRIVATE <boost/python.hpp> <Eigen/Core> <Eigen/Geometry> <boost/archive/binary_iarchive.hpp> <boost/archive/binary_oarchive.hpp>
	<boost/archive/xml_iarchive.hpp> <boost/archive/xml_oarchive.hpp> <boost/serialization/export.hpp> <boost/serialization/shared_ptr.hpp>
	<boost/serialization/vector.hpp> <boost/preprocessor.hpp> <boost/mpl/vector.hpp> <map> <mutex> <string> <vector>)

# mca_add_extension(name sources...): a Python extension module with the YADE classes of these sources, guarded
function(mca_add_extension name)
	add_library(${name} MODULE ${ARGN} "${MCA_PLUGIN_DIR}/sdk/module.cpp" $<TARGET_OBJECTS:mca_sdk>)
	target_compile_definitions(${name} PRIVATE MCA_MODULE=${name})
	target_link_libraries(${name} PRIVATE mca_yade_abi mcasolver)
	target_precompile_headers(${name} REUSE_FROM mca_sdk)
	set_target_properties(
		${name} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY "${MCA_LIB_DIR}" BUILD_RPATH "$ORIGIN;${MCA_YADE_LIBDIR}" INSTALL_RPATH
				   "$ORIGIN;${MCA_YADE_LIBDIR}")
	set_property(TARGET ${name} PROPERTY BUILD_WITH_INSTALL_RPATH ON)
endfunction()

# mca_add_manifest(targets...): sizes, checksums and identities of the libraries, for the loader
function(mca_add_manifest)
	set(libraries)
	foreach(target ${ARGN})
		if(TARGET ${target})
			list(APPEND libraries $<TARGET_FILE:${target}>)
		endif()
	endforeach()
	set(script "${MCA_PLUGIN_DIR}/sdk/manifest.py")
	add_custom_command(
		OUTPUT "${MCA_LIB_DIR}/manifest.json"
		COMMAND /usr/bin/python3 "${script}" "${MCA_LIB_DIR}" "${MCA_VERSION}" "${PROJECT_SOURCE_DIR}" "${MCA_YADE_LIBDIR}"
		DEPENDS ${libraries} "${script}" "${PROJECT_SOURCE_DIR}/pyscripts/yade_mca/_elf.py"
		VERBATIM)
	add_custom_target(mca_manifest ALL DEPENDS "${MCA_LIB_DIR}/manifest.json")
endfunction()
