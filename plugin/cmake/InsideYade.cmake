# SPDX-License-Identifier: GPL-2.0-or-later
# Included at the end of YADE's own CMakeLists.txt (patches/0001): builds the plugin as one more library of YADE's, libyade_mca.so, which YADE loads at start
# as it loads all libraries in its folder. Then `import yade_mca` finds the classes there and loads nothing.
get_filename_component(MCA_PLUGIN_DIR "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
set(MCA_INSIDE_YADE ON)
set(MCA_LIB_DIR "${CMAKE_BINARY_DIR}/yade_mca_lib")
set(MCA_VERSION "inside YADE")
set(MCA_HWCAPS OFF) # YADE is then built for one machine, with its own flags
add_subdirectory("${MCA_PLUGIN_DIR}" "${CMAKE_BINARY_DIR}/mca")
