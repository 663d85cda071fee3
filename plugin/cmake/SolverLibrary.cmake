# SPDX-License-Identifier: GPL-2.0-or-later
# The solver library, once per instruction level: same sources, same name, other folder; the dynamic loader takes the highest level the machine has.
# Never -ffast-math: at link it would switch the whole process to flush denormals. -ffp-contract=off: a fused multiply-add only where written.
find_package(OpenMP REQUIRED)

set(MCA_OPTIMISATION "-O3" CACHE STRING "level of optimisation of the solvers")
set(MCA_SOLVER_FLAGS ${MCA_OPTIMISATION} -ffp-contract=off -fno-math-errno -fno-trapping-math -fvisibility=hidden -fvisibility-inlines-hidden -Wall -Wextra -Werror=switch -Wno-psabi)
if(MCA_SANITIZE)
	list(TRANSFORM MCA_SOLVER_FLAGS REPLACE "^-O[0-3]$" "-O1")
endif()

# what all sources of a solver are compiled with
function(mca_solver_options target level)
	target_include_directories(${target} PUBLIC "${MCA_PLUGIN_DIR}")
	target_compile_options(${target} PRIVATE ${MCA_SOLVER_FLAGS})
	if(level)
		target_compile_options(${target} PRIVATE -march=${level})
		if(level STREQUAL "x86-64-v4")
			target_compile_options(${target} PRIVATE -mprefer-vector-width=512)
		endif()
	endif()
	target_link_libraries(${target} PUBLIC OpenMP::OpenMP_CXX)
endfunction()

function(mca_add_solver target level folder)
	get_property(space GLOBAL PROPERTY MCA_SPACE_SOURCES)
	add_library(${target}_space OBJECT ${space})
	mca_solver_options(${target}_space "${level}")
	target_compile_definitions(${target}_space PRIVATE MCA_DIM=3)
	add_library(${target} SHARED ${ARGN} $<TARGET_OBJECTS:${target}_space>)
	mca_solver_options(${target} "${level}")
	if(NOT MCA_SANITIZE) # clang's sanitizer runtime is linked to the program alone
		target_link_options(${target} PRIVATE -Wl,-z,defs)
	endif()
	set_target_properties(${target} PROPERTIES OUTPUT_NAME mcasolver LIBRARY_OUTPUT_DIRECTORY "${MCA_LIB_DIR}/${folder}")
endfunction()
