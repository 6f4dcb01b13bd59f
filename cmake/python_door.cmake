# SPDX-License-Identifier: GPL-2.0-or-later
# nscd_lmp/_core: the core as a Python module, and its type stubs.
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)
execute_process(COMMAND ${Python_EXECUTABLE} -m nanobind --cmake_dir
                OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE nanobind_ROOT COMMAND_ERROR_IS_FATAL ANY)
find_package(nanobind CONFIG REQUIRED)

nanobind_add_module(_core NB_STATIC nscd_lmp/bindings/module.cpp
                    nscd_lmp/bindings/external_fix.cpp nscd_lmp/bindings/external_fix_arrays.cpp
                    nscd_lmp/bindings/list_reach.cpp
                    nscd_lmp/bindings/problems.cpp nscd_lmp/bindings/grain_arrays.cpp
                    nscd_lmp/bindings/python_ranks.cpp nscd_lmp/bindings/told_pair.cpp)
target_compile_options(_core PRIVATE -Wno-psabi)
target_link_libraries(_core PRIVATE nscd_core)
nanobind_add_stub(_core_stub MODULE _core OUTPUT _core.pyi PYTHON_PATH $<TARGET_FILE_DIR:_core> DEPENDS _core)
export_only(_core PyInit__core)
install(TARGETS _core LIBRARY DESTINATION nscd_lmp)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/_core.pyi DESTINATION nscd_lmp)
