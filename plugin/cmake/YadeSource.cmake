# SPDX-License-Identifier: GPL-2.0-or-later
# The same YADE classes against YADE's sources instead of the declarations of plugin/sdk/include.

# mca_use_yade_source(target folder): include paths and warnings for sources that see YADE's own headers in folder
function(mca_use_yade_source target folder)
	target_include_directories(${target} SYSTEM PRIVATE "${folder}")
	if(NOT EXISTS "${folder}/core/Dispatching.hpp") # before 2021
		target_include_directories(${target} PRIVATE "${MCA_PLUGIN_DIR}/sdk/compat")
	endif()
	target_include_directories(${target} PRIVATE "${MCA_PLUGIN_DIR}/sdk/helpers" "${MCA_PLUGIN_DIR}")
	target_compile_definitions(${target} PRIVATE BOOST_BIND_GLOBAL_PLACEHOLDERS BOOST_ALLOW_DEPRECATED_HEADERS MCA_VERSION="${MCA_VERSION}")
endfunction()

# -DYADE_SOURCE_DIR=: compile all classes against these sources, to see that they fit; nothing is linked
function(mca_add_yade_source_check target folder)
	find_package(Eigen3 REQUIRED NO_MODULE)
	execute_process(COMMAND /usr/bin/python3 -c "import sysconfig; print(sysconfig.get_path('include'))" OUTPUT_VARIABLE python OUTPUT_STRIP_TRAILING_WHITESPACE)
	set(definitions YADE_OPENMP YADE_OPENGL YADE_REAL_BIT=64 YADE_REAL_DEC=15 MAX_LOG_LEVEL=6)
	add_library(${target} OBJECT ${ARGN})
	mca_use_yade_source(${target} "${folder}")
	target_include_directories(${target} SYSTEM PRIVATE "${python}")
	target_compile_definitions(${target} PRIVATE ${definitions})
	target_link_libraries(${target} PRIVATE Eigen3::Eigen OpenMP::OpenMP_CXX)
endfunction()
