# SPDX-License-Identifier: GPL-2.0-or-later
# The Python extension with the YADE classes, built against the stock package (declarations of plugin/sdk, libraries of libyade).
# Baseline instructions only: -mavx and the like change the alignment of Eigen's types and with it the layout of YADE's classes.
find_path(MCA_YADE_LIBDIR libyade.so PATHS /usr/lib/x86_64-linux-gnu/yade-double NO_DEFAULT_PATH DOC "folder of libyade.so (double precision build)")
if(NOT MCA_YADE_LIBDIR)
	message(FATAL_ERROR "libyade.so not found: apt-get install yade, or set -DMCA_YADE_LIBDIR=, or -DMCA_YADE=OFF for the solvers alone")
endif()

# version, Python and Boost are those of the installed YADE; another YADE in that folder configures anew
execute_process(
	COMMAND /usr/bin/python3 "${MCA_PLUGIN_DIR}/sdk/facts.py" "${MCA_YADE_LIBDIR}" RESULT_VARIABLE status OUTPUT_VARIABLE facts ERROR_VARIABLE message)
if(status)
	message(FATAL_ERROR "${message}")
endif()
cmake_language(EVAL CODE "${facts}")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${MCA_PLUGIN_DIR}/sdk/facts.py" "${MCA_YADE_LIBDIR}/libyade.so" "${MCA_YADE_LIBDIR}/py/yade/config.py")
option(MCA_YADE_UNKNOWN "build against a version of YADE that the declarations were never compared with" OFF)
if(MCA_YADE_STANDING STREQUAL tried)
	message(WARNING "YADE ${MCA_YADE_VERSION} was tried but is not supported; the guard decides at import")
elseif(NOT MCA_YADE_STANDING STREQUAL supported AND NOT MCA_YADE_UNKNOWN)
	message(
		FATAL_ERROR
			"The declarations in plugin/sdk do not know YADE ${MCA_YADE_VERSION} (${MCA_YADE_LIBDIR}). `pyscripts/run abi` measures what differs, plugin/sdk/README.md says "
			"what to do then; -DMCA_YADE_UNKNOWN=ON builds all the same and leaves it to the guard.")
endif()
find_package(Boost ${MCA_YADE_BOOST} EXACT REQUIRED CONFIG COMPONENTS python serialization)
find_package(Eigen3 REQUIRED NO_MODULE)
set(python "/usr/include/python${MCA_YADE_PYTHON}")
if(NOT EXISTS "${python}/Python.h")
	message(FATAL_ERROR "no ${python}/Python.h: apt-get install libpython${MCA_YADE_PYTHON}-dev")
endif()

# flags of whatever sees YADE's types
add_library(mca_yade_abi INTERFACE)
target_include_directories(mca_yade_abi INTERFACE "${MCA_PLUGIN_DIR}/sdk/include" "${MCA_PLUGIN_DIR}/sdk/helpers"
			   "${MCA_PLUGIN_DIR}")
target_include_directories(mca_yade_abi SYSTEM INTERFACE "${python}")
target_compile_definitions(
	mca_yade_abi INTERFACE EIGEN_DONT_ALIGN EIGEN_DONT_VECTORIZE EIGEN_DONT_PARALLELIZE EIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT BOOST_BIND_GLOBAL_PLACEHOLDERS
			       BOOST_ALLOW_DEPRECATED_HEADERS MCA_VERSION="${MCA_VERSION}" MCA_YADE_NUMBER=${MCA_YADE_NUMBER}
			       MCA_YADE_VERSION="${MCA_YADE_VERSION}")
target_compile_options(mca_yade_abi INTERFACE -Wall -Wextra -Werror=switch -ffp-contract=off)
target_link_directories(mca_yade_abi INTERFACE "${MCA_YADE_LIBDIR}")
# -z defs: a symbol this libyade lacks is an error here; libyade and libpkg_* themselves leave symbols to be found in the process
target_link_options(mca_yade_abi INTERFACE -Wl,--no-as-needed -Wl,--allow-shlib-undefined -Wl,-z,defs)
target_link_libraries(
	mca_yade_abi INTERFACE Eigen3::Eigen OpenMP::OpenMP_CXX pkg_dem pkg_common yade Boost::python Boost::serialization python${MCA_YADE_PYTHON})

# Boost and Eigen are most of the compiler's work: several sources at once share it. -DMCA_UNITY=OFF compiles each alone, to see that no source leans on another.
option(MCA_UNITY "compile several sources of the extension at once" ON)

# registration and guard, once for all extensions
get_property(sdk GLOBAL PROPERTY MCA_SDK_SOURCES)
add_library(mca_sdk OBJECT ${sdk} ${helpers})
target_link_libraries(mca_sdk PRIVATE mca_yade_abi)
set_target_properties(mca_sdk PROPERTIES UNITY_BUILD ${MCA_UNITY} UNITY_BUILD_BATCH_SIZE 5)
# only headers of Boost and Eigen, so that no source leans on an include of another
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
	set_target_properties(${name} PROPERTIES BUILD_WITH_INSTALL_RPATH ON UNITY_BUILD ${MCA_UNITY} UNITY_BUILD_BATCH_SIZE 5)
endfunction()

# mca_add_space_objects(name sources...): objects of the extension that are compiled for space
function(mca_add_space_objects name)
	add_library(${name} OBJECT ${ARGN})
	target_compile_definitions(${name} PRIVATE MCA_DIM=3)
	target_link_libraries(${name} PRIVATE mca_yade_abi mcasolver)
	target_precompile_headers(${name} REUSE_FROM mca_sdk)
	set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON UNITY_BUILD ${MCA_UNITY} UNITY_BUILD_BATCH_SIZE 5)
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
		DEPENDS ${libraries} "${script}" "${MCA_PLUGIN_DIR}/sdk/facts.py" "${PROJECT_SOURCE_DIR}/pyscripts/yade_mca/_elf.py" "${MCA_YADE_LIBDIR}/libyade.so"
		VERBATIM)
	add_custom_target(mca_manifest ALL DEPENDS "${MCA_LIB_DIR}/manifest.json")
endfunction()
